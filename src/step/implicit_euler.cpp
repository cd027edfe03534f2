#include "step/implicit_euler.hpp"

#include "core/stopwatch.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double loose_passes = 3;  // times the residual at which the last pass stops
// Passes before the end of a step is judged: the first guess of the contacts is poor.
constexpr int contact_passes = 2;
constexpr double most_made = 0.1;           // energy beyond the linearisation in threads, of the kinetic energy
constexpr double shortest_part = 1.0 / 16;  // of the update by a solve about an end

}  // namespace

ImplicitEuler::ImplicitEuler(const ClothModel& model, const StepWorld& world, const StepOptions& options)
    : model_(&model),
      world_(&world),
      options_(options),
      elements_(model),
      stretch_(model, elements_),
      solver_(elements_.pattern(), model.mesh),
      constraints_(model.particle_count()),
      body_(model, world.body, options.body),
      flypaper_(world.body, model.mass_kg.size(), options.body),
      penetration_recovery_(model, world.body),
      rows_(model, world.body, world.merged_particle, options.body, options.rows) {
  const auto n = static_cast<std::size_t>(model.particle_count());
  for (Vec3s* vector :
       {&force_, &b_, &y_, &y_known_, &y_linearised_, &linearised_, &displacement_, &force_linearised_, &x_linearised_,
        &moved_, &reference_, &dv_, &dv_last_, &dv_linearised_, &way_, &e_, &landing_, &landing_v_})
    vector->assign(n, Vec3::Zero());
}

// The body's start and end for a step of h_s from t_s.  One of the two is often known from the attempt before.
void ImplicitEuler::move_body(double t_s, double h_s) {
  if (world_->body == nullptr || !world_->body_at) return;
  const Timed timed(seconds_.body);
  const bool first = body_start_.empty(), same_start = !first && body_start_s_ == t_s;
  if (same_start && body_end_s_ == t_s + h_s) return;
  if (!same_start) {
    if (!first && body_end_s_ == t_s) {
      std::swap(body_start_, body_end_);
    } else {
      world_->body_at(t_s, world_->body->next_positions(), body_start_);
    }
  }
  world_->body_at(t_s + h_s, body_start_, body_end_);
  body_start_s_ = t_s;
  body_end_s_ = t_s + h_s;
  if (same_start) {
    world_->body->set_end(body_end_);
  } else {
    world_->body->set_motion(body_start_, body_end_);
  }
}

void ImplicitEuler::prepare(const ClothState& state, double t_s, double h_s, double base_h_s) {
  base_h_s_ = base_h_s;
  move_body(t_s, h_s);
  evaluated_at_state_ = true;
  history_.check(state);
  {
    const Timed timed(seconds_.eval);
    elements_.evaluate(*model_, state);
    elements_.forces(force_);
    for (std::size_t i = 0; i < force_.size(); ++i)
      force_[i] += model_->mass_kg[i] * (model_->gravity_m_per_s2 - model_->drag_per_s * state.v[i]);
    stretch_.begin(state.x);
  }
  {
    const Timed timed(seconds_.cloth_solid);
    body_.detect(state, base_h_s);
    if (options_.flypaper) {
      flypaper_.detect(state, body_.points());
      rows_.let_be(flypaper_.any() ? flypaper_.pinched() : std::span<const Pinched>());
    }
  }
  rows_.detect(state, base_h_s);
  if (world_->body) look_through_body(state);
}

// Cloth that is through the body already is not kept there, and cloth deep within it is drawn out.  Both only occur from the start of a
// run, after a step that allowed it, or with a body that is not guarded.
void ImplicitEuler::look_through_body(const ClothState& state) {
  const Timed timed(seconds_.cloth_solid);
  may_be_through_ |= flypaper_.any_without_room();
  if (may_be_through_) {
    const bool crosses =
        mark_through_body(rows_.topology(), rows_.tree(), state.x, *world_->body, body_workspace_, through_body_);
    penetration_recovery_.detect(state.x, body_);
    may_be_through_ = crosses || penetration_recovery_.any() || !options_.guard_body;
  } else {
    through_body_.assign(state.x.size(), 0);
    penetration_recovery_.clear();
  }
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (body_.inside(static_cast<Index>(i)) || flypaper_.pinched()[i] == Pinched::without_room) through_body_[i] = 1;
  }
}

