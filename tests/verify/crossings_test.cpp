// The finders against all pairs, exact truth on float32 soup, and surfaces in every degenerate position.
#include "verify/crossings.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "io/obj.hpp"
#include "support/exact.hpp"
#include "support/paths.hpp"
#include "verify/predicates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <set>
#include <tuple>

namespace toile::internal {
namespace {

using exact::Random;
using Found = std::set<std::tuple<bool, Index, Index, Index>>;  // edge of body, edge, triangle

struct Mesh {
  std::vector<Triangle> triangles;
  Vec3s x;
};

Found as_set(const std::vector<Crossing>& crossings) {
  Found found;
  for (const Crossing& c : crossings) found.insert({c.edge_of_body, c.edge[0], c.edge[1], c.triangle});
  return found;
}

std::set<std::array<Index, 2>> edges_of(const std::vector<Triangle>& triangles) {
  std::set<std::array<Index, 2>> edges;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  return edges;
}

// Every edge of `a` against every triangle of `b`, by `crosses(p, q, a, b, c)` on (mesh, particle).
template <class Crosses>
void all_pairs(const Mesh& a, const Mesh& b, bool same, bool edge_of_body, Crosses&& crosses, Found& found) {
  for (const auto& [i, j] : edges_of(a.triangles))
    for (std::size_t t = 0; t < b.triangles.size(); ++t) {
      const Triangle& corner = b.triangles[t];
      if (same &&
          (std::count(corner.begin(), corner.end(), i) != 0 || std::count(corner.begin(), corner.end(), j) != 0))
        continue;
      if (crosses(i, j, corner)) found.insert({edge_of_body, i, j, static_cast<Index>(t)});
    }
}

Vec3 rounded(const Vec3& p) { return p.cast<float>().cast<double>(); }

// Separate triangles of about `size` in a unit box, in float32.
Mesh soup(Random& random, int count, double size) {
  Mesh mesh;
  for (Index t = 0; t < count; ++t) {
    const Vec3 centre = random.point(0, 1);
    for (int k = 0; k < 3; ++k) mesh.x.push_back(rounded(centre + random.point(-size, size)));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

// A grid of (columns + 1) x (rows + 1) particles placed by `at(column, row)`.
template <class At>
Mesh grid(int columns, int rows, At&& at) {
  Mesh mesh;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) mesh.x.push_back(at(c, r));
  for (Index r = 0; r < rows; ++r)
    for (Index c = 0; c < columns; ++c) {
      const Index i = r * (columns + 1) + c, right = i + 1, up = i + columns + 1;
      mesh.triangles.push_back({i, right, up + 1});
      mesh.triangles.push_back({i, up + 1, up});
    }
  return mesh;
}

TEST(Crossings, AreThoseOfExactArithmeticOnFloatSoup) {
  Random random(21);
  std::size_t total = 0;
  for (int n = 0; n < 20; ++n) {
    const Mesh cloth = soup(random, 24, 0.3), body = soup(random, 24, 0.3);
    Vec3s all = cloth.x;
    all.insert(all.end(), body.x.begin(), body.x.end());
    const auto whole = exact::whole_points(all);
    const auto first_body = cloth.x.size();
    const auto truth = [&](std::size_t edges_from, std::size_t triangles_from) {
      return [&whole, edges_from, triangles_from](Index i, Index j, const Triangle& t) {
        const auto& p = whole[edges_from + static_cast<std::size_t>(i)];
        const auto& q = whole[edges_from + static_cast<std::size_t>(j)];
        const auto& a = whole[triangles_from + static_cast<std::size_t>(t[0])];
        const auto& b = whole[triangles_from + static_cast<std::size_t>(t[1])];
        const auto& c = whole[triangles_from + static_cast<std::size_t>(t[2])];
        const int side = exact::orient3d(p, q, a, b);
        return exact::orient3d(a, b, c, p) * exact::orient3d(a, b, c, q) < 0 && side != 0 &&
               side == exact::orient3d(p, q, b, c) && side == exact::orient3d(p, q, c, a);
      };
    };
    Found expected;
    all_pairs(cloth, body, false, false, truth(0, first_body), expected);
    all_pairs(body, cloth, false, true, truth(first_body, 0), expected);
    total += expected.size();
    EXPECT_EQ(as_set(find_body_crossings(cloth.triangles, cloth.x, body.triangles, body.x)), expected);

    Found expected_self;
    all_pairs(cloth, cloth, true, false, truth(0, 0), expected_self);
    EXPECT_EQ(as_set(find_cloth_crossings(cloth.triangles, cloth.x)), expected_self);
  }
  EXPECT_GT(total, 200u);
}

// The predicate on particles of two meshes, with the ranks that the finders promise.
auto ranked(const Mesh& edges, std::int64_t first, const Mesh& triangles, std::int64_t second) {
  return [&edges, &triangles, first, second](Index i, Index j, const Triangle& t) {
    const auto of_edge = [&](Index k) { return RankedPoint{edges.x[static_cast<std::size_t>(k)], first + k}; };
    const auto of_triangle = [&](Index k) { return RankedPoint{triangles.x[static_cast<std::size_t>(k)], second + k}; };
    return segment_crosses_triangle(of_edge(i), of_edge(j), of_triangle(t[0]), of_triangle(t[1]), of_triangle(t[2]));
  };
}

TEST(Crossings, OfTheTreeAreThoseOfAllPairs) {
  Random random(22);
  // A sheet crumpled onto itself: neighbours everywhere, and many real crossings.
  const Mesh cloth = grid(24, 24, [&](int c, int r) {
    const double u = c / 24.0, v = r / 24.0;
    return rounded(
        Vec3(0.5 * std::sin(7 * u) + 0.02 * random.unit(), 0.5 * std::cos(9 * v + 3 * u), 0.4 * std::sin(5 * v * u)));
  });
  const Mesh body = soup(random, 600, 0.05);
  const auto n = static_cast<std::int64_t>(cloth.x.size());
  Found expected;
  all_pairs(cloth, body, false, false, ranked(cloth, 0, body, n), expected);
  all_pairs(body, cloth, false, true, ranked(body, n, cloth, 0), expected);
  EXPECT_GT(expected.size(), 50u);
  const auto crossings = find_body_crossings(cloth.triangles, cloth.x, body.triangles, body.x);
  EXPECT_EQ(as_set(crossings), expected);
  EXPECT_EQ(crossings.size(), expected.size());

  Found expected_self;
  all_pairs(cloth, cloth, true, false, ranked(cloth, 0, cloth, 0), expected_self);
  EXPECT_GT(expected_self.size(), 50u);
  EXPECT_EQ(as_set(find_cloth_crossings(cloth.triangles, cloth.x)), expected_self);
}

// More frames than a tree lives, of a sheet that crumples up and of a body that comes to it.
TEST(Crossings, OfMovingSurfacesAreThoseOfEveryFrame) {
  Random random(31);
  Mesh body = soup(random, 300, 0.05);
  const Vec3s body_at_start = body.x;
  const auto sheet = [](double bend) {
    return grid(24, 24, [&](int c, int r) {
      const double u = c / 24.0, v = r / 24.0;
      return Vec3(u + bend * (0.5 * std::sin(7 * u) - u), v + bend * (0.5 * std::cos(9 * v + 3 * u) - v),
                  0.4 * bend * std::sin(5 * v * u) + 0.5);
    });
  };
  CrossingSearch search(sheet(0).triangles, body.triangles);
  std::size_t of_body = 0, of_cloth = 0;
  for (int frame = 0; frame < 64; ++frame) {
    const Mesh cloth = sheet(frame / 63.0);
    for (std::size_t i = 0; i < body.x.size(); ++i) body.x[i] = body_at_start[i] + Vec3(0, 0, 1 - frame / 63.0);
    const CrossingSearch::Found found = search.find(cloth.x, body.x);
    const auto expected_body = find_body_crossings(cloth.triangles, cloth.x, body.triangles, body.x);
    const auto expected_cloth = find_cloth_crossings(cloth.triangles, cloth.x);
    ASSERT_EQ(as_set(found.of_body), as_set(expected_body)) << frame;
    ASSERT_EQ(as_set(found.of_cloth), as_set(expected_cloth)) << frame;
    ASSERT_EQ(found.of_body.size(), expected_body.size());
    ASSERT_EQ(found.of_cloth.size(), expected_cloth.size());
    of_body += found.of_body.size();
    of_cloth += found.of_cloth.size();
  }
  EXPECT_GT(of_body, 1000u);
  EXPECT_GT(of_cloth, 1000u);
  EXPECT_THROW(search.find(Vec3s(3, Vec3::Zero()), body.x), InputError);
}

// Lattice points: most pairs touch, overlap or are coplanar, and the answer depends on the ranks.
TEST(Crossings, InDegeneratePositionsAreThoseOfAllPairsWithTheBodyRankedAfterTheCloth) {
  Random random(26);
  std::size_t total = 0;
  for (int n = 0; n < 200; ++n) {
    Mesh cloth, body;
    for (Mesh* mesh : {&cloth, &body})
      for (Index t = 0; t < 6; ++t) {
        for (int k = 0; k < 3; ++k) mesh->x.push_back(random.lattice_point(0, 2));
        mesh->triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
      }
    Found expected;
    all_pairs(cloth, body, false, false, ranked(cloth, 0, body, 18), expected);
    all_pairs(body, cloth, false, true, ranked(body, 18, cloth, 0), expected);
    total += expected.size();
    ASSERT_EQ(as_set(find_body_crossings(cloth.triangles, cloth.x, body.triangles, body.x)), expected) << n;
  }
  EXPECT_GT(total, 1000u);
}

TEST(Crossings, AreSortedAndTheSameOnAnyNumberOfThreads) {
  Random random(23);
  const Mesh cloth = soup(random, 3000, 0.03), body = soup(random, 3000, 0.03);
  std::vector<std::vector<Crossing>> results;
  for (const int threads : {1, 2, 5})
    with_threads(threads,
                 [&] { results.push_back(find_body_crossings(cloth.triangles, cloth.x, body.triangles, body.x)); });
  ASSERT_GT(results[0].size(), 500u);
  const auto key = [](const Crossing& c) { return std::tuple(c.edge_of_body, c.edge, c.triangle); };
  EXPECT_TRUE(std::is_sorted(results[0].begin(), results[0].end(),
                             [&](const Crossing& a, const Crossing& b) { return key(a) < key(b); }));
  for (const auto& result : results) {
    ASSERT_EQ(result.size(), results[0].size());
    for (std::size_t k = 0; k < result.size(); ++k) {
      EXPECT_EQ(key(result[k]), key(results[0][k]));
      EXPECT_EQ(result[k].position, results[0][k].position);
    }
  }
}

TEST(Crossings, LieWhereTheEdgeMeetsTheTriangle) {
  const Mesh body = {{{0, 1, 2}}, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  const Mesh cloth = {{{0, 1, 2}}, {{1, 1, 3}, {1, 1, -1}, {9, 9, 3}}};
  const auto crossings = find_body_crossings(cloth.triangles, cloth.x, body.triangles, body.x);
  ASSERT_FALSE(crossings.empty());
  EXPECT_EQ(crossings[0].edge, (std::array<Index, 2>{0, 1}));
  EXPECT_EQ(crossings[0].triangle, 0);
  EXPECT_LT((crossings[0].position - Vec3(1, 1, 0)).norm(), 1e-14);
}

// A surface that is pierced exactly at a particle, along an edge, or at the middle of an edge, is pierced once.
TEST(Crossings, ThroughAParticleOrAnEdgeOfASurfaceAreCountedOnce) {
  Mesh body = grid(6, 6, [](int c, int r) { return Vec3(c, r, 0); });
  Random random(24);
  for (int n = 0; n < 200; ++n) {
    // Another order of the body's particles: other ranks, other perturbation, same count.
    std::vector<Index> place(body.x.size());
    std::iota(place.begin(), place.end(), 0);
    random.shuffle(place);
    Mesh shuffled = body;
    for (std::size_t i = 0; i < place.size(); ++i) shuffled.x[static_cast<std::size_t>(place[i])] = body.x[i];
    for (Triangle& t : shuffled.triangles)
      for (Index& i : t) i = place[static_cast<std::size_t>(i)];

    // Half-integers: at particles, middles of sides and diagonals; straight down or slanted.
    const Vec3 at(0.5 * static_cast<double>(random.between(2, 10)), 0.5 * static_cast<double>(random.between(2, 10)),
                  0);
    const Vec3 slant(static_cast<double>(random.between(-1, 1)), static_cast<double>(random.between(-1, 1)), 1);
    const Mesh cloth = {{{0, 1, 2}}, {at + slant, at - slant, at + slant + Vec3(0, 0, 7)}};
    const auto crossings = find_body_crossings(cloth.triangles, cloth.x, shuffled.triangles, shuffled.x);
    const auto on_edge = std::count_if(crossings.begin(), crossings.end(), [](const Crossing& c) {
      return !c.edge_of_body && c.edge == std::array<Index, 2>{0, 1};
    });
    ASSERT_EQ(on_edge, 1) << at.transpose() << " slant " << slant.transpose();
  }
}

// Closed curves enter a closed surface as often as they leave it.  On a 3 x 3 x 3 lattice nearly everything is
// coplanar, collinear or coincident, and only one consistent perturbation keeps the sum zero.
TEST(Crossings, OfAClosedCurveWithAClosedSurfaceCancelInEveryDegeneratePosition) {
  const std::vector<Triangle> faces = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}, {0, 5, 1}, {0, 4, 5},
                                       {1, 6, 2}, {1, 5, 6}, {2, 7, 3}, {2, 6, 7}, {3, 4, 0}, {3, 7, 4}};
  Random random(25);
  int crossed = 0;
  for (int n = 0; n < 20000; ++n) {
    std::array<Vec3, 11> x;
    for (Vec3& p : x) p = random.lattice_point(0, 2);
    std::array<int, 11> rank;
    std::iota(rank.begin(), rank.end(), 0);
    random.shuffle(rank);
    const auto at = [&](Index i) {
      return RankedPoint{x[static_cast<std::size_t>(i)], rank[static_cast<std::size_t>(i)]};
    };
    int sum = 0;
    for (const auto& [p, q] : {std::pair{8, 9}, {9, 10}, {10, 8}})
      for (const auto& [a, b, c] : faces)
        if (segment_crosses_triangle(at(p), at(q), at(a), at(b), at(c))) {
          sum += orient3d_perturbed(at(a), at(b), at(c), at(p));
          ++crossed;
        }
    ASSERT_EQ(sum, 0) << n;
  }
  EXPECT_GT(crossed, 10000);
}

TEST(Crossings, OfTwoTrianglesThatShareAParticleAreFoundThroughTheEdgeOppositeToIt) {
  const Mesh cloth = {{{0, 1, 2}, {0, 3, 4}}, {{0, 0, 0}, {2, -1, 0}, {2, 1, 0}, {1, 0, -1}, {1, 0, 1}}};
  const auto crossings = find_cloth_crossings(cloth.triangles, cloth.x);
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_EQ(crossings[0].edge, (std::array<Index, 2>{3, 4}));
  EXPECT_EQ(crossings[0].triangle, 0);
}

TEST(Crossings, AreNotReportedBetweenNeighboursOfAFlatOrSharplyFoldedSheet) {
  const Mesh flat = grid(8, 8, [](int c, int r) { return Vec3(0.1 * c, 0, 0.1 * r); });
  EXPECT_TRUE(find_cloth_crossings(flat.triangles, flat.x).empty());
  const Mesh rolled = grid(40, 5, [](int c, int r) {
    const double turn = 2 * std::numbers::pi * 3 * c / 40.0, radius = 0.1 + 0.002 * c;
    return rounded(Vec3(radius * std::cos(turn), 0.02 * r, radius * std::sin(turn)));
  });
  EXPECT_TRUE(find_cloth_crossings(rolled.triangles, rolled.x).empty());
}

TEST(Crossings, OfABodyTipInsideOneClothTriangleAreEdgesOfTheBody) {
  const Mesh cloth = {{{0, 1, 2}}, {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}};
  const Mesh body = {{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}, {{0, 0, 1}, {1, 0, -3}, {-1, 1, -3}, {-1, -1, -3}}};
  const auto crossings = find_body_crossings(cloth.triangles, cloth.x, body.triangles, body.x);
  EXPECT_EQ(crossings.size(), 3u);
  for (const Crossing& c : crossings) EXPECT_TRUE(c.edge_of_body);
  EXPECT_EQ(count_edges(crossings), 3);
}

TEST(Crossings, AreCountedPerEdge) {
  // One edge through both walls of a box, one through a single triangle.
  const std::vector<Crossing> crossings = {{{0, 1}, 3, Vec3::Zero(), false},
                                           {{0, 1}, 9, Vec3::Zero(), false},
                                           {{0, 2}, 3, Vec3::Zero(), false},
                                           {{0, 2}, 3, Vec3::Zero(), true}};
  EXPECT_EQ(count_edges(crossings), 3);
  EXPECT_EQ(count_edges({}), 0);
}

TEST(Crossings, RefuseWhatIsNoSurface) {
  const std::vector<Triangle> triangle = {{0, 1, 2}}, beyond = {{0, 1, 3}}, negative = {{0, -1, 2}},
                              repeated = {{0, 1, 1}};
  const Vec3s x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  Vec3s bad = x;
  bad[1].y() = std::numeric_limits<double>::quiet_NaN();
  for (const auto* triangles : {&beyond, &negative, &repeated}) {
    EXPECT_THROW(find_cloth_crossings(*triangles, x), InputError);
    EXPECT_THROW(find_body_crossings(triangle, x, *triangles, x), InputError);
  }
  EXPECT_THROW(find_cloth_crossings(triangle, bad), InputError);
  try {
    find_body_crossings(triangle, x, triangle, bad);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("body: vertex 1"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(find_body_crossings({}, {}, triangle, x).empty());
  EXPECT_TRUE(find_cloth_crossings({}, {}).empty());
}

// The mean body of GarmentCode overlaps itself in the mouth, and two of its particles lie at the same place there.
// Each crossing found is confirmed in whole numbers: proper, or touching (which may count).
TEST(Crossings, OfARealBodyWithItselfAreConfirmedByExactArithmetic) {
  const std::string path = test::shared_path("bodies/garmentcode/mean_all.obj");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const SurfaceMesh body = load_obj(path);
  const auto crossings = find_cloth_crossings(body.triangles, body.positions);
  int proper = 0, touching = 0;
  for (const Crossing& c : crossings) {
    const auto at = [&](Index i) { return body.positions[static_cast<std::size_t>(i)]; };
    const Triangle& t = body.triangles[static_cast<std::size_t>(c.triangle)];
    const Vec3 p = at(c.edge[0]), q = at(c.edge[1]), a = at(t[0]), b = at(t[1]), d = at(t[2]);
    const int ends = exact::orient3d(a, b, d, p) * exact::orient3d(a, b, d, q);
    const std::array<int, 3> sides = {exact::orient3d(p, q, a, b), exact::orient3d(p, q, b, d),
                                      exact::orient3d(p, q, d, a)};
    const bool one_side = sides[0] == sides[1] && sides[1] == sides[2] && sides[0] != 0;
    proper += ends < 0 && one_side;
    touching += ends == 0 || sides[0] * sides[1] * sides[2] == 0;
  }
  EXPECT_EQ(count_edges(crossings), 115);
  EXPECT_EQ(proper, 107);
  EXPECT_EQ(touching, 12);
}

}  // namespace
}  // namespace toile::internal
