#include "step/body_constraints.hpp"

#include "core/parallel.hpp"
#include "step/tangents.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double static_over_kinetic = 1.02;  // hysteresis, so that stick and slip do not alternate at the cone
constexpr double largest_alteration = 0.2;    // of the offset, per step
// And shorter steps alter by less, in proportion: else a triangle of 2 mm, of cloth that the weld of a gather has left within the offset,
// is stretched by 7 % in a step however short, and the step collapses.
constexpr double fully_altered_s = 1e-3;
constexpr double deepest = 0.5;          // offsets
constexpr double dead_band = 0.02;       // of the offset
constexpr double deep = 0.5;             // of the offset
constexpr double slowest_slip = 1e-3;    // v_0, m/s
constexpr double stick_below = 0.99;     // of v_0: below v_0 friction needs less than its cone
constexpr double slides_on_s = 0.1;      // after it broke loose
constexpr double pull_of_weight = 0.01;  // a pull below this part of the particle's weight is solver noise
constexpr double same_face = 0.9;        // cosine between normals, from which on they are of one face
constexpr double look_back = -0.9;       // cosine between normals of faces that look at each other
constexpr double least_sine2 = 0.1;      // between two faces at the start of a step it is 0.19 at least
constexpr double over = 0.87;            // cosine between a face's normal and the direction to a particle over it

// lambda and mu of a force lambda n + mu m + a component along the crease.
std::array<double, 2> along_normals(const Vec3& force, const Vec3& n, const Vec3& m) {
  const double c = n.dot(m), f_n = n.dot(force), f_m = m.dot(force), s2 = std::max(1 - c * c, least_sine2);
  return {(f_n - c * f_m) / s2, (f_m - c * f_n) / s2};
}

}  // namespace

BodyConstraints::BodyConstraints(const ClothModel& model, const BodySurface* body, const BodyContactOptions& options)
    : model_(&model),
      body_(body),
      options_(options),
      largest_offset_m_(options.largest_offset_m()),
      points_(body ? model.mass_kg.size() : 0),
      reach_m_(points_.size()),
      touch_(model.mass_kg.size(), Touch::none),
      lambda_n_(model.mass_kg.size(), 0),
      loose_s_(model.mass_kg.size(), 0) {
  near_.reserve(points_.size());
  memory_.reserve(points_.size());
}

bool BodyConstraints::too_deep(const BodyPoint& point) const { return point.gap_m < -deepest * offset_m(point); }

double BodyConstraints::friction(const Contact& contact, Index particle) const {
  return friction_share_ *
         options_.friction_of(body_->collider(contact.point.triangle), model_->friction[at(particle)]);
}

// Radius of Coulomb's cone: the sum over both faces in a crease.
double BodyConstraints::cone_N(const Near& near) {
  const double mu = friction(near.contact, near.particle);
  const Contact* other = other_face(near);
  if (!other) return mu * near.contact.lambda_n;
  const double other_mu = friction(*other, near.particle);
  return mu * (near.contact.lambda_n + other->lambda_n) + (other_mu - mu) * other->lambda_n;
}

double BodyConstraints::reach(const Vec3& x, double way_m) const {
  const double own = largest_offset_m_ + way_m;
  return body_moves_ ? own + body_->travel_near(x, own) : own;
}

void BodyConstraints::detect(const ClothState& state, double h_s) {
  near_.clear();
  if (!body_) return;
  const auto start = body_->positions(), end = body_->next_positions();
  body_moves_ = !std::equal(start.begin(), start.end(), end.begin());
  const double fall = h_s * h_s * model_->gravity_m_per_s2.norm();
  parallel_for(points_.size(), 256, [&](std::size_t i) {
    reach_m_[i] = 1.01 * reach(state.x[i], h_s * state.v[i].norm() + fall);
    points_[i] = body_->nearest(state.x[i], reach_m_[i]);
  });
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const BodyPoint& point = points_[i];
    if (point.triangle < 0 || too_deep(point)) continue;
    near_.push_back({static_cast<Index>(i), {point, Vec3::Zero(), point.normal}});
  }
  find_creases(state);
}

