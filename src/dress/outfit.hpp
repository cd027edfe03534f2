// dress/outfit.hpp: garments that are worn together, as one cloth; inner garments come first.
//
// A garment that is sewn around others is meshed by itself, then `over` appends its panels to the garments already
// worn; those stand still while it is sewn, and touch it like any cloth.  The weld of all is the new outfit.
#pragma once
#include "assembly/cloth_model.hpp"
#include "garment/garment_mesh.hpp"

#include <span>
#include <string>
#include <vector>

namespace toile::internal {

struct OutfitPart {  // one garment, or a grid
  std::string name;
  Index first_panel = 0, panels = 0;  // of Outfit::mesh
  Index particles = 0;                // parts are contiguous
};

struct Outfit {
  std::vector<OutfitPart> parts;
  ClothMesh mesh;
  ClothState state;
  std::vector<Fabric> fabrics;          // [panel]
  std::vector<Vec2> rest_stretch;       // [panel] (b_u, b_v)
  std::vector<double> thickness_scale;  // [particle] of the fabrics' contact distance; grows back to 1
  int seams = 0;

  Index part_of_panel(Index panel) const;

  // The state between frames (core/state_archive.hpp); the rest follows from the garments.
  template <class Archive>
  void remember(Archive& archive) {
    archive.fixed(state.x);
    archive.fixed(state.v);
    archive.fixed(thickness_scale);
    archive.fixed(rest_stretch);
  }
};

// Appends a garment (or a grid) at its final positions, without sewing or welding.
void put_behind(Outfit& outfit, const GarmentMesh& garment, std::span<const Fabric> fabrics,
                std::span<const Vec2> rest_stretch);

// The outfit's particles at their positions, then the placed panels of `garment`.  Its seams, labels and classes are renumbered;
// those of the outfit are welded already.
GarmentMesh over(const Outfit& outfit, const GarmentMesh& garment);

}  // namespace toile::internal
