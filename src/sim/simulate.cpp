#include "sim/simulate.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "core/parallel.hpp"
#include "io/run_folder.hpp"
#include "sim/checkpoint.hpp"
#include "sim/recorder.hpp"
#include "sim/scene_inputs.hpp"
#include "sim/simulation.hpp"

#include <sys/resource.h>

#include <memory>
#include <optional>
#include <utility>

namespace toile::internal {
namespace {

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// Runs a scene from its files to the files of its run.  A saved state: the numbers of written frames, then the simulation's state.
class Run : public SimulationObserver {
 public:
  Run(const Scene& scene, const RunOptions& options) : scene_(scene), options_(options) {}
  // Its recorder and checkpoints point at its writer.
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  Report operator()();

 private:
  void sewing_begins(const ClothMesh& panels, std::string_view garment, std::span<const Vec3> x,
                     std::span<const Triangle> body, std::span<const Vec3> body_x) override;
  void sewing_frame(std::span<const Vec3> x) override { writer_->sewing_frame(x); }
  void begins(const Outfit& outfit, std::span<const Vec2> rest_stretch, std::span<const Triangle> body,
              std::span<const Vec3> body_x) override;
  void frame(std::span<const Vec3> x, std::span<const Vec3> body_x) override { recorder_->frame(x, body_x); }
  void motion_begins() override { set_facts(); }
  void collapsed(const SurfaceMesh& offenders) override { writer_->offenders(offenders); }
  void between_frames(bool first, const std::function<std::string()>& state) override;

  void open_folder();
  void load();
  void set_facts();
  void take_up();
  Report finish();

  const Scene& scene_;
  const RunOptions& options_;
  Stopwatch watch_;
  std::vector<std::string> inputs_;
  std::uint64_t input_hash_ = 0;
  std::unique_ptr<RunFolder> folder_;
  std::optional<Simulation> simulation_;
  std::optional<RunWriter> writer_;
  std::optional<Recorder> recorder_;
  std::optional<Checkpoints> checkpoints_;
  std::string state_;                  // the saved state,
  std::optional<StateReader> reader_;  // from which the simulation may still read
  WrittenFrames written_;              // when the state was saved
};

Report Run::operator()() {
  require_budget(scene_, options_.read, options_.limits);
  open_folder();
  load();
  if (options_.resume)
    take_up();
  else
    writer_.emplace(*folder_);
  checkpoints_.emplace(*writer_, input_hash_, options_.checkpoints);
  try {
    simulation_->run();
    return finish();
  } catch (const IoError& error) {
    throw Error(error.kind(), std::string(error.what()) + "; " + std::to_string(writer_->cloth_frames()) +
                                  " frames are kept in " + folder_->directory() + ": toile resume goes on from there");
  }
}

void Run::open_folder() {
  inputs_ = input_paths(scene_);
  inputs_.insert(inputs_.end(), options_.inputs.begin(), options_.inputs.end());
  folder_ = std::make_unique<RunFolder>(
      options_.directory, options_.resume ? RunFolder::Use::resume : RunFolder::Use::new_run,
      RunFolder::Owner{options_.command, options_.arguments, std::string(toile_version())}, inputs_);
}

void Run::load() {
  if (options_.progress) options_.progress({"meshing", 0, -1});
  LoadedScene loaded = load_scene(scene_, options_.read);
  input_hash_ = input_hash(scene_, loaded);
  simulation_.emplace(
      scene_, std::move(loaded),
      SimulationOptions{options_.progress, options_.stop, options_.time_limit_s, options_.seconds_before, watch_},
      *this);
  Report& report = simulation_->report();
  if (!options_.resume && folder_->was_unfinished())
    report.warnings.insert(
        report.warnings.begin(),
        "the folder held a run that was interrupted; it is replaced, toile resume would have gone on with it");
  if (!options_.built_in) report.inputs = checksums_of_inputs(inputs_, folder_->directory());
  report.command = options_.command;
  report.input_hash = hex_of(input_hash_);
  report.threads = available_threads();
}

// Resumes at the saved state; from the beginning, if there is none.
void Run::take_up() {
  const std::string path = folder_->path("checkpoint.bin");
  std::optional<std::string> state = read_checkpoint(path, input_hash_);
  if (!state) {
    writer_.emplace(*folder_);
    return;
  }
  state_ = std::move(*state);
  reader_.emplace(state_, printable(path));
  (*reader_)(written_);
  const Index panels = simulation_->particles_of_first_panels();
  simulation_->take_up(*reader_);
  writer_.emplace(*folder_, written_, panels, simulation_->outfit().mesh.particle_count,
                  static_cast<Index>(simulation_->body_x().size()));
}

void Run::sewing_begins(const ClothMesh& panels, std::string_view garment, std::span<const Vec3> x,
                        std::span<const Triangle> body, std::span<const Vec3> body_x) {
  checkpoints_->wait();
  writer_->begin_sewing(panels, garment, x, body, body_x);
}

void Run::begins(const Outfit& outfit, std::span<const Vec2> rest_stretch, std::span<const Triangle> body,
                 std::span<const Vec3> body_x) {
  if (written_.cloth > 0) {
    recorder_.emplace(*writer_, outfit, rest_stretch, scene_.fps, body, body_x.size(), written_);
    return;
  }
  checkpoints_->wait();
  set_facts();
  recorder_.emplace(*writer_, outfit, rest_stretch, scene_.fps, body, body_x);
}

void Run::set_facts() {
  checkpoints_->wait();
  folder_->set_facts([&](JsonText& json) { add_facts(json, simulation_->report()); });
}

void Run::between_frames(bool first, const std::function<std::string()>& state) {
  if (!first && !checkpoints_->due()) return;
  StateWriter archive;
  written_ = writer_->frames();
  archive(written_);
  checkpoints_->save(archive.take() + state());
}

Report Run::finish() {
  checkpoints_->wait();
  Report& report = simulation_->report();
  Hash state;
  state.add(std::span<const Vec3>(simulation_->outfit().state.x));
  state.add(std::span<const Vec3>(simulation_->outfit().state.v));
  report.state_hash = state.hex();
  report.frames = writer_->cloth_frames();
  Limits limits;
  const bool fell = report.ended == reason::never_touched || report.ended == reason::fell_off;
  limits.must_be_still = scene_.until_still && !simulation_->body_moves() && !fell &&
                         !simulation_->stopped_short();  // falling cloth need not rest
  report.verdict.limits = limits;
  if (recorder_) {
    report.audit = recorder_->report();
    report.audit.must_be_still = limits.must_be_still;
    report.verdict = judge(report.audit, limits);
  }
  auto& reasons = report.verdict.reasons;
  reasons.insert(reasons.begin(), simulation_->failure().begin(), simulation_->failure().end());
  report.verdict.pass = reasons.empty();
  auto& qualifications = report.verdict.qualifications;
  qualifications.insert(qualifications.begin(), simulation_->qualifications().begin(),
                        simulation_->qualifications().end());
  report.seconds_total = simulation_->seconds();
  report.peak_memory_mb = peak_memory_mb();
  const auto text = [&](const std::vector<WrittenFile>& files) {
    report.files = files;
    return to_json(report);
  };
  writer_->finish(text, report.ended == reason::interrupted);
  return report;
}

}  // namespace

Report simulate(const Scene& scene, const RunOptions& options) { return Run(scene, options)(); }

Outcome outcome(const Report& report) {
  if (report.ended == reason::interrupted) return Outcome::interrupted;
  return report.verdict.pass ? Outcome::passed : Outcome::failed;
}

}  // namespace toile::internal