void BodyConstraints::find_creases(const ClothState& state) {
  beside_.clear();
  auto memory = memory_.begin();
  for (Near& near : near_) {
    while (memory != memory_.end() && memory->particle < near.particle) ++memory;
    if (memory == memory_.end()) return;
    if (memory->particle != near.particle) continue;
    const Vec3 &n = near.contact.normal, &x = state.x[at(near.particle)];
    for (int k = 0; k < memory->faces && near.beside < 0; ++k) {
      const Vec3& before = memory->normal[static_cast<std::size_t>(k)];
      if (before.dot(n) > same_face) continue;
      const BodyPoint face = body_->nearest_facing(x, before, reach_m_[at(near.particle)]);
      if (face.triangle < 0 || face.normal.dot(n) > same_face) continue;
      if (face.gap_m < over * (x - body_->position(face.triangle, face.barycentric)).norm()) continue;
      const bool slit = face.normal.dot(n) < look_back;
      if (slit && face.gap_m + near.contact.point.gap_m >= offset_m(face) + offset_m(near.contact)) continue;
      near.beside = static_cast<std::ptrdiff_t>(beside_.size());
      beside_.push_back({{face, Vec3::Zero(), face.normal, false, memory->lambda_beside_N}, slit, memory->faces == 2});
    }
  }
}

// Reads the body's motion over the step, which may have changed since detect.
void BodyConstraints::Contact::follow(const BodySurface& body) {
  body_travel = body.travel(point.triangle, point.barycentric);
  normal = body.normal_midway(point.triangle, point.normal);
}

// The velocity before a step does not bound the motion in it: a seam that is welded under tension, without gravity,
// moves by 6 mm in a step of 1/60 s.
void BodyConstraints::find_far_moving(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i].triangle >= 0) continue;
    const auto particle = static_cast<Index>(i);
    const Vec3 way = step.drift(particle) + step.weight_s * (state.v[i] + dv[i]);
    const double farther = reach(state.x[i], way.norm());
    if (farther <= reach_m_[i]) continue;
    reach_m_[i] = farther;
    points_[i] = body_->nearest(state.x[i], farther);
    if (points_[i].triangle < 0 || too_deep(points_[i])) continue;
    Near near{particle, {points_[i], Vec3::Zero(), points_[i].normal}};
    near.contact.follow(*body_);
    near.contact.lambda_n = lambda_n_[i];
    near_.push_back(near);
  }
}

// A new contact slides: the solve decides whether friction stops it.
void BodyConstraints::touch_down(Near& near, const Vec3& v, double h_s) const {
  Contact& contact = near.contact;
  const Vec3 relative = v - contact.body_travel / h_s;
  const double v_n = contact.normal.dot(relative);
  near.touch = Touch::slides;
  near.slip_m_per_s = (relative - v_n * contact.normal).norm();
  if (contact.lambda_n <= 0) {
    const double stop = -v_n / h_s - contact.normal.dot(model_->gravity_m_per_s2);
    contact.lambda_n = model_->mass_kg[at(near.particle)] * std::max(0.0, stop);
  }
}

void BodyConstraints::begin(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step) {
  for (Beside& beside : beside_) {
    beside.contact.released = false;
    beside.contact.follow(*body_);
  }
  for (Near& near : near_) {
    const std::size_t i = at(near.particle);
    Contact& contact = near.contact;
    contact.released = near.slipped = false;
    contact.follow(*body_);
    contact.lambda_n = lambda_n_[i];
    near.touch = Touch::none;
    const Vec3 way = step.drift(near.particle) + step.weight_s * (state.v[i] + dv[i]);
    const auto gap = [&](const Contact& c) { return c.point.gap_m + c.normal.dot(way - c.body_travel); };
    if (Beside* beside = this->beside(near))
      beside->touches = beside->slit || beside->touched || gap(beside->contact) < offset_m(beside->contact);
    if (touch_[i] == Touch::none && gap(contact) >= offset_m(contact)) continue;
    touch_down(near, state.v[i] + dv[i], step.h_s);
    if (touch_[i] == Touch::sticks && friction(contact, near.particle) > 0) near.touch = Touch::sticks;
  }
}