void ImplicitEuler::hold_pins(const ClothState& state, double t_s, const StepFormula& step) {
  for (const Pin& pin : world_->pins) {
    const auto i = static_cast<std::size_t>(pin.particle);
    Vec3 way = Vec3::Zero();
    if (pin.on_body) {
      way = carried(*pin.on_body, *world_->body) - state.x[i];
    } else if (pin.path) {
      way = pin.path(t_s + step.h_s) - state.x[i];
    }
    if (!step.drift_m.empty()) way -= step.drift_m[i];
    const Vec3 velocity = way / step.weight_s;
    const Vec3 z = velocity - state.v[i];
    if (pin.constrained_directions == 3) {
      constraints_.hold(pin.particle, z);
    } else {
      constraints_.hold_along(pin.particle, pin.p, pin.p.dot(z));
      if (pin.constrained_directions == 2) constraints_.hold_along(pin.particle, pin.q, pin.q.dot(z));
    }
  }
}

void ImplicitEuler::evaluate_forces(const ClothState& at, double end_s) {
  force_is_prepared_.resize(world_->forces.size(), 0);
  acting_.clear();
  for (std::size_t k = 0; k < world_->forces.size(); ++k) {
    Force& force = *world_->forces[k];
    if (!force.acts(end_s)) continue;
    if (!std::exchange(force_is_prepared_[k], 1)) force.prepare(*model_, *elements_.pattern());
    force.evaluate(at, end_s);
    acting_.push_back(&force);
  }
}

void ImplicitEuler::assemble(const ClothState& at, double t_s, const StepFormula& step) {
  const double H = step.weight_s;
  evaluate_forces(at, t_s + step.h_s);
  solver_.assemble([&](auto& A) {
    for (std::size_t i = 0; i < force_.size(); ++i)
      A.grounded(static_cast<Index>(i)) = model_->mass_kg[i] * (1 + H * model_->drag_per_s) * Mat3::Identity();
    elements_.assemble(H, A);
    for (const Force* force : acting_) force->assemble(H, A);
  });
}

StepReport ImplicitEuler::attempt(const ClothState& state, double t_s, double h_s, const StepLimits& limits,
                                  ClothState& candidate) {
  StepReport report;
  report.h_s = h_s;
  const std::size_t n = force_.size();
  const StepFormula step = options_.integrator == Integrator::bdf2 ? history_.formula(h_s) : StepFormula(h_s);
  {
    const Timed timed(seconds_.eval);
    if (!evaluated_at_state_)
      elements_.evaluate(*model_, state);  // Newton iterations of a refused attempt left them elsewhere
    evaluated_at_state_ = true;
    assemble(state, t_s, step);
    linearised_is_old_ = true;
    force_linearised_ = force_;
    for (const Force* force : acting_) force->add_forces(force_linearised_);
    x_linearised_ = state.x;
    for (std::size_t i = 0; i < n; ++i) {
      reference_[i] = (step.weight_s * model_->mass_kg[i]) * model_->gravity_m_per_s2;
      // The predictor: the last change of velocity, so that free fall is exact at any tolerance.
      dv_[i] = h_last_s_ > 0 ? Vec3((h_s / h_last_s_) * dv_last_[i]) : Vec3(h_s * model_->gravity_m_per_s2);
    }
  }
  move_body(t_s, h_s);
  body_.begin(state, dv_, step);
  rows_.begin(state, dv_, step, base_h_s_, solver_.diagonals());
  candidate.x.resize(n);
  candidate.v.resize(n);
  for (int iteration = 1;; ++iteration) {
    if (!solve_with_contacts(state, t_s, step, iteration, limits, candidate, report)) return report;
    find_end(state, step, candidate);
    if (iteration >= options_.newton_iterations) break;
    const Timed timed(seconds_.eval);
    relinearise(state, t_s, step, candidate);
  }
  // The loss of velocity at a landing is not smooth: such a step is backward Euler from its start.
  if (!step.drift_m.empty() && (body_.changed() || rows_.changed())) {
    history_.forget();
    StepReport again = attempt(state, t_s, h_s, limits, candidate);
    again.passes += report.passes;
    again.cg_iterations += report.cg_iterations;
    return again;
  }
  report.touching = body_.touching();
  report.pinched = static_cast<int>(flypaper_.count());
  {
    const Timed timed(seconds_.eval);
    judge(limits, candidate, report);
  }
  if (report && (options_.rows.cloth_cloth || (world_->body && options_.guard_body)))
    keep_apart(state, h_s, limits, candidate, report);
  h_last_s_ = report ? h_s : h_last_s_;
  if (report) dv_last_ = dv_;
  if (report && options_.integrator == Integrator::bdf2) {
    history_.remember(state, candidate, moved_, h_s);
    if (report.filter.corrected > 0) history_.forget();
  }
  return report;
}

