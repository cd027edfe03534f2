// Exactness of what steers, on its own; tests/sim/finders_test.cpp holds it against the judge's.
#include "contact/crossing_finder.hpp"

#include "contact/whole_orientation.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "support/exact.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace toile::internal {
namespace {

using exact::Random;

Vec3 whole_point(Random& random, double largest) {
  const auto coordinate = [&] { return std::rint(random.point(-largest, largest).x()); };
  return {coordinate(), coordinate(), coordinate()};
}

// Coordinates with all of their bits, nearly coplanar: no double, and no 128 bits, tell the sign.
TEST(WholeOrientation, IsThatOfWholeNumbersOfAnyLength) {
  Random random(71);
  const double largest = std::ldexp(1.0, whole_bits);
  int zero = 0;
  for (int n = 0; n < 2000; ++n) {
    std::array<Vec3, 4> p;
    for (Vec3& q : p) q = whole_point(random, n % 2 == 0 ? largest : 3);
    if (n % 4 == 0) {  // in the plane of the others, but for rounding
      const double s = random.unit(), t = random.unit();
      p[3] = p[0] + s * (p[1] - p[0]) + t * (p[2] - p[0]);
      for (double& c : p[3]) c = std::clamp(std::rint(c), -largest, largest);
    }
    const auto whole = exact::whole_points(p);
    const int expected = exact::orient3d(whole[0], whole[1], whole[2], whole[3]);
    ASSERT_EQ(whole_orientation(p[0], p[1], p[2], p[3]), expected) << n;
    zero += expected == 0 ? 1 : 0;
  }
  EXPECT_GT(zero, 20);
}

TEST(WholeOrientation, OfDisplacedPointsIsNeverZeroAndChangesSignWhenTwoAreSwapped) {
  Random random(72);
  for (int n = 0; n < 500; ++n) {
    std::array<WholePoint, 4> p;
    for (std::size_t i = 0; i < 4; ++i) p[i] = {whole_point(random, 1), static_cast<Index>((7 * i + n) % 29)};
    const int sign = perturbed_orientation({&p[0], &p[1], &p[2], &p[3]});
    EXPECT_NE(sign, 0);
    EXPECT_EQ(perturbed_orientation({&p[1], &p[0], &p[2], &p[3]}), -sign);
    EXPECT_EQ(perturbed_orientation({&p[0], &p[1], &p[3], &p[2]}), -sign);
  }
}

struct Surface {
  std::vector<Triangle> triangles;
  Vec3s x;
};

// (columns + 1) x (rows + 1) particles placed by at(column, row).
template <class At>
Surface grid(int columns, int rows, At&& at) {
  Surface mesh;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) mesh.x.push_back(at(c, r));
  for (Index r = 0; r < rows; ++r)
    for (Index c = 0; c < columns; ++c) {
      const Index i = r * (columns + 1) + c, up = i + columns + 1;
      mesh.triangles.push_back({i, i + 1, up + 1});
      mesh.triangles.push_back({i, up + 1, up});
    }
  return mesh;
}

Surface sheet_in_sheet(double tilt) {
  Surface a = grid(12, 12, [](int c, int r) { return Vec3(c, r, 0.0); });
  const Surface b = grid(12, 12, [&](int c, int r) { return Vec3(c, 6.25 + tilt * (r - 6), r - 6.5); });
  a.triangles = joined_triangles(a.triangles, a.x.size(), b.triangles);
  a.x.insert(a.x.end(), b.x.begin(), b.x.end());
  return a;
}

TEST(CrossingFinder, FindsTheLineAlongWhichTwoSheetsMeet) {
  const Surface both = sheet_in_sheet(0.1);
  const FoundCrossings found = find_crossings(both.triangles, both.x, {}, {});
  ASSERT_GT(found.all.size(), 24u);
  EXPECT_EQ(found.of_cloth, found.all.size());
  EXPECT_TRUE(std::is_sorted(found.all.begin(), found.all.end(), [](const auto& a, const auto& b) {
    return std::tie(a.edge, a.triangle) < std::tie(b.edge, b.triangle);
  }));
  for (const SurfaceCrossing& c : found.all) {
    EXPECT_LT(c.edge[0], c.edge[1]);
    EXPECT_LT(std::abs(c.position.z()), 1e-12);
    EXPECT_LT(std::abs(c.position.y() - 6.3), 1e-12);
  }
  // No loose ends: one open contour from rim to rim.
  const Topology topology = build_topology(static_cast<Index>(both.x.size()), both.triangles);
  const auto contours = trace_contours(topology, both.triangles, found.all);
  ASSERT_EQ(contours.size(), 1u);
  EXPECT_NEAR(contour_length(contours[0], found.all, both.x), 12, 1e-9);
}

