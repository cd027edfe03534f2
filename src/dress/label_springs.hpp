// dress/label_springs.hpp: springs that hold labelled edges up at a height of the body, a waist seam at the waist.   docs/theory/sewing.md
//
//   F = min( k (y_wanted - y)+, f_max ) upwards,      f_max = 20 N per metre of edge,  k = f_max / 2 cm
//
// Nothing draws them down: a band that is too narrow for the hips is worn above them, and drawn to the waist it would fold over itself.
// The force is small.  On a garment that hangs from the shoulders it acts only once the seams are closed: before, it would push the armholes above the arms.
#pragma once
#include "garment/garment_mesh.hpp"
#include "step/implicit_euler.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

struct LabelHeight {
  std::string label;  // of edges in the pattern: "lower_interface" ...
  double height_m = 0;
};

class LabelSprings {
 public:
  LabelSprings() = default;
  // Labels without an edge do nothing.
  LabelSprings(const GarmentMesh& garment, std::span<const LabelHeight> heights);

  // Of a bodice to whose waist something is sewn: waist and neckline; each particle is held at 5 cm below its present place.
  static LabelSprings of_bodice(const GarmentMesh& garment);

  bool empty() const { return held_.empty(); }
  // Appends one row per particle below its height; `strength` 0 ... 1 scales the force.
  void append(const ClothState& state, double strength, std::vector<LinearSpring>& springs) const;
  // The same on the welded cloth, particle i having become particle_of[i].
  LabelSprings welded(std::span<const Index> particle_of) const;

 private:
  void hold(const GarmentMesh& garment, const LabelledEdge& edge, std::optional<double> height_m);

  struct Held {
    Index particle;
    double height_m, share_m;  // of the edge's length
  };
  std::vector<Held> held_;
};

}  // namespace toile::internal
