// What every mesh of every outline must be, and how good it must be on outlines like those of garments.
#include "garment/triangulate.hpp"

#include "core/error.hpp"
#include "garment/exact_predicates.hpp"
#include "garment/pattern.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

using Outline = std::vector<Vec2>;

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53;
  }
  int integer(int low, int high) {
    return low + static_cast<int>(bits_() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::mt19937_64 bits_;
};

double area(const Outline& o) {
  double sum = 0;
  for (std::size_t i = 0; i < o.size(); ++i) {
    const Vec2 &a = o[i], &b = o[(i + 1) % o.size()];
    sum += (a.x() - o[0].x()) * (b.y() - o[0].y()) - (a.y() - o[0].y()) * (b.x() - o[0].x());
  }
  return 0.5 * sum;
}

// Each side cut into equal pieces no longer than `edge`, as panels are.
Outline cut(const Outline& corners, double edge) {
  Outline result;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / edge - 1e-9)));
    for (int k = 0; k < pieces; ++k) result.push_back(a + (b - a) * (double(k) / pieces));
  }
  return result;
}

Outline star_shaped(Random& random, int count, double low, double high) {
  Outline result;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random(0.1, 0.9)) / count, radius = random(low, high);
    result.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return result;
}

// A simple polygon through random points: crossing edges are exchanged until none is left (the length falls each time).
Outline random_simple(Random& random, int count) {
  Outline o;
  for (int i = 0; i < count; ++i) {
    const double y = random(0, 0.4), x = random(0, 0.4);
    o.emplace_back(x, y);
  }
  const auto side = [](const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) > 0;
  };
  const std::size_t n = o.size();
  for (bool crossing = true; crossing;) {
    crossing = false;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 2; j < n; ++j) {
        if (i == 0 && j == n - 1) continue;
        const Vec2 &a = o[i], &b = o[i + 1], &c = o[j], &d = o[(j + 1) % n];
        if (side(a, b, c) == side(a, b, d) || side(c, d, a) == side(c, d, b)) continue;
        std::reverse(o.begin() + static_cast<std::ptrdiff_t>(i) + 1, o.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        crossing = true;
      }
  }
  return o;
}

Outline comb(int teeth, double tooth, double width) {  // spikes of tooth height 0.1 m with an angle of tooth / 0.1
  Outline result{{width * teeth, -0.05}};
  for (int i = teeth; i > 0; --i) {
    result.emplace_back(width * i, 0.0);
    result.emplace_back(width * i - 0.5 * tooth, 0.1);
    result.emplace_back(width * i - tooth, 0.0);
  }
  result.emplace_back(0.0, 0.0);
  result.emplace_back(0.0, -0.05);
  return result;
}

Outline spiral(int turns, double pitch, double edge) {
  Outline outer, inner;
  const double last = 2 * std::numbers::pi * turns;
  for (double t = 2 * std::numbers::pi; t < last; t += edge / (pitch / (2 * std::numbers::pi) * t)) {
    const double r = pitch * t / (2 * std::numbers::pi);
    outer.emplace_back(r * std::cos(t), r * std::sin(t));
    inner.emplace_back((r - 0.6 * pitch) * std::cos(t), (r - 0.6 * pitch) * std::sin(t));
  }
  outer.insert(outer.end(), inner.rbegin(), inner.rend());
  return outer;
}

// A bodice-like panel of the size of a garment's: straight hem and sides, curved armhole and neck.
Outline bodice(double edge) {
  Outline dense;
  const auto line = [&](Vec2 a, Vec2 b) {
    const int n = std::max(1, static_cast<int>(std::ceil((b - a).norm() / edge - 1e-9)));
    for (int i = 0; i < n; ++i) dense.push_back(a + (b - a) * (double(i) / n));
  };
  const auto arc = [&](Vec2 centre, double r, double from, double to) {
    const int n = static_cast<int>(std::ceil(std::abs(to - from) * r / edge));
    for (int i = 0; i < n; ++i) {
      const double t = from + (to - from) * i / n;
      dense.push_back(centre + r * Vec2(std::cos(t), std::sin(t)));
    }
  };
  const double pi = std::numbers::pi;
  line({0, 0}, {0.27, 0});
  line({0.27, 0}, {0.29, 0.26});
  arc({0.29, 0.36}, 0.10, -0.5 * pi, -pi);
  line({0.19, 0.36}, {0.18, 0.44});
  line({0.18, 0.44}, {0.12, 0.46});
  arc({0, 0.46}, 0.12, 0, -0.5 * pi);
  line({0, 0.34}, {0, 0});
  return dense;
}

