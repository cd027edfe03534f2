#include "toile/simulation.hpp"

#include "api/implementation.hpp"
#include "core/hash.hpp"
#include "io/file.hpp"
#include "sim/budget.hpp"
#include "sim/recorder.hpp"
#include "sim/rest_watch.hpp"
#include "verify/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace toile {
namespace {

[[noreturn]] void misuse(const std::string& message) { throw internal::Error(internal::ErrorKind::usage, message); }

internal::Scene scene_of(std::span<const Cloth> cloths, const Body& body, std::span<const Body> solids,
                         const SimulationOptions& options) {
  if (cloths.empty()) throw internal::InputError("", "cloths", "at least one", "none");
  internal::Scene scene;
  scene.name = "simulation";
  for (const Cloth& cloth : cloths) {
    internal::SceneCloth one = cloth.parts().cloth;
    if (!scene.cloth.empty() && one.is_sewn() != scene.cloth.front().is_sewn())
      throw internal::InputError("", "cloths", "only patterns, or no pattern", "both kinds");
    const std::string name = one.name;
    const auto taken = [&](const internal::SceneCloth& other) { return other.name == one.name; };
    for (int k = 2; std::any_of(scene.cloth.begin(), scene.cloth.end(), taken); ++k)
      one.name = name + '-' + std::to_string(k);
    scene.cloth.push_back(std::move(one));
  }
  scene.body = body.parts().body;
  scene.body.worn = true;
  if (is_placed(scene.body))
    throw internal::InputError("", "body", "a body that stands where it was made, as it is worn", "one that is placed");
  for (const Body& solid : solids) {
    if (!solid.parts().body.exists()) throw internal::InputError("", "solids", "surfaces", "Body::none()");
    scene.solids.push_back(solid.parts().body);
  }
  scene.gravity_m_per_s2 = engine_vector(options.gravity_m_per_s2);
  scene.air.wind_m_per_s = engine_vector(options.wind_m_per_s);
  scene.air.density_kg_per_m3 = options.air_density_kg_per_m3;
  scene.until_still = true;
  require_finite("gravity_m_per_s2", options.gravity_m_per_s2);
  require_finite("wind_m_per_s", options.wind_m_per_s);
  require_at_least_zero("air_density_kg_per_m3", options.air_density_kg_per_m3);
  return scene;
}

}  // namespace

Simulation::Implementation::Recipe::Recipe(internal::SceneFile made_of, SimulationOptions made_options)
    : options(std::move(made_options)), scene(std::move(made_of.scene)), places(std::move(made_of.places)) {
  places.complete_errors_of([&] { internal::require_budget(scene, internal::read_text_file, {}); });
  in_threads([&] { loaded = internal::load_scene(scene, internal::read_text_file); });
  input_hash = internal::input_hash(scene, loaded);
}

void Simulation::Implementation::make_engine() {
  const SimulationOptions& options = recipe->options;
  internal::SimulationOptions engine_options;
  if (options.progress)
    engine_options.progress = [tell_caller = options.progress](const internal::Progress& p) {
      tell_caller({p.phase, p.share, p.seconds_left});
    };
  if (options.cancelled) engine_options.stop = [this] { return !making && recipe->options.cancelled(); };
  begun = false;
  interaction = {};
  recipe->in_threads([&] {
    engine = std::make_unique<internal::Simulation>(recipe->scene, recipe->loaded, std::move(engine_options), *this);
  });
  body_x.assign(engine->body_x().begin(), engine->body_x().end());
}

void Simulation::Implementation::make() {
  make_engine();
  flat = internal::outfit_of_shapes(recipe->loaded.cloth);
  if (recipe->scene.cloth.front().is_sewn() && !recipe->loaded.start) return;
  making = true;  // a half-made simulation is useless
  recipe->in_threads([&] { engine->put_on(); });
  making = false;
  begin();
}

void Simulation::Implementation::take_up(std::string_view bytes) {
  internal::StateReader archive(bytes, "state");
  Interaction then;
  archive(then);
  make_engine();
  engine->take_up(archive);
  interaction = std::move(then);
  begin();
}

void Simulation::Implementation::begin() {
  engine->begin([this](internal::OutfitRun& run) {
    begins(run);
    tell(run);
    if (interaction.moves) lead_body(run);
  });
  update_body();
}

