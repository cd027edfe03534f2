// apps/cli/check_command.cpp: `toile check`: reads scenes, patterns and meshes, says what they hold or what is wrong with them.
#include "commands.hpp"
#include "output_folder.hpp"
#include "core/hash.hpp"
#include "garment/garment_mesh.hpp"
#include "garment/pattern_check.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/obj.hpp"
#include "mesh/check.hpp"
#include "io/json_text.hpp"
#include "sim/budget.hpp"
#include "sim/setup.hpp"
#include "terminal.hpp"

#include <fmt/printf.h>

#include <cstdio>
#include <filesystem>
#include <utility>

namespace toile {
namespace {

constexpr double checked_resolution_m = 0.01;

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

std::string check_mesh(const std::string& path, JsonText& json) {
  const std::string file = printable(path);
  const ObjMesh mesh = parse_obj(read_file(path), file);
  check_triangles(file, mesh.positions, mesh.triangles);
  check_areas(file, mesh.positions, mesh.triangles);
  std::string open;
  try {
    check_closed(file, mesh.positions, mesh.triangles);
  } catch (const InputError& error) {
    open = error.what();
  }
  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  json.member("kind", "mesh");
  json.member("vertices", mesh.positions.size());
  json.member("triangles", mesh.triangles.size());
  json.member("panels", mesh.group_names.size());
  json.member("closed", open.empty());
  json.member("height", high.y() - low.y());
  std::string text =
      fmt::sprintf("mesh, %zu vertices, %zu triangles, %zu groups, %s, %.3f x %.3f x %.3f units\n",
                   mesh.positions.size(), mesh.triangles.size(), mesh.group_names.size(),
                   open.empty() ? "closed" : "open", high.x() - low.x(), high.y() - low.y(), high.z() - low.z());
  if (!open.empty()) text += "  not a body: " + open + '\n';
  return text;
}

std::string check_pattern_text(const std::string& path, const std::string& text, const BudgetLimits& limits, JsonText& json) {
  const double resolution_m = checked_resolution_m;
  const Pattern pattern = parse_pattern(text, printable(path));
  Scene dressed;  // as `dress` would, on the mannequin
  dressed.name = pattern.name;
  dressed.seconds = 10;
  dressed.until_still = true;
  dressed.body.kind = SceneBody::Kind::mannequin;
  dressed.cloth.emplace_back().pattern = path;
  dressed.cloth.front().resolution_m = resolution_m;
  const std::string budget = "  as dressed for 10 s: " + describe(dressed, limits, json);
  GarmentMesh garment;
  try {
    garment = mesh_garment(pattern, resolution_m);
  } catch (const InputError& error) {
    throw Error(error.code(), printable(path) + ": " + error.what());
  }
  return describe(pattern, garment, resolution_m, json) + budget;
}

std::string check_scene(const std::string& path, const std::string& text, const BudgetLimits& limits, JsonText& json) {
  const Scene scene = parse_scene(text, path);
  output_folder({}, scene);
  const std::string budget = "  " + describe(scene, limits, json);
  Hash hash;
  Index vertices = 0, triangles = 0;
  for (const SceneCloth& cloth : scene.cloth) {
    const LoadedCloth loaded = load_cloth(scene, cloth, read_text_file, hash);
    vertices += loaded.garment.mesh.particle_count;
    triangles += loaded.garment.mesh.triangle_count();
  }
  LoadedBody body = load_body(scene.body, hash);
  add_solids(scene.solids, body, hash);
  json.member("kind", "scene");
  json.member("vertices", vertices);
  json.member("triangles", triangles);
  json.member("body_vertices", body.solid.positions.size());
  return fmt::sprintf("scene, cloth of %d vertices and %d triangles, body of %zu vertices%s\n", vertices, triangles,
                      body.solid.positions.size(), body.movement ? ", moving" : "") +
         budget;
}

std::string check_file(const std::string& path, const BudgetLimits& limits, JsonText& json) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".obj" || ending == ".OBJ") return check_mesh(path, json);
  if (ending != ".json" && ending != ".JSON") {
    read_file(path);  // a missing file is told as such
    throw InputError(printable(path), "name", "a file that ends in .json (scene or pattern) or .obj (mesh)",
                     '"' + printable(ending) + '"');
  }
  const std::string text = read_text_file(path);
  const Json root = Json::parse(text, printable(path));
  if (root.is_object() && root.find("cloth") == nullptr && root.find("pattern") != nullptr)
    return check_pattern_text(path, text, limits, json);
  if (root.is_object() && root.find("cloth") == nullptr)
    root.fail("\"cloth\" (a scene) or \"pattern\" (a pattern)", "neither of them");
  return check_scene(path, text, limits, json);
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
      const std::string said = check_file(path, line.limits, json);
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