// A Newton update may leave the region where its linearisation is valid: then it is halved until the energy beyond the linearisation
// is no more than the decrease by the linear model.  Over the part a of the update d, dv.A dv / 2 - dv.b falls by
// (a - a^2 / 2) d.A d.                                                        [Nocedal & Wright 2006, 3.1: backtracking]
void ImplicitEuler::shorten(const ClothState& state, const StepFormula& step, ClothState& candidate) {
  const Timed timed(seconds_.eval);
  for (std::size_t i = 0; i < dv_.size(); ++i) way_[i] = dv_[i] - dv_linearised_[i];
  solver_.multiply_unfiltered(way_, displacement_);
  double gain = 0;
  for (std::size_t i = 0; i < dv_.size(); ++i) gain += way_[i].dot(displacement_[i]);
  for (double part = 1; part >= shortest_part; part /= 2) {
    for (std::size_t i = 0; i < dv_.size(); ++i) dv_[i] = dv_linearised_[i] + part * way_[i];
    find_end(state, step, candidate);
    if (elements_.energy_beyond_linear(candidate.x).net <= (part - 0.5 * part * part) * gain) return;
  }
}

// The end of the step by the last solve.
void ImplicitEuler::find_end(const ClothState& state, const StepFormula& step, ClothState& candidate) {
  for (std::size_t i = 0; i < dv_.size(); ++i) {
    candidate.v[i] = state.v[i] + dv_[i];
    moved_[i] = step.drift(static_cast<Index>(i)) + step.weight_s * candidate.v[i];
    candidate.x[i] = state.x[i] + moved_[i] + y_[i];
  }
}

// Whether threads have too much energy beyond the linearisation at that end, as they do where cloth turns: it would brake the turn in the
// next step.  Motion below slow_motion counts as that speed, or cloth that hardly moves would never pass the test.
bool ImplicitEuler::makes_energy(const ClothState& candidate, double h_s) {
  const double fall2 = (options_.slow_motion * h_s * model_->gravity_m_per_s2).squaredNorm();
  double kinetic_J = 0;
  for (std::size_t i = 0; i < candidate.v.size(); ++i)
    kinetic_J += 0.5 * model_->mass_kg[i] * (candidate.v[i].squaredNorm() + fall2);
  return elements_.energy_beyond_linear(candidate.x).made > most_made * kinetic_J;
}

// About the end x^k that the last solve found, with the unknown dv still counted from v:
//   f(x', v') = f(x^k, v) - K (x' - x^k) - D dv          at x' = x + drift + H (v + dv) + y
void ImplicitEuler::relinearise(const ClothState& state, double t_s, const StepFormula& step,
                                const ClothState& candidate) {
  evaluated_at_state_ = false;
  linearised_is_old_ = true;
  x_linearised_ = candidate.x;
  dv_linearised_ = dv_;
  elements_.evaluate(*model_, {candidate.x, state.v});
  elements_.forces(force_linearised_);
  for (std::size_t i = 0; i < force_linearised_.size(); ++i)
    force_linearised_[i] += model_->mass_kg[i] * (model_->gravity_m_per_s2 - model_->drag_per_s * state.v[i]);
  assemble(candidate, t_s, step);
  for (const Force* force : acting_) {  // F(v') = F(v^k) - B (v' - v^k) = F(v^k) + B (v^k - v) - B dv
    force->add_forces(force_linearised_);
    force->add_damping(dv_, force_linearised_);
  }
}

// [particle] the velocity of a landing in this step, the part of its fall in y; empty without landings.
std::span<const Vec3> ImplicitEuler::landing_velocity(double H) {
  bool any = false;
  for (std::size_t i = 0; i < landing_.size(); ++i) {
    landing_v_[i] = landing_[i] / H;
    any |= landing_[i] != Vec3::Zero();
  }
  if (!any || options_.position_alteration == PositionAlteration::after_solve) return {};
  return landing_v_;
}

