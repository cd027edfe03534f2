#include "sim/collider_person.hpp"

#include "body/body_parts.hpp"
#include "core/error.hpp"
#include "core/hash.hpp"
#include "io/file.hpp"
#include "mesh/check.hpp"
#include "mesh/thicken.hpp"
#include "sim/body_figure.hpp"
#include "sim/colliders.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace toile::internal {
namespace {

// Measured as the peak of whole runs (bench/notes.md, "What a run takes").
constexpr double mannequin_mb = 32;            // while it is made; freed again
constexpr double obj_bytes_per_triangle = 40;  // "f 1234 1235 1236", and half of "v 0.123456 1.234567 -0.123456"
constexpr double obj_copies = 4;               // of a mesh file while it is read: its text, and the parsed data
constexpr double mannequin_s = 1.5;

void add_input(std::uint64_t hash, Collider& loaded) { loaded.input_hash = combined({loaded.input_hash, hash}); }

void set_movement(BodyMotion motion, std::string name, Collider& loaded) {
  for (std::string& note : motion.notes()) loaded.warnings.push_back(std::move(note));
  Hash hash;
  motion.add_to(hash);
  add_input(hash.value(), loaded);
  const double duration_s = motion.duration_s();
  loaded.movement =
      BodyMovement{[motion = std::move(motion)](double t_s, std::span<Vec3> x) { motion.positions(t_s, x); },
                   std::move(name), duration_s};
}

std::string name_of_motion(const SceneMotion& motion) {
  const std::string file = std::filesystem::path(motion.path).filename().string();
  return motion.clip.empty() ? file : file + ' ' + motion.clip;
}

void load_movement(const SceneMotion& motion, LengthUnit unit, const CollisionBody& standing, Collider& loaded) {
  SampleOptions samples;
  samples.rate_hz = motion.fps;
  samples.unit = unit;
  samples.lead_in_s = motion.lead_in_s;
  set_movement(BodyMotion::from_files(motion.path, standing, samples), name_of_motion(motion), loaded);
}

// Hair and shoes add to a mesh and not to measurements; people differ by more.
constexpr double height_agrees = 0.02;

void load_measurements(const SceneMesh& mesh, std::span<const Vec3> x, Collider& loaded) {
  const std::string path = measurements_path(mesh), file = printable(path);
  if (path.empty()) return;
  const std::string text = read_file(path, std::size_t{1} << 20);
  if (mesh.measurements.empty() && !holds_measurements(text, file)) {
    loaded.warnings.push_back(file + " is beside the body and holds no measurements: it has no key \"body\"");
    return;
  }
  add_input(hash_of_text(text), loaded);
  BodyMeasurements measured = parse_measurements(text, file);
  const auto [low, high] =
      std::minmax_element(x.begin(), x.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  const double height_m = high->y() - low->y();
  if (std::abs(measured.height_m - height_m) > height_agrees * height_m)
    throw InputError(file, "body.height",
                     fmt::sprintf("%.1f cm within %g %%, the height of %s", 100 * height_m, 100 * height_agrees,
                                  printable(mesh.path)),
                     fmt::sprintf("%.1f cm", 100 * measured.height_m));
  loaded.measurements = std::move(measured);
}

}  // namespace

CollisionBody make_body(const SurfaceMesh& read, const SceneMesh& mesh) {
  const std::string file = printable(mesh.path);
  CollisionBody body = make_collision_body(read, file, mesh.unit, mesh.up);
  check_areas(file, body.positions, body.triangles);
  return body;
}

CollisionBody read_body(const std::string& path, std::string_view text, LengthUnit unit, UpAxis up,
                        const BytesSeen& beside) {
  SceneMesh mesh;
  mesh.path = path;
  mesh.unit = unit;
  mesh.up = up;
  return make_body(parse_mesh(text, path, beside), mesh);
}

std::string measurements_path(const SceneMesh& mesh) {
  if (!mesh.measurements.empty()) return mesh.measurements;
  const std::filesystem::path beside = std::filesystem::path(mesh.path).replace_extension(".yaml");
  std::error_code ignored;
  return std::filesystem::is_regular_file(beside, ignored) ? beside.string() : std::string();
}

Collider load(const SceneMannequin& mannequin, const SceneCollider& whole) {
  Collider collider;
  const Mannequin made = make_mannequin(mannequin.who);
  CollisionBody body = from_mannequin(made);
  if (whole.motion && whole.motion->name.empty() && moves_a_skeleton(whole.motion->path)) {
    Hash bytes;
    BodyMotion moves = mannequin_motion(
        made, *whole.motion, [&](std::string_view file) { bytes.add_text(file); }, collider.warnings);
    set_movement(std::move(moves), name_of_motion(*whole.motion), collider);
    add_input(bytes.value(), collider);
  } else if (whole.motion && whole.motion->name.empty()) {
    load_movement(*whole.motion, LengthUnit::automatic, body, collider);
  } else if (whole.motion) {
    Motion motion = Motion::named(whole.motion->name, mannequin.who);
    motion.set_lead_in_s(whole.motion->lead_in_s);
    set_movement(BodyMotion::of_mannequin(made, motion), whole.motion->name, collider);
  }
  collider.surface = {std::move(body.positions), std::move(body.triangles)};
  return collider;
}

namespace {

// A solid takes the whole file, parts of any number; open ones get a back.
CollisionBody read_whole(const SceneMesh& file_of, const BytesSeen& seen) {
  const std::string file = printable(file_of.path);
  const SurfaceMesh mesh = load_mesh(file_of.path, seen);
  const BodyParts parts = solid_parts(mesh, file, metres_in(file_of.unit));
  SolidMesh read = whole_of(mesh, parts.triangles), sheets = whole_of(mesh, parts.sheets);
  const Mat3 turn = file_of.up == UpAxis::z ? z_up_to_y_up() : Mat3(Mat3::Identity());
  for (SolidMesh* part : {&read, &sheets})
    for (Vec3& x : part->positions) x = metres_in(file_of.unit) * (turn * x);
  thicken(sheet_thickness_m, sheets.positions, sheets.triangles);
  const auto before = static_cast<Index>(read.positions.size());
  read.positions.insert(read.positions.end(), sheets.positions.begin(), sheets.positions.end());
  for (const auto& [a, b, c] : sheets.triangles) read.triangles.push_back({a + before, b + before, c + before});
  check_closed(file, read.positions, read.triangles);
  check_areas(file, read.positions, read.triangles);
  CollisionBody whole;
  whole.notes = mesh.notes;
  whole.notes.insert(whole.notes.end(), parts.notes.begin(), parts.notes.end());
  whole.positions = std::move(read.positions);
  whole.triangles = std::move(read.triangles);
  return whole;
}

Collider load_figure(const SceneMesh& mesh, const SceneMotion& motion, bool worn) {
  Hash bytes;
  const BytesSeen seen = [&](std::string_view file) { bytes.add_text(file); };
  const std::string text = read_file(mesh.path);
  seen(text);
  FigureBody figure = read_figure(mesh, text, motion, seen);
  Collider collider;
  collider.input_hash = bytes.value();
  collider.warnings = std::move(figure.standing.notes);
  if (worn) load_measurements(mesh, figure.standing.positions, collider);
  set_movement(std::move(figure.motion), name_of_motion(motion), collider);
  collider.surface = {std::move(figure.standing.positions), std::move(figure.standing.triangles)};
  return collider;
}

}  // namespace

Collider load(const SceneMesh& given, const SceneCollider& whole) {
  Collider collider;
  SceneMesh mesh = given;
  if (!whole.worn && mesh.up == UpAxis::automatic) mesh.up = UpAxis::y;
  if (whole.motion && whole.motion->name.empty() && moves_a_skeleton(whole.motion->path))
    return load_figure(mesh, *whole.motion, whole.worn);
  Hash bytes;
  const BytesSeen seen = [&](std::string_view file) { bytes.add_text(file); };
  const auto read_person = [&] {
    const std::string text = read_file(mesh.path);
    seen(text);
    return make_body(shaped_surface(mesh, text, seen), mesh);
  };
  const bool is_person = whole.worn || whole.motion;
  CollisionBody read = is_person ? read_person() : read_whole(mesh, seen);
  collider.input_hash = bytes.value();
  collider.warnings = std::move(read.notes);
  if (whole.worn) load_measurements(mesh, read.positions, collider);
  if (whole.motion && whole.motion->name.empty()) {
    load_movement(*whole.motion, mesh.unit, read, collider);
  } else if (whole.motion) {
    Motion motion = Motion::named(whole.motion->name);
    motion.set_lead_in_s(whole.motion->lead_in_s);
    set_movement(BodyMotion::of_person(printable(mesh.path), read, motion), whole.motion->name, collider);
  }
  collider.surface = {std::move(read.positions), std::move(read.triangles)};
  return collider;
}

Collider load(const SceneArrays& arrays, const SceneCollider&) {
  const SceneArrays::Frames& given = *arrays.frames;
  const std::span frames(given.x);
  Hash arrays_given;
  arrays_given.add_counted(frames);
  arrays_given.add_counted(std::span<const Triangle>(given.triangles));
  CollisionBody standing;
  standing.positions.assign(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(given.vertices));
  standing.triangles = given.triangles;
  check_closed("body", standing.positions, standing.triangles);
  check_areas("body", standing.positions, standing.triangles);
  Collider collider;
  collider.input_hash = arrays_given.value();
  if (frames.size() > given.vertices) {
    SampleOptions samples;
    samples.rate_hz = given.fps;
    samples.lead_in_s = 0;
    set_movement(BodyMotion::from_frames("body", frames, standing, samples), "frames", collider);
  }
  collider.surface = {std::move(standing.positions), std::move(standing.triangles)};
  return collider;
}

ColliderCost cost(const SceneMannequin& mannequin, const SceneCollider&) {
  return {std::string(to_string(mannequin.who)), mannequin.who == MannequinKind::dancer ? 15256.0 : 20104.0,
          mannequin_mb, mannequin_s};
}

ColliderCost cost_of_file(const std::string& path) {
  std::error_code error;  // a missing file is reported when it is read
  const auto size = std::filesystem::file_size(path, error);
  const double bytes = error ? 0 : static_cast<double>(size);
  return {printable(path), bytes / obj_bytes_per_triangle, obj_copies * bytes / (1 << 20)};
}

ColliderCost cost(const SceneMesh& mesh, const SceneCollider&) { return cost_of_file(mesh.path); }

ColliderCost cost(const SceneArrays& arrays, const SceneCollider&) {
  return {"in memory", static_cast<double>(arrays.frames->triangles.size())};
}

}  // namespace toile::internal