void Simulation::Implementation::begins(const internal::OutfitRun& run) {
  scene_pins = run.events().pins.size();
  scene_drags = run.events().drags.size();
  begun = true;
  flat = {};
}

internal::OutfitRun& Simulation::Implementation::live(std::string_view what) {
  if (!begun) misuse(std::string(what) + ": nothing is on yet, and what is to be sewn is by dress()");
  return engine->live();
}

DressReport Simulation::Implementation::report() {
  const internal::Report& from = engine->report();
  DressReport to;
  to.ended = from.ended;
  if (to.ended == "time" && engine->rests()) to.ended = "still";
  for (const internal::Reason& reason : engine->failure()) to.reasons.push_back({reason.code, reason.detail});
  to.warnings = from.warnings;
  to.simulated_s = begun ? engine->live().time_s() : 0;
  if (begun) judge(to);
  return to;
}

// Judges this state as if read from files.
void Simulation::Implementation::judge(DressReport& to) {
  internal::RunAudit audit(internal::describe(mesh(), engine->outfit().rest_stretch, recipe->scene.fps,
                                              engine->body_triangles(), body_x.size()));
  audit.add(internal::as_written(state().x), internal::as_written(body_x));
  internal::VerifyReport measured = audit.report();
  const internal::Verdict verdict = internal::judge(measured);
  for (const internal::Reason& reason : verdict.reasons) to.reasons.push_back({reason.code, reason.detail});
  for (const internal::Reason& reservation : verdict.qualifications)
    to.warnings.push_back(reservation.code + ": " + reservation.detail);
  const bool other_end = to.ended != "time" && to.ended != "still";
  if (engine->scene().until_still && !other_end && !engine->rests())
    to.reasons.push_back({std::string(internal::reason::static_equilibrium), "it is not at rest yet"});
}

namespace {

std::unique_ptr<Simulation::Implementation> make_simulation(internal::SceneFile of, const SimulationOptions& options) {
  using Implementation = Simulation::Implementation;
  auto made = std::make_unique<Implementation>(std::make_shared<const Implementation::Recipe>(std::move(of), options));
  made->make();
  return made;
}

}  // namespace

