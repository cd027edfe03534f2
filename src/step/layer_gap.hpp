// step/layer_gap.hpp: the gaps between layers of cloth, compared with the distances that contact asks for.
//
//   gap     = distance of two features of the cloth that do not touch (contact/proximity.hpp)
//   asked   = r of the pair, unscaled (step/layer_distance.hpp)
//   nearest = of a vertex, the least gap to a face, edge or vertex of another layer, where that is below 2 r
#pragma once
#include "contact/proximity.hpp"
#include "step/layer_distance.hpp"

#include <span>

namespace toile::internal {

struct LayerGap {
  int pairs = 0;                          // of features nearer than 2 r; 0: no layers in contact, and all else is 0
  int particles = 0;                      // with a `nearest`; 0: only edges are near each other, and the median is 0
  double least_m = 0, least_share = 0;    // of all pairs, edges with edges too; share = gap / r
  double median_m = 0, median_share = 0;  // of `nearest`
};

inline constexpr double layer_gap_reach = 2;  // in r: features farther apart are not in contact

// From all contacts within layer_gap_reach of the largest r, of cloth without open seams.
LayerGap measure_layer_gap(std::span<const ClothContact> contacts, const LayerDistance& distance,
                           std::size_t particles);

}  // namespace toile::internal
