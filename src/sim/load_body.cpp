// sim/load_body.cpp: the body of a scene, and how it moves.
#include "body/body_motion.hpp"
#include "body/solid_shapes.hpp"
#include "core/error.hpp"
#include "io/file.hpp"
#include "io/mesh_file.hpp"
#include "mesh/check.hpp"
#include "sim/setup.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace toile::internal {
namespace {

BodyMovement movement_of(BodyMotion motion, std::string name, Hash& inputs) {
  motion.add_to(inputs);
  const double duration_s = motion.duration_s();
  return {[motion = std::move(motion)](double t_s, std::span<Vec3> x) { motion.positions(t_s, x); }, std::move(name),
          duration_s};
}

BodyMovement movement_from_file(const SceneBody& body, const CollisionBody& standing, Hash& inputs) {
  SampleOptions samples;
  samples.rate_hz = body.motion->fps;
  samples.unit = body.unit;
  samples.lead_in_s = body.motion->lead_in_s;
  return movement_of(BodyMotion::from_files(body.motion->path, standing, samples),
                     std::filesystem::path(body.motion->path).filename().string(), inputs);
}

}  // namespace

void check_areas(std::string_view file, std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  constexpr double smallest = 1e-9;  // of the longer side's square
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3& origin = positions[at(triangles[t][0])];
    const Vec3 a = positions[at(triangles[t][1])] - origin, b = positions[at(triangles[t][2])] - origin;
    const double area = 0.5 * a.cross(b).norm();
    if (area > smallest * std::max(a.squaredNorm(), b.squaredNorm())) continue;
    throw InputError(file, "triangle " + std::to_string(t), "an area above zero", fmt::sprintf("%g", area));
  }
}

CollisionBody read_body(const std::string& path, std::string_view text, LengthUnit unit, Hash* inputs) {
  const std::string file = printable(path);
  const SurfaceMesh mesh = parse_mesh(text, path, [&](std::string_view beside) {
    if (inputs != nullptr) inputs->add_text(beside);
  });
  CollisionBody body = make_collision_body(mesh, file, unit);
  check_areas(file, body.positions, body.triangles);
  return body;
}

std::string measurements_path(const SceneBody& body) {
  if (body.kind != SceneBody::Kind::mesh || !body.measurements.empty()) return body.measurements;
  const std::filesystem::path beside = std::filesystem::path(body.mesh).replace_extension(".yaml");
  std::error_code ignored;
  return std::filesystem::is_regular_file(beside, ignored) ? beside.string() : std::string();
}