// On a lattice, where every position is degenerate: the contour stays one, whatever the ranks.
TEST(CrossingFinder, LeavesNoLooseEndsInDegeneratePositions) {
  for (const double shift : {0.0, 0.5, 1.0}) {
    Surface both = grid(12, 12, [](int c, int r) { return Vec3(c, r, 0.0); });
    const Surface other = grid(12, 12, [&](int c, int r) { return Vec3(c, 6 + shift, r - 6.0); });
    both.triangles = joined_triangles(both.triangles, both.x.size(), other.triangles);
    both.x.insert(both.x.end(), other.x.begin(), other.x.end());
    const FoundCrossings found = find_crossings(both.triangles, both.x, {}, {});
    const Topology topology = build_topology(static_cast<Index>(both.x.size()), both.triangles);
    const auto contours = trace_contours(topology, both.triangles, found.all);
    ASSERT_EQ(contours.size(), 1u) << shift;
    EXPECT_NEAR(contour_length(contours[0], found.all, both.x), 12, 1e-9);
  }
}

TEST(CrossingFinder, TellsEdgesOfTheBodyFromThoseOfTheCloth) {
  const Surface cloth = grid(4, 4, [](int c, int r) { return Vec3(c, r, 0.0); });
  // A thin spike through the middle of one large triangle, and a body that cloth edges enter.
  const Surface spike = {{{0, 1, 2}}, {{1.6, 1.3, 1}, {1.7, 1.3, 1}, {1.6, 1.3, -1}}};
  const FoundCrossings through = find_crossings(cloth.triangles, cloth.x, spike.triangles, spike.x);
  EXPECT_EQ(through.of_cloth, 0u);
  ASSERT_EQ(through.all.size(), 2u);
  for (const SurfaceCrossing& c : through.all) {
    EXPECT_GE(c.edge[0], static_cast<Index>(cloth.x.size()));
    EXPECT_LT(c.triangle, static_cast<Index>(cloth.triangles.size()));
  }
  EXPECT_EQ(count_crossing_edges(through.all), 2);
  const Surface wall = {{{0, 1, 2}}, {{2.2, -9, -9}, {2.2, 20, -9}, {2.2, 2, 20}}};
  const FoundCrossings entered = find_crossings(cloth.triangles, cloth.x, wall.triangles, wall.x);
  EXPECT_EQ(entered.all.size(), 9u);  // 5 rows and 4 diagonals
  for (const SurfaceCrossing& c : entered.all) EXPECT_EQ(c.triangle, static_cast<Index>(cloth.triangles.size()));
}

// What was looked at before leaves nothing behind, in another unit neither.
TEST(CrossingFinder, DependsOnThePositionsAlone) {
  const Surface first = sheet_in_sheet(0.1), second = sheet_in_sheet(0.7);
  const Topology topology = build_topology(static_cast<Index>(first.x.size()), first.triangles);
  CrossingFinder finder(topology, first.triangles, first.triangles.size(), first.x.size());
  Vec3s huge = first.x;
  for (Vec3& p : huge) p *= 1e6;
  finder.find(huge);
  finder.find(first.x);
  const FoundCrossings again = finder.find(second.x), fresh = find_crossings(second.triangles, second.x, {}, {});
  ASSERT_EQ(again.all.size(), fresh.all.size());
  for (std::size_t k = 0; k < fresh.all.size(); ++k) {
    EXPECT_EQ(again.all[k].edge, fresh.all[k].edge);
    EXPECT_EQ(again.all[k].triangle, fresh.all[k].triangle);
    EXPECT_EQ(again.all[k].position, fresh.all[k].position);
  }
  const std::size_t of_first = find_crossings(first.triangles, first.x, {}, {}).all.size();
  for (const double unit : {1e-280, 1e-9, 1e9, 1e290}) {
    Vec3s scaled = first.x;
    for (Vec3& p : scaled) p *= unit;
    EXPECT_EQ(find_crossings(first.triangles, scaled, {}, {}).all.size(), of_first) << unit;
  }
}

TEST(CrossingFinder, GivesTheSameOnAnyNumberOfThreads) {
  Random random(73);
  const Surface crumpled = grid(60, 60, [&](int c, int r) {
    const double u = c / 60.0, v = r / 60.0;
    return Vec3(0.5 * std::sin(7 * u) + 0.01 * random.unit(), 0.5 * std::cos(9 * v + 3 * u), 0.4 * std::sin(5 * v * u));
  });
  std::vector<FoundCrossings> found;
  for (const int threads : {1, 2, 5})
    with_threads(threads, [&] { found.push_back(find_crossings(crumpled.triangles, crumpled.x, {}, {})); });
  ASSERT_GT(found[0].all.size(), 100u);
  for (const FoundCrossings& other : found) {
    ASSERT_EQ(other.all.size(), found[0].all.size());
    for (std::size_t k = 0; k < other.all.size(); ++k) {
      EXPECT_EQ(other.all[k].edge, found[0].all[k].edge);
      EXPECT_EQ(other.all[k].triangle, found[0].all[k].triangle);
    }
  }
}

TEST(CrossingFinder, RefusesWhatIsNotFinite) {
  Surface sheet = grid(2, 2, [](int c, int r) { return Vec3(c, r, 0.0); });
  sheet.x[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(find_crossings(sheet.triangles, sheet.x, {}, {}), InputError);
}

}  // namespace
}  // namespace toile::internal
