#include "sim/simulate.hpp"

#include "core/parallel.hpp"
#include "mesh/check.hpp"
#include "sim/offenders.hpp"
#include "sim/run.hpp"
#include "sim/scene_inputs.hpp"
#include "sim/start_run.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// Each code once.
void add_reason(std::vector<Reason>& reasons, std::string_view code, const std::string& detail) {
  for (Reason& known : reasons) {
    if (known.code != code) continue;
    known.detail += "; " + detail;
    return;
  }
  reasons.push_back({std::string(code), detail});
}

}  // namespace

Report Run::operator()() {
  require_budget(scene_, options_.read, options_.limits);
  std::vector<std::string> inputs = input_paths(scene_);
  inputs.insert(inputs.end(), options_.inputs.begin(), options_.inputs.end());
  folder_ = std::make_unique<RunFolder>(
      options_.directory, options_.resume ? RunFolder::Use::resume : RunFolder::Use::new_run,
      RunFolder::Owner{options_.command, options_.arguments, std::string(toile_version())}, inputs);
  if (!options_.resume && folder_->was_unfinished())
    report_.warnings.emplace_back(
        "the folder held a run that was interrupted; it is replaced, toile resume would have gone on with it");
  Hash hash;
  load(hash);
  if (!options_.built_in) report_.inputs = checksums_of_inputs(inputs, folder_->directory());
  describe_run(hash.hex());
  if (options_.resume) {
    take_up(hash.value());
  } else {
    writer_.emplace(*folder_);
  }
  checkpoints_.emplace(*writer_, hash.value(), options_.checkpoints);
  try {
    if (put_on()) {
      report_.vertices = outfit_.mesh.particle_count;
      live();
    }
    return finish();
  } catch (const IoError& error) {
    throw Error(error.code(), std::string(error.what()) + "; " + std::to_string(writer_->cloth_frames()) +
                                  " frames are kept in " + folder_->directory() + ": toile resume goes on from there");
  }
}

