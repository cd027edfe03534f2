// verify/verify.cpp: see the header; first the audit of frames, then the files.
#include "verify/verify.hpp"

#include "core/error.hpp"
#include "io/json.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "verify/pinch.hpp"
#include "verify/surface.hpp"
#include "verify/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

namespace toile {
namespace {

bool all_finite(std::span<const Vec3> x) {
  return std::all_of(x.begin(), x.end(), [](const Vec3& p) { return p.allFinite(); });
}

void count(const std::vector<Crossing>& crossings, int frame, PenetrationCount& total, Index& first_frame) {
  total.last = count_edges(crossings);
  total.max = std::max(total.max, total.last);
  if (total.last > 0) ++total.frames;
  if (total.last > 0 && first_frame < 0) first_frame = frame;
}

void check_count(const char* place, std::size_t expected, std::size_t got) {
  if (expected != got) throw InputError("audit", place, std::to_string(expected) + " positions", std::to_string(got));
}

std::string join(const std::string& directory, const char* name) {
  return (std::filesystem::path(directory) / name).string();
}

ClothMesh cloth_of(const ObjMesh& obj, const std::string& path) {
  ClothMesh mesh;
  mesh.particle_count = static_cast<Index>(obj.positions.size());
  mesh.triangles = obj.triangles;
  mesh.panel = obj.group;
  mesh.panel_names = obj.group_names;
  mesh.uv.resize(obj.triangles.size());
  for (std::size_t t = 0; t < obj.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index vt = obj.texcoord.empty() ? -1 : obj.texcoord[t][k];
      if (vt < 0)
        throw InputError(printable(path), "triangle " + std::to_string(t), "vt (pattern coordinates) at every corner",
                         "none");
      mesh.uv[t][k] = obj.texcoords[static_cast<std::size_t>(vt)];
    }
  return mesh;
}

// (b_u, b_v) per triangle from {"panel": [b_u, b_v]}.
std::vector<Vec2> rest_stretch(const Json& report, const ClothMesh& mesh) {
  const Json* by_panel = report.find("rest_stretch");
  if (by_panel == nullptr || by_panel->is_null()) return {};
  std::vector<Vec2> b(mesh.triangles.size(), Vec2(1, 1));
  for (const auto& [name, value] : by_panel->object()) {
    if (std::find(mesh.panel_names.begin(), mesh.panel_names.end(), name) == mesh.panel_names.end())
      value.fail("a panel (g) of cloth.obj as key", '"' + printable(name) + '"');
    if (!value.is_array() || value.array().size() != 2) value.fail("[b_u, b_v]", value.describe());
    const Vec2 b_uv(value.array()[0].number(), value.array()[1].number());
    if (!(b_uv.minCoeff() > 0)) value.fail("b_u, b_v > 0", value.describe());
    for (std::size_t t = 0; t < b.size(); ++t)
      if (mesh.panel_names[static_cast<std::size_t>(mesh.panel[t])] == name) b[t] = b_uv;
  }
  return b;
}

void check_points(const std::string& cache, const Pc2Reader& reader, const char* obj, std::size_t vertices) {
  if (static_cast<std::size_t>(reader.points()) != vertices)
    throw InputError(printable(cache), "points", std::to_string(vertices) + ", the vertices of " + obj,
                     std::to_string(reader.points()));
}

// Frame 0 of a cache is its OBJ.  If not, vertices were reordered and every measurement of triangles would be nonsense.
// The tolerance is for OBJ writers with 6 digits.
void check_first_frame(const std::string& cache, std::span<const Vec3> x, const char* obj,
                       std::span<const Vec3> expected) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double tolerance = 1e-5 * std::max(1.0, expected[i].cwiseAbs().maxCoeff());
    if (x[i].allFinite() && (x[i] - expected[i]).cwiseAbs().maxCoeff() > tolerance)
      throw InputError(printable(cache), "frame 0, vertex " + std::to_string(i), std::string("the position in ") + obj,
                       std::to_string((x[i] - expected[i]).norm()) + " m from it");
  }
}

}  // namespace

RunAudit::RunAudit(RunDescription run)
    : run_(std::move(run)),
      jitter_(run_.body_triangles, run_.fps),
      crossings_(run_.mesh.triangles, run_.body_triangles) {
  if (!(run_.fps > 0) || !std::isfinite(run_.fps)) throw InputError("audit", "fps", "> 0", std::to_string(run_.fps));
  // Positions come later; every other complaint about the meshes comes now.
  const Vec3s no_cloth(static_cast<std::size_t>(run_.mesh.particle_count), Vec3::Zero());
  const Vec3s no_body(static_cast<std::size_t>(run_.body_particle_count), Vec3::Zero());
  measure_stretch(run_.mesh, no_cloth, run_.b);
  check_surface("body", run_.body_triangles, no_body);
  report_.has_body = !run_.body_triangles.empty();
}