double BodyConstraints::alteration(const Contact& contact, double to_m) const {
  const double r = offset_m(contact), missing = to_m - contact.point.gap_m;
  if (missing >= 0 && missing < dead_band * r) return 0;
  return std::min(missing, altered_share_ * largest_alteration * r);
}

// In a crease y is the shortest displacement that restores the offset from both faces.
Vec3 BodyConstraints::alteration(const Near& near) {
  const double r = offset_m(near.contact);
  const Vec3& n = near.contact.normal;
  const Beside* other = touching_beside(near);
  if (!other) return alteration(near.contact, r) * n;
  if (other->slit) return alteration(near.contact, 0.5 * (near.contact.point.gap_m + other->contact.point.gap_m)) * n;
  const Vec3& m = other->contact.normal;
  const double along_n = alteration(near.contact, r), along_m = alteration(other->contact, offset_m(other->contact)),
               c = n.dot(m);
  const Vec3 y = along_n * n + ((along_m - c * along_n) / std::max(1 - c * c, least_sine2)) * (m - c * n);
  const double most = std::max({altered_share_ * largest_alteration * r, std::abs(along_n), std::abs(along_m)});
  return std::min(1.0, most / std::max(y.norm(), most)) * y;
}

void BodyConstraints::apply(const ClothState& state, const StepFormula& step, ParticleConstraints& constraints,
                            std::span<Vec3> y, std::span<Vec3> landing, std::vector<LinearSpring>& springs) {
  altered_share_ = std::min(1.0, step.h_s / fully_altered_s);
  for (Near& near : near_) {
    near.pinned = !constraints.is_free(near.particle);
    if (near.touch == Touch::none || near.pinned) continue;
    const std::size_t i = at(near.particle);
    const Contact* other = other_face(near);
    const auto z = [&](const Contact& contact) -> Vec3 {
      return (contact.body_travel - step.drift(near.particle)) / step.weight_s - state.v[i];
    };
    y[i] = alteration(near);
    if (near.contact.normal.dot(y[i]) < -dead_band * offset_m(near.contact)) landing[i] = y[i];
    if (near.touch == Touch::sticks) {
      constraints.hold(near.particle, z(near.contact));
      continue;
    }
    const Vec3& n = near.contact.normal;
    constraints.hold_along(near.particle, n, n.dot(z(near.contact)));
    std::array<Vec3, 2> across = tangents(n);
    std::span<const Vec3> free = across;
    if (other) {
      constraints.hold_along(near.particle, other->normal, other->normal.dot(z(*other)));
      across[0] = n.cross(other->normal).normalized();
      free = free.first(1);
    }
    const double cone = cone_N(near);
    if (cone <= 0) continue;
    for (const Vec3& t : free) {
      LinearSpring drag;
      drag.particle[0] = near.particle;
      drag.weight[0] = 1;
      drag.direction = t;
      drag.damping_N_s_per_m = cone / std::max(near.slip_m_per_s, slowest_slip);
      drag.body_displacement_m = t.dot(near.contact.body_travel);
      springs.push_back(drag);
    }
  }
}

double BodyConstraints::predicted_gap_m(const Contact& contact, Index particle, const Vec3& v,
                                        const StepFormula& step) const {
  const Vec3& n = contact.normal;
  const Vec3 velocity = v - contact.body_travel / step.h_s;
  const double gap = contact.point.gap_m + step.weight_s * n.dot(velocity);
  if (step.drift_m.empty()) return gap;
  return gap + n.dot(step.drift(particle) + (step.weight_s / step.h_s - 1) * contact.body_travel);
}

// Whether it touches, after adding the faces that it would come too near to.
bool BodyConstraints::touches(Near& near, const Vec3& v, const StepFormula& step, Change& change) {
  const auto comes_to = [&](Contact& contact) {
    const double gap = predicted_gap_m(contact, near.particle, v, step);
    const double r = offset_m(contact);
    if (gap >= (1 - dead_band) * r) return false;
    contact.lambda_n = 0;
    ++change.added;
    if (gap < deep * r) ++change.deep;
    return true;
  };
  Beside* beside = this->beside(near);
  if (beside && !beside->touches) beside->touches = comes_to(beside->contact);
  if (near.touch != Touch::none) return true;
  if (!comes_to(near.contact)) {
    if (!beside || !beside->touches) return false;
    std::swap(near.contact, beside->contact);
    beside->touches = false;
  }
  touch_down(near, v, step.h_s);
  return true;
}