Simulation::Simulation(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Simulation::Simulation(const Cloth& cloth, const Body& body, const SimulationOptions& options)
    : Simulation(std::span(&cloth, 1), body, options) {}

Simulation::Simulation(std::span<const Cloth> cloths, const Body& body, const SimulationOptions& options)
    : Simulation(cloths, body, {}, options) {}

Simulation::Simulation(std::span<const Cloth> cloths, const Body& body, std::span<const Body> solids,
                       const SimulationOptions& options)
    : implementation_(translated([&] {
        return make_simulation({scene_of(cloths, body, solids, options), {}}, options);
      })) {}

Simulation Simulation::from_scene(const std::string& path, const SimulationOptions& options) {
  return translated(
      [&] { return Simulation(make_simulation(internal::read_scene(internal::read_text_file(path), path), options)); });
}

DressReport Simulation::dress(double longest_s, double time_limit_s) {
  return translated([&] {
    Implementation& own = *implementation_;
    require_above_zero("longest_s", longest_s);
    require_at_least_zero("time_limit_s", time_limit_s);
    const bool sewn = own.recipe->scene.cloth.front().is_sewn();
    if (own.begun && (sewn || own.engine->live().time_s() > 0))
      misuse("dress: it is on already, and time has gone on; reset() takes it off");
    own.engine->limit_dressing(longest_s, time_limit_s);
    own.unless_it_throws([&] {
      bool good = true;
      if (!own.begun) {
        good = own.engine->put_on();
        if (good) own.begin();
      }
      if (good && !own.engine->stopped_short()) own.engine->drape();
      own.engine->judge_worn();
    });
    own.update_body();
    const DressReport report = own.report();
    if (report.ended == internal::reason::interrupted) own.make();
    return report;
  });
}

DressReport Simulation::run() {
  return translated([&] {
    Implementation& own = *implementation_;
    if (own.begun && own.engine->live().time_s() > 0) misuse("run: time has gone on already; reset() takes it back");
    own.make_engine();
    own.flat = internal::outfit_of_shapes(own.recipe->loaded.cloth);
    own.unless_it_throws([&] { own.engine->run(); });
    if (own.engine->has_begun()) {
      own.begins(own.engine->live());
      own.interaction.moves = own.engine->report().motion_first_frame >= 0;
      own.interaction.moves_from_s = own.interaction.moves ? own.engine->motion_from_s() : 0;
    }
    own.update_body();
    return own.report();
  });
}

StepReport Simulation::advance(double h_s) {
  return translated([&] {
    Implementation& own = *implementation_;
    internal::OutfitRun& run = own.live("advance");
    if (!std::isfinite(h_s) || !(h_s > 0) || h_s > 10)
      throw internal::InputError("", "h_s", "above 0 and at most 10 s", std::to_string(h_s));
    own.interaction.from_s = run.time_s();
    own.interaction.length_s = h_s;
    own.start_motion(run);
    own.engine->go_on();
    internal::FrameReport frame;
    own.recipe->in_threads([&] { frame = run.frame(h_s); });
    StepReport report;
    report.reached = frame.ok && !frame.interrupted;
    report.cancelled = frame.interrupted;
    report.steps = frame.steps;
    report.rejected = frame.rejected;
    report.step_min_s = frame.step_min_s;
    report.step_max_s = frame.step_max_s;
    report.cg_iterations = frame.cg_iterations;
    report.diagnosis = frame.diagnosis;
    internal::add_frame(own.engine->report().drape, frame);
    if (report.reached) own.arrived();
    own.update_body();
    return report;
  });
}

double Simulation::time_s() const { return implementation_->begun ? implementation_->engine->live().time_s() : 0; }

void Simulation::reset() {
  translated([&] { implementation_->make(); });
}

const std::vector<std::string>& Simulation::warnings() const { return implementation_->engine->report().warnings; }

std::span<const Point> Simulation::positions_m() const { return view(implementation_->state().x); }
std::span<const Point> Simulation::velocities_m_per_s() const { return view(implementation_->state().v); }
std::span<const Face> Simulation::faces() const { return implementation_->mesh().triangles; }
std::span<const CornerUvs> Simulation::uv_m() const { return view(implementation_->mesh().uv); }
std::span<const std::int32_t> Simulation::panel() const { return implementation_->mesh().panel; }
const std::vector<std::string>& Simulation::panel_names() const { return implementation_->mesh().panel_names; }
std::span<const Point> Simulation::body_positions_m() const { return view(implementation_->body_x); }
int Simulation::collider_count() const { return static_cast<int>(implementation_->engine->colliders().size()); }
std::span<const Point> Simulation::collider_positions_m(int collider) const {
  return translated([&] {
    const internal::JoinedColliders::Part& part = implementation_->collider(collider);
    return body_positions_m().subspan(part.first_vertex, part.vertices);
  });
}
std::span<const Face> Simulation::body_faces() const { return implementation_->engine->body_triangles(); }

std::string Simulation::state_hash() const {
  internal::Hash hash;
  hash.add(std::span<const internal::Vec3>(implementation_->state().x));
  hash.add(std::span<const internal::Vec3>(implementation_->state().v));
  return hash.hex();
}

Crossings Simulation::crossings() const {
  return translated([&] {
    const Implementation& own = *implementation_;
    const internal::Vec3s x = internal::as_written(own.state().x), body = internal::as_written(own.body_x);
    Crossings found;
    if (!body.empty())
      found.cloth_body_edges = internal::count_edges(
          internal::find_body_crossings(own.mesh().triangles, x, own.engine->body_triangles(), body));
    found.cloth_cloth_edges = internal::count_edges(internal::find_cloth_crossings(own.mesh().triangles, x));
    return found;
  });
}

std::string DressReport::explain() const {
  std::string text = ended;
  for (const Reason& reason : reasons) text += '\n' + reason.code + ": " + reason.detail;
  for (const std::string& warning : warnings) text += "\nwarning: " + warning;
  return text;
}

std::string StepReport::explain() const {
  if (cancelled) return "cancelled";
  if (!reached) return diagnosis;
  return std::to_string(steps) + " steps, " + std::to_string(rejected) + " rejected";
}

}  // namespace toile