void RunAudit::add(std::span<const Vec3> x, std::span<const Vec3> body_x) {
  check_count("cloth", static_cast<std::size_t>(run_.mesh.particle_count), x.size());
  check_count("body", static_cast<std::size_t>(run_.body_particle_count), body_x.size());
  const int frame = report_.frames++;
  const bool finite = all_finite(x) && all_finite(body_x);
  report_.last_body_crossings.clear();
  report_.last_cloth_crossings.clear();
  report_.cloth_body_edges.last = report_.outside_pinches.last = report_.cloth_cloth_edges.last = 0;
  if (finite) {
    jitter_.add(x, body_x);
    CrossingSearch::Found found = crossings_.find(x, body_x);
    report_.last_cloth_crossings = std::move(found.of_cloth);
    report_.last_body_crossings = std::move(found.of_body);
    count(report_.last_cloth_crossings, frame, report_.cloth_cloth_edges, report_.first_cloth_crossing_frame);
    count(report_.last_body_crossings, frame, report_.cloth_body_edges, report_.first_body_crossing_frame);
    Index first_outside = -1;
    count(outside_pinches(report_.last_body_crossings, run_.mesh.triangles, x, run_.body_triangles, body_x), frame,
          report_.outside_pinches, first_outside);
    const std::size_t crossings = report_.last_cloth_crossings.size() + report_.last_body_crossings.size();
    if (crossings > report_.worst_cloth_crossings.size() + report_.worst_body_crossings.size()) {
      report_.worst_frame = frame;
      report_.worst_cloth_crossings = report_.last_cloth_crossings;
      report_.worst_body_crossings = report_.last_body_crossings;
    }
  } else {
    jitter_.skip();
    if (report_.finite) report_.first_bad_frame = frame;
    report_.finite = false;
  }
  if (frame > 0) speed_p99_.push_back(finite && last_is_finite_ ? speed_p99_mm_per_s(last_x_, x, run_.fps) : 0);
  last_x_.assign(x.begin(), x.end());
  last_body_x_.assign(body_x.begin(), body_x.end());
  last_is_finite_ = finite;
}

VerifyReport RunAudit::report() const {
  VerifyReport result = report_;
  result.jitter = jitter_.statistics();
  if (!last_is_finite_) return result;
  result.stretch = measure_stretch(run_.mesh, last_x_, run_.b);
  if (result.has_body) result.gap = measure_gap(last_x_, run_.body_triangles, last_body_x_);
  const auto second = std::max<std::size_t>(1, static_cast<std::size_t>(std::min(std::round(run_.fps), 1e9)));
  const std::size_t pairs = std::min(speed_p99_.size(), second);
  for (std::size_t k = speed_p99_.size() - pairs; k < speed_p99_.size(); ++k)
    result.still_mm_per_s_p99 = std::max(result.still_mm_per_s_p99, speed_p99_[k]);
  return result;
}

VerifyReport verify_directory(const std::string& directory) {
  const std::string cloth_obj = join(directory, "cloth.obj"), cloth_pc2 = join(directory, "cloth.pc2");
  const std::string body_obj = join(directory, "body.obj"), body_pc2 = join(directory, "body.pc2");
  const std::string report_path = join(directory, "report.json");

  const Json report = Json::load(report_path);
  const ObjMesh cloth = load_obj(cloth_obj);
  RunDescription run;
  run.mesh = cloth_of(cloth, cloth_obj);
  run.b = rest_stretch(report, run.mesh);
  run.fps = report.at("fps").number();
  if (!(run.fps > 0)) report.at("fps").fail("a number > 0", report.at("fps").describe());

  Pc2Reader cloth_frames(cloth_pc2);
  check_points(cloth_pc2, cloth_frames, "cloth.obj", cloth.positions.size());

  const Json* body_entry = report.find("body");
  const bool body_reported =
      body_entry != nullptr && body_entry->is_object() && body_entry->number_or("vertices", 0) > 0;
  ObjMesh body;
  std::optional<Pc2Reader> body_frames;
  if (body_reported || std::filesystem::exists(body_obj) || std::filesystem::exists(body_pc2)) {
    body = load_obj(body_obj);
    body_frames.emplace(body_pc2);
    check_points(body_pc2, *body_frames, "body.obj", body.positions.size());
    if (body_frames->samples() != cloth_frames.samples())
      throw InputError(printable(body_pc2), "samples", std::to_string(cloth_frames.samples()) + " as in cloth.pc2",
                       std::to_string(body_frames->samples()));
    run.body_triangles = body.triangles;
    run.body_particle_count = static_cast<Index>(body.positions.size());
  }

  RunAudit audit(std::move(run));
  Vec3s x, body_x;
  for (int frame = 0; frame < cloth_frames.samples(); ++frame) {
    cloth_frames.read(frame, x);
    if (body_frames) body_frames->read(frame, body_x);
    if (frame == 0) {
      check_first_frame(cloth_pc2, x, "cloth.obj", cloth.positions);
      check_first_frame(body_pc2, body_x, "body.obj", body.positions);
    }
    audit.add(x, body_x);
  }

  VerifyReport result = audit.report();
  if (const Json* frames = report.find("frames"))
    result.frames_expected = static_cast<int>(std::clamp(frames->number(), 0.0, 2e9));
  if (const Json* limits = report.find("limits"); limits != nullptr && limits->is_object())
    if (const Json* still = limits->find("still_mm_per_s")) result.must_be_still = still->is_number();
  if (const Json* reasons = report.find("reasons"))
    for (const Json& reason : reasons->array())
      if (!is_measured_reason(reason.string())) result.reported_reasons.push_back(reason.string());
  if (const Json* details = report.find("qualification_details"))
    for (const auto& [code, detail] : details->object())
      result.reported_qualifications.push_back({code, detail.string()});
  return result;
}

}  // namespace toile
