#include "dress/outfit_run.hpp"

#include "core/error.hpp"
#include "dress/forces.hpp"
#include "dress/sewing.hpp"

#include <algorithm>
#include <utility>

namespace toile::internal {
namespace {

// Faster cloth is not about to rest, and is solved no better than elsewhere.  A dress of five gathered tiers takes half the
// iterations while it falls; at 0.01, 0.05 and 0.2 m/s four garments take 89, 95 and 89 % of the iterations until rest.
constexpr double slow_m_per_s = 0.05;
constexpr double slow_share = 0.99;  // of the particles that are slower: as rest is judged

// Moves a grabbed particle along its path.
void lead(TimedPin& timed) {
  if (timed.from)
    timed.pin.path = [moves = timed.moves, from = *timed.from](double t_s) { return moves.place(t_s, from); };
}

StiffnessShare share_of(const Vec3& share) { return {share.x(), share.y(), share.z()}; }

}  // namespace

OutfitRun::OutfitRun(const OutfitRunOptions& options, Outfit& outfit, BodySurface* body, NewGarment garment)
    : options_(options),
      outfit_(&outfit),
      garment_(std::move(garment)),
      model_(build_model(outfit.mesh, outfit.fabrics, options.model)),
      gravity_m_per_s2_(options.model.gravity_m_per_s2),
      wind_m_per_s_(options.air.wind_m_per_s),
      frame_s_(1 / options.fps) {
  world_.body = body;
  world_.forces = forces_of(*this);
  for (Index i = 0; i < garment_.worn_before; ++i) {
    Pin held;
    held.particle = i;
    worn_pins_.push_back(std::move(held));
  }
  world_.pins = worn_pins_;
  world_.springs = [this](const ClothState& at, double, double, std::vector<LinearSpring>& springs) {
    if (!garment_.labels.empty()) garment_.labels.append(at, label_strength_, springs);
    tangles_->append_springs(springs);
  };
  AdaptiveOptions adaptive;
  adaptive.stop = options.stop;
  stepper_.emplace(model_, world_, options.step, adaptive);
  phase_ = as_drawn(steps_of(frame_s_), steps_of(frame_s_));
  choose_steps();
  set_rest_stretch(1);
  if (outfit.thickness_scale.empty()) outfit.thickness_scale.assign(outfit.state.x.size(), 1);
  tangles_.emplace(model_.topology, model_.mesh.triangles);
  tangles_->find(outfit.state.x);
}

void OutfitRun::begin(const Phase& phase) {
  phase_ = phase;
  frames_ = 0;
  frames_from_s_ = motion_start_s_ = 0;
  motion_ = {};
  world_.body_at = {};
  stepper_->integrator().restart_clock();
  seconds_before_ = stepper_->integrator().seconds();
  choose_steps();
}

void OutfitRun::set_rest_stretch(double share) {
  if (share == ramped_) return;
  ramped_ = share;
  for (std::size_t p = 0; p < outfit_->rest_stretch.size(); ++p) {
    const Vec2& b = outfit_->rest_stretch[p];
    if (b != Vec2(1, 1)) set_panel_rest_stretch(model_, static_cast<Index>(p), Vec2(1, 1) + share * (b - Vec2(1, 1)));
  }
  set_folds(model_, share);
  set_finishes(model_, share);
  set_stiffening(model_, share);
}

std::vector<Vec2> OutfitRun::panel_rest_stretch() const {
  std::vector<Vec2> b(model_.mesh.panel_names.size(), Vec2(1, 1));
  for (std::size_t t = 0; t < model_.membrane.size(); ++t)
    b[static_cast<std::size_t>(model_.mesh.panel[t])] = Vec2(model_.membrane[t].b_u, model_.membrane[t].b_v);
  return b;
}

// After reading a state: the model is made to agree.
void OutfitRun::take_up(std::span<const Vec2> panel_rest_stretch) {
  for (std::size_t p = 0; p < panel_rest_stretch.size(); ++p)
    set_panel_rest_stretch(model_, static_cast<Index>(p), panel_rest_stretch[p]);
  set_folds(model_, ramped_);
  set_finishes(model_, ramped_);
  set_stiffening(model_, ramped_);
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
  if (known == events_.panels.end()) known = events_.panels.insert(known, TimedPanel{panel, {}});
  known->own.pressure_Pa = Pa;
  known->own.pressure_path.clear();
  changed_.pressure_Pa.resize(panels);
  changed_.pressure_Pa[at(panel)] = Pa;
}

// Applies the phase's shares of gravity, elastic, friction and labels.
void OutfitRun::share_out() {
  const double t_s = time_s();
  label_strength_ = phase_.labels.at(t_s);
  model_.gravity_m_per_s2 = phase_.gravity.at(t_s) * gravity_m_per_s2_;
  set_rest_stretch(phase_.elastic.at(t_s));
  stepper_->integrator().body_constraints().set_friction_share(phase_.friction.at(t_s));
}

void OutfitRun::choose_steps() {
  stepper_->options().step_max_s = options_.step_max_s.value_or(phase_.pace.step_max_s);
  stepper_->options().stretch_floor = phase_.pace.stretch_floor;
  stepper_->integrator().set_slow_motion(phase_.pace.slow_motion.value_or(options_.step.slow_motion));
}

// For the coming frame.
void OutfitRun::choose_tolerance() {
  const double tolerance = options_.step.pcg.tolerance, slow = std::min(tolerance, phase_.pace.slow_tolerance);
  stepper_->integrator().set_tolerance(slow < tolerance && is_slow() ? slow : tolerance);
}

bool OutfitRun::is_slow() const {
  const Vec3s& v = outfit_->state.v;
  const auto slow = std::count_if(v.begin(), v.end(), [](const Vec3& u) { return u.norm() <= slow_m_per_s; });
  return static_cast<double>(slow) >= slow_share * static_cast<double>(v.size());
}

void OutfitRun::start_motion(BodyAt body_at) {
  motion_ = std::move(body_at);
  motion_start_s_ = time_s();
  phase_.pace = phase_.moving;
  choose_steps();
  world_.body_at = [this](double t_s, std::span<Vec3> x) {
    motion_.function()(std::max(0.0, t_s - motion_start_s_), x);
  };
}

// The pins of the coming frame.
void OutfitRun::take_and_let_go() {
  world_.pins.clear();
  if (time_s() < phase_.held_until_s) world_.pins = worn_pins_;
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

// The scene's events in the coming frame.
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
  if (!events_.gravity.empty()) gravity_m_per_s2_ = along(events_.gravity, &VectorKey::x, end_s);
  if (!events_.wind.empty()) wind_m_per_s_ = along(events_.wind, &VectorKey::x, end_s);
  for (const TimedFriction& timed : events_.friction)
    set_friction(timed.collider, along(timed.keys, &FrictionKey::friction, end_s));
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
  share_out();
  happen();
  std::vector<double>& thickness = outfit_->thickness_scale;
  if (settled()) grow_thickness(thickness);
  const long without_room = stepper_->integrator().flypaper().steps_without_room();
  const bool let_through = std::exchange(without_room_, without_room) != without_room;
  if (let_through) tangles_->look_again();
  if (tangles_->any() || let_through) tangles_->find(outfit_->state.x);
  tangles_->switch_off(thickness);  // also where sewing left it off
  stepper_->integrator().contact_rows().set_thickness_scale(thickness);
  choose_tolerance();
  const FrameReport report = stepper_->advance(outfit_->state, time_s(), frame_s_);
  if (!report.interrupted && report.ok) ++frames_;
  return report;
}

}  // namespace toile::internal
