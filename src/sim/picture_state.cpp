#include "sim/picture_state.hpp"

#include "core/error.hpp"
#include "preview/png.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace toile::internal {

std::string picture_state(const PicturedState& state, const StillOptions& options) {
  require_pictures();
  std::vector<std::vector<Triangle>> triangles(std::max<std::size_t>(1, state.parts.size()));
  std::vector<std::vector<std::array<Vec2, 3>>> uv(triangles.size());
  for (std::size_t t = 0; t < state.mesh.triangles.size(); ++t) {
    std::size_t part = 0;
    while (part + 1 < triangles.size() && state.mesh.panel[t] >= state.parts[part + 1].first_panel) ++part;
    triangles[part].push_back(state.mesh.triangles[t]);
    uv[part].push_back(state.mesh.uv[t]);
  }
  PreviewScene scene;
  for (std::size_t k = 0; k < triangles.size(); ++k)
    scene.cloths.push_back({triangles[k], uv[k], state.x, garment_colours[k % garment_colours.size()]});
  scene.body_triangles = state.body_triangles;
  scene.body_positions = state.body_x;
  return still_of(std::move(scene), options);
}

std::string still_of(PreviewScene scene, const StillOptions& options) {
  if (options.width < 1 || options.height < 1)
    throw InputError("", "width, height", "at least 1 pixel",
                     std::to_string(options.width) + " x " + std::to_string(options.height));
  PreviewScene cloth;
  cloth.cloths = scene.cloths;
  const auto [low, high] = bounds(cloth);
  scene.ground_y_m = bounds(scene)[0].y();
  RenderOptions render_options;
  render_options.width = options.width;
  render_options.height = options.height;
  render_options.samples = options.samples;
  const Vec3 margin = 0.04 * (high - low) + Vec3::Constant(0.01);
  const Camera camera = frame_subject(low - margin, high + margin, options.azimuth_deg, options.elevation_deg,
                                      static_cast<double>(options.width) / options.height);
  return png_of(render(scene, camera, render_options), "picture");
}

}  // namespace toile::internal