// Everything that must hold whatever the outline.
void expect_valid(const Outline& outline, const PlanarMesh& mesh) {
  const std::size_t n = outline.size();
  ASSERT_GE(mesh.points.size(), n);
  EXPECT_EQ(std::memcmp(mesh.points.data(), outline.data(), n * sizeof(Vec2)), 0) << "an outline point has moved";

  std::vector<GridPoint> grid;
  const Vec2 origin(std::round(outline[0].x() / grid_step_m), std::round(outline[0].y() / grid_step_m));
  for (const Vec2& p : mesh.points) {
    const Vec2 steps(p.x() / grid_step_m - origin.x(), p.y() / grid_step_m - origin.y());
    grid.push_back(
        {static_cast<std::int32_t>(std::lround(steps.x())), static_cast<std::int32_t>(std::lround(steps.y()))});
  }
  std::map<std::pair<Index, Index>, Index> apex;  // directed edge -> the third corner
  std::vector<int> uses(mesh.points.size());
  std::int64_t twice_area = 0;
  double metres = 0;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_GE(t[k], 0);
      ASSERT_LT(static_cast<std::size_t>(t[k]), mesh.points.size());
      ++uses[static_cast<std::size_t>(t[k])];
      EXPECT_TRUE(apex.emplace(std::pair{t[k], t[(k + 1) % 3]}, t[(k + 2) % 3]).second) << "an edge used twice";
    }
    const auto g = [&](std::size_t k) { return grid[static_cast<std::size_t>(t[k])]; };
    const auto p = [&](std::size_t k) { return mesh.points[static_cast<std::size_t>(t[k])]; };
    const std::int64_t twice = orient2d(g(0), g(1), g(2));
    EXPECT_GT(twice, 0);
    twice_area += twice;
    const double a = area({p(0), p(1), p(2)});
    EXPECT_GT(a, 0) << "clockwise or flat in the given coordinates";
    metres += a;
  }
  for (std::size_t v = 0; v < uses.size(); ++v) EXPECT_GT(uses[v], 0) << "point " << v << " is in no triangle";

  std::int64_t outline_twice = 0;
  for (std::size_t i = 0; i < n; ++i) outline_twice += orient2d(grid[0], grid[i], grid[(i + 1) % n]);
  EXPECT_EQ(twice_area, std::abs(outline_twice)) << "the triangles do not cover the outline";
  EXPECT_NEAR(metres, std::abs(area(outline)), 1e-12);

  // Edges without a twin are the outline's edges, each once.
  std::size_t border = 0;
  for (const auto& [edge, corner] : apex) {
    const auto twin = apex.find({edge.second, edge.first});
    if (twin == apex.end()) {
      ++border;
      const Index count = static_cast<Index>(n), step = outline_twice > 0 ? 1 : count - 1;
      EXPECT_EQ(edge.second, (edge.first + step) % count) << "a border edge that is not one of the outline";
    } else if (edge.first < edge.second) {
      const auto g = [&](Index v) { return grid[static_cast<std::size_t>(v)]; };
      EXPECT_LE(incircle(g(edge.first), g(edge.second), g(corner), g(twin->second)), 0) << "not Delaunay";
    }
  }
  EXPECT_EQ(border, n);
  const std::size_t edges = (apex.size() + border) / 2;
  EXPECT_EQ(mesh.points.size() + mesh.triangles.size(), edges + 1) << "Euler: one piece without holes";
}

void expect_valid(const Outline& outline, double edge) {
  SCOPED_TRACE("outline of " + std::to_string(outline.size()) + " points, edge " + std::to_string(edge));
  expect_valid(outline, triangulate(outline, edge));
  Outline reversed(outline.rbegin(), outline.rend());
  expect_valid(reversed, triangulate(reversed, edge));
}

TEST(Triangulate, IsValidOnStarShapedOutlinesWithRawAndWithCutSides) {
  Random random(11);
  for (int i = 0; i < 60; ++i) {
    const Outline o = star_shaped(random, random.integer(3, 40), 0.03, 0.3);
    expect_valid(o, random(0.01, 0.2));
    expect_valid(cut(o, 0.015), 0.015);
  }
}

TEST(Triangulate, IsValidOnRandomSimpleOutlines) {
  Random random(12);
  for (int i = 0; i < 60; ++i) {
    const Outline o = random_simple(random, random.integer(4, 60));
    expect_valid(o, random(0.01, 0.2));
    expect_valid(cut(o, 0.01), 0.01);
  }
}

