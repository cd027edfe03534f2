#include "sim/simulate.hpp"

#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "garment/placement.hpp"
#include "garment/sewing.hpp"
#include "sim/run_writer.hpp"
#include "sim/setup.hpp"
#include "sim/tangles.hpp"
#include "verify/crossings.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <optional>

namespace toile {
namespace {

constexpr double weightless_s = 0.2, ramp_s = 0.3;    // after the weld
constexpr double at_rest_mm_per_s = 2, rest_s = 0.5;  // when a drape may stop
constexpr double sewing_film_fps = 30;
constexpr double labels_held_s = 0.5, labels_fade_s = 0.5;  // after the weld
constexpr double frictionless_s = 1;  // after the weld: the garment slips into place before friction holds it

template <class... Values>
std::string words(const char* format, Values... values) {
  std::array<char, 512> text;
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

// What a reader of the files will see: float32.
Vec3s as_written(std::span<const Vec3> x) {
  Vec3s rounded(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) rounded[i] = x[i].cast<float>().cast<double>();
  return rounded;
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void add(PhaseReport& phase, const FrameReport& frame) {
  ++phase.frames;
  phase.steps += frame.steps;
  phase.steps_rejected += frame.rejected;
  phase.passes += frame.passes;
  phase.cg_iterations += frame.cg_iterations;
  phase.cg_max = std::max(phase.cg_max, frame.cg_max);
  phase.corrected += frame.corrected;
  phase.truncated += frame.truncated;
  if (frame.steps == 0) return;
  phase.step_min_s = phase.step_min_s == 0 ? frame.step_min_s : std::min(phase.step_min_s, frame.step_min_s);
  phase.step_max_s = std::max(phase.step_max_s, frame.step_max_s);
}

void set_seconds(PhaseReport& phase, const PhaseSeconds& seconds) {
  phase.eval = seconds.eval;
  phase.cg = seconds.cg;
  phase.cloth_cloth = seconds.cloth_cloth;
  phase.cloth_solid = seconds.cloth_solid;
}

// Where a seam is open and why.
std::string explain(const Sewing& sewing, const GarmentMesh& garment, double weld_gap_m) {
  constexpr std::size_t most = 5;
  constexpr double too_small = 0.05;
  if (sewing.weld_obstacle()) {  // the gaps are small, and not what is in the way
    const Vec3& p = *sewing.weld_obstacle();
    return words(
        "every seam is closed to %.1f mm, but the weld would push cloth through cloth near (%.2f, %.2f, %.2f) m",
        1e3 * sewing.widest_gap_m(), p.x(), p.y(), p.z());
  }
  std::string text;
  std::size_t open = 0;
  for (const SeamGap& gap : sewing.gaps()) {
    if (gap.gap_m < weld_gap_m) continue;
    if (++open > most) continue;
    const std::string why = gap.stretch > too_small
                                ? words("too small: the cloth beside it is stretched by %.0f %%", 100 * gap.stretch)
                                : std::string("the body is in the way");
    text += (open == 1 ? "" : "; ") + ("seam " + garment.seams[static_cast<std::size_t>(gap.seam)].name) +
            words(" is open by %.1f mm near (%.2f, %.2f, %.2f) m, ", 1e3 * gap.gap_m, gap.where.x(), gap.where.y(),
                  gap.where.z()) +
            why;
  }
  if (open > most) text += "; and " + std::to_string(open - most) + " more seams";
  return text;
}

class Run {
 public:
  Run(const Scene& scene, const RunOptions& options) : scene_(scene), options_(options) {}

  Report operator()() {
    Hash inputs;
    add_to_hash(scene_, inputs);
    const SceneCloth& cloth = scene_.cloth.front();
    say("meshing", 0);
    const bool sewn = !cloth.grid;
    if (sewn) {
      garment_ = load_garment(cloth, options_.read, inputs);
      start_ = {garment_.x, {}};
      mesh_ = garment_.mesh;
      name_ = garment_.name;
    } else {
      PlacedGrid grid = make_grid(cloth);
      start_ = {std::move(grid.x), {}};
      mesh_ = std::move(grid.mesh);
      name_ = cloth.name;
    }
    fabrics_ = fabrics_of(scene_, mesh_);
    b_of_panel_ = rest_stretch_of(cloth, mesh_);
    pins_ = pins_of(cloth, start_.x);
    SolidMesh solid = load_body(scene_.body, inputs);
    body_x_ = solid.positions;
    body_triangles_ = solid.triangles;
    if (!body_triangles_.empty()) body_.emplace(std::move(solid.positions), std::move(solid.triangles));
    step_ = step_options(scene_, fabrics_.front());
    start_.v.assign(start_.x.size(), Vec3::Zero());

    report_.name = scene_.name;
    report_.command = options_.command;
    report_.input_hash = inputs.hex();
    report_.threads = available_threads();
    report_.fps = scene_.fps;
    report_.body_vertices = static_cast<int>(body_x_.size());
    report_.body_triangles = static_cast<int>(body_triangles_.size());
    report_.vertices = mesh_.particle_count;
    report_.triangles = mesh_.triangle_count();
    report_.panels = static_cast<int>(mesh_.panel_names.size());
    report_.seams = static_cast<int>(garment_.seams.size());

    writer_.emplace(options_.directory);
    bool whole = true;
    if (sewn) whole = sew();
    if (!sewn) check_start();
    if (whole) drape(sewn);
    return finish();
  }

 private:
  void say(std::string_view phase, double share, double seconds_left = -1) const {
    if (options_.progress) options_.progress({phase, share, seconds_left});
  }
  bool stopped() const { return options_.stop && options_.stop(); }
  BodySurface* body() { return body_ ? &*body_ : nullptr; }

  void end(std::string_view how, std::string detail) {
    report_.ended = how;
    failure_.push_back({std::string(how), std::move(detail)});
  }

  void bad_start(const std::string& what) {
    if (scene_.strict_start) throw Error(ExitCode::bad_start, printable(name_) + ": bad start: " + what);
    report_.warnings.push_back("bad start: " + what);
  }

  void check_start() {
    const auto self = find_cloth_crossings(mesh_.triangles, start_.x);
    if (!self.empty()) bad_start(std::to_string(count_edges(self)) + " edges of the cloth pass through it");
    if (!body_) return;
    const auto through = find_body_crossings(mesh_.triangles, start_.x, body_triangles_, body_x_);
    if (!through.empty()) bad_start(std::to_string(count_edges(through)) + " edges pass between cloth and body");
  }

  void place() {
    if (!body_) return;
    say("placing", 0);
    const Placement placement = place_garment(garment_, *body_);
    report_.shift_m = placement.shift_m;
    if (placement.panel_crossings > 0)
      bad_start(std::to_string(placement.panel_crossings) + " edges of the placed panels pass through the body");
    for (const Index seam : placement.blocked_seams)
      report_.warnings.push_back("the straight way between the two sides of seam " +
                                 garment_.seams[static_cast<std::size_t>(seam)].name + " leads through the body");
    start_.x = garment_.x;
  }

  // Panels that are drawn through each other.  Left alone for the whole sewing: the drape looks again.
  void leave_tangles(Sewing& sewing) {
    Tangles tangles;
    tangles.find(garment_.mesh.triangles, garment_.x);
    if (!tangles.any()) return;
    bad_start("placed panels pass through each other");
    std::vector<double> scale = sewing.thickness_scale();
    tangles.switch_off(garment_.x, scale);
    sewing.set_thickness_scale(std::move(scale));
  }

  // False when the garment could not be closed.  Leaves the welded garment in mesh_ and start_.
  bool sew() {
    place();
    SewingOptions sewing_options;
    sewing_options.step_max_s = scene_.step_max_s.value_or(1 / sewing_options.fps);
    sewing_options.paper_scaling = scene_.paper_scaling;
    sewing_options.damping_jacobian = scene_.damping_jacobian;
    sewing_options.label_heights =
        label_heights_of(scene_.cloth.front(), garment_, body_x_, body_triangles_, report_.warnings);
    sewing_options.stop = options_.stop;
    Sewing sewing(garment_, fabrics_, body(), step_, sewing_options);
    leave_tangles(sewing);
    writer_->begin_sewing(garment_.mesh, name_, garment_.x);
    const int every = std::max(1, static_cast<int>(std::lround(sewing_options.fps / sewing_film_fps)));
    Stopwatch watch;
    PhaseReport& phase = report_.sewing;
    FrameReport frame;
    while (sewing.status() == SewingStatus::sewing && !stopped()) {
      {
        const Timed timed(phase.seconds);
        frame = sewing.frame();
      }
      if (frame.interrupted) break;
      add(phase, frame);
      if (phase.frames % every == 0 || sewing.status() != SewingStatus::sewing) writer_->sewing_frame(sewing.state().x);
      const double share = sewing.closed_share();
      say("sewing", share, share > 0.05 ? watch.seconds() * (1 - share) / share : -1);
    }
    phase.simulated_s = sewing.time_s();
    set_seconds(phase, sewing.seconds());
    switch (sewing.status()) {
      case SewingStatus::closed:
        break;
      case SewingStatus::sewing:
        end(reason::interrupted, "while sewing, after " + std::to_string(phase.frames) + " frames");
        break;
      case SewingStatus::blocked:
        end(reason::seam_blocked, explain(sewing, garment_, sewing_options.weld_gap_m));
        break;
      case SewingStatus::failed:
        end(reason::step_collapsed, "while sewing: " + frame.diagnosis);
        break;
    }
    if (sewing.status() != SewingStatus::closed) {
      final_ = sewing.state();
      return false;
    }
    const WeldedMesh welded = weld(garment_);
    start_ = weld_state(garment_, welded, sewing.model(), sewing.state());
    thickness_scale_ = weld_thickness(welded, sewing.thickness_scale());
    labels_ = LabelSprings(garment_, sewing_options.label_heights).welded(welded.particle_of);
    mesh_ = welded.mesh;
    report_.vertices = mesh_.particle_count;
    return true;
  }

  // Share of gravity and of the elastic's pull at time t after the weld.
  static double ramp(double t_s) { return std::clamp((t_s - weightless_s) / ramp_s, 0.0, 1.0); }

  void set_rest_stretch(ClothModel& model, double share) const {
    for (std::size_t t = 0; t < model.membrane.size(); ++t) {
      const Vec2& b = b_of_panel_[static_cast<std::size_t>(mesh_.panel[t])];
      model.membrane[t].b_u = 1 + share * (b.x() - 1);
      model.membrane[t].b_v = 1 + share * (b.y() - 1);
    }
  }

  void begin_audit() {
    RunDescription run;
    run.mesh = drawn_mesh(mesh_);
    const bool elastic =
        std::any_of(b_of_panel_.begin(), b_of_panel_.end(), [](const Vec2& b) { return b != Vec2(1, 1); });
    if (elastic) {
      for (const Index panel : mesh_.panel) {
        const Vec2& b = b_of_panel_[static_cast<std::size_t>(panel)];
        run.b.emplace_back(b.y(), b.x());  // the first axis of vt is the weft: run_writer.hpp
      }
      for (std::size_t p = 0; p < b_of_panel_.size(); ++p)
        if (b_of_panel_[p] != Vec2(1, 1))
          report_.rest_stretch.push_back({mesh_.panel_names[p], {b_of_panel_[p].y(), b_of_panel_[p].x()}});
    }
    run.body_triangles = body_triangles_;
    run.body_particle_count = static_cast<Index>(body_x_.size());
    run.fps = scene_.fps;
    audit_.emplace(std::move(run));
    written_body_ = as_written(body_x_);
  }

  void drape(bool sewn) {
    ModelOptions model_options;
    model_options.gravity_m_per_s2 = scene_.gravity_m_per_s2;
    model_options.paper_scaling = scene_.paper_scaling;
    model_options.damping_jacobian = scene_.damping_jacobian;
    ClothModel model = build_model(mesh_, fabrics_, model_options);
    StepWorld world;
    world.body = body();
    world.pins = pins_;
    AdaptiveOptions adaptive;
    const double frame_s = 1 / scene_.fps;
    adaptive.stop = options_.stop;
    adaptive.step_max_s = scene_.step_max_s.value_or(sewn ? 1.0 / 60 : frame_s);
    double label_strength = 0;
    if (!labels_.empty()) {
      world.springs = [&](const ClothState& at, double, double, std::vector<LinearSpring>& springs) {
        labels_.append(at, label_strength, springs);
      };
    }
    AdaptiveStep stepper(model, world, step_, adaptive);
    set_rest_stretch(model, 1);

    begin_audit();
    ClothState state = start_;
    Tangles tangles;
    tangles.find(mesh_.triangles, state.x);
    if (thickness_scale_.empty()) thickness_scale_.assign(state.x.size(), 1);
    Vec3s written = as_written(state.x);
    writer_->begin_cloth(mesh_, name_, state.x, body_triangles_, body_x_);
    audit_->add(written, written_body_);

    const int frames = std::max(1, static_cast<int>(std::lround(scene_.seconds * scene_.fps)));
    std::deque<double> speeds;  // of the last second
    Stopwatch watch;
    PhaseReport& phase = report_.drape;
    report_.ended = "time";
    for (int k = 1; k < frames; ++k) {
      const double t_s = (k - 1) * frame_s;
      if (sewn) {
        label_strength = std::clamp(1 - (t_s - labels_held_s) / labels_fade_s, 0.0, 1.0);
        model.gravity_m_per_s2 = ramp(t_s) * scene_.gravity_m_per_s2;
        set_rest_stretch(model, ramp(t_s));
        stepper.integrator().body_constraints().set_friction(t_s < frictionless_s ? 0 : step_.body.friction);
      }
      if (!sewn || t_s >= weightless_s + ramp_s) grow_thickness(thickness_scale_);
      if (tangles.any()) tangles.find(mesh_.triangles, state.x);
      tangles.switch_off(state.x, thickness_scale_);  // also where sewing had left it so
      stepper.integrator().contact_rows().set_thickness_scale(thickness_scale_);
      FrameReport frame;
      {
        const Timed timed(phase.seconds);
        frame = stepper.advance(state, t_s, frame_s);
      }
      if (frame.interrupted) {
        end(reason::interrupted, "while draping, after frame " + std::to_string(k - 1));
        break;
      }
      add(phase, frame);
      if (!frame.ok) {
        end(reason::step_collapsed, "in frame " + std::to_string(k) + ": " + frame.diagnosis);
        break;
      }
      Vec3s before = std::move(written);
      written = as_written(state.x);
      writer_->cloth_frame(state.x, body_x_);
      audit_->add(written, written_body_);
      speeds.push_back(speed_p99_mm_per_s(before, written, scene_.fps));
      if (static_cast<double>(speeds.size()) > std::max(1.0, std::round(scene_.fps))) speeds.pop_front();
      say("draping", static_cast<double>(k) / frames, watch.seconds() * (frames - 1 - k) / k);
      if (scene_.until_still && (!sewn || t_s > weightless_s + ramp_s + rest_s) && at_rest(speeds)) {
        report_.ended = "still";
        break;
      }
    }
    phase.simulated_s = phase.frames * frame_s;
    set_seconds(phase, stepper.integrator().seconds());
    final_ = std::move(state);
  }

  bool at_rest(const std::deque<double>& speeds) const {
    const auto recent = static_cast<std::size_t>(std::max(1.0, std::ceil(rest_s * scene_.fps)));
    if (speeds.size() < recent) return false;
    const double limit = Limits{}.still_mm_per_s;
    return std::all_of(speeds.begin(), speeds.end(), [&](double v) { return v <= limit; }) &&
           std::all_of(speeds.end() - static_cast<std::ptrdiff_t>(recent), speeds.end(),
                       [](double v) { return v <= at_rest_mm_per_s; });
  }

  Report finish() {
    Hash state;
    state.add(std::span<const Vec3>(final_.x));
    state.add(std::span<const Vec3>(final_.v));
    report_.state_hash = state.hex();
    report_.frames = writer_->cloth_frames();
    Limits limits;
    limits.must_be_still = scene_.until_still;
    report_.verdict.limits = limits;
    if (audit_) {
      report_.audit = audit_->report();
      report_.audit.must_be_still = limits.must_be_still;
      report_.verdict = judge(report_.audit, limits);
    }
    auto& reasons = report_.verdict.reasons;
    reasons.insert(reasons.begin(), failure_.begin(), failure_.end());
    report_.verdict.pass = reasons.empty();
    report_.seconds_total = total_.seconds();
    report_.peak_memory_mb = peak_memory_mb();
    writer_->finish(to_json(report_));
    return report_;
  }

  const Scene& scene_;
  const RunOptions& options_;
  Stopwatch total_;
  Report report_;
  std::vector<Reason> failure_;
  GarmentMesh garment_;
  ClothMesh mesh_;
  std::string name_;
  std::vector<double> thickness_scale_;  // [welded particle]
  LabelSprings labels_;                  // on the welded cloth
  ClothState start_, final_;
  std::vector<Fabric> fabrics_;
  std::vector<Vec2> b_of_panel_;
  std::vector<Pin> pins_;
  Vec3s body_x_, written_body_;
  std::vector<Triangle> body_triangles_;
  std::optional<BodySurface> body_;
  StepOptions step_;
  std::optional<RunWriter> writer_;
  std::optional<RunAudit> audit_;
};

}  // namespace

Report simulate(const Scene& scene, const RunOptions& options) { return Run(scene, options)(); }

ExitCode exit_code(const Report& report) {
  if (report.ended == reason::interrupted) return ExitCode::interrupted;
  return report.verdict.pass ? ExitCode::ok : ExitCode::simulation_failed;
}

}  // namespace toile
