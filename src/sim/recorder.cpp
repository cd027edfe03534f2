#include "sim/recorder.hpp"

#include "sim/rest_watch.hpp"

#include <algorithm>
#include <optional>

namespace toile::internal {

RunDescription describe(const ClothMesh& mesh, std::span<const Vec2> rest_stretch, double fps,
                        std::span<const Triangle> body, std::size_t body_vertices) {
  RunDescription run;
  run.mesh = drawn_mesh(mesh);
  if (std::any_of(rest_stretch.begin(), rest_stretch.end(), [](const Vec2& b) { return b != Vec2(1, 1); })) {
    for (const Index panel : mesh.panel) {
      const Vec2& b = rest_stretch[static_cast<std::size_t>(panel)];
      run.b.emplace_back(b.y(), b.x());  // the first axis of vt is the weft: run_writer.hpp
    }
  }
  run.body_triangles.assign(body.begin(), body.end());
  run.body_particle_count = static_cast<Index>(body_vertices);
  run.fps = fps;
  return run;
}

Recorder::Recorder(RunWriter& writer, const Outfit& outfit, std::span<const Vec2> rest_stretch, double fps,
                   std::span<const Triangle> body, std::span<const Vec3> body_x)
    : writer_(&writer), audit_(describe(outfit.mesh, rest_stretch, fps, body, body_x.size())) {
  std::vector<Index> garment_of_panel;
  for (std::size_t p = 0; p < outfit.mesh.panel_names.size(); ++p)
    garment_of_panel.push_back(outfit.part_of_panel(static_cast<Index>(p)));
  std::vector<std::string> names;
  for (const OutfitPart& part : outfit.parts) names.push_back(part.name);
  writer_->begin_cloth(outfit.mesh, garment_of_panel, names, outfit.state.x, body, body_x);
  audit_.add(as_written(outfit.state.x), as_written(body_x));
}

Recorder::Recorder(RunWriter& writer, const Outfit& outfit, std::span<const Vec2> rest_stretch, double fps,
                   std::span<const Triangle> body, std::size_t body_vertices, const WrittenFrames& written)
    : writer_(&writer), audit_(describe(outfit.mesh, rest_stretch, fps, body, body_vertices)) {
  Pc2Reader cloth(writer.path("cloth.pc2"));
  std::optional<Pc2Reader> bodies;
  if (written.has_body) bodies.emplace(writer.path("body.pc2"));
  Vec3s x, body_x;
  for (int frame = 0; frame < written.cloth; ++frame) {
    cloth.read(frame, x);
    if (bodies) bodies->read(frame, body_x);
    audit_.add(x, body_x);
  }
}

void Recorder::frame(std::span<const Vec3> x, std::span<const Vec3> body_x) {
  writer_->cloth_frame(x, body_x);
  audit_.add(as_written(x), as_written(body_x));
}

}  // namespace toile::internal