TEST(Triangulate, IsValidFarFromTheOriginAndRotated) {
  Random random(13);
  for (int i = 0; i < 10; ++i) {
    Outline o = bodice(0.02);
    const double t = random(0, 6.3);
    for (Vec2& p : o)
      p = Vec2(std::cos(t) * p.x() - std::sin(t) * p.y() + 7.125, std::sin(t) * p.x() + std::cos(t) * p.y() - 3.3);
    expect_valid(o, 0.02);
    EXPECT_GT(planar_quality(triangulate(o, 0.02)).min_angle_deg, 30);
  }
}

TEST(Triangulate, KeepsSpikesOfAFewDegrees) {
  for (const double tooth : {0.002, 0.005, 0.01, 0.02}) {  // 1.1 to 11 degrees
    const Outline corners = comb(4, tooth, 0.04);
    expect_valid(corners, 0.01);
    expect_valid(cut(corners, 0.01), 0.01);
    // The spike's own angle is the worst: nothing else was made much worse by it.
    const double tip = 2 * std::atan(0.5 * tooth / 0.1) * 180 / std::numbers::pi;
    EXPECT_GT(planar_quality(triangulate(cut(corners, 0.01), 0.01)).min_angle_deg, 0.45 * tip);
  }
  for (const double degrees : {5.0, 10.0, 20.0, 30.0}) {  // a wedge: its tip is the smallest angle there is
    const double t = degrees * std::numbers::pi / 180;
    const Outline wedge = cut({{0, 0}, {0.3, 0}, {0.3 * std::cos(t), 0.3 * std::sin(t)}}, 0.01);
    expect_valid(wedge, 0.01);
    EXPECT_NEAR(planar_quality(triangulate(wedge, 0.01)).min_angle_deg, degrees, 1e-6);
  }
}

TEST(Triangulate, KeepsATinyOutlineEdgeBesideLongOnes) {
  // Sides cut at 1 cm but for one piece of 0.89 mm, on a straight side and at a corner.
  Outline o = cut({{0, 0}, {0.2, 0}, {0.2, 0.2}, {0, 0.2}}, 0.01);
  o.insert(o.begin() + 6, Vec2(0.05089, 0));
  o.insert(o.begin() + 1, Vec2(0.00089, 0));
  ASSERT_NEAR((o[1] - o[0]).norm(), 0.00089, 1e-12);
  expect_valid(o, 0.01);
  EXPECT_GT(planar_quality(triangulate(o, 0.01)).min_angle_deg, 18);
}

TEST(Triangulate, IsValidOnASpiralWhoseInsideCannotBeWalkedStraight) { expect_valid(spiral(4, 0.05, 0.008), 0.008); }

TEST(Triangulate, IsValidWhenTheEdgeIsLargerThanTheOutlineOrItsSidesAreNotCut) {
  const Outline square{{0, 0}, {0.2, 0}, {0.2, 0.2}, {0, 0.2}};
  EXPECT_EQ(triangulate(square, 1.0).triangles.size(), 2U);
  EXPECT_EQ(triangulate(square, 1e300).triangles.size(), 2U);
  expect_valid(square, 0.01);
  expect_valid(cut({{-15, 0}, {15, 0}, {15, 3e-5}, {-15, 3e-5}}, 0.5), 0.5);  // thirty steps thin, thirty metres long
  expect_valid({{0, 0}, {0.3, 0.1}, {0.1, 0.3}}, 0.02);
  expect_valid({{0, 0}, {0.1, 0}, {0.2, 0}, {0.1, 0.1}}, 5.0);        // a corner of 180 degrees
  expect_valid({{0, 0}, {0.1, 0}, {0.3, 0}, {0.7, 0}, {1, 1}}, 9.0);  // only one corner sees the others
}

TEST(Triangulate, ReachesSixteenMetresFromTheCentre) {
  expect_valid(cut({{-16, -16}, {16, -16}, {16, 16}, {-16, 16}}, 2), 2);
}

TEST(Triangulate, GivesGarmentPanelsGoodTriangles) {
  for (const double edge : {0.0045796, 0.005, 0.01, 0.02}) {  // the first is 1.49 long without the size limit
    const PlanarMesh mesh = triangulate(bodice(edge), edge);
    const PlanarQuality quality = planar_quality(mesh);
    EXPECT_GT(quality.min_angle_deg, 33);
    EXPECT_GT(quality.p1_angle_deg, 38);
    EXPECT_NEAR(quality.mean_edge_m / edge, 1.0, 0.05);
    EXPECT_LT(quality.max_edge_m / edge, 1.48);
    EXPECT_GT(quality.min_edge_m / edge, 0.5);
  }
}