namespace {

// Hair and shoes are in a mesh and not on a tape; people differ by more.
constexpr double height_agrees = 0.02;

void load_measurements(const SceneBody& body, std::span<const Vec3> x, LoadedBody& loaded, Hash& inputs) {
  const std::string path = measurements_path(body), file = printable(path);
  if (path.empty()) return;
  const std::string text = read_file(path, std::size_t{1} << 20);
  if (body.measurements.empty() && !holds_measurements(text, file)) {
    loaded.warnings.push_back(file + " is beside the body and holds no measurements: it has no key \"body\"");
    return;
  }
  inputs.add_text(text);
  BodyMeasurements measured = parse_measurements(text, file);
  const auto [low, high] =
      std::minmax_element(x.begin(), x.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  const double height_m = high->y() - low->y();
  if (std::abs(measured.height_m - height_m) > height_agrees * height_m)
    throw InputError(file, "body.height",
                     fmt::sprintf("%.1f cm within %g %%, the height of %s", 100 * height_m, 100 * height_agrees,
                                  printable(body.mesh)),
                     fmt::sprintf("%.1f cm", 100 * measured.height_m));
  loaded.measurements = std::move(measured);
}

}  // namespace

namespace {

void load_arrays(const SceneBodyArrays& arrays, LoadedBody& loaded, Hash& inputs) {
  const std::span frames(arrays.frames);
  inputs.add_counted(frames);
  inputs.add_counted(std::span<const Triangle>(arrays.triangles));
  CollisionBody standing;
  standing.positions.assign(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(arrays.vertices));
  standing.triangles = arrays.triangles;
  check_closed("body", standing.positions, standing.triangles);
  check_areas("body", standing.positions, standing.triangles);
  if (frames.size() > arrays.vertices) {
    SampleOptions samples;
    samples.rate_hz = arrays.fps;
    samples.lead_in_s = 0;
    loaded.movement = movement_of(BodyMotion::from_frames("body", frames, standing, samples), "frames", inputs);
  }
  loaded.solid = {std::move(standing.positions), std::move(standing.triangles)};
}

}  // namespace

LoadedBody load_body(const SceneBody& body, Hash& inputs) {
  LoadedBody loaded;
  switch (body.kind) {
    case SceneBody::Kind::none:
      break;
    case SceneBody::Kind::cylinder:
      loaded.solid = rounded_cylinder(body.cylinder.radius_m, body.cylinder.height_m, body.cylinder.top_m);
      break;
    case SceneBody::Kind::mannequin: {
      const Mannequin mannequin = make_mannequin(body.mannequin);
      CollisionBody made = from_mannequin(mannequin);
      if (body.motion && body.motion->name.empty()) {
        loaded.movement = movement_from_file(body, made, inputs);
      } else if (body.motion) {
        Motion motion = Motion::named(body.motion->name, body.mannequin);
        motion.set_lead_in_s(body.motion->lead_in_s);
        loaded.movement = movement_of(BodyMotion::of_mannequin(mannequin, motion), body.motion->name, inputs);
      }
      loaded.solid = {std::move(made.positions), std::move(made.triangles)};
      break;
    }
    case SceneBody::Kind::arrays: {
      load_arrays(*body.arrays, loaded, inputs);
      break;
    }
    case SceneBody::Kind::mesh: {
      const std::string text = read_file(body.mesh);
      inputs.add_text(text);
      CollisionBody read = read_body(body.mesh, text, body.unit, &inputs);
      loaded.warnings = std::move(read.notes);
      load_measurements(body, read.positions, loaded, inputs);
      if (body.motion && body.motion->name.empty()) {
        loaded.movement = movement_from_file(body, read, inputs);
      } else if (body.motion) {
        Motion motion = Motion::named(body.motion->name);
        motion.set_lead_in_s(body.motion->lead_in_s);
        loaded.movement =
            movement_of(BodyMotion::of_person(printable(body.mesh), read, motion), body.motion->name, inputs);
      }
      loaded.solid = {std::move(read.positions), std::move(read.triangles)};
      break;
    }
  }
  return loaded;
}

namespace {

SolidMesh shape_of(const SceneSolid& solid, Hash& inputs) {
  struct Make {
    const SceneSolid& solid;
    Hash& inputs;
    SolidMesh operator()(const SceneSolid::Sphere& sphere) const { return ball(sphere.radius_m, solid.edge_m); }
    SolidMesh operator()(const SceneSolid::Box& box) const { return block(box.size_m); }
    SolidMesh operator()(const SceneSolid::Revolved& revolved) const {
      return toile::internal::revolved(revolved.profile_m, solid.edge_m);
    }
    SolidMesh operator()(const SceneSolid::Mesh& mesh) const {
      return whole_of(load_mesh(mesh.path, [&](std::string_view bytes) { inputs.add_text(bytes); }));
    }
  };
  SolidMesh shape;
  const auto* const mesh = std::get_if<SceneSolid::Mesh>(&solid.shape);
  try {
    shape = std::visit(Make{solid, inputs}, solid.shape);
    const std::string file = mesh != nullptr ? printable(mesh->path) : std::string();
    check_closed(file, shape.positions, shape.triangles);
    check_areas(file, shape.positions, shape.triangles);
  } catch (const InputError& error) {
    if (mesh != nullptr) throw;  // names its own file
    throw Error(error.code(), solid.where + ": " + solid.pointer + ": " + error.what());
  }
  if (solid.inside_out) turn_inside_out(shape);
  const Mat3 turn = rotation_from_degrees(solid.rotation_deg);
  double reach_m = 0;
  for (Vec3& x : shape.positions) {
    reach_m = std::max(reach_m, x.norm());
    x = turn * x + solid.translation_m;
  }
  check_speed(solid.moves, reach_m, solid.where, solid.pointer);
  return shape;
}

}  // namespace

void check_speed(const RigidPath& moves, double reach_m, std::string_view where, std::string_view pointer) {
  const auto [key, m_per_s] = moves.fastest(reach_m);
  if (m_per_s > most_led_m_per_s)
    throw InputError(where, std::string(pointer) + "/moves/" + std::to_string(key),
                     fmt::sprintf("no point faster than %g m/s from the key before", most_led_m_per_s),
                     fmt::sprintf("up to %.4g m/s", m_per_s));
}

void add_solids(std::span<const SceneSolid> solids, LoadedBody& body, Hash& inputs) {
  struct Part {
    std::size_t first, count;
    RigidPath moves;
  };
  const std::size_t own = body.solid.positions.size();
  std::vector<Part> parts;
  Vec3s standing;                                                      // where the moves of the solids begin
  const Vec3s still = body.movement ? Vec3s() : body.solid.positions;  // the body's own, when it does not move
  double duration_s = 0;
  for (const SceneSolid& solid : solids) {
    const SolidMesh shape = shape_of(solid, inputs);
    const auto first = static_cast<Index>(own + standing.size());
    for (const auto& [a, b, c] : shape.triangles) body.solid.triangles.push_back({a + first, b + first, c + first});
    parts.push_back({standing.size(), shape.positions.size(), solid.moves});
    standing.insert(standing.end(), shape.positions.begin(), shape.positions.end());
    duration_s = std::max(duration_s, solid.moves.duration_s());
  }
  const bool any_moves = std::any_of(parts.begin(), parts.end(), [](const Part& part) { return !part.moves.empty(); });
  const auto place = [parts, standing](double t_s, std::span<Vec3> x) {
    for (const Part& part : parts)
      part.moves.place(t_s, std::span(standing).subspan(part.first, part.count), x.subspan(part.first, part.count));
  };
  body.solid.positions.resize(own + standing.size());
  place(0, std::span(body.solid.positions).subspan(own));
  if (!any_moves && !body.movement) return;
  BodyMovement whole{{}, "moves", duration_s};
  if (body.movement) {
    whole.name = body.movement->name;
    whole.duration_s = std::max(duration_s, body.movement->duration_s);
  }
  whole.at = [own, place, still, of_body = body.movement ? body.movement->at : BodyAt{}](double t_s,
                                                                                         std::span<Vec3> x) {
    if (of_body) {
      of_body.function()(t_s, x.first(own));
    } else {
      std::copy(still.begin(), still.end(), x.begin());
    }
    place(t_s, x.subspan(own));
  };
  body.movement = std::move(whole);
}

}  // namespace toile::internal
