#include "toile/run.hpp"

#include "api/implementation.hpp"
#include "api/verdict.hpp"
#include "core/stopwatch.hpp"
#include "io/run_folder.hpp"
#include "preview/looks.hpp"
#include "preview/preview.hpp"
#include "sim/export_run.hpp"
#include "sim/picture_run.hpp"
#include "sim/recorder.hpp"
#include "sim/simulate.hpp"

#include <optional>

namespace toile {

struct RunWriter::Parts {
  Parts(const std::string& directory, const Simulation& simulation, double fps);

  internal::Stopwatch watch;
  // Until it is finished: then the folder is no longer locked.
  std::optional<internal::RunFolder> folder;
  std::optional<internal::RunWriter> writer;
  std::optional<internal::Recorder> recorder;
  internal::Report report;
  std::size_t vertices = 0, body_vertices = 0;
  std::string state_hash;
};

RunWriter::Parts::Parts(const std::string& directory, const Simulation& simulation, double fps) {
  const Simulation::Implementation& made = simulation.implementation();
  if (!made.begun)
    throw internal::Error(internal::ErrorKind::usage,
                          "RunWriter: nothing is on yet, and what is to be sewn is by dress()");
  report = made.engine->report();
  report.command = "toile::RunWriter";
  report.fps = fps;
  report.input_hash = internal::hex_of(made.recipe->input_hash);
  report.threads = internal::available_threads();
  report.motion_first_frame = -1;
  folder.emplace(directory, internal::RunFolder::Use::new_run,
                 internal::RunFolder::Owner{"toile::RunWriter", {}, std::string(internal::toile_version())},
                 std::span<const std::string>{});
  writer.emplace(*folder);
  folder->set_facts([&](internal::JsonText& json) { internal::add_facts(json, report); });
  internal::Outfit outfit = made.engine->outfit();
  outfit.mesh = made.mesh();
  vertices = made.state().x.size();
  body_vertices = made.body_x.size();
  report.vertices = static_cast<int>(vertices);
  state_hash = simulation.state_hash();
  recorder.emplace(*writer, outfit, outfit.rest_stretch, fps, made.engine->body_triangles(), made.body_x);
  report.frames = writer->cloth_frames();
}

RunWriter::RunWriter(const std::string& folder, const Simulation& simulation, double fps)
    : parts_(translated([&] {
        require_above_zero("fps", fps);
        return std::make_unique<Parts>(folder, simulation, fps);
      })) {}
RunWriter::RunWriter(RunWriter&&) noexcept = default;
RunWriter& RunWriter::operator=(RunWriter&&) noexcept = default;
RunWriter::~RunWriter() = default;

void RunWriter::add(const Simulation& simulation) {
  translated([&] {
    Parts& own = *parts_;
    const Simulation::Implementation& made = simulation.implementation();
    if (!own.writer) throw internal::Error(internal::ErrorKind::usage, "RunWriter::add: the run is finished");
    if (made.state().x.size() != own.vertices || made.body_x.size() != own.body_vertices)
      throw internal::InputError(
          "", "simulation",
          std::to_string(own.vertices) + " vertices and a body of " + std::to_string(own.body_vertices),
          std::to_string(made.state().x.size()) + " and " + std::to_string(made.body_x.size()));
    own.recorder->frame(made.state().x, made.body_x);
    own.report.drape = made.engine->report().drape;
    own.report.drape.simulated_s = simulation.time_s();
    own.report.frames = own.writer->cloth_frames();
    own.state_hash = simulation.state_hash();
  });
}

int RunWriter::frames() const { return parts_->report.frames; }

Verdict RunWriter::finish() {
  return translated([&] {
    Parts& own = *parts_;
    if (!own.writer) throw internal::Error(internal::ErrorKind::usage, "RunWriter::finish: the run is finished");
    own.report.state_hash = own.state_hash;
    own.report.ended = "time";
    own.report.audit = own.recorder->report();
    own.report.verdict = internal::judge(own.report.audit, {});
    own.report.seconds_total = own.watch.seconds();
    own.writer->finish(
        [&](const std::vector<internal::WrittenFile>& files) {
          own.report.files = files;
          return internal::to_json(own.report);
        },
        false);
    own.recorder.reset();
    own.writer.reset();
    own.folder.reset();
    return verdict_of(own.report.audit, own.report.verdict);
  });
}

Verdict run_scene(const std::string& path, const std::string& folder, const RunOptions& options) {
  return translated([&] {
    const internal::SceneFile file = internal::read_scene(internal::read_text_file(path), path);
    internal::RunOptions run;
    run.directory = folder;
    run.command = "toile run " + path;
    run.arguments = {"run", path, "--out", folder};
    run.inputs = {path};
    if (options.progress)
      run.progress = [&](const internal::Progress& p) { options.progress({p.phase, p.share, p.seconds_left}); };
    run.stop = options.cancelled;
    run.time_limit_s = options.time_limit_s;
    internal::Report report;
    const auto work = [&] { file.places.complete_errors_of([&] { report = internal::simulate(file.scene, run); }); };
    if (options.threads > 0)
      internal::with_threads(options.threads, work);
    else
      work();
    return verdict_of(report.audit, report.verdict);
  });
}

std::vector<std::string> export_run(const std::string& folder, const std::string& out, const ExportOptions& options) {
  return translated([&] {
    internal::ExportOptions wanted;
    wanted.to = options.to;
    wanted.out = out;
    wanted.of = options.of;
    if (options.frame != -1) wanted.frame = options.frame;
    wanted.all = options.all;
    return internal::export_run(folder, wanted).files;
  });
}

void preview(const std::string& folder, const PreviewOptions& options) {
  translated([&] {
    if (options.style != "technical" && options.style != "studio")
      throw internal::InputError("", "style", "\"technical\" or \"studio\"", options.style);
    internal::PictureOptions wanted =
        options.style == "studio" ? internal::studio_pictures() : internal::PictureOptions{};
    if (const auto& point = options.close_up_m)
      wanted.close_up_m = internal::Vec3((*point)[0], (*point)[1], (*point)[2]);
    wanted.turntable = options.turntable;
    wanted.film = options.film;
    std::vector<std::string> inputs;
    if (!options.looks.empty()) {
      internal::require_pictures();
      const auto looks = std::make_shared<const internal::Looks>(internal::Looks::load(options.looks));
      inputs = looks->files();
      wanted.looks = looks;
    }
    const internal::RunFolder pictures(folder, internal::RunFolder::Use::pictures, {}, inputs);
    internal::picture_run(folder, wanted, {}, {});
  });
}

}  // namespace toile