bool ImplicitEuler::solve_with_contacts(const ClothState& state, double t_s, const StepFormula& step, int iteration,
                                        const StepLimits& limits, ClothState& candidate, StepReport& report) {
  const std::size_t n = force_.size();
  const double H = step.weight_s;
  // Passes that only look for the active set are solved loosely; the one that is kept, to the tolerance asked for.
  // The target as a whole is loosened: the tolerance alone would change nothing where the target is 2 % of gravity.
  PcgOptions pcg_options = options_.pcg;
  if (iteration == 1 && options_.max_passes > 1) pcg_options.loosen = loose_passes;
  for (int pass = 1;; ++pass) {
    ++report.passes;
    {
      const Timed timed(seconds_.eval);
      constraints_.clear();
      hold_pins(state, t_s, step);
      springs_.clear();
      std::fill(y_.begin(), y_.end(), Vec3::Zero());
      std::fill(landing_.begin(), landing_.end(), Vec3::Zero());
      flypaper_.apply(state, step, constraints_);
      body_.apply(state, step, constraints_, y_, landing_, springs_);
      if (options_.position_alteration == PositionAlteration::in_solve) y_known_ = y_;
      rows_.append_springs(springs_);
      penetration_recovery_.append_springs(springs_);
      for (const Drag& drag : world_->drags) toile::internal::append_springs(drag, state, t_s, step.h_s, springs_);
      if (world_->springs) world_->springs(state, t_s + step.h_s, step.h_s, springs_);
      const bool drifts = !step.drift_m.empty();
      if (drifts) {
        for (std::size_t i = 0; i < n; ++i) displacement_[i] = step.drift_m[i] + y_known_[i];
      }
      implicit_rows_.clear();
      for (const LinearSpring& spring : springs_)
        implicit_rows_.push_back(implicit_row(spring, H, state.v, drifts ? displacement_ : y_known_, step.h_s));
      if (linearised_is_old_ || y_known_ != y_linearised_) {  // f - K (x + drift + H v + y - x^k) - D y_l / H
        linearised_is_old_ = false;
        y_linearised_ = y_known_;
        linearised_ = force_linearised_;
        for (std::size_t i = 0; i < n; ++i) {
          displacement_[i] = H * state.v[i] + y_known_[i];
          if (drifts) displacement_[i] += step.drift_m[i];
          if (!evaluated_at_state_) displacement_[i] += state.x[i] - x_linearised_[i];
        }
        elements_.subtract_stiffness(displacement_, landing_velocity(H), linearised_);
      }
      for (std::size_t i = 0; i < n; ++i) b_[i] = H * linearised_[i];
      if (drifts) {
        for (std::size_t i = 0; i < n; ++i) b_[i] += model_->mass_kg[i] * history_.kick()[i];
      }
      for (const ImplicitRow& row : implicit_rows_) {
        for (std::size_t k = 0; k < 4; ++k) {
          if (row.particle[k] >= 0)
            b_[static_cast<std::size_t>(row.particle[k])] += (row.beta * row.weight[k]) * row.direction;
        }
      }
    }
    {
      const Timed timed(seconds_.cg);
      solver_.prepare(implicit_rows_, constraints_, pcg_options);
      report.pcg = solver_.solve(b_, reference_, pcg_options, dv_);
      report.cg_iterations += report.pcg.iterations;
      if (!report.pcg) {
        report.status = StepStatus::solver_failed;
        return false;
      }
      solver_.held_residual(dv_, b_, e_);
    }
    BodyConstraints::Change body;
    {
      const Timed timed(seconds_.cloth_solid);
      body = body_.update(state, dv_, e_, step, report.passes <= 2);
    }
    const ContactRows::Change change = rows_.update(state, dv_, y_known_, step, report.passes <= 4);
    report.rows = change.active;
    if (report.relinearised > 0) shorten(state, step, candidate);
    if (pass >= contact_passes && report.relinearised < options_.relinearisations) {
      const Timed timed(seconds_.eval);
      find_end(state, step, candidate);
      const StretchChange largest = stretch_.largest(candidate.x);
      if (largest.change > limits.stretch || largest.beyond >= 0 ||
          (report.relinearised == 0 && makes_energy(candidate, step.h_s))) {
        relinearise(state, t_s, step, candidate);
        ++report.relinearised;
        continue;
      }
    }
    const bool last = pcg_options.loosen == options_.pcg.loosen;
    // A few particles that begin to slip, leave the body or end a little below the offset, or rows that come and go, can wait for
    // the next step; cloth that would end near the body's surface cannot.
    const bool settled = body.deep == 0 && 50 * (body.released + body.added) <= body.touching &&
                         20 * body.slipped <= body.touching && 20 * (change.added + change.dropped) <= change.active &&
                         20 * change.turned_back <= change.active;
    const int passes_left = options_.max_passes + report.relinearised - pass;
    if ((settled && last) || passes_left <= 0) return true;
    if (settled || passes_left == 1) pcg_options.loosen = options_.pcg.loosen;
  }
}

void ImplicitEuler::judge_finite(const ClothState& candidate, StepReport& report) const {
  for (std::size_t i = 0; i < candidate.x.size(); ++i) {
    if (std::isfinite(candidate.v[i].squaredNorm() + candidate.x[i].squaredNorm())) continue;
    report.status = StepStatus::not_finite;
    report.worst_particle = static_cast<Index>(i);
    return;
  }
}