TEST(Triangulate, GradesFromAFinelyCutSideToTheTarget) {
  // A gathered seam: one side carries three times as many points.
  Outline o;
  for (int i = 0; i < 90; ++i) o.emplace_back(0.3 * i / 90, 0.0);
  for (int i = 0; i < 20; ++i) o.emplace_back(0.3, 0.2 * i / 20);
  for (int i = 30; i > 0; --i) o.emplace_back(0.3 * i / 30, 0.2);
  for (int i = 20; i > 0; --i) o.emplace_back(0.0, 0.2 * i / 20);
  expect_valid(o, 0.01);
  EXPECT_GT(planar_quality(triangulate(o, 0.01)).min_angle_deg, 32);
}

TEST(Triangulate, HasNoPreferredDiagonal) {
  // The edge directions' mean of exp(i m angle) vanishes for m = 2 and 4 on an isotropic mesh; a grid with one diagonal
  // has 0.33 or more for one of them.  The lattice alone has it for m = 6 only.
  const PlanarMesh mesh = triangulate(bodice(0.01), 0.01);
  for (const int m : {2, 4}) {
    Vec2 sum(0, 0);
    int count = 0;
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 d =
            mesh.points[static_cast<std::size_t>(t[(k + 1) % 3])] - mesh.points[static_cast<std::size_t>(t[k])];
        const double angle = m * std::atan2(d.y(), d.x());
        sum += Vec2(std::cos(angle), std::sin(angle));
        ++count;
      }
    EXPECT_LT(sum.norm() / count, 0.03) << m;
  }
}

TEST(Triangulate, KeepsTheLatticeEquilateralAwayFromTheOutline) {
  const double edge = 0.01;
  const PlanarMesh mesh = equilateral_sheet(0.4, 0.4, edge);
  for (const Triangle& t : mesh.triangles) {
    bool deep = true;
    for (const Index v : t) {
      const Vec2& p = mesh.points[static_cast<std::size_t>(v)];
      deep = deep && p.minCoeff() > 0.1 && p.maxCoeff() < 0.3;
    }
    if (!deep) continue;
    const auto p = [&](std::size_t k) { return mesh.points[static_cast<std::size_t>(t[k % 3])]; };
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR((p(k + 1) - p(k)).norm() / edge, 1.0, 0.02);
  }
}

TEST(Triangulate, GivesTheSameBitsEveryTimeAndAfterAShiftByGridSteps) {
  Outline o = bodice(0.01);
  for (Vec2& p : o) p = Vec2(std::round(p.x() / grid_step_m), std::round(p.y() / grid_step_m)) * grid_step_m;
  const PlanarMesh first = triangulate(o, 0.01), again = triangulate(o, 0.01);
  ASSERT_EQ(first.points.size(), again.points.size());
  EXPECT_EQ(std::memcmp(first.points.data(), again.points.data(), first.points.size() * sizeof(Vec2)), 0);
  EXPECT_EQ(first.triangles, again.triangles);
  const Vec2 shift(1234567 * grid_step_m, -7654322 * grid_step_m);
  for (Vec2& p : o) p += shift;
  const PlanarMesh moved = triangulate(o, 0.01);
  EXPECT_EQ(first.triangles, moved.triangles);
  ASSERT_EQ(first.points.size(), moved.points.size());
  for (std::size_t i = 0; i < moved.points.size(); ++i) EXPECT_EQ(first.points[i] + shift, moved.points[i]);
}

// Row by row along the longer side: corners of a triangle are at most about a row apart.
TEST(EquilateralSheet, IsNumberedRowByRow) {
  for (const auto& [width, height] : {std::pair(0.4, 0.4), std::pair(1.0, 0.1), std::pair(0.1, 1.0)}) {
    const PlanarMesh mesh = equilateral_sheet(width, height, 0.02);
    const double row = std::min(width, height) / 0.02 + 1;
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(std::abs(t[k] - t[(k + 1) % 3]), 2 * row) << width;
    }
    EXPECT_GT(planar_quality(mesh).min_angle_deg, 20);
  }
}

