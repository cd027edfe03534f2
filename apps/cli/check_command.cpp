// apps/cli/check_command.cpp: `toile check`: reads scenes, patterns and meshes, says what they hold or what is wrong with them.
#include "body/solid_shapes.hpp"
#include "body_option.hpp"
#include "commands.hpp"
#include "core/hash.hpp"
#include "garment/garment_mesh.hpp"
#include "garment/pattern_check.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/json_text.hpp"
#include "io/obj.hpp"
#include "mesh/check.hpp"
#include "output_folder.hpp"
#include "sim/budget.hpp"
#include "sim/setup.hpp"
#include "sim/start_run.hpp"
#include "terminal.hpp"

#include <fmt/printf.h>

#include <cstdio>
#include <filesystem>
#include <utility>

namespace toile {
namespace {

// What this throws for bad input, or nothing.
template <class Work>
std::string complaint(Work&& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

// `garment` is the pattern meshed.
std::string describe(const Pattern& pattern, const GarmentMesh& garment, double resolution_m, JsonText& json) {
  const PatternSummary summary = summarize(pattern);
  const MeshQuality quality = mesh_quality(garment.mesh);
  json.member("kind", "pattern");
  json.member("panels", summary.panels.size());
  json.member("stitches", summary.stitches);
  json.member("darts", summary.darts);
  json.member("eased", summary.eased_stitches);
  json.member("longest_ratio", summary.longest_ratio);
  json.member("seam_m", summary.seam_m);
  json.member("area_m2", summary.area_m2);
  json.key("mesh");
  json.begin_object();
  json.member("resolution_cm", 100 * resolution_m);
  json.member("vertices", garment.mesh.particle_count);
  json.member("triangles", garment.mesh.triangle_count());
  json.member("min_angle_deg", quality.min_angle_deg);
  json.member("mean_edge_m", quality.mean_edge_m);
  json.member("min_edge_m", quality.min_edge_m);
  json.member("max_edge_m", quality.max_edge_m);
  json.end_object();
  json.key("notes");
  json.begin_array();
  for (const std::string& note : summary.notes) json.value(note);
  json.end_array();
  std::string text = fmt::sprintf(
      "pattern, %zu panels, %d stitches (%d darts, %d eased, longest ratio %.2f), %.2f m of seam, %.2f m2 of cloth\n",
      summary.panels.size(), summary.stitches, summary.darts, summary.eased_stitches, summary.longest_ratio,
      summary.seam_m, summary.area_m2);
  text += fmt::sprintf(
      "  at %.1f cm: %d vertices, %d triangles, smallest angle %.1f degrees, edges %.1f / %.1f / %.1f mm (least, mean, "
      "most)\n",
      100 * resolution_m, garment.mesh.particle_count, garment.mesh.triangle_count(), quality.min_angle_deg,
      1e3 * quality.min_edge_m, 1e3 * quality.mean_edge_m, 1e3 * quality.max_edge_m);
  for (const std::string& note : summary.notes) text += "  note: " + note + '\n';
  return text;
}

// What a run of the scene will take; throws when that is beyond the limits.
std::string describe(const Scene& scene, const BudgetLimits& limits, JsonText& json) {
  const Budget budget = estimate_budget(scene, read_text_file);
  check_budget(budget, limits);
  json.key("budget");
  json.begin_object();
  json.member("memory_mb", budget.memory_mb);
  json.member("frames", budget.frames);
  json.member("unwritten_frames", budget.unwritten_frames);
  json.member("seconds", budget.seconds);
  json.end_object();
  return fmt::sprintf("about %.0f MB, up to %.0f frames%s, up to %s\n", budget.memory_mb, budget.frames,
                      budget.unwritten_frames > 0 ? fmt::sprintf(" and %.0f before them", budget.unwritten_frames) : "",
                      budget.seconds < 120    ? fmt::sprintf("%.0f s", budget.seconds)
                      : budget.seconds < 7200 ? fmt::sprintf("%.0f min", budget.seconds / 60)
                                              : fmt::sprintf("%.1f hours", budget.seconds / 3600));
}

// A mesh may be meant as a cloth (`untangle CLOTH`) or as a body; one that neither command takes is refused.
std::string check_mesh(const std::string& path, LengthUnit unit, JsonText& json) {
  const std::string file = printable(path), text = read_file(path);
  const ObjMesh mesh = parse_obj(text, file);
  const SolidMesh used = whole_of(mesh);  // `untangle` and `dress` leave the rest out, too
  const std::size_t unused = mesh.positions.size() - used.positions.size();
  const std::string no_cloth = complaint([&] {
    check_triangles(file, used.positions, used.triangles);
    check_areas(file, used.positions, used.triangles);
  });
  const std::string open = complaint([&] { check_closed(file, used.positions, used.triangles); });
  CollisionBody body;
  const std::string no_body = complaint([&] { body = read_body(path, text, unit); });
  if (!no_cloth.empty() && !no_body.empty()) throw Error(ExitCode::bad_input, open.empty() ? no_body : no_cloth);
  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  json.member("kind", "mesh");
  json.member("vertices", mesh.positions.size());
  json.member("unused_vertices", unused);
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
  for (const std::string& note : body.notes) json.value(note);
  json.end_array();
  std::string said =
      fmt::sprintf("mesh, %zu vertices, %zu triangles, %zu groups, %s, %.3f x %.3f x %.3f units\n",
                   mesh.positions.size(), mesh.triangles.size(), mesh.group_names.size(),
                   open.empty() ? "closed" : "open", high.x() - low.x(), high.y() - low.y(), high.z() - low.z());
  if (unused > 0) said += fmt::sprintf("  %zu vertices are in no triangle, and are left out\n", unused);
  if (no_body.empty())
    said += fmt::sprintf("  as a body: %zu vertices, %zu triangles, %.3f m high\n", body.positions.size(),
                         body.triangles.size(), body.height_m);
  for (const std::string& note : body.notes) said += "  note: " + note + '\n';
  if (!no_body.empty()) said += "  not a body: " + no_body + '\n';
  if (!no_cloth.empty()) said += "  not a cloth: " + no_cloth + '\n';
  return said;
}

// As `dress` loads it, and what that would take for 10 s on the mannequin.
std::string check_pattern_text(const CommandLine& line, const std::string& path, const std::string& text,
                               JsonText& json) {
  const double resolution_m = line.resolution_cm ? 0.01 * *line.resolution_cm : SceneCloth{}.resolution_m;
  const Pattern pattern = parse_pattern(text, printable(path));
  Scene dressed;
  dressed.name = pattern.name;
  dressed.seconds = 10;
  dressed.until_still = true;
  dressed.body.kind = SceneBody::Kind::mannequin;
  dressed.cloth.emplace_back().pattern = path;
  dressed.cloth.front().set_edge_m(resolution_m);
  const std::string budget = "  as dressed for 10 s: " + describe(dressed, line.limits, json);
  Hash hash;
  const LoadedCloth loaded = load_cloth(
      dressed, dressed.cloth.front(), [&](const std::string&) { return text; }, hash);
  return describe(pattern, loaded.garment, resolution_m, json) + budget;
}

std::string check_scene(const std::string& path, const std::string& text, const BudgetLimits& limits, JsonText& json) {
  const Scene scene = parse_scene(text, path);
  output_folder({}, scene);
  const std::string budget = "  " + describe(scene, limits, json);
  Hash hash;
  Index vertices = 0, triangles = 0;
  std::vector<LoadedCloth> cloth;
  for (const SceneCloth& one : scene.cloth) {
    cloth.push_back(load_cloth(scene, one, read_text_file, hash));
    vertices += cloth.back().garment.mesh.particle_count;
    triangles += cloth.back().garment.mesh.triangle_count();
  }
  LoadedBody body = load_body(scene.body, hash);
  add_solids(scene.solids, body, hash);
  if (!scene.start.empty()) start_from(scene.start, cloth, body.solid.positions);
  json.member("kind", "scene");
  json.member("vertices", vertices);
  json.member("triangles", triangles);
  json.member("body_vertices", body.solid.positions.size());
  std::string said = fmt::sprintf("scene, cloth of %d vertices and %d triangles, body of %zu vertices%s\n", vertices,
                                  triangles, body.solid.positions.size(), body.movement ? ", moving" : "");
  for (const std::string& note : body.warnings) said += "  note: " + note + '\n';
  return said + budget;
}

std::string check_file(const CommandLine& line, const std::string& path, JsonText& json) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".obj" || ending == ".OBJ") return check_mesh(path, body_option(line).unit, json);
  if (ending != ".json" && ending != ".JSON") {
    read_file(path);  // a missing file is told as such
    throw InputError(printable(path), "name", "a file that ends in .json (scene or pattern) or .obj (mesh)",
                     '"' + printable(ending) + '"');
  }
  const std::string text = read_text_file(path);
  const Json root = Json::parse(text, printable(path));
  if (root.is_object() && root.find("cloth") == nullptr && root.find("pattern") != nullptr)
    return check_pattern_text(line, path, text, json);
  if (root.is_object() && root.find("cloth") == nullptr)
    root.fail("\"cloth\" (a scene) or \"pattern\" (a pattern)", "neither of them");
  return check_scene(path, text, line.limits, json);
}

}  // namespace

ExitCode check_command(const CommandLine& line) {
  ExitCode code = ExitCode::ok;
  JsonText json;
  json.begin_object();
  json.key("files");
  json.begin_array();
  std::string text;
  for (const std::string& path : line.inputs) {
    const JsonText before = json;  // members of a file that fails half-way are not shown
    try {
      json.begin_object();
      json.member("file", path);
      json.member("ok", true);
      const std::string said = check_file(line, path, json);
      json.end_object();
      text += path + ": " + said;
    } catch (const Error& error) {
      if (code == ExitCode::ok) code = error.code();
      std::fprintf(stderr, "toile: %s\n", error.what());
      json = before;
      json.begin_object();
      json.member("file", path);
      json.member("ok", false);
      json.member("error", error.what());
      json.end_object();
    }
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

}  // namespace toile