void ImplicitEuler::judge(const StepLimits& limits, const ClothState& candidate, StepReport& report) {
  judge_finite(candidate, report);
  if (!report) return;
  const StretchChange largest = stretch_.largest(candidate.x);
  report.stretch_change = largest.change;
  report.worst_triangle = largest.triangle;
  if (largest.change > limits.stretch) report.status = StepStatus::stretched;
  judge_strain(largest, report);
}

// A thread beyond its limit may only get shorter.
void ImplicitEuler::judge_strain(const StretchChange& largest, StepReport& report) const {
  if (largest.beyond < 0) return;
  report.status = StepStatus::beyond_limit;
  report.worst_triangle = largest.beyond;
  report.strain = largest.strain;
  report.strain_limit = model_->stiffness_of(static_cast<std::size_t>(largest.beyond)).strain_limit;
}

// For the impacts with the body that the last attempt could not prevent.
bool ImplicitEuler::may_pierce(StepLimits::Pierce pierce) const {
  if (pierce != StepLimits::Pierce::pinched) return pierce == StepLimits::Pierce::all;
  const auto is_pinched = [&](Index i) {
    const auto p = static_cast<std::size_t>(i);
    return p < flypaper_.pinched().size() && flypaper_.pinched()[p] != Pinched::no;
  };
  return std::all_of(filter_.left_with_body().begin(), filter_.left_with_body().end(), [&](const Impact& impact) {
    return std::any_of(impact.particle.begin(), impact.particle.end(), is_pinched);
  });
}

void ImplicitEuler::keep_apart(const ClothState& state, double h_s, const StepLimits& limits, ClothState& candidate,
                               StepReport& report) {
  const Timed timed(seconds_.filter);
  inverse_mass_.resize(state.x.size());
  for (std::size_t i = 0; i < state.x.size(); ++i)
    inverse_mass_[i] = constraints_.is_free(static_cast<Index>(i)) ? 1 / model_->mass_kg[i] : 0;
  std::span<const double> contact_m;
  if (options_.rows.cloth_cloth) contact_m = rows_.contact_m();
  BodyGuard guard{world_->body, options_.body.smallest_offset_m(), through_body_};
  const bool guarded = world_->body && options_.guard_body;
  if (guarded) {
    before_body_.resize(state.x.size());
    for (std::size_t i = 0; i < state.x.size(); ++i) before_body_[i] = 1 / model_->mass_kg[i];
    for (const Pin& pin : world_->pins) before_body_[static_cast<std::size_t>(pin.particle)] = 0;
  }
  report.filter = filter_(rows_.topology(), rows_.tree(), state.x, inverse_mass_, contact_m, limits.truncate,
                          candidate.x, guarded ? &guard : nullptr, before_body_,
                          flypaper_.any() ? flypaper_.pinched() : std::span<const Pinched>(), &rows_.near());
  if (report.filter.hopeless || report.filter.left > 0 || (report.filter.body_left > 0 && !may_pierce(limits.pierce))) {
    report.status = StepStatus::passed_through;
    return;
  }
  pierced_ = report.filter.body_left > 0;
  if (report.filter.corrected == 0) return;
  judge(limits, candidate, report);
  if (!report) return;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (!filter_.moved()[i]) continue;
    const Vec3 correction = candidate.x[i] - (state.x[i] + moved_[i] + y_[i]);
    const Vec3 uncounted = (1 - counted_share(correction, candidate.v[i], h_s, base_h_s_)) * correction;
    candidate.v[i] = velocity_of_motion(candidate.x[i] - state.x[i] - uncounted, y_[i], h_s);
  }
  judge_finite(candidate, report);  // impulses against one contact may lead far into another
}

void ImplicitEuler::accept(const ClothState& candidate, double h_s) {
  if (options_.integrator == Integrator::bdf2 && (body_.changed() || rows_.changed())) history_.forget();
  body_.accept(h_s);
  rows_.accept(candidate);
  {
    const Timed timed(seconds_.eval);
    elements_.follow_bends(*model_, candidate.x, h_s);
  }
  may_be_through_ |= pierced_;
}

PhaseSeconds ImplicitEuler::seconds() const {
  PhaseSeconds total = seconds_;
  total.cloth_cloth += rows_.cloth_seconds + seconds_.filter;
  total.cloth_solid += rows_.body_seconds;
  return total;
}

}  // namespace toile::internal
