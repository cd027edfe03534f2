#include "step/layer_gap.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace toile::internal {
namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

LayerGap measure_layer_gap(std::span<const ClothContact> contacts, const LayerDistance& distance,
                           std::size_t particles) {
  constexpr double none = std::numeric_limits<double>::infinity();
  LayerGap result{0, 0, none, none, 0, 0};
  std::vector<double> nearest_m(particles, none), nearest_share(particles, none);
  for (const ClothContact& contact : contacts) {
    const double r = distance.between(contact.kind, contact.particle).full_m;
    if (r <= 0 || contact.gap_m >= layer_gap_reach * r) continue;
    ++result.pairs;
    const double share = contact.gap_m / r;
    result.least_m = std::min(result.least_m, contact.gap_m);
    result.least_share = std::min(result.least_share, share);
    if (contact.kind == ContactKind::edge_edge) continue;
    const std::size_t vertices = contact.kind == ContactKind::vertex_vertex ? 2 : 1;
    for (std::size_t k = 0; k < vertices; ++k) {
      const auto i = static_cast<std::size_t>(contact.particle[k]);
      nearest_m[i] = std::min(nearest_m[i], contact.gap_m);
      nearest_share[i] = std::min(nearest_share[i], share);
    }
  }
  if (result.pairs == 0) return {};
  std::erase(nearest_m, none);
  std::erase(nearest_share, none);
  result.particles = static_cast<int>(nearest_m.size());
  if (result.particles == 0) return result;
  result.median_m = median(nearest_m);
  result.median_share = median(nearest_share);
  return result;
}

}  // namespace toile::internal
