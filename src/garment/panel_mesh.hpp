// garment/panel_mesh.hpp: the panels of a pattern as flat meshes, each by itself.
//
// Both sides of a seam are cut into equally many pieces; otherwise panels are independent, and are meshed in parallel.
#pragma once
#include "garment/fold_lines.hpp"
#include "garment/pattern.hpp"

#include <span>
#include <utility>
#include <vector>

namespace toile::internal {

struct PanelMesh {
  std::vector<std::vector<Index>> edge_points;  // [edge] first to last corner, in the edge's direction
  std::size_t outline_points = 0;               // the outline's points come first
  bool mirrored = false;                        // the panel is drawn clockwise
  FoldedPlanarMesh folded;
};

class PanelMesher {
 public:
  // `halved`: edges that are cut in two at least.
  explicit PanelMesher(const Pattern& pattern, std::vector<StitchSide> halved = {})
      : pattern_(&pattern), halved_(std::move(halved)) {}

  // [panel] `inner_m` is the edge length inside each; outlines are cut at `outline_m`.  Panels with the same request as in the last call are
  // not meshed again.  Throws InputError for the first panel that cannot be meshed.
  std::span<const PanelMesh> mesh(double outline_m, std::span<const double> inner_m);

 private:
  struct Asked {
    std::vector<int> pieces;  // [edge]
    double inner_m = 0;
    bool operator==(const Asked&) const = default;
  };
  const Pattern* pattern_;
  std::vector<StitchSide> halved_;
  std::vector<Asked> asked_;  // the requests of meshes_; empty for one that failed
  std::vector<PanelMesh> meshes_;
};

}  // namespace toile::internal
