#include "sim/body_figure.hpp"

#include "body/mannequin_figure.hpp"
#include "core/error.hpp"
#include "io/bone_parts.hpp"
#include "io/bvh.hpp"
#include "io/file.hpp"
#include "io/makehuman.hpp"
#include "rig/pose_track.hpp"
#include "rig/retarget.hpp"
#include "rig/same_names.hpp"
#include "sim/collider_person.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

namespace toile::internal {
namespace {

constexpr std::size_t text_limit = std::size_t{64} << 20;  // bytes of a rig, weights, a target

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored);
}

std::string read_seen(const std::string& path, const BytesSeen& seen) {
  std::string text = read_file(path, text_limit);
  if (seen) seen(text);
  return text;
}

void apply_targets(const SceneMesh& mesh, const BytesSeen& seen, SurfaceMesh& surface) {
  for (const SceneTarget& target : mesh.targets)
    apply_target(read_seen(target.path, seen), printable(target.path), target.share, surface);
  if (!mesh.targets.empty() || !mesh.rig.empty()) put_on_floor(surface);
}

// The body with its own skeleton, or with the rig beside it.
AnimatedMesh animated_body(const SceneMesh& mesh, std::string_view text, const SceneMotion& motion,
                           const BytesSeen& seen) {
  if (mesh.rig.empty()) {
    if (!mesh.targets.empty())
      throw InputError(printable(mesh.path), "targets", "\"rig\" beside them, or no motion of a skeleton", "none");
    if (!has_animated_ending(mesh.path))
      throw InputError(printable(mesh.path), "skeleton",
                       "a glTF body that has one, or a rig for this mesh (--rig, in a scene \"rig\") beside " +
                           printable(motion.path),
                       "a mesh alone");
    return parse_animated(text, mesh.path, seen);
  }
  AnimatedMesh body;
  body.surface = shaped_surface(mesh, text, seen);
  const std::vector<std::string> paths = rig_paths(mesh);
  if (paths.size() < 2)
    throw InputError(printable(mesh.rig), "weights", "a file of them, as the rig's name is not rig.NAME.json", "none");
  const std::string rig = read_seen(paths[0], seen), weights = read_seen(paths[1], seen);
  const std::string rig_file = printable(paths[0]), weights_file = printable(paths[1]);
  body.figure = makehuman_figure(body.surface, {rig, rig_file}, {weights, weights_file}, body.surface.notes);
  return body;
}

SampleOptions options_of(const SceneMotion& motion, LengthUnit unit) {
  SampleOptions options;
  options.rate_hz = motion.fps;
  options.unit = unit;
  options.lead_in_s = motion.lead_in_s;
  // A recording is of another body, and makes room for cloth; an animation was made for this one, and is kept.
  if (!has_bvh_ending(motion.path)) options.limb_room_m = options.fold_room_m = 0;
  return options;
}

// An animation out of the body's own file or another.
PoseTrack animation(const AnimatedMesh& body, const SceneMesh& mesh, const SceneMotion& motion, const BytesSeen& seen,
                    std::vector<std::string>& notes) {
  const std::string file = printable(motion.path);
  if (same_file(mesh.path, motion.path))
    return track_of(chosen_clip(body.clips, motion.clip, file), body.figure, motion.fps, file);
  const AnimatedMesh other = load_animated(motion.path, seen);
  std::size_t left_out = 0;
  const Clip clip = clip_for(body.figure, chosen_clip(other.clips, motion.clip, file), other.figure, file, left_out);
  if (left_out > 0)
    notes.push_back(file + ": " + std::to_string(left_out) + " of its channels move nodes that " +
                    printable(mesh.path) + " does not have");
  return track_of(clip, body.figure, motion.fps, file);
}

PoseTrack recording(const Figure& figure, PersonBones& body, const SceneMotion& motion, const BytesSeen& seen,
                    std::vector<std::string>& notes) {
  const std::string file = printable(motion.path);
  std::string text;
  const BvhMotion recorded = load_bvh(motion.path, text);
  if (seen) seen(text);
  PersonBones given = person_bones(recorded.figure);
  if (!motion.bones.empty())
    read_bone_parts(read_seen(motion.bones, seen), printable(motion.bones), {&figure, &body},
                    {&recorded.figure, &given});
  Retargeted moved = retarget({&recorded.figure, given}, recorded.track, {&figure, body}, file);
  for (const std::string& note : moved.notes) notes.push_back(file + ": " + note);
  return std::move(moved.track);
}

}  // namespace

bool moves_a_skeleton(std::string_view path) { return has_animated_ending(path) || has_bvh_ending(path); }

SurfaceMesh shaped_surface(const SceneMesh& mesh, std::string_view text, const BytesSeen& seen) {
  SurfaceMesh surface = parse_mesh(text, mesh.path, seen);
  apply_targets(mesh, seen, surface);
  return surface;
}

FigureBody read_figure(const SceneMesh& mesh, std::string_view text, const SceneMotion& motion, const BytesSeen& seen) {
  AnimatedMesh body = animated_body(mesh, text, motion, seen);
  CollisionBody standing = make_body(body.surface, mesh);
  PersonBones bones = person_bones(body.figure);
  PoseTrack track = has_bvh_ending(motion.path) ? recording(body.figure, bones, motion, seen, standing.notes)
                                                : animation(body, mesh, motion, seen, standing.notes);
  BodyMotion moving = BodyMotion::of_figure(printable(motion.path), std::move(body.figure), bones, std::move(track),
                                            standing, options_of(motion, mesh.unit));
  return {std::move(standing), std::move(moving)};
}

BodyMotion mannequin_motion(const Mannequin& mannequin, const SceneMotion& motion, const BytesSeen& seen,
                            std::vector<std::string>& notes) {
  if (!has_bvh_ending(motion.path))
    throw InputError(printable(motion.path), "motion",
                     "a name, a .pc2 file, a folder of OBJ files or a BVH file, for a mannequin", "a glTF file");
  Figure figure = mannequin_figure(mannequin);
  PersonBones bones = person_bones(figure);
  PoseTrack track = recording(figure, bones, motion, seen, notes);
  return BodyMotion::of_mannequin(printable(motion.path), mannequin, std::move(figure), bones, std::move(track),
                                  options_of(motion, LengthUnit::m));
}

std::vector<std::string> rig_paths(const SceneMesh& mesh) {
  if (mesh.rig.empty()) return {};
  const std::string weights = mesh.weights.empty() ? weights_beside(mesh.rig) : mesh.weights;
  return weights.empty() ? std::vector{mesh.rig} : std::vector{mesh.rig, weights};
}

double skeleton_motion_s(const SceneMotion& motion) {
  try {
    if (has_bvh_ending(motion.path)) {
      std::string text;
      return load_bvh(motion.path, text).track.length_s();
    }
    const AnimatedMesh read = load_animated(motion.path);
    const Clip& clip = chosen_clip(read.clips, motion.clip, "");
    return clip.end_s - clip.begin_s;
  } catch (const Error&) {  // reported when it is read
    return 0;
  }
}

}  // namespace toile::internal
