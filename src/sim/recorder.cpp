#include "sim/recorder.hpp"

#include "verify/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace toile::internal {
namespace {

constexpr double at_rest_mm_per_s = 2, rest_s = 0.5;  // when a drape may stop

// What a reader of the files will see: float32.  By way of memory: of x.cast<float>().cast<double>() GCC 12 at -O3 leaves the last entry of
// an odd number as it was.
Vec3s as_written(std::span<const Vec3> x) {
  std::vector<float> single(3 * x.size());
  for (std::size_t i = 0; i < single.size(); ++i)
    single[i] = static_cast<float>(x[i / 3][static_cast<Eigen::Index>(i % 3)]);
  Vec3s rounded;
  rounded.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) rounded.emplace_back(single[3 * i], single[3 * i + 1], single[3 * i + 2]);
  return rounded;
}

RunDescription describe(const Outfit& outfit, std::span<const Vec2> rest_stretch, double fps,
                        std::span<const Triangle> body, std::size_t body_vertices) {
  RunDescription run;
  run.mesh = drawn_mesh(outfit.mesh);
  if (std::any_of(rest_stretch.begin(), rest_stretch.end(), [](const Vec2& b) { return b != Vec2(1, 1); })) {
    for (const Index panel : outfit.mesh.panel) {
      const Vec2& b = rest_stretch[static_cast<std::size_t>(panel)];
      run.b.emplace_back(b.y(), b.x());  // the first axis of vt is the weft: run_writer.hpp
    }
  }
  run.body_triangles.assign(body.begin(), body.end());
  run.body_particle_count = static_cast<Index>(body_vertices);
  run.fps = fps;
  return run;
}

}  // namespace

Recorder::Recorder(RunWriter& writer, const Outfit& outfit, std::span<const Vec2> rest_stretch, double fps,
                   std::span<const Triangle> body, std::span<const Vec3> body_x)
    : writer_(&writer),
      audit_(describe(outfit, rest_stretch, fps, body, body_x.size())),
      fps_(fps),
      written_(as_written(outfit.state.x)) {
  std::vector<Index> garment_of_panel;
  for (std::size_t p = 0; p < outfit.mesh.panel_names.size(); ++p)
    garment_of_panel.push_back(outfit.part_of_panel(static_cast<Index>(p)));
  std::vector<std::string> names;
  for (const OutfitPart& part : outfit.parts) names.push_back(part.name);
  writer_->begin_cloth(outfit.mesh, garment_of_panel, names, outfit.state.x, body, body_x);
  audit_.add(written_, as_written(body_x));
}

Recorder::Recorder(RunWriter& writer, const Outfit& outfit, std::span<const Vec2> rest_stretch, double fps,
                   std::span<const Triangle> body, std::size_t body_vertices, const WrittenFrames& written)
    : writer_(&writer), audit_(describe(outfit, rest_stretch, fps, body, body_vertices)), fps_(fps) {
  Pc2Reader cloth(writer.path("cloth.pc2"));
  std::optional<Pc2Reader> bodies;
  if (written.has_body) bodies.emplace(writer.path("body.pc2"));
  Vec3s x, body_x;
  for (int frame = 0; frame < written.cloth; ++frame) {
    cloth.read(frame, x);
    if (bodies) bodies->read(frame, body_x);
    if (frame > 0) {
      judge(x, body_x);
    } else {
      written_ = x;
      audit_.add(written_, body_x);
    }
  }
}

void Recorder::frame(std::span<const Vec3> x, std::span<const Vec3> body_x) {
  writer_->cloth_frame(x, body_x);
  judge(as_written(x), as_written(body_x));
}

void Recorder::judge(Vec3s x, std::span<const Vec3> body_x) {
  const Vec3s before = std::exchange(written_, std::move(x));
  audit_.add(written_, body_x);
  speeds_.push_back(speed_p99_mm_per_s(before, written_, fps_));
  if (static_cast<double>(speeds_.size()) > std::max(1.0, std::round(fps_))) speeds_.pop_front();
}

bool Recorder::at_rest() const {
  const auto recent = static_cast<std::size_t>(std::max(1.0, std::ceil(rest_s * fps_)));
  if (speeds_.size() < recent) return false;
  const double limit = Limits{}.still_mm_per_s;
  return std::all_of(speeds_.begin(), speeds_.end(), [&](double v) { return v <= limit; }) &&
         std::all_of(speeds_.end() - static_cast<std::ptrdiff_t>(recent), speeds_.end(),
                     [](double v) { return v <= at_rest_mm_per_s; });
}

}  // namespace toile::internal
