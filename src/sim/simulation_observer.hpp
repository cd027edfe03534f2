// sim/simulation_observer.hpp: who looks on while a scene is simulated: a writer of files, a judge, a picture.
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

  // The panels of the first garment, placed.  `body` is the person around whom it is sewn, where she is not as when it begins; empty: she is.
  virtual void sewing_begins(const ClothMesh& /*panels*/, std::string_view /*garment*/, std::span<const Vec3> /*x*/,
                             std::span<const Triangle> /*body*/, std::span<const Vec3> /*body_x*/) {}
  virtual void sewing_frame(std::span<const Vec3> /*x*/) {}
  // Everything is on: frame 0, or the last before a simulation was left that is taken up.  `rest_stretch` is what each panel ends with.
  virtual void begins(const Outfit& /*outfit*/, std::span<const Vec2> /*rest_stretch*/,
                      std::span<const Triangle> /*body*/, std::span<const Vec3> /*body_x*/) {}
  virtual void frame(std::span<const Vec3> /*x*/, std::span<const Vec3> /*body_x*/) {}
  virtual void motion_begins() {}
  // What the step collapsed over.
  virtual void collapsed(const SurfaceMesh& /*offenders*/) {}
  // A state could be kept; `state` makes it.  `first`: nothing of the phase is simulated yet.
  virtual void between_frames(bool /*first*/, const std::function<std::string()>& /*state*/) {}
};

}  // namespace toile::internal
