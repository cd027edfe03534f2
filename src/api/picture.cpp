#include "api/implementation.hpp"
#include "sim/picture_state.hpp"
#include "toile/run.hpp"

namespace toile {

namespace {

internal::StillOptions still(const PictureOptions& options) {
  return {options.width, options.height, options.samples, options.azimuth_deg, options.elevation_deg};
}

}  // namespace

std::string picture(const Simulation& simulation, const PictureOptions& options) {
  return translated([&] {
    const Simulation::Implementation& made = simulation.implementation();
    const internal::Outfit& outfit = made.begun ? made.engine->outfit() : made.flat;
    std::string png;
    made.recipe->in_threads([&] {
      png = internal::picture_state(
          {made.mesh(), outfit.parts, made.state().x, made.engine->body_triangles(), made.body_x}, still(options));
    });
    return png;
  });
}

std::string picture(const std::string& folder, const PictureOptions& options) {
  return translated([&] { return internal::picture_last_frame(folder, still(options)); });
}

}  // namespace toile
