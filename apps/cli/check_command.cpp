// apps/cli/check_command.cpp: `toile check`: reads scenes, patterns and meshes, and reports their contents or errors.
#include "body/solid_shapes.hpp"
#include "body_option.hpp"
#include "budget_text.hpp"
#include "check_pattern.hpp"
#include "commands.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/json_text.hpp"
#include "io/mesh_file.hpp"
#include "mesh/check.hpp"
#include "mesh/join_sides.hpp"
#include "output_folder.hpp"
#include "sim/setup.hpp"
#include "sim/start_run.hpp"
#include "terminal.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace toile::internal {
namespace {

// The message of the InputError that `work` throws; empty if none.
template <class Work>
std::string complaint(Work&& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

// A mesh may be meant as a cloth (`untangle CLOTH`) or as a body; one that neither command takes is refused.
std::string check_mesh(const std::string& path, LengthUnit unit, UpAxis up, JsonText& json) {
  const std::string file = printable(path), text = read_file(path);
  const SurfaceMesh mesh = parse_mesh(text, path);
  const SolidMesh used = whole_of(
      mesh,
      joined_triangles(mesh.triangles, join_sides(mesh.positions, mesh.triangles,
                                                  mesh.object)));  // `untangle` and `dress` leave the rest out, too
  std::vector<char> in_triangle(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const Index i : t) in_triangle[at(i)] = 1;
  const auto unused = static_cast<std::size_t>(std::count(in_triangle.begin(), in_triangle.end(), 0));
  const std::size_t joined = mesh.positions.size() - unused - used.positions.size();
  const std::string no_cloth = complaint([&] {
    check_triangles(file, used.positions, used.triangles);
    check_areas(file, used.positions, used.triangles);
  });
  const std::string open = complaint([&] { check_closed(file, used.positions, used.triangles); });
  CollisionBody body;
  const std::string no_body = complaint([&] { body = read_body(path, text, unit, up); });
  const std::vector<std::string>& notes = no_body.empty() ? body.notes : mesh.notes;
  if (!no_cloth.empty() && !no_body.empty()) throw Error(ErrorKind::bad_input, open.empty() ? no_body : no_cloth);
  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  json.member("kind", "mesh");
  json.member("vertices", mesh.positions.size());
  json.member("unused_vertices", unused);
  json.member("joined_vertices", joined);
  json.member("triangles", mesh.triangles.size());
  json.member("panels", mesh.group_names.size());
  json.member("closed", open.empty());
  json.member("height", high.y() - low.y());
  json.key("body");
  if (no_body.empty()) {
    json.begin_object();
    json.member("vertices", body.positions.size());
    json.member("triangles", body.triangles.size());
    json.member("height_m", body.height_m);
    json.end_object();
  } else {
    json.null();
  }
  json.member("not_a_body", no_body);
  json.member("not_a_cloth", no_cloth);
  json.key("notes");
  json.begin_array();
  for (const std::string& note : notes) json.value(note);
  json.end_array();
  std::string said =
      fmt::sprintf("mesh, %zu vertices, %zu triangles, %zu groups, %s, %.3f x %.3f x %.3f units\n",
                   mesh.positions.size(), mesh.triangles.size(), mesh.group_names.size(),
                   open.empty() ? "closed" : "open", high.x() - low.x(), high.y() - low.y(), high.z() - low.z());
  if (unused > 0) said += fmt::sprintf("  %zu vertices are in no triangle, and are left out\n", unused);
  if (no_body.empty())
    said += fmt::sprintf("  as a body: %zu vertices, %zu triangles, %.3f m high\n", body.positions.size(),
                         body.triangles.size(), body.height_m);
  for (const std::string& note : notes) said += "  note: " + note + '\n';
  if (!no_body.empty()) said += "  not a body: " + no_body + '\n';
  if (!no_cloth.empty()) said += "  not a cloth: " + no_cloth + '\n';
  return said;
}

std::string check_scene(const Scene& scene, const BudgetLimits& limits, JsonText& json) {
  output_folder({}, scene);
  const std::string budget = "  " + describe_budget(scene, limits, json);
  Index vertices = 0, triangles = 0;
  std::vector<LoadedCloth> cloth;
  for (std::size_t k = 0; k < scene.cloth.size(); ++k) {
    cloth.push_back(load_cloth(scene, k, read_text_file));
    const GarmentMesh worn = as_worn(cloth.back());
    vertices += worn.mesh.particle_count;
    triangles += worn.mesh.triangle_count();
  }
  const LoadedColliders colliders = load_colliders(scene.body, scene.solids);
  const JoinedColliders& body = colliders.joined;
  if (!scene.start.empty()) start_from(scene.start, cloth, body.surface.positions);
  json.member("kind", "scene");
  json.member("vertices", vertices);
  json.member("triangles", triangles);
  json.member("body_vertices", body.surface.positions.size());
  std::string said = fmt::sprintf("scene, cloth of %d vertices and %d triangles, body of %zu vertices%s\n", vertices,
                                  triangles, body.surface.positions.size(), body.movement ? ", moving" : "");
  for (const std::string& note : colliders.warnings) said += "  note: " + note + '\n';
  return said + budget;
}

Checked check_file(const CommandLine& line, const std::string& path, JsonText& json) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (has_mesh_ending(path)) {
    refuse_other_files(line, false, path);
    return {check_mesh(path, unit_option(line), up_option(line), json)};
  }
  if (ending != ".json" && ending != ".JSON") {
    read_file(path);  // throws for a missing file
    throw InputError(printable(path), "name",
                     "a file that ends in .json (scene or pattern), or as a mesh in " + mesh_formats_in_words(),
                     '"' + printable(ending) + '"');
  }
  const std::string text = read_text_file(path);
  const Json root = Json::parse(text, printable(path));
  const bool is_pattern = root.is_object() && root.find("cloth") == nullptr && root.find("pattern") != nullptr;
  refuse_other_files(line, is_pattern, path);
  if (is_pattern) return check_pattern(line, path, text, json);
  if (root.is_object() && root.find("cloth") == nullptr)
    root.fail("\"cloth\" (a scene) or \"pattern\" (a pattern)", "neither of them");
  const SceneFile scene = read_scene(text, path);
  return scene.places.complete_errors_of([&]() -> Checked { return {check_scene(scene.scene, line.limits, json)}; });
}

}  // namespace

