// body/body_motion.cpp: the sources of a moving body.
#include "body/body_motion.hpp"

#include "body/body_samples.hpp"
#include "body/figure_motion.hpp"
#include "body/middle_line.hpp"
#include "core/error.hpp"
#include "io/mdd.hpp"
#include "io/mesh_file.hpp"
#include "io/pc2.hpp"

#include <algorithm>
#include <limits>

namespace toile::internal {

namespace {

// Moves by a named motion.
class ByName : public BodyMotion::Source {
 public:
  explicit ByName(const Motion& motion) : motion_(motion) {}

  double duration_s() const override { return std::numeric_limits<double>::infinity(); }
  double lead_in_s() const override { return motion_.lead_in_s(); }
  void add_to(Hash& hash) const override {
    for (const std::string_view text : {std::string_view(motion_.name()), to_string(motion_.kind())})
      hash.add_text(text);
    const double lead_in = motion_.lead_in_s();
    hash.add_bytes(&lead_in, sizeof lead_in);
  }

 protected:
  Motion motion_;
};

class MovingMannequin : public ByName {
 public:
  MovingMannequin(const Mannequin& mannequin, const Motion& motion) : ByName(motion), body_(mannequin) {}
  std::size_t vertex_count() const override { return body_.vertex_count(); }
  void positions(double t_s, std::span<Vec3> x) const override { body_.positions(motion_.at(t_s), x); }

 private:
  SkinnedBody body_;
};

class MovingPerson : public ByName {
 public:
  MovingPerson(std::string_view file, const CollisionBody& body, const Motion& motion)
      : ByName(motion), line_(file, body.positions, body.triangles) {}
  std::size_t vertex_count() const override { return line_.vertex_count(); }
  void positions(double t_s, std::span<Vec3> x) const override { line_.bend(motion_.posture(t_s), x); }
  void add_to(Hash& hash) const override {
    ByName::add_to(hash);
    hash.add_text("middle line");
  }

 private:
  MiddleLine line_;
};

// A frame has the triangles of the body's file.
void check_triangles(std::string_view file, std::size_t frame, const SurfaceMesh& mesh, const CollisionBody& body) {
  const std::string place = "frame " + std::to_string(frame);
  const auto& expected = body.source_triangles.empty() ? body.triangles : body.source_triangles;
  if (mesh.triangles.size() != expected.size())
    throw InputError(file, place, std::to_string(expected.size()) + " triangles as in the body's file",
                     std::to_string(mesh.triangles.size()));
  const auto text = [](const Triangle& t) {
    return std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]);
  };
  for (std::size_t t = 0; t < expected.size(); ++t)
    if (mesh.triangles[t] != expected[t])
      throw InputError(file, place + ", triangle " + std::to_string(t),
                       "vertices " + text(expected[t]) + " as in the body's file", text(mesh.triangles[t]));
}

}  // namespace

bool is_point_cache(std::string_view path) { return path.ends_with(".pc2") || path.ends_with(".mdd"); }

BodyMotion BodyMotion::of_mannequin(const Mannequin& mannequin, const Motion& motion) {
  const bool fits =
      std::equal(mannequin.joints.begin(), mannequin.joints.end(), motion.joints().begin(), motion.joints().end(),
                 [](const Joint& a, const Joint& b) { return a.position_m == b.position_m; });
  if (!fits)
    throw InputError("", "body motion", "a motion for the joints of this mannequin",
                     "one for the " + std::string(to_string(motion.kind())));
  return {mannequin.triangles, std::make_shared<MovingMannequin>(mannequin, motion)};
}

BodyMotion BodyMotion::of_person(std::string_view file, const CollisionBody& body, const Motion& motion) {
  const auto names = motion_names_without_skeleton();
  if (std::find(names.begin(), names.end(), motion.name()) == names.end())
    throw InputError(file, "motion", std::string(motions_for_a_mesh), '"' + motion.name() + '"');
  return {body.triangles, std::make_shared<MovingPerson>(file, body, motion)};
}

BodyMotion BodyMotion::of_figure(std::string_view file, Figure figure, const PersonBones& bones, PoseTrack track,
                                 const CollisionBody& body, const SampleOptions& options) {
  return {body.triangles,
          std::make_shared<FigureMotion>(file, std::move(figure), bones, std::move(track), body, options)};
}

BodyMotion BodyMotion::of_mannequin(std::string_view file, const Mannequin& mannequin, Figure figure,
                                    const PersonBones& bones, PoseTrack track, const SampleOptions& options) {
  return {mannequin.triangles,
          std::make_shared<FigureMotion>(file, mannequin, std::move(figure), bones, std::move(track), options)};
}

BodyMotion BodyMotion::from_pc2(const std::string& path, const CollisionBody& body, const SampleOptions& options) {
  const std::string file = printable(path);
  auto samples = std::make_shared<BodySamples>(file, body, options);
  Pc2Reader reader(path);
  std::vector<Vec3> positions;
  for (int frame = 0; frame < reader.samples(); ++frame) {
    reader.read(frame, positions);
    samples->append(file, positions);
  }
  samples->finish(file);
  return {body.triangles, samples};
}

BodyMotion BodyMotion::from_mdd(const std::string& path, const CollisionBody& body, const SampleOptions& options) {
  const std::string file = printable(path);
  auto samples = std::make_shared<BodySamples>(file, body, options);
  const MddReader reader(path);
  std::vector<Vec3> positions;
  for (int frame = 0; frame < reader.samples(); ++frame) {
    reader.read(frame, positions);
    samples->append(file, positions);
  }
  samples->finish(file);
  return {body.triangles, samples};
}

BodyMotion BodyMotion::from_obj_sequence(const std::string& path, const CollisionBody& body,
                                         const SampleOptions& options) {
  auto samples = std::make_shared<BodySamples>(printable(path), body, options);
  const std::vector<NumberedFile> files = numbered_files(path);
  for (std::size_t frame = 0; frame < files.size(); ++frame) {
    const std::string file = printable(files[frame].path);
    const SurfaceMesh mesh = load_mesh(files[frame].path);
    samples->append(file, mesh.positions);
    check_triangles(file, frame, mesh, body);
  }
  samples->finish(printable(path));
  return {body.triangles, samples};
}

BodyMotion BodyMotion::from_frames(std::string_view name, std::span<const Vec3> frames, const CollisionBody& body,
                                   const SampleOptions& options) {
  const std::size_t vertices = body.positions.size();
  auto samples = std::make_shared<BodySamples>(name, body, options);
  for (std::size_t first = 0; first < frames.size(); first += vertices)
    samples->append(name, frames.subspan(first, std::min(vertices, frames.size() - first)));
  samples->finish(name);
  return {body.triangles, samples};
}

BodyMotion BodyMotion::from_files(const std::string& path, const CollisionBody& body, const SampleOptions& options) {
  if (path.ends_with(".pc2")) return from_pc2(path, body, options);
  if (path.ends_with(".mdd")) return from_mdd(path, body, options);
  return from_obj_sequence(path, body, options);
}

void BodyMotion::positions(double t_s, std::span<Vec3> x) const {
  if (x.size() != vertex_count())
    throw InputError("", "body", "room for " + std::to_string(vertex_count()) + " vertices", std::to_string(x.size()));
  source_->positions(t_s, x);
}

void BodyMotion::add_to(Hash& hash) const {
  hash.add_counted(std::span<const Triangle>(triangles_));
  source_->add_to(hash);
}

}  // namespace toile::internal
