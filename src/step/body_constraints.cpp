#include "step/body_constraints.hpp"

#include "core/parallel.hpp"
#include "step/tangents.hpp"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

constexpr double static_over_kinetic = 1.02;  // hysteresis, so that stick and slip do not alternate at the cone
constexpr double largest_alteration = 0.2;    // of the offset, per step
constexpr double deepest = 0.5;               // offsets
constexpr double dead_band = 0.02;            // of the offset
constexpr double deep = 0.5;                  // of the offset
constexpr double slowest_slip = 1e-3;         // v_0, m/s
constexpr double stick_below = 0.99;          // of v_0: below v_0 friction needs less than its cone
constexpr double slides_on_s = 0.1;           // after it broke loose
constexpr double pull_of_weight = 0.01;       // a pull below this part of the particle's weight is solver noise

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

BodyConstraints::BodyConstraints(const ClothModel& model, const BodySurface* body, const BodyContactOptions& options)
    : model_(&model),
      body_(body),
      options_(options),
      points_(body ? model.mass_kg.size() : 0),
      reach_m_(points_.size()),
      touch_(model.mass_kg.size(), Touch::none),
      lambda_n_(model.mass_kg.size(), 0),
      loose_s_(model.mass_kg.size(), 0) {
  near_.reserve(points_.size());
}

bool BodyConstraints::too_deep(const BodyPoint& point) const { return point.gap_m < -deepest * options_.offset_m; }

void BodyConstraints::detect(const ClothState& state, double h_s) {
  near_.clear();
  if (!body_) return;
  double body_travel = 0;
  const auto start = body_->positions(), end = body_->next_positions();
  for (std::size_t i = 0; i < start.size(); ++i) body_travel = std::max(body_travel, (end[i] - start[i]).squaredNorm());
  farthest_travel_m_ = std::sqrt(body_travel);
  const double fall = h_s * h_s * model_->gravity_m_per_s2.norm();
  parallel_for(points_.size(), 256, [&](std::size_t i) {
    const double reach = options_.offset_m + farthest_travel_m_ + h_s * state.v[i].norm() + fall;
    reach_m_[i] = 1.01 * reach;
    points_[i] = body_->nearest(state.x[i], reach_m_[i]);
  });
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const BodyPoint& point = points_[i];
    if (point.triangle < 0 || too_deep(point)) continue;
    near_.push_back({static_cast<Index>(i), point, Vec3::Zero(), point.normal});
  }
}

// The body's motion over the step, of which it may have been told anew.
void BodyConstraints::Near::follow(const BodySurface& body) {
  body_travel = body.travel(point.triangle, point.barycentric);
  normal = body.normal_midway(point.triangle, point.normal);
}

// What is at rest before a step says nothing of the forces that will move it: a seam that is welded under tension, without gravity,
// comes 6 mm in a step of 1/60 s.
void BodyConstraints::find_what_came_far(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i].triangle >= 0) continue;
    const auto particle = static_cast<Index>(i);
    const Vec3 way = step.drift(particle) + step.weight_s * (state.v[i] + dv[i]);
    const double reach = options_.offset_m + farthest_travel_m_ + way.norm();
    if (reach <= reach_m_[i]) continue;
    reach_m_[i] = reach;
    points_[i] = body_->nearest(state.x[i], reach);
    if (points_[i].triangle < 0 || too_deep(points_[i])) continue;
    Near near{particle, points_[i], Vec3::Zero(), points_[i].normal};
    near.follow(*body_);
    near.lambda_n = lambda_n_[i];
    near_.push_back(near);
  }
}

// A new contact slides: what friction does to it is decided by the solve.
void BodyConstraints::touch_down(Near& near, const Vec3& v, double h_s) const {
  const Vec3 relative = v - near.body_travel / h_s;
  const double v_n = near.normal.dot(relative);
  near.touch = Touch::slides;
  near.slip_m_per_s = (relative - v_n * near.normal).norm();
  if (near.lambda_n <= 0) {
    const double stop = -v_n / h_s - near.normal.dot(model_->gravity_m_per_s2);
    near.lambda_n = model_->mass_kg[at(near.particle)] * std::max(0.0, stop);
  }
}

void BodyConstraints::begin(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step) {
  for (Near& near : near_) {
    const std::size_t i = at(near.particle);
    near.released = near.slipped = false;
    near.follow(*body_);
    near.lambda_n = lambda_n_[i];
    near.touch = Touch::none;
    const Vec3 travel = step.drift(near.particle) + step.weight_s * (state.v[i] + dv[i]) - near.body_travel;
    if (touch_[i] == Touch::none && near.point.gap_m + near.normal.dot(travel) >= options_.offset_m) continue;
    touch_down(near, state.v[i] + dv[i], step.h_s);
    if (touch_[i] == Touch::sticks && options_.friction > 0) near.touch = Touch::sticks;
  }
}

