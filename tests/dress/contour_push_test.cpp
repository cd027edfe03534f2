// How far the contours of two sheets that are slotted into each other are pulled.
#include "dress/contour_push.hpp"

#include "contact/crossing_finder.hpp"
#include "support/tangled_starts.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace toile::internal {
namespace {

struct Slotted {
  test::TangledStart start = test::tangled_start(8, 0);
  Topology topology = build_topology(static_cast<Index>(start.x.size()), start.triangles);
  std::vector<SurfaceCrossing> crossings = find_crossings(start.triangles, start.x, {}, {}).all;
  std::vector<IntersectionContour> contours = trace_contours(topology, start.triangles, crossings);
  ContourPush push{topology, start.triangles, start.x};

  // The longest move of each contour.
  std::vector<double> longest_m(ContourPush::Way way, double edge_m) {
    std::vector<double> longest;
    for (const IntersectionContour& contour : contours) {
      longest.push_back(0);
      std::vector<char> marked(start.x.size(), 0);
      push(contour, crossings, start.x, way, edge_m, 1, marked,
           [&](const ContourPull&, const Vec3& move_m) { longest.back() = std::max(longest.back(), move_m.norm()); });
    }
    return longest;
  }
};

// It cuts nothing off, and is pulled shorter: with coarse edges by more than it is long, unless gently.
TEST(ContourPush, GentlyMakesAContourShorterByHalfAtMost) {
  Slotted slotted;
  const double coarse_m = 1;
  const std::vector<double> far = slotted.longest_m(ContourPush::Way::cheapest, coarse_m);
  const std::vector<double> near = slotted.longest_m(ContourPush::Way::gently, coarse_m);
  ASSERT_FALSE(far.empty());
  for (std::size_t k = 0; k < far.size(); ++k) {
    const double length_m = contour_length(slotted.contours[k], slotted.crossings, slotted.start.x);
    EXPECT_GT(far[k], length_m);
    EXPECT_GT(near[k], 0.2 * length_m);
    EXPECT_LE(near[k], 0.25 * length_m * (1 + 1e-12));
  }
  const double fine_m = 1e-3;  // less than its length: the same
  EXPECT_EQ(slotted.longest_m(ContourPush::Way::gently, fine_m), slotted.longest_m(ContourPush::Way::cheapest, fine_m));
}

}  // namespace
}  // namespace toile::internal
