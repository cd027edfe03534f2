// step/layer_gap.hpp: how near layers of cloth lie to each other, beside the distance that they are asked to keep.
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
  int pairs = 0;                          // of features nearer than 2 r; 0: no layer lies on another, and all else is 0
  int particles = 0;                      // that lie on another layer; 0: only edges do, and the median is 0
  double least_m = 0, least_share = 0;    // of all pairs, edges with edges too; the share is gap / r
  double median_m = 0, median_share = 0;  // of `nearest`
};

inline constexpr double layer_gap_reach = 2;  // in r: what is farther does not lie on the other layer

// Of all contacts within layer_gap_reach of the largest r, of cloth without open seams.
LayerGap measure_layer_gap(std::span<const ClothContact> contacts, const LayerDistance& distance,
                           std::size_t particles);

}  // namespace toile::internal
