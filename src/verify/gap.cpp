// verify/gap.cpp: how near the cloth is to the body, and on which side (statistics.hpp).
#include "verify/box_tree.hpp"
#include "verify/interior.hpp"
#include "verify/nearest_point.hpp"
#include "verify/statistics.hpp"
#include "verify/surface.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {

GapStatistics measure_gap(std::span<const Vec3> x, std::span<const Triangle> body, std::span<const Vec3> body_x) {
  check_surface("cloth", {}, x);
  check_surface("body", body, body_x);
  GapStatistics result;
  if (x.empty() || body.empty()) return result;

  const Interior interior(body, body_x);
  const BoxTree tree(body, body_x);
  const auto at = [&](Index i) -> const Vec3& { return body_x[static_cast<std::size_t>(i)]; };
  std::vector<double> gap_mm(x.size());
  parallel_for(x.size(), 256, [&](std::size_t i) {
    const BoxTree::Nearest nearest = tree.nearest(x[i], {}, [&](Index t) {
      const auto [a, b, c] = body[static_cast<std::size_t>(t)];
      return squared_distance_to_triangle(x[i], at(a), at(b), at(c));
    });
    gap_mm[i] = (interior.depth(x[i]) != 0 ? -1000 : 1000) * std::sqrt(nearest.squared_distance);
  });
  const auto nearest = std::min_element(gap_mm.begin(), gap_mm.end());
  result.min_mm = *nearest;
  result.nearest_vertex = static_cast<Index>(nearest - gap_mm.begin());
  std::vector<double> hover_mm;
  for (const double gap : gap_mm) {
    if (gap >= 0 && gap <= hover_reach_mm) hover_mm.push_back(gap);
  }
  result.hovering = static_cast<Index>(hover_mm.size());
  result.hover_p50_mm = nearest_rank(hover_mm, 50);
  result.hover_p90_mm = nearest_rank(hover_mm, 90);
  result.p50_mm = nearest_rank(gap_mm, 50);
  return result;
}

}  // namespace toile::internal