TEST(Triangulate, MakesSheetsOfTheAskedSizeAndEdge) {
  const PlanarMesh mesh = equilateral_sheet(1.0, 1.0, 1.0 / 47);
  EXPECT_NEAR(static_cast<double>(mesh.points.size()), 2602, 10);
  const PlanarQuality quality = planar_quality(mesh);
  EXPECT_NEAR(quality.mean_edge_m * 47, 1.0, 0.02);
  EXPECT_GT(quality.min_angle_deg, 33);
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += area({mesh.points[static_cast<std::size_t>(t[0])], mesh.points[static_cast<std::size_t>(t[1])],
                 mesh.points[static_cast<std::size_t>(t[2])]});
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_EQ(equilateral_sheet(0.01, 0.02, 1.0).triangles.size(), 2U);
  EXPECT_THROW(equilateral_sheet(0, 1, 0.1), InputError);
  EXPECT_THROW(equilateral_sheet(1, -1, 0.1), InputError);
  EXPECT_THROW(equilateral_sheet(1, 1, std::nan("")), InputError);
}

std::string message(const Outline& outline, double edge = 0.01) {
  try {
    triangulate(outline, edge);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Triangulate, NamesWhatIsWrongWithAnOutline) {
  const double nan = std::nan(""), huge = 1e308;
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(message({}), "expected 3 or more points, got 0 points");
  has(message({{0, 0}, {1, 0}}), "got 2 points");
  has(message({{0, 0}, {1, 0}, {1, nan}}), "point 2");
  has(message({{0, 0}, {huge, 0}, {-huge, 1}}), "point 1");
  has(message({{0, 0}, {40, 0}, {0, 1}}), "32 m wide");
  has(message({{0, 0}, {1, 0}, {1, 1}, {1, 0}, {0, 1}}),
      "point 3: expected points at least 2 micrometres apart, got the same place as point 1");
  has(message({{0, 0}, {1, 0}, {1, 1e-9}, {1, 1}}), "same place as point 1");
  has(message({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), "point 0: expected an outline that does not cross");
  has(message({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), "meets the edge from point 2");
  has(message({{0, 0}, {1, 0}, {1, 1}, {0.5, 0}, {0, 1}}),
      "point 0: expected an outline that does not cross");  // touches
  has(message({{0.5, 0}, {0.5, 1}, {0, 1}, {0.5, 0.5}, {0, 0}}), "point 0: expected an outline that does not cross");
  has(message({{0, 0}, {1, 0}, {0.5, 0}, {0.5, 1}}),
      "turn back on itself, got the edge from here meets the edge from point 1");
  has(message({{0, 0}, {1, 0}, {2, 0}, {3, 0}}), "an area that is not zero");
  has(message({{0, 0}, {1, 1}, {0.5, 0.5}}), "an area that is not zero");
  has(message({{0, 0}, {1, 0}, {2, 1e-6}}), "an area that is not zero");
  const Outline square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const double edge : {0.0, -1.0, nan, std::numeric_limits<double>::infinity(), 1e-7})
    has(message(square, edge), "edge_m");
  has(message(square, 1e-4), "16,777,216 points");
  has(message(square, 1e-7), "expected an edge length of at least 0.00007 m, got 1e-07");
}

TEST(Triangulate, MeshesTheShirtOfGarmentCode) {
  const std::string path = test::shared_path("patterns/garmentcode/shirt_mean_specification.json");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real patterns at " << path;
  const double edge = 0.01;
  std::size_t points = 0;
  for (const Panel& panel : load_pattern(path).panels) {
    Outline o;
    for (const PanelEdge& side : panel.edges) {
      const int pieces = std::max(1, static_cast<int>(std::ceil(edge_length_m(panel, side) / edge - 1e-9)));
      const std::vector<Vec2> samples = sample_edge(panel, side, pieces);
      o.insert(o.end(), samples.begin(), samples.end() - 1);
    }
    const PlanarMesh mesh = triangulate(o, edge);
    expect_valid(o, mesh);
    points += mesh.points.size();
    const PlanarQuality quality = planar_quality(mesh);
    EXPECT_GT(quality.min_angle_deg, 33) << panel.name;
    EXPECT_NEAR(quality.mean_edge_m / edge, 1.0, 0.03) << panel.name;
    EXPECT_LT(quality.max_edge_m / edge, 1.5) << panel.name;
  }
  EXPECT_NEAR(static_cast<double>(points), 8000, 400);
}

TEST(PlanarQuality, MeasuresAKnownPairOfTriangles) {
  const PlanarMesh mesh{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  const PlanarQuality quality = planar_quality(mesh);
  EXPECT_NEAR(quality.min_angle_deg, 45, 1e-12);
  EXPECT_NEAR(quality.mean_edge_m, (4 + std::sqrt(2.0)) / 5, 1e-15);
  EXPECT_EQ(quality.min_edge_m, 1);
  EXPECT_EQ(quality.max_edge_m, std::sqrt(2.0));
  EXPECT_EQ(planar_quality({}).mean_edge_m, 0);
}

}  // namespace
}  // namespace toile::internal
