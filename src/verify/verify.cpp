// verify/verify.cpp: see the header; first the audit of frames, then the files.
#include "verify/verify.hpp"

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/run_folder.hpp"
#include "verify/integrity.hpp"
#include "verify/pinch.hpp"
#include "verify/surface.hpp"
#include "verify/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

namespace toile::internal {
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

ClothMesh cloth_of(const SurfaceMesh& obj, const std::string& path) {
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
std::vector<Vec2> rest_stretch(const Json& by_panel, const ClothMesh& mesh) {
  std::vector<Vec2> b(mesh.triangles.size(), Vec2(1, 1));
  for (const auto& [name, value] : by_panel.object()) {
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
      slip_(run_.mesh, run_.body_triangles),
      crossings_(run_.mesh.triangles, run_.body_triangles) {
  if (!(run_.fps > 0) || !std::isfinite(run_.fps)) throw InputError("audit", "fps", "> 0", std::to_string(run_.fps));
  // Positions come later; all other errors of the meshes are found now.
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
  report_.last_outside_pinches.clear();
  report_.last_cloth_crossings.clear();
  report_.cloth_body_edges.last = report_.outside_pinches.last = report_.cloth_cloth_edges.last = 0;
  if (finite) {
    jitter_.add(x, body_x);
    slip_.add(x, body_x);
    CrossingSearch::Found found = crossings_.find(x, body_x);
    report_.last_cloth_crossings = std::move(found.of_cloth);
    report_.last_body_crossings = std::move(found.of_body);
    count(report_.last_cloth_crossings, frame, report_.cloth_cloth_edges, report_.first_cloth_crossing_frame);
    count(report_.last_body_crossings, frame, report_.cloth_body_edges, report_.first_body_crossing_frame);
    Index first_outside = -1;
    report_.last_outside_pinches =
        outside_pinches(report_.last_body_crossings, run_.mesh.triangles, x, run_.body_triangles, body_x);
    count(report_.last_outside_pinches, frame, report_.outside_pinches, first_outside);
    const std::size_t crossings = report_.last_cloth_crossings.size() + report_.last_body_crossings.size();
    if (crossings > report_.worst_cloth_crossings.size() + report_.worst_body_crossings.size()) {
      report_.worst_frame = frame;
      report_.worst_cloth_crossings = report_.last_cloth_crossings;
      report_.worst_body_crossings = report_.last_body_crossings;
    }
  } else {
    jitter_.skip();
    slip_.skip();
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
  result.slip = slip_.statistics();
  if (!last_is_finite_) return result;
  result.stretch = measure_stretch(run_.mesh, last_x_, run_.b);
  if (result.has_body)
    result.stretch.body_girth_m = girth_within_m(result.stretch.ring, last_body_x_, run_.body_triangles);
  if (result.has_body) result.gap = measure_gap(last_x_, run_.body_triangles, last_body_x_);
  const auto second = std::max<std::size_t>(1, static_cast<std::size_t>(std::min(std::round(run_.fps), 1e9)));
  const std::size_t pairs = std::min(speed_p99_.size(), second);
  for (std::size_t k = speed_p99_.size() - pairs; k < speed_p99_.size(); ++k)
    result.still_mm_per_s_p99 = std::max(result.still_mm_per_s_p99, speed_p99_[k]);
  return result;
}

namespace {

// The record of a run beside its meshes and caches.
struct RunRecord {
  std::string text;            // of report.json
  std::optional<Json> report;  // absent while the run is not finished
  std::optional<UnfinishedRun> unfinished;
  double fps = 0;
  bool has_body = false;
  std::optional<Json> rest_stretch;
};

RunRecord read_record(const std::string& directory) {
  RunRecord record;
  const std::string path = join(directory, "report.json");
  record.unfinished = read_unfinished_run(directory);
  if (record.unfinished && !std::filesystem::exists(path)) {
    record.fps = record.unfinished->fps;
    record.has_body = record.unfinished->body_vertices > 0;
    record.rest_stretch = record.unfinished->rest_stretch;
    return record;
  }
  record.text = read_file(path, Json::text_limit);
  record.report = Json::parse(record.text, printable(path));
  const Json& report = *record.report;
  const bool any_frames = report.number_or("frames", -1) != 0;  // without frames, nothing is measured
  if (any_frames || report.find("fps") != nullptr) {
    record.fps = report.at("fps").number();
    if (!(record.fps > 0)) report.at("fps").fail("a number > 0", report.at("fps").describe());
  }
  const Json* body = report.find("body");
  record.has_body = body != nullptr && body->is_object() && body->number_or("vertices", 0) > 0;
  if (const Json* rest = report.find("rest_stretch"); rest != nullptr && !rest->is_null()) record.rest_stretch = *rest;
  return record;
}

void add_reported(const Json& report, VerifyReport& result) {
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
}

// Describes a run that has not ended.
std::string interrupted(const std::string& directory, const UnfinishedRun& run, int frames) {
  if (is_written_to(directory)) return "the run still goes on (" + run.process + ")";
  return (frames > 0 ? "interrupted at frame " + std::to_string(frames - 1)
                     : std::string("interrupted before frame 0")) +
         " (" + run.process + "); toile resume goes on with it";
}

struct Caches {
  std::optional<Pc2Reader> cloth, body;
};

// Judges every frame, and compares it with its checksum in the report.
VerifyReport audit_frames(const std::string& directory, const RunRecord& record, Integrity* integrity) {
  const std::string cloth_obj = join(directory, "cloth.obj"), cloth_pc2 = join(directory, "cloth.pc2");
  const std::string body_obj = join(directory, "body.obj"), body_pc2 = join(directory, "body.pc2");
  const Pc2End end = record.report ? Pc2End::exact : Pc2End::cut;
  const SurfaceMesh cloth = load_obj(cloth_obj);
  RunDescription run;
  run.mesh = cloth_of(cloth, cloth_obj);
  if (record.rest_stretch) run.b = rest_stretch(*record.rest_stretch, run.mesh);
  run.fps = record.fps;

  Caches caches;
  caches.cloth.emplace(cloth_pc2, end);
  check_points(cloth_pc2, *caches.cloth, "cloth.obj", cloth.positions.size());
  int samples = caches.cloth->samples();

  SurfaceMesh body;
  if (record.has_body || std::filesystem::exists(body_obj) || std::filesystem::exists(body_pc2)) {
    body = load_obj(body_obj);
    caches.body.emplace(body_pc2, end);
    check_points(body_pc2, *caches.body, "body.obj", body.positions.size());
    if (!record.report) {  // it may have ended between the two
      samples = std::min(samples, caches.body->samples());
    } else if (caches.body->samples() != samples) {
      throw InputError(printable(body_pc2), "samples", std::to_string(samples) + " as in cloth.pc2",
                       std::to_string(caches.body->samples()));
    }
    run.body_triangles = body.triangles;
    run.body_particle_count = static_cast<Index>(body.positions.size());
  }
  if (integrity != nullptr) {
    integrity->check_header("cloth.pc2", *caches.cloth);
    if (caches.body) integrity->check_header("body.pc2", *caches.body);
  }

  RunAudit audit(std::move(run));
  Vec3s x, body_x;
  for (int frame = 0; frame < samples; ++frame) {
    caches.cloth->read(frame, x);
    if (caches.body) caches.body->read(frame, body_x);
    if (frame == 0) {
      check_first_frame(cloth_pc2, x, "cloth.obj", cloth.positions);
      check_first_frame(body_pc2, body_x, "body.obj", body.positions);
    }
    if (integrity != nullptr) {
      integrity->check_frame("cloth.pc2", frame, *caches.cloth);
      if (caches.body) integrity->check_frame("body.pc2", frame, *caches.body);
    }
    audit.add(x, body_x);
  }
  return audit.report();
}

}  // namespace

VerifyReport verify_directory(const std::string& directory) {
  const RunRecord record = read_record(directory);
  std::optional<Integrity> integrity;
  if (record.report) integrity.emplace(directory, record.text, *record.report);
  // A run whose seams did not close, or that has only begun, has no cloth to measure: then its own report is used, and it is no pass.
  const bool any_cloth =
      std::filesystem::exists(join(directory, "cloth.obj")) && std::filesystem::exists(join(directory, "cloth.pc2"));
  const bool may_lack_cloth = record.report ? record.report->number_or("frames", -1) == 0 : true;
  VerifyReport result;
  if (any_cloth || !may_lack_cloth) result = audit_frames(directory, record, integrity ? &*integrity : nullptr);
  if (record.report) {
    add_reported(*record.report, result);
    Integrity::Inputs inputs = Integrity::check_inputs(directory, *record.report);
    result.inputs = inputs.known;
    result.missing_inputs = inputs.missing;
    for (const std::string& name : inputs.changed) result.changed_inputs.push_back(printable(name));
  }
  if (integrity) {
    integrity->check_cache(directory, "sewing.pc2");
    result.changes = integrity->changes();
  }
  if (record.unfinished) result.interrupted = interrupted(directory, *record.unfinished, result.frames);
  return result;
}

}  // namespace toile::internal
