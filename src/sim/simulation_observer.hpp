// sim/simulation_observer.hpp: the observer of a simulation: a writer of files, a judge, a picture.
#pragma once
#include "core/types.hpp"
#include "dress/outfit.hpp"
#include "io/surface_mesh.hpp"
#include "mesh/cloth_mesh.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace toile::internal {

class SimulationObserver {
 public:
  virtual ~SimulationObserver() = default;

  // The panels of the first garment, placed.  `body`: the person around whom it is sewn; empty: as in begins().
  virtual void sewing_begins(const ClothMesh& /*panels*/, std::string_view /*garment*/, std::span<const Vec3> /*x*/,
                             std::span<const Triangle> /*body*/, std::span<const Vec3> /*body_x*/) {}
  virtual void sewing_frame(std::span<const Vec3> /*x*/) {}
  // All garments are on: frame 0, or the last before a resumed simulation was left.  `rest_stretch` is the final one of each panel.
  virtual void begins(const Outfit& /*outfit*/, std::span<const Vec2> /*rest_stretch*/,
                      std::span<const Triangle> /*body*/, std::span<const Vec3> /*body_x*/) {}
  virtual void frame(std::span<const Vec3> /*x*/, std::span<const Vec3> /*body_x*/) {}
  virtual void motion_begins() {}
  // The step collapsed over these triangles.
  virtual void collapsed(const SurfaceMesh& /*offenders*/) {}
  // A state can be saved; `state` makes it.  `first`: before the first frame of the phase.
  virtual void between_frames(bool /*first*/, const std::function<std::string()>& /*state*/) {}
};

}  // namespace toile::internal
