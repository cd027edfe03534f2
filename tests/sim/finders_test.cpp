// The finder that steers a run and the one that judges it share nothing: here each checks the other.
#include "contact/crossing_finder.hpp"
#include "support/exact.hpp"
#include "support/tangled_starts.hpp"
#include "verify/crossings.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <tuple>

namespace toile::internal {
namespace {

using exact::Random;

struct Surface {
  std::vector<Triangle> triangles;
  Vec3s x;
};

using Named = std::vector<std::tuple<Index, Index, Index>>;  // edge and triangle, numbered in the whole mesh, sorted

Named of_judge(const Surface& cloth, const Surface& body, std::size_t& of_cloth) {
  Named found;
  for (const Crossing& c : find_cloth_crossings(cloth.triangles, cloth.x))
    found.emplace_back(c.edge[0], c.edge[1], c.triangle);
  of_cloth = found.size();
  if (body.triangles.empty()) return found;
  const auto particles = static_cast<Index>(cloth.x.size()), triangles = static_cast<Index>(cloth.triangles.size());
  for (const Crossing& c : find_body_crossings(cloth.triangles, cloth.x, body.triangles, body.x)) {
    const Index shift = c.edge_of_body ? particles : 0;
    found.emplace_back(c.edge[0] + shift, c.edge[1] + shift, c.edge_of_body ? c.triangle : c.triangle + triangles);
  }
  return found;
}

// Returns how many there are.
std::size_t expect_equal(const Surface& cloth, const Surface& body, const std::string& what) {
  std::size_t of_cloth = 0;
  const Named judged = of_judge(cloth, body, of_cloth);
  const FoundCrossings found = find_crossings(cloth.triangles, cloth.x, body.triangles, body.x);
  Named steered;
  for (const SurfaceCrossing& c : found.all) steered.emplace_back(c.edge[0], c.edge[1], c.triangle);
  EXPECT_EQ(found.of_cloth, of_cloth) << what;
  EXPECT_EQ(steered, judged) << what;
  return judged.size();
}

// Separate triangles, whose particles are numbered at random: ranks decide in degenerate positions.
template <class Point>
Surface soup(Random& random, Index count, Point&& point) {
  Surface mesh;
  std::vector<Index> number(3 * static_cast<std::size_t>(count));
  std::iota(number.begin(), number.end(), 0);
  random.shuffle(number);
  for (std::size_t k = 0; k < number.size(); k += 3)
    mesh.triangles.push_back({number[k], number[k + 1], number[k + 2]});
  for (std::size_t k = 0; k < number.size(); ++k) mesh.x.push_back(point());
  return mesh;
}

TEST(Finders, AgreeOnRandomTriangles) {
  Random random(81);
  std::size_t total = 0;
  for (int n = 0; n < 60; ++n) {
    const auto point = [&] { return Vec3(random.point(0, 1)); };
    total += expect_equal(soup(random, 40, point), soup(random, 40, point), std::to_string(n));
  }
  EXPECT_GT(total, 5000u);
}

// Most pairs touch, overlap, or lie in one plane; triangles without area too: all depends on how the mesh is thought to be displaced.
TEST(Finders, AgreeOnALattice) {
  Random random(82);
  std::size_t total = 0;
  for (int n = 0; n < 400; ++n) {
    const int size = 1 + n % 3;
    const auto point = [&] { return Vec3(random.lattice_point(0, size)); };
    total += expect_equal(soup(random, 8, point), soup(random, 8, point), std::to_string(n));
  }
  EXPECT_GT(total, 5000u);
}

// Everything in one plane, on one line, in one point.
TEST(Finders, AgreeOnFlatLatticesOfEveryDirection) {
  Random random(83);
  std::size_t total = 0;
  for (int n = 0; n < 300; ++n) {
    Mat3 flat = Mat3::Zero();
    for (int k = 0; k < n % 3; ++k) flat.col(k) = random.lattice_point(-2, 2);
    const auto point = [&] { return Vec3(flat * random.lattice_point(0, 2)); };
    total += expect_equal(soup(random, 6, point), soup(random, 6, point), std::to_string(n));
  }
  EXPECT_GT(total, 500u);
}

// Off a lattice by a unit in the last place, far from the origin and near it.
TEST(Finders, AgreeAUnitInTheLastPlaceOffALattice) {
  Random random(84);
  std::size_t total = 0;
  for (int n = 0; n < 300; ++n) {
    const Vec3 shift = n % 2 == 0 ? Vec3::Zero() : Vec3(1000, 20, -500);
    const auto point = [&] {
      Vec3 p = shift + random.lattice_point(1, 3);
      for (double& c : p) c = std::nextafter(c, random.unit() < 0.5 ? -1e9 : 1e9);
      return p;
    };
    total += expect_equal(soup(random, 8, point), soup(random, 8, point), std::to_string(n));
  }
  EXPECT_GT(total, 1000u);
}

TEST(Finders, AgreeOnTangledStarts) {
  for (int kind = 0; kind < test::tangled_kinds; ++kind) {
    const int seed = kind % test::seeds_per_kind;
    const test::TangledStart start = test::tangled_start(kind, seed);
    EXPECT_GT(expect_equal({start.triangles, start.x}, {start.body.triangles, start.body.positions}, start.name), 10u);
  }
}

}  // namespace
}  // namespace toile::internal