// Whether a face would have to pull, and is released: of two the one that would pull more.
bool BodyConstraints::releases(Near& near, const Vec3& force_N, bool may_leave) {
  Contact& contact = near.contact;
  Beside* beside = touching_beside(near);
  std::array<double, 2> lambda{contact.normal.dot(force_N), 0};
  if (beside && beside->slit) {  // one of the two pushes
    if (lambda[0] < 0) std::swap(contact, beside->contact);
    contact.lambda_n = std::abs(lambda[0]);
    beside->contact.lambda_n = 0;
    return false;
  }
  if (beside) lambda = along_normals(force_N, contact.normal, beside->contact.normal);
  const bool other_pulls_more = beside && lambda[1] < lambda[0];
  Contact& pulls = other_pulls_more ? beside->contact : contact;
  const double noise = pull_of_weight * model_->mass_kg[at(near.particle)] * model_->gravity_m_per_s2.norm();
  if (std::min(lambda[0], lambda[1]) < -noise && !pulls.released && may_leave) {
    pulls.released = true;
    pulls.lambda_n = 0;
    if (!beside) {
      near.touch = Touch::none;
    } else {
      if (!other_pulls_more) std::swap(contact, beside->contact);
      beside->touches = false;
    }
    return true;
  }
  contact.lambda_n = std::max(lambda[0], 0.0);
  if (beside) beside->contact.lambda_n = std::max(lambda[1], 0.0);
  return false;
}

BodyConstraints::Change BodyConstraints::update(const ClothState& state, std::span<const Vec3> dv,
                                                std::span<const Vec3> e, const StepFormula& step, bool first_passes) {
  Change change;
  find_far_moving(state, dv, step);
  for (Near& near : near_) {
    if (near.pinned) continue;
    const std::size_t i = at(near.particle);
    const Vec3 v = state.v[i] + dv[i];
    const bool touched = near.touch != Touch::none;
    if (!touches(near, v, step, change)) continue;
    if (!touched) {
      ++change.touching;
      continue;
    }
    const Vec3 force = e[i] / step.weight_s;
    if (releases(near, force, first_passes)) {
      ++change.released;
      change.touching += near.touch != Touch::none ? 1 : 0;
      continue;
    }
    ++change.touching;
    const Vec3 &n = near.contact.normal, velocity = v - near.contact.body_travel / step.h_s;  // at the end of the step
    near.slip_m_per_s = (velocity - n.dot(velocity) * n).norm();
    if (near.touch == Touch::sticks && !near.slipped) {
      Vec3 tangential = force - n.dot(force) * n;
      if (const Contact* other = other_face(near)) {
        const Vec3 along = n.cross(other->normal).normalized();
        tangential = along.dot(force) * along;
      }
      if (tangential.norm() > static_over_kinetic * cone_N(near)) {
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
  memory_.clear();
  for (const Near& near : near_) {
    double& loose_s = loose_s_[at(near.particle)];
    if (near.slipped) loose_s = slides_on_s;
    const bool stopped = near.touch == Touch::slides && friction(near.contact, near.particle) > 0 && loose_s == 0 &&
                         near.slip_m_per_s < stick_below * slowest_slip;
    touch_[at(near.particle)] = stopped ? Touch::sticks : near.touch;
    if (near.touch == Touch::none) continue;
    lambda_n_[at(near.particle)] = near.contact.lambda_n;
    memory_.push_back({near.particle, 1, {near.contact.normal, Vec3::Zero()}, 0});
    if (const Beside* other = touching_beside(near)) {
      memory_.back().faces = 2;
      memory_.back().normal[1] = other->contact.normal;
      memory_.back().lambda_beside_N = other->contact.lambda_n;
    }
  }
  std::sort(memory_.begin(), memory_.end(), [](const Memory& a, const Memory& b) { return a.particle < b.particle; });
}

int BodyConstraints::touching() const {
  return static_cast<int>(
      std::count_if(near_.begin(), near_.end(), [](const Near& near) { return near.touch != Touch::none; }));
}

}  // namespace toile::internal