double BodyConstraints::alteration(const Near& near) const {
  const double r = options_.offset_m, missing = r - near.point.gap_m;
  if (missing >= 0 && missing < dead_band * r) return 0;
  return std::min(missing, largest_alteration * r);
}

void BodyConstraints::apply(const ClothState& state, const StepFormula& step, ParticleConstraints& constraints,
                            std::span<Vec3> y, std::vector<LinearSpring>& springs) {
  for (Near& near : near_) {
    near.pinned = !constraints.is_free(near.particle);
    if (near.touch == Touch::none || near.pinned) continue;
    const std::size_t i = at(near.particle);
    const Vec3& n = near.normal;
    const Vec3 z = (near.body_travel - step.drift(near.particle)) / step.weight_s - state.v[i];
    y[i] = alteration(near) * n;
    if (near.touch == Touch::sticks) {
      constraints.hold(near.particle, z);
      continue;
    }
    constraints.hold_along(near.particle, n, n.dot(z));
    if (options_.friction <= 0 || near.lambda_n <= 0) continue;
    for (const Vec3& t : tangents(n)) {
      LinearSpring drag;
      drag.particle[0] = near.particle;
      drag.weight[0] = 1;
      drag.direction = t;
      drag.damping_N_s_per_m = options_.friction * near.lambda_n / std::max(near.slip_m_per_s, slowest_slip);
      drag.body_displacement_m = t.dot(near.body_travel);
      springs.push_back(drag);
    }
  }
}

BodyConstraints::Change BodyConstraints::update(const ClothState& state, std::span<const Vec3> dv,
                                                std::span<const Vec3> e, const StepFormula& step, bool first_passes) {
  Change change;
  find_what_came_far(state, dv, step);
  for (Near& near : near_) {
    if (near.pinned) continue;
    const std::size_t i = at(near.particle);
    const Vec3& n = near.normal;
    const Vec3 velocity =
        state.v[i] + dv[i] - near.body_travel / step.h_s;  // relative to the body, at the end of the step
    if (near.touch == Touch::none) {
      double gap = near.point.gap_m + step.weight_s * n.dot(velocity);
      if (!step.drift_m.empty())
        gap += n.dot(step.drift(near.particle) + (step.weight_s / step.h_s - 1) * near.body_travel);
      if (gap < (1 - dead_band) * options_.offset_m) {
        near.lambda_n = 0;
        touch_down(near, state.v[i] + dv[i], step.h_s);
        ++change.added;
        if (gap < deep * options_.offset_m) ++change.deep;
        ++change.touching;
      }
      continue;
    }
    const Vec3 force = e[i] / step.weight_s;
    const double lambda = n.dot(force);
    if (lambda < -pull_of_weight * model_->mass_kg[i] * model_->gravity_m_per_s2.norm() && !near.released &&
        first_passes) {
      near.touch = Touch::none;
      near.released = true;
      near.lambda_n = 0;
      ++change.released;
      continue;
    }
    ++change.touching;
    near.lambda_n = std::max(lambda, 0.0);
    const Vec3 v_t = velocity - n.dot(velocity) * n;
    near.slip_m_per_s = v_t.norm();
    if (near.touch == Touch::sticks && !near.slipped) {
      const Vec3 tangential = force - lambda * n;
      if (tangential.norm() > static_over_kinetic * options_.friction * near.lambda_n) {
        near.touch = Touch::slides;
        near.slipped = true;
        ++change.slipped;
      }
    }
  }
  return change;
}

bool BodyConstraints::changed() const {
  std::ptrdiff_t touching = 0;
  for (const Near& near : near_) {
    if (near.touch == Touch::none) continue;
    if (touch_[at(near.particle)] == Touch::none) return true;
    ++touching;
  }
  return touching != std::count_if(touch_.begin(), touch_.end(), [](Touch touch) { return touch != Touch::none; });
}

void BodyConstraints::accept(double h_s) {
  std::fill(touch_.begin(), touch_.end(), Touch::none);
  std::fill(lambda_n_.begin(), lambda_n_.end(), 0.0);
  for (double& loose_s : loose_s_) loose_s = std::max(loose_s - h_s, 0.0);
  for (const Near& near : near_) {
    double& loose_s = loose_s_[at(near.particle)];
    if (near.slipped) loose_s = slides_on_s;
    const bool stopped = options_.friction > 0 && near.touch == Touch::slides && loose_s == 0 &&
                         near.slip_m_per_s < stick_below * slowest_slip;
    touch_[at(near.particle)] = stopped ? Touch::sticks : near.touch;
    if (near.touch != Touch::none) lambda_n_[at(near.particle)] = near.lambda_n;
  }
}

int BodyConstraints::touching() const {
  return static_cast<int>(
      std::count_if(near_.begin(), near_.end(), [](const Near& near) { return near.touch != Touch::none; }));
}

}  // namespace toile
