// apps/cli/untangle_command.cpp: `toile untangle`: untangles cloth that passes through itself or a body.
#include "body_option.hpp"
#include "commands.hpp"
#include "dress/untangle.hpp"
#include "io/file.hpp"
#include "io/json_text.hpp"
#include "io/mesh_file.hpp"
#include "io/mesh_writer.hpp"
#include "io/obj.hpp"
#include "io/obj_replace.hpp"
#include "mesh/check.hpp"
#include "mesh/join_sides.hpp"
#include "sim/setup.hpp"
#include "terminal.hpp"
#include "verify/crossings.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace toile::internal {
namespace {

constexpr std::size_t told_contours = 3, told_pairs = 2;  // in the one line on stderr; --json has them all

struct ClothFile {
  std::string name, text;
  SurfaceMesh mesh;
  bool is_obj = false;
  std::vector<Index> particle_of;   // [vertex of the file]; -1: no face uses it
  std::vector<Triangle> triangles;  // of the particles
  Vec3s x;
};

ClothFile load_cloth_file(const std::string& path) {
  ClothFile cloth;
  cloth.name = printable(path);
  cloth.text = read_file(path);
  cloth.mesh = parse_mesh(cloth.text, path);
  cloth.is_obj = mesh_format_of(cloth.text, path) == "OBJ";
  const JoinedSides joined = join_sides(cloth.mesh.positions, cloth.mesh.triangles, cloth.mesh.object);
  cloth.particle_of.assign(cloth.mesh.positions.size(), -1);
  for (const Triangle& t : cloth.mesh.triangles)
    for (const Index i : t) cloth.particle_of[at(i)] = 0;
  for (std::size_t i = 0; i < cloth.particle_of.size(); ++i) {
    if (cloth.particle_of[i] < 0) continue;
    const std::size_t first = at(joined.same_as[i]);
    if (first < i) {
      cloth.particle_of[i] = cloth.particle_of[first];
    } else {
      cloth.particle_of[i] = static_cast<Index>(cloth.x.size());
      cloth.x.push_back(cloth.mesh.positions[i]);
    }
  }
  for (Triangle t : cloth.mesh.triangles) {
    for (Index& i : t) i = cloth.particle_of[at(i)];
    cloth.triangles.push_back(t);
  }
  check_triangles(cloth.name, cloth.x, cloth.triangles);
  check_areas(cloth.name, cloth.x, cloth.triangles);
  return cloth;
}

// In the unit and axes of the cloth's file.
SolidMesh load_solid(const CommandLine& line) {
  if (line.body.empty()) return {};
  SceneCollider body = body_option(line);
  if (SceneMesh* const mesh = std::get_if<SceneMesh>(&body.shape))
    mesh->up = UpAxis::y;  // the cloth lies as the body does
  SolidMesh solid = load_collider(body).surface;
  for (Vec3& p : solid.positions) p /= metres_in(unit_option(line));
  return solid;
}

// "triangle 12 (shirt/sleeve)": counted from 0, quads split into fans, as `check` counts.
std::string name_of(const ClothFile& cloth, Index triangle) {
  const auto t = static_cast<std::size_t>(triangle);
  std::string name;
  const auto add = [&](const std::vector<Index>& of, const std::vector<std::string>& names) {
    if (t >= of.size() || names[static_cast<std::size_t>(of[t])].empty()) return;
    if (!name.empty()) name += '/';
    name += printable(names[static_cast<std::size_t>(of[t])]);
  };
  add(cloth.mesh.object, cloth.mesh.object_names);
  add(cloth.mesh.group, cloth.mesh.group_names);
  return "triangle " + std::to_string(triangle) + (name.empty() ? "" : " (" + name + ')');
}

std::string describe(const ClothFile& cloth, const Tangle& tangle) {
  std::string text = std::string(tangle.closed ? "closed" : "open") + (tangle.with_body ? " with the body, " : ", ");
  text += fmt::sprintf("length %.4g at (%.4g %.4g %.4g): ", tangle.length, tangle.position.x(), tangle.position.y(),
                       tangle.position.z());
  for (std::size_t k = 0; k < std::min(told_pairs, tangle.triangles.size()); ++k) {
    const auto& [a, b] = tangle.triangles[k];
    text += (k == 0 ? "" : ", ") + name_of(cloth, a) + " through " +
            (tangle.with_body ? "body triangle " + std::to_string(b) : name_of(cloth, b));
  }
  if (tangle.triangles.size() > told_pairs) text += fmt::sprintf(" and %zu more", tangle.triangles.size() - told_pairs);
  return text;
}

void add(JsonText& json, std::string_view key, int cloth, int body) {
  json.key(key);
  json.begin_object();
  json.member("cloth_cloth", cloth);
  json.member("cloth_body", body);
  json.end_object();
}

void add(JsonText& json, std::string_view key, const ClothFile& cloth, const std::vector<Tangle>& tangles) {
  json.key(key);
  json.begin_array();
  for (const Tangle& tangle : tangles) {
    json.begin_object();
    json.member("closed", tangle.closed);
    json.member("with_body", tangle.with_body);
    json.member("length", tangle.length);
    json.key("position");
    json.begin_array();
    for (const double coordinate : tangle.position) json.value(coordinate);
    json.end_array();
    json.member("first", name_of(cloth, tangle.triangles.front()[0]));
    json.member("second", tangle.with_body ? "body" : name_of(cloth, tangle.triangles.front()[1]));
    json.key("triangles");
    json.begin_array();
    for (const auto& pair : tangle.triangles) {
      json.begin_array();
      for (const Index t : pair) json.value(t);
      json.end_array();
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
}

// In the format of the cloth, unless --out has another; a format without a writer (.gltf) becomes OBJ.
std::string out_path(const CommandLine& line, bool resolved) {
  const std::filesystem::path in(line.inputs.front());
  std::filesystem::path path(line.out);
  if (line.out.empty()) {
    const MeshWriter* const own = mesh_writer_for(line.inputs.front());
    path = std::filesystem::path("out") /
           (in.stem().string() + "_untangled" + std::string(own != nullptr ? own->ending : ".obj"));
  }
  const std::string ending = path.extension().empty() ? ".obj" : path.extension().string();
  if (!resolved) path.replace_filename(path.stem().string() + "_still_tangled" + ending);
  return path.string();
}

// The output must not overwrite an input.
void refuse_what_would_be_lost(const CommandLine& line) {
  std::error_code ignored;
  for (const bool resolved : {true, false})
    for (const std::string& input : {line.inputs.front(), line.body})
      if (!input.empty() && std::filesystem::equivalent(input, out_path(line, resolved), ignored))
        throw IoError(printable(input), "is an input, which would be written over: name another file with --out");
}

// Writes the cloth's file with the present positions, and updates the report's crossings to those of the written file.  In an OBJ everything
// but the positions stays unchanged.
void write(const ClothFile& cloth, const SolidMesh& solid, const CommandLine& line, UntangleReport& report,
           std::string& out) {
  SurfaceMesh moved = cloth.mesh;
  for (std::size_t i = 0; i < moved.positions.size(); ++i)
    if (cloth.particle_of[i] >= 0) moved.positions[i] = cloth.x[at(cloth.particle_of[i])];
  std::string text;
  Vec3s x = cloth.x;  // as read from the written file
  if (cloth.is_obj) {
    text = with_positions(cloth.text, moved.positions, cloth.name);
    const SurfaceMesh written = parse_obj(text, cloth.name);
    for (std::size_t i = 0; i < moved.positions.size(); ++i)
      if (cloth.particle_of[i] >= 0) x[at(cloth.particle_of[i])] = written.positions[i];
  } else {
    for (Vec3& p : x) p = p.cast<float>().cast<double>();
  }
  report.cloth_crossings = static_cast<int>(find_cloth_crossings(cloth.triangles, x).size());
  report.body_crossings = 0;
  if (!solid.triangles.empty())
    report.body_crossings =
        static_cast<int>(find_body_crossings(cloth.triangles, x, solid.triangles, solid.positions).size());
  report.resolved = report.cloth_crossings + report.body_crossings == 0;
  out = out_path(line, report.resolved);
  make_directories(std::filesystem::path(out).parent_path().string());
  const MeshWriter* const writer = mesh_writer_for(out);
  if (!cloth.is_obj || (writer != nullptr && writer->name != "obj")) {
    writer->write(out, moved);
    return;
  }
  AtomicFile file(out);
  file.write(text);
  file.commit();
}

}  // namespace

ExitCode untangle_command(const CommandLine& line) {
  refuse_what_would_be_lost(line);
  ClothFile cloth = load_cloth_file(line.inputs.front());
  if (!cloth.is_obj && mesh_writer_for(out_path(line, true)) == nullptr)
    throw Error(ErrorKind::usage,
                "--out: expected a name that ends as " + mesh_writers_in_words() + ", got " + printable(line.out));
  const SolidMesh solid = load_solid(line);

  ProgressBar progress(line);
  bool stopped = false;
  int first = 0;
  UntangleReport report =
      untangle(cloth.triangles, cloth.x, solid.triangles, solid.positions, {}, [&](int iteration, int crossings) {
        if (iteration == 0) first = crossings;
        Progress shown;
        shown.phase = "untangling";
        shown.share = 1 - static_cast<double>(crossings) / std::max(first, 1);
        progress.show(shown);
        stopped = interrupted();
        return !stopped;
      });
  progress.clear();

  std::string out;
  write(cloth, solid, line, report, out);

  const ExitCode code = report.resolved ? ExitCode::ok : stopped ? ExitCode::interrupted : ExitCode::simulation_failed;
  if (line.json) {
    JsonText json;
    json.begin_object();
    json.member("resolved", report.resolved);
    json.member("out", out);
    json.member("vertices", cloth.x.size());
    json.member("triangles", cloth.triangles.size());
    add(json, "crossings_before", report.cloth_crossings_before, report.body_crossings_before);
    add(json, "crossings", report.cloth_crossings, report.body_crossings);
    add(json, "contours_before", cloth, report.before);
    add(json, "contours", cloth, report.left);
    json.member("inside_body", report.inside);
    json.member("iterations", report.iterations);
    json.member("largest_move", report.largest_move);
    json.member("mean_move", report.mean_move);
    json.member("edge_change_p99", report.edge_change_p99);
    json.member("edge_change_max", report.edge_change_max);
    json.member("exit_code", static_cast<int>(code));
    json.end_object();
    print(json.str() + '\n');
  } else if (!line.quiet) {
    std::string said =
        fmt::sprintf("%d crossings (%d with the body) in %zu contours before, %d (%d) in %zu after %d trials\n",
                     report.cloth_crossings_before + report.body_crossings_before, report.body_crossings_before,
                     report.before.size(), report.cloth_crossings + report.body_crossings, report.body_crossings,
                     report.left.size(), report.iterations);
    said += fmt::sprintf(
        "moved by %.3g at most, %.3g on average; edges changed by %.1f %% at most, 99 of 100 by less than %.1f %%\n",
        report.largest_move, report.mean_move, 100 * report.edge_change_max, 100 * report.edge_change_p99);
    if (report.inside > 0) said += fmt::sprintf("%d vertices are inside the body\n", report.inside);
    for (const Tangle& tangle : report.left) said += "left: " + describe(cloth, tangle) + '\n';
    print(said + out + '\n');
  }
  if (!report.resolved) {
    std::string what = cloth.name + ": " + std::to_string(report.cloth_crossings + report.body_crossings) +
                       " crossings are left in " + std::to_string(report.left.size()) + " contours";
    for (std::size_t k = 0; k < std::min(told_contours, report.left.size()); ++k)
      what += (k == 0 ? ": " : "; ") + describe(cloth, report.left[k]);
    if (report.left.size() > told_contours) what += "; ...";
    std::fprintf(stderr, "toile: %s%s\n", stopped ? "interrupted, " : "", what.c_str());
  }
  return code;
}

}  // namespace toile::internal