void Run::load(Hash& inputs) {
  add_to_hash(scene_, inputs);
  say("meshing", 0);
  report_.startup.scene = options_.seconds_before;
  {
    const Timed timed(report_.startup.cloth);
    for (const SceneCloth& cloth : scene_.cloth) cloth_.push_back(load_cloth(scene_, cloth, options_.read, inputs));
  }
  const Timed timed(report_.startup.body);
  LoadedBody loaded = load_body(scene_.body, inputs);
  person_vertices_ = loaded.solid.positions.size();
  person_triangles_ = loaded.solid.triangles.size();
  add_solids(scene_.solids, loaded, inputs);
  if (!scene_.start.empty()) add_start(scene_.start, inputs);
  motion_ = std::move(loaded.movement);
  measurements_ = std::move(loaded.measurements);
  report_.warnings.insert(report_.warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
  SolidMesh& solid = loaded.solid;
  body_x_ = standing_x_ = solid.positions;
  body_triangles_ = solid.triangles;
  if (!body_triangles_.empty()) body_.emplace(std::move(solid.positions), std::move(solid.triangles));
  double edge_m = 0;
  for (const LoadedCloth& cloth : cloth_) edge_m = std::max(edge_m, cloth.edge_m);
  step_ = step_options(scene_, cloth_.front().fabrics.front(), edge_m);
}

void Run::describe_run(const std::string& input_hash) {
  report_.name = scene_.name;
  report_.command = options_.command;
  report_.input_hash = input_hash;
  report_.threads = available_threads();
  report_.fps = scene_.fps;
  report_.body_vertices = static_cast<int>(body_x_.size());
  report_.body_triangles = static_cast<int>(body_triangles_.size());
  for (const LoadedCloth& cloth : cloth_) {
    report_.vertices += cloth.garment.mesh.particle_count;
    report_.triangles += cloth.garment.mesh.triangle_count();
    report_.panels += static_cast<int>(cloth.garment.mesh.panel_names.size());
    report_.seams += static_cast<int>(cloth.garment.seams.size());
  }
}

// Where the run was left; from its beginning, when it had not come to a state that could be kept.
void Run::take_up(std::uint64_t input_hash) {
  const std::string path = folder_->path("checkpoint.bin");
  std::optional<std::string> state = read_checkpoint(path, input_hash);
  if (!state) {
    writer_.emplace(*folder_);
    return;
  }
  state_ = std::move(*state);
  taken_up_ = std::make_unique<StateReader>(state_, printable(path));
  remember(*taken_up_);
  earlier_s_ = report_.seconds_total;
  if (place_.cloth >= cloth_.size())
    throw InputError(printable(path), "garment", "one of " + std::to_string(cloth_.size()),
                     std::to_string(place_.cloth));
  wear_again();
  (*taken_up_)(outfit_);
  writer_.emplace(*folder_, written_, cloth_.front().garment.mesh.particle_count, outfit_.mesh.particle_count,
                  static_cast<Index>(body_x_.size()));
}

int Run::frames_in(double seconds) const { return std::max(1, static_cast<int>(std::lround(seconds * scene_.fps))); }

void Run::end(std::string_view how, const std::string& detail) {
  report_.ended = how;
  add_reason(failure_, how, detail);
}

// The verdict, if it is a pass, is one with this reservation.
void Run::qualify(std::string_view code, const std::string& detail) { add_reason(qualifications_, code, detail); }

// The step could not be made however short: says over what, and leaves it in a file.
void Run::collapse(const std::string& when, const FrameReport& frame, const ClothMesh& mesh, std::span<const Vec3> x) {
  std::string words = when + ": " + frame.diagnosis;
  if (!frame.offenders.empty()) {
    const ObjMesh offenders =
        offenders_obj(mesh, x, frame.offenders, body_triangles_, body_ ? body_->positions() : std::span<const Vec3>{});
    words += "; offenders.obj: " + name_triangles(mesh, frame.offenders);
    const auto of_body = std::count(offenders.object.begin(), offenders.object.end(), 1);
    if (of_body > 0) words += ", and " + std::to_string(of_body) + " triangles of the body near them";
    writer_->offenders(offenders);
  }
  end(reason::step_collapsed, words);
}

// Called before every first step of something; the first of them counts.
void Run::end_startup() {
  if (report_.startup.total == 0) report_.startup.total = options_.seconds_before + total_.seconds();
}

// Where the time of one of its parts goes: after the first step, nowhere.
double& Run::startup(double StartupReport::*part) {
  return report_.startup.total == 0 ? report_.startup.*part : after_startup_;
}

Report Run::finish() {
  checkpoints_->wait();
  Hash state;
  state.add(std::span<const Vec3>(outfit_.state.x));
  state.add(std::span<const Vec3>(outfit_.state.v));
  report_.state_hash = state.hex();
  report_.frames = writer_->cloth_frames();
  Limits limits;
  const bool fell = report_.ended == reason::never_touched || report_.ended == reason::fell_off;
  limits.must_be_still = scene_.until_still && !motion_ && !fell && !stopped_short_;  // of what falls rest is not asked
  report_.verdict.limits = limits;
  if (recorder_) {
    report_.audit = recorder_->report();
    report_.audit.must_be_still = limits.must_be_still;
    report_.verdict = judge(report_.audit, limits);
  }
  auto& reasons = report_.verdict.reasons;
  reasons.insert(reasons.begin(), failure_.begin(), failure_.end());
  report_.verdict.pass = reasons.empty();
  report_.verdict.qualifications = qualifications_;
  report_.seconds_total = earlier_s_ + total_.seconds();
  report_.peak_memory_mb = peak_memory_mb();
  const auto text = [this](const std::vector<WrittenFile>& files) {
    report_.files = files;
    return to_json(report_);
  };
  writer_->finish(text, report_.ended == reason::interrupted);
  return report_;
}

Report simulate(const Scene& scene, const RunOptions& options) { return Run(scene, options)(); }

ExitCode exit_code(const Report& report) {
  if (report.ended == reason::interrupted) return ExitCode::interrupted;
  return report.verdict.pass ? ExitCode::ok : ExitCode::simulation_failed;
}

}  // namespace toile::internal
