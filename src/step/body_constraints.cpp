#include "step/body_constraints.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

constexpr double static_over_kinetic = 1.02;    // hysteresis, so that stick and slip do not alternate at the cone
constexpr double largest_alteration = 0.2;      // of the offset, per step
constexpr double dead_band = 0.02;              // of the offset
constexpr int most_switches = 2;                // stick <-> slip per particle and step
constexpr double pull_of_weight = 0.01;         // a pull below this part of the particle's weight is solver noise

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

BodyConstraints::BodyConstraints(const ClothModel& model, const BodySurface* body, const BodyContactOptions& options)
    : model_(&model),
      body_(body),
      options_(options),
      points_(body ? model.mass_kg.size() : 0),
      touch_(model.mass_kg.size(), Touch::none),
      lambda_n_(model.mass_kg.size(), 0) {
  near_.reserve(points_.size());
}

void BodyConstraints::detect(const ClothState& state, double h_s) {
  near_.clear();
  if (!body_) return;
  double body_travel = 0;
  const auto start = body_->positions(), end = body_->next_positions();
  for (std::size_t i = 0; i < start.size(); ++i) body_travel = std::max(body_travel, (end[i] - start[i]).squaredNorm());
  body_travel = std::sqrt(body_travel);
  const double fall = h_s * h_s * model_->gravity_m_per_s2.norm();
  parallel_for(points_.size(), 256, [&](std::size_t i) {
    const double reach = options_.offset_m + body_travel + h_s * state.v[i].norm() + fall;
    points_[i] = body_->nearest(state.x[i], 1.01 * reach);
  });
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const BodyPoint& point = points_[i];
    if (point.triangle < 0) continue;
    Near near{static_cast<Index>(i), point, Vec3::Zero()};
    const Triangle& t = body_->triangles()[at(point.triangle)];
    for (std::size_t c = 0; c < 3; ++c) near.body_travel += point.barycentric[static_cast<Eigen::Index>(c)] * (end[at(t[c])] - start[at(t[c])]);
    near_.push_back(near);
  }
}

// Whether a new contact starts as stick or slip: sticks if friction can stop it within the step.
void BodyConstraints::touch_down(Near& near, const Vec3& v, double h_s) const {
  const Vec3 relative = v - near.body_travel / h_s;
  const double v_n = near.point.normal.dot(relative);
  const Vec3 v_t = relative - v_n * near.point.normal;
  const double mass = model_->mass_kg[at(near.particle)];
  const double speed = v_t.norm();
  if (near.lambda_n <= 0) {
    near.lambda_n = mass * std::max(0.0, -v_n / h_s - near.point.normal.dot(model_->gravity_m_per_s2));
  }
  const bool stops = options_.friction > 0 && mass * speed <= options_.friction * near.lambda_n * h_s;
  near.touch = stops ? Touch::sticks : Touch::slides;
  near.slip_direction = speed > 0 ? Vec3(v_t / speed) : Vec3::Zero();
}

void BodyConstraints::begin(const ClothState& state, double h_s) {
  for (Near& near : near_) {
    const std::size_t i = at(near.particle);
    near.released = false;
    near.switches = 0;
    near.lambda_n = lambda_n_[i];
    near.touch = Touch::none;
    const Vec3 travel = h_s * (state.v[i] + h_s * model_->gravity_m_per_s2) - near.body_travel;
    if (near.point.gap_m + near.point.normal.dot(travel) >= options_.offset_m) continue;
    touch_down(near, state.v[i], h_s);
    if (touch_[i] == Touch::sticks && options_.friction > 0) near.touch = Touch::sticks;
  }
}

double BodyConstraints::alteration(const Near& near) const {
  const double r = options_.offset_m, missing = r - near.point.gap_m;
  if (missing >= 0 && missing < dead_band * r) return 0;
  return std::min(missing, largest_alteration * r);
}

void BodyConstraints::apply(const ClothState& state, double h_s, ParticleConstraints& constraints, std::span<Vec3> y,
                            std::span<Vec3> friction_N) {
  std::fill(y.begin(), y.end(), Vec3::Zero());
  std::fill(friction_N.begin(), friction_N.end(), Vec3::Zero());
  for (Near& near : near_) {
    near.pinned = !constraints.is_free(near.particle);
    if (near.touch == Touch::none || near.pinned) continue;
    const std::size_t i = at(near.particle);
    const Vec3& n = near.point.normal;
    const Vec3 z = near.body_travel / h_s - state.v[i];
    if (near.touch == Touch::sticks) {
      constraints.hold(near.particle, z);
    } else {
      constraints.hold_along(near.particle, n, n.dot(z));
      friction_N[i] = -options_.friction * near.lambda_n * near.slip_direction;
    }
    y[i] = alteration(near) * n;
  }
}

int BodyConstraints::update(const ClothState& state, std::span<const Vec3> dv, std::span<const Vec3> e, double h_s, bool first_passes) {
  int changes = 0;
  for (Near& near : near_) {
    if (near.pinned) continue;
    const std::size_t i = at(near.particle);
    const Vec3& n = near.point.normal;
    const Vec3 velocity = state.v[i] + dv[i] - near.body_travel / h_s;   // relative to the body, at the end of the step
    if (near.touch == Touch::none) {
      if (near.point.gap_m + h_s * n.dot(velocity) < (1 - dead_band) * options_.offset_m) {
        near.lambda_n = 0;
        touch_down(near, state.v[i], h_s);
        ++changes;
      }
      continue;
    }
    const Vec3 force = e[i] / h_s;
    const double lambda = n.dot(force);
    if (lambda < -pull_of_weight * model_->mass_kg[i] * model_->gravity_m_per_s2.norm() && !near.released && first_passes) {
      near.touch = Touch::none;
      near.released = true;
      near.lambda_n = 0;
      ++changes;
      continue;
    }
    near.lambda_n = std::max(lambda, 0.0);
    if (options_.friction <= 0) continue;
    if (near.touch == Touch::sticks) {
      const Vec3 tangential = force - lambda * n;
      const double size = tangential.norm();
      if (size > static_over_kinetic * options_.friction * near.lambda_n && near.switches < most_switches) {
        near.touch = Touch::slides;
        near.slip_direction = size > 0 ? Vec3(-tangential / size) : Vec3::Zero();
        ++near.switches;
        ++changes;
      }
    } else {
      const Vec3 v_t = velocity - n.dot(velocity) * n;
      const double speed = v_t.norm();
      if (v_t.dot(near.slip_direction) < 0 && near.switches < most_switches) {   // friction would turn the motion round: it stops it
        near.touch = Touch::sticks;
        ++near.switches;
        ++changes;
      } else if (speed > 0) {
        near.slip_direction = v_t / speed;
      }
    }
  }
  return changes;
}

void BodyConstraints::accept() {
  std::fill(touch_.begin(), touch_.end(), Touch::none);
  std::fill(lambda_n_.begin(), lambda_n_.end(), 0.0);
  for (const Near& near : near_) {
    touch_[at(near.particle)] = near.touch;
    if (near.touch != Touch::none) lambda_n_[at(near.particle)] = near.lambda_n;
  }
}

int BodyConstraints::touching() const {
  return static_cast<int>(std::count_if(near_.begin(), near_.end(), [](const Near& near) { return near.touch != Touch::none; }));
}

}  // namespace toile
