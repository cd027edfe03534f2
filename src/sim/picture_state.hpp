// sim/picture_state.hpp: a still of cloth and body in memory.
#pragma once
#include "dress/outfit.hpp"
#include "mesh/cloth_mesh.hpp"
#include "preview/preview.hpp"

#include <array>
#include <span>
#include <string>

namespace toile::internal {

// Every garment has a colour of its own, linear RGB.
inline const std::array<Vec3, 4> garment_colours{Vec3(0.35, 0.45, 0.62), Vec3(0.62, 0.40, 0.34), Vec3(0.42, 0.56, 0.40),
                                                 Vec3(0.60, 0.55, 0.38)};

struct PicturedState {
  const ClothMesh& mesh;
  std::span<const OutfitPart> parts;
  std::span<const Vec3> x;
  std::span<const Triangle> body_triangles;
  std::span<const Vec3> body_x;
};

struct StillOptions {
  int width = 480, height = 480, samples = 8;
  double azimuth_deg = 25, elevation_deg = 10;  // preview/preview.hpp: frame_subject
};

// The bytes of a PNG, the cloth filling it.  Throws Error (usage) where Toile is built without pictures, and as Renderer does.
std::string picture_state(const PicturedState& state, const StillOptions& options);
// The same of the last frame in a run's folder, finished or not.  Throws IoError or InputError for files that are missing or wrong.
std::string picture_last_frame(const std::string& directory, const StillOptions& options);
// A picture of cloths and body, on the ground.
std::string still_of(PreviewScene scene, const StillOptions& options);

}  // namespace toile::internal