ExitCode check_command(const CommandLine& line) {
  if (line.inputs.size() > 1 && !(line.svg.empty() && line.repair.empty()))
    throw Error(ErrorKind::usage, "--svg and --repair take one pattern at a time");
  ExitCode code = ExitCode::ok;
  JsonText json;
  json.begin_object();
  json.key("files");
  json.begin_array();
  std::string text;
  for (const std::string& path : line.inputs) {
    const JsonText before = json;  // restored when a file fails half-way
    Checked checked;
    try {
      json.begin_object();
      json.member("file", path);
      json.member("ok", true);
      checked = check_file(line, path, json);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::usage) throw;
      checked.error = error.what();
      checked.code = exit_code(error.kind());
    }
    if (!checked.error.empty()) {
      if (code == ExitCode::ok) code = checked.code;
      std::fprintf(stderr, "toile: %s\n", checked.error.c_str());
      json = before;
      json.begin_object();
      json.member("file", path);
      json.member("ok", false);
      json.member("error", checked.error);
    }
    if (checked.is_pattern) write_findings(checked, json);
    json.end_object();
    if (!checked.said.empty()) text += path + ": " + checked.said;
  }
  json.end_array();
  json.member("exit_code", static_cast<int>(code));
  json.end_object();
  if (line.json) {
    print(json.str() + '\n');
  } else if (!line.quiet) {
    print(text);
  }
  return code;
}

}  // namespace toile::internal
