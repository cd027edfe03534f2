#include "sim/outfit_run.hpp"

#include "core/error.hpp"
#include "garment/sewing.hpp"
#include "sim/forces.hpp"
#include "sim/setup.hpp"

#include <algorithm>
#include <utility>

namespace toile::internal {
namespace {

constexpr double weightless_s = 0.2, ramp_s = 0.3;  // after the weld
static_assert(weightless_s + ramp_s == OutfitRun::settling_s);
constexpr double labels_held_s = 0.5, labels_fade_s = 0.5;  // after the weld
constexpr double frictionless_s = 1;  // after the weld: the garment slips into place before friction holds it
constexpr double sewn_step_max_s = 1.0 / 60;
// While rest is awaited: it takes as many steps, however long they are, so each is solved better; what turns slowly is not to be braked,
// and what a solve leaves undone lets folds drift.
constexpr double awaited_step_max_s = 1.0 / 30, awaited_slow_motion = 0.01, awaited_tolerance = 0.002;
// What moves faster than this is not about to rest, and solved no better than elsewhere.  A dress of five gathered tiers takes half the
// iterations while it falls; at 0.01, 0.05 and 0.2 m/s four garments take 89, 95 and 89 % of what they took until they rest.
constexpr double awaited_slow_m_per_s = 0.05;
constexpr double awaited_share = 0.99;  // of the particles that are slower: as rest is judged

// What is taken goes where its moves lead it.
void lead(TimedPin& timed) {
  if (timed.from)
    timed.pin.path = [moves = timed.moves, from = *timed.from](double t_s) { return moves.place(t_s, from); };
}

StiffnessShare share_of(const Vec3& share) { return {share.x(), share.y(), share.z()}; }

// Share of gravity and of the elastic's pull at time t after the weld.
double ramp(double t_s) { return std::clamp((t_s - weightless_s) / ramp_s, 0.0, 1.0); }

}  // namespace

OutfitRun::OutfitRun(const Scene& scene, Outfit& outfit, BodySurface* body, const StepOptions& step, Settling settling,
                     std::function<bool()> stop)
    : scene_(&scene),
      outfit_(&outfit),
      settling_(std::move(settling)),
      step_(step),
      gravity_m_per_s2_(scene.gravity_m_per_s2),
      wind_m_per_s_(scene.air.wind_m_per_s),
      frame_s_(1 / scene.fps) {
  ModelOptions options;
  options.gravity_m_per_s2 = scene.gravity_m_per_s2;
  options.paper_scaling = scene.paper_scaling;
  options.damping_jacobian = scene.damping_jacobian;
  options.pair_friction = scene.friction_between;
  model_ = build_model(outfit.mesh, outfit.fabrics, options);
  world_.body = body;
  world_.forces = forces_of(*this);
  for (Index i = 0; i < settling_.held_particles; ++i) {
    Pin held;
    held.particle = i;
    worn_pins_.push_back(std::move(held));
  }
  world_.pins = worn_pins_;
  world_.springs = [this](const ClothState& at, double, double, std::vector<LinearSpring>& springs) {
    if (!settling_.labels.empty()) settling_.labels.append(at, label_strength_, springs);
    tangles_->append_springs(springs);
  };
  AdaptiveOptions adaptive;
  adaptive.stop = std::move(stop);
  stepper_.emplace(model_, world_, step_, adaptive);
  choose_steps();
  set_rest_stretch(1);
  if (outfit.thickness_scale.empty()) outfit.thickness_scale.assign(outfit.state.x.size(), 1);
  tangles_.emplace(model_.topology, model_.mesh.triangles);
  tangles_->find(outfit.state.x);
}

bool OutfitRun::settled() const { return !settling_.sewn || (!settling_.waits && time_s() >= settling_s); }

void OutfitRun::set_rest_stretch(double share) {
  if (share == ramped_) return;
  ramped_ = share;
  for (std::size_t p = 0; p < outfit_->rest_stretch.size(); ++p) {
    const Vec2& b = outfit_->rest_stretch[p];
    if (b != Vec2(1, 1)) set_panel_rest_stretch(model_, static_cast<Index>(p), Vec2(1, 1) + share * (b - Vec2(1, 1)));
  }
  set_folds(model_, share);
}

std::vector<Vec2> OutfitRun::panel_rest_stretch() const {
  std::vector<Vec2> b(model_.mesh.panel_names.size(), Vec2(1, 1));
  for (std::size_t t = 0; t < model_.membrane.size(); ++t)
    b[static_cast<std::size_t>(model_.mesh.panel[t])] = Vec2(model_.membrane[t].b_u, model_.membrane[t].b_v);
  return b;
}

// Of what was read: the model is made to agree.
void OutfitRun::take_up(std::span<const Vec2> panel_rest_stretch) {
  for (std::size_t p = 0; p < panel_rest_stretch.size(); ++p)
    set_panel_rest_stretch(model_, static_cast<Index>(p), panel_rest_stretch[p]);
  set_folds(model_, ramped_);
  for (TimedPin& timed : events_.pins) lead(timed);
  const Changed changed = changed_;
  if (changed.friction) set_friction({}, *changed.friction);
  for (std::size_t k = 0; k < changed.collider_friction.size(); ++k)
    if (const auto& own = changed.collider_friction[k]) set_friction(static_cast<Index>(k), *own);
  for (std::size_t p = 0; p < changed.stiffness.size(); ++p)
    if (const auto& own = changed.stiffness[p]) set_stiffness(static_cast<Index>(p), share_of(*own));
  for (std::size_t p = 0; p < changed.pressure_Pa.size(); ++p)
    if (const auto& own = changed.pressure_Pa[p]) set_pressure(static_cast<Index>(p), *own);
}

void OutfitRun::set_friction(std::optional<Index> collider, double friction) {
  stepper_->integrator().set_body_friction(collider, friction);
  if (!collider) {
    changed_.friction = friction;
    return;
  }
  if (changed_.collider_friction.size() <= at(*collider)) changed_.collider_friction.resize(at(*collider) + 1);
  changed_.collider_friction[at(*collider)] = friction;
}

void OutfitRun::set_stiffness(Index panel, const StiffnessShare& share) {
  set_panel_stiffness(model_, panel, share);
  changed_.stiffness.resize(model_.mesh.panel_names.size());
  changed_.stiffness[at(panel)] = Vec3(share.stretch, share.shear, share.bend);
}

void OutfitRun::set_pressure(Index panel, double Pa) {
  const std::size_t panels = model_.mesh.panel_names.size();
  if (panel < 0 || at(panel) >= panels)
    throw InputError("", "panel", "a number below " + std::to_string(panels), std::to_string(panel));
  auto known =
      std::find_if(events_.panels.begin(), events_.panels.end(), [&](const auto& of) { return of.panel == panel; });
  if (known == events_.panels.end()) known = events_.panels.insert(known, OwnOfPanel{panel, {}});
  known->own.pressure_Pa = Pa;
  known->own.pressure_path.clear();
  changed_.pressure_Pa.resize(panels);
  changed_.pressure_Pa[at(panel)] = Pa;
}

void OutfitRun::settle() {
  const double t_s = settling_.waits ? 0 : time_s(), weight = settling_.weightless ? 0 : ramp(time_s());
  const bool first = settling_.held_particles == 0;  // with friction off, what is worn below would slide down
  label_strength_ = std::clamp(1 - (t_s - labels_held_s) / labels_fade_s, 0.0, 1.0);
  model_.gravity_m_per_s2 = weight * gravity_m_per_s2_;
  set_rest_stretch(ramp(t_s));
  if (t_s >= settling_s) worn_pins_.clear();
  const double slippery_s = first ? frictionless_s : settling_s;
  stepper_->integrator().body_constraints().set_friction_share(t_s < slippery_s ? 0 : 1);
}

void OutfitRun::choose_steps() {
  const bool awaited = settling_.to_rest && !motion_;
  const double longest = !scene_->cloth.front().is_sewn() ? 1 / scene_->fps
                         : awaited                        ? awaited_step_max_s
                                                          : sewn_step_max_s;
  stepper_->options().step_max_s = scene_->step_max_s.value_or(longest);
  stepper_->integrator().set_slow_motion(awaited ? awaited_slow_motion : step_.slow_motion);
}

// Of the coming frame.
void OutfitRun::choose_tolerance() {
  const double tolerance = step_.pcg.tolerance;
  const bool awaited = settling_.to_rest && !motion_;
  stepper_->integrator().set_tolerance(awaited && is_slow() ? std::min(tolerance, awaited_tolerance) : tolerance);
}

bool OutfitRun::is_slow() const {
  const Vec3s& v = outfit_->state.v;
  const auto slow = std::count_if(v.begin(), v.end(), [](const Vec3& u) { return u.norm() <= awaited_slow_m_per_s; });
  return static_cast<double>(slow) >= awaited_share * static_cast<double>(v.size());
}

void OutfitRun::start_motion(BodyAt body_at) {
  motion_ = std::move(body_at);
  motion_start_s_ = time_s();
  choose_steps();
  world_.body_at = [this](double t_s, std::span<Vec3> x) {
    motion_.function()(std::max(0.0, t_s - motion_start_s_), x);
  };
}

// The pins of the coming frame.
void OutfitRun::take_and_let_go() {
  world_.pins = worn_pins_;
  for (TimedPin& timed : events_.pins) {
    if (time_s() < timed.from_s || time_s() >= timed.to_s) continue;
    if (!timed.moves.empty() && !timed.from) {
      timed.from = timed.moves.before(time_s(), outfit_->state.x[static_cast<std::size_t>(timed.pin.particle)]);
      lead(timed);
    }
    if (timed.on_body && !timed.pin.on_body)
      timed.pin.on_body = attach(*world_.body, outfit_->state.x[at(timed.pin.particle)]);
    world_.pins.push_back(timed.pin);
  }
}

// What the scene says happens in the coming frame.
void OutfitRun::happen() {
  const double end_s = time_s() + frame_s_;
  take_and_let_go();
  world_.drags.clear();
  for (const TimedDrag& timed : events_.drags)
    if (time_s() >= timed.from_s && time_s() < timed.to_s) world_.drags.push_back(timed.drag);
  for (const auto& [panel, own] : events_.panels) {
    if (own.rest_stretch_path.empty()) continue;
    const Vec2 b = along(own.rest_stretch_path, &RestStretchKey::b, end_s);
    Vec2& now = outfit_->rest_stretch[at(panel)];
    if (b == now) continue;
    now = b;
    set_panel_rest_stretch(model_, panel, b);
  }
}

// Gravity, wind, friction and stiffness of the coming frame.
void OutfitRun::change_in_time(double end_s) {
  if (!scene_->gravity_path.empty()) gravity_m_per_s2_ = along(scene_->gravity_path, &ScenePin::Key::x_m, end_s);
  if (!scene_->wind_path.empty()) wind_m_per_s_ = along(scene_->wind_path, &ScenePin::Key::x_m, end_s);
  const auto friction = [&](const SceneCollider& collider, std::optional<Index> number) {
    if (!collider.friction_path.empty())
      set_friction(number, along(collider.friction_path, &FrictionKey::friction, end_s));
  };
  friction(scene_->body, {});
  const Index first = scene_->body.exists() ? 1 : 0;
  for (std::size_t k = 0; k < scene_->solids.size(); ++k) friction(scene_->solids[k], first + static_cast<Index>(k));
  for (const auto& [panel, own] : events_.panels) {
    if (own.stiffness_path.empty()) continue;
    const StiffnessShare share = share_of(along(own.stiffness_path, &StiffnessKey::share, end_s));
    if (model_.stiffness_share.empty() || model_.stiffness_share[at(panel)] != share) set_stiffness(panel, share);
  }
}

FrameReport OutfitRun::frame(double length_s) {
  if (length_s != frame_s_) {
    frames_from_s_ = time_s();
    frames_ = 0;
    frame_s_ = length_s;
  }
  change_in_time(time_s() + frame_s_);
  if (settling_.sewn)
    settle();
  else
    model_.gravity_m_per_s2 = gravity_m_per_s2_;
  happen();
  std::vector<double>& thickness = outfit_->thickness_scale;
  if (settled()) grow_thickness(thickness);
  const long without_room = stepper_->integrator().flypaper().steps_without_room();
  const bool let_through = std::exchange(without_room_, without_room) != without_room;
  if (let_through) tangles_->look_again();
  if (tangles_->any() || let_through) tangles_->find(outfit_->state.x);
  tangles_->switch_off(thickness);  // also where sewing had left it so
  stepper_->integrator().contact_rows().set_thickness_scale(thickness);
  choose_tolerance();
  const FrameReport report = stepper_->advance(outfit_->state, time_s(), frame_s_);
  if (!report.interrupted && report.ok) ++frames_;
  return report;
}

}  // namespace toile::internal
