#include "step/body_constraints.hpp"

#include "core/parallel.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double static_over_kinetic = 1.02;  // hysteresis, so that stick and slip do not alternate at the cone
constexpr double largest_alteration = 0.2;    // of the offset, per step
// And shorter steps alter by less, in proportion: else a triangle of 2 mm, of cloth that the weld of a gather has left within the offset,
// is stretched by 7 % in a step however short, and the step collapses.
constexpr double fully_altered_s = 1e-3;
constexpr double deepest = 0.5;       // offsets
constexpr double dead_band = 0.02;    // of the offset
constexpr double deep_share = 0.5;    // of the offset
constexpr double slides_from = 1e-3;  // m/s; slower motion is the settling of what sticks,
constexpr double still_below = 1e-6;  // m/s; and slower than this it has settled
// k_t h^2 / m; in proportion to the mass, or light particles at an edge would reach their cones long before the others.  Tight trousers press
// a particle with 3000 times its weight: its bristle is stretched by 1 mm.  With 1000 it is 10 mm, and such cloth never comes to rest; with
// 10^5 a crease is not at rest, and rounding refuses steps of stiff cloth.
constexpr double bristle_stiffness = 1e4;
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
      lambda_n_(model.mass_kg.size(), 0) {
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
  const double share = near.slid ? 1 : static_over_kinetic;
  const Contact* other = other_face(near);
  return share * (friction(near.contact, near.particle) * near.contact.lambda_n +
                  (other ? friction(*other, near.particle) * other->lambda_n : 0));
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

const BodyConstraints::Memory* BodyConstraints::memory_of(Index particle) const {
  const auto place = std::lower_bound(memory_.begin(), memory_.end(), particle,
                                      [](const Memory& a, Index i) { return a.particle < i; });
  return place != memory_.end() && place->particle == particle ? &*place : nullptr;
}

// The part of u in the tangent plane, or along the crease.
Vec3 BodyConstraints::along_body(Near& near, const Vec3& u) {
  const Vec3& n = near.contact.normal;
  const Contact* other = other_face(near);
  if (!other) return u - n.dot(u) * n;
  const Vec3 along = n.cross(other->normal).normalized();
  return along.dot(u) * along;
}

// u of the bristle: the motion in the step relative to the body.
Vec3 BodyConstraints::way_along_body(Near& near, const Vec3& v, const StepFormula& step) {
  return along_body(near, step.drift(near.particle) + step.weight_s * v - near.contact.body_travel);
}

// A new contact slides: the solve decides whether friction stops it.
void BodyConstraints::touch_down(Near& near, const Vec3& v, const StepFormula& step) {
  Contact& contact = near.contact;
  const Vec3& n = contact.normal;
  near.touch = Touch::slides;
  if (contact.lambda_n <= 0) {
    const double v_n = n.dot(v - contact.body_travel / step.h_s);
    const double stop = -v_n / step.h_s - n.dot(model_->gravity_m_per_s2);
    contact.lambda_n = model_->mass_kg[at(near.particle)] * std::max(0.0, stop);
  }
  const double k_t = bristle_stiffness * model_->mass_kg[at(near.particle)] / (step.weight_s * step.weight_s);
  near.bristle.carry_on(contact.normal, k_t);
  near.way_m = way_along_body(near, v, step);
  near.bristle.decide(near.way_m, cone_N(near));
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
    const Memory* before = memory_of(near.particle);
    near.bristle = before ? before->bristle : Bristle();
    near.slid = !before || before->slid;
    const Vec3 way = step.drift(near.particle) + step.weight_s * (state.v[i] + dv[i]);
    const auto gap = [&](const Contact& c) { return c.point.gap_m + c.normal.dot(way - c.body_travel); };
    if (Beside* beside = this->beside(near))
      beside->touches = beside->slit || beside->touched || gap(beside->contact) < offset_m(beside->contact);
    if (touch_[i] == Touch::none && gap(contact) >= offset_m(contact)) continue;
    touch_down(near, state.v[i] + dv[i], step);
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
    if (other) constraints.hold_along(near.particle, other->normal, other->normal.dot(z(*other)));
    LinearSpring contact;
    contact.particle[0] = near.particle;
    contact.weight[0] = 1;
    contact.direction = n;
    near.bristle.append_springs(contact, near.contact.body_travel, 0, springs);
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
    if (gap < deep_share * r) ++change.deep;
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
  touch_down(near, v, step);
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
    near.way_m = way_along_body(near, v, step);
    const Vec3 friction_N = along_body(near, force);
    const double cone = cone_N(near);
    if (near.touch == Touch::slides) {
      change.slipped += near.bristle.decide(near.way_m, cone) ? 1 : 0;
    } else if (friction_N.norm() > cone) {
      near.touch = Touch::slides;
      near.slipped = true;
      near.bristle.take_over(friction_N, cone);
      near.bristle.decide(near.way_m, cone);
      ++change.slipped;
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
  memory_.clear();
  for (Near& near : near_) {
    const double way_m = near.way_m.norm();
    near.slid = near.touch == Touch::slides && way_m >= slides_from * h_s;
    const bool stopped = near.touch == Touch::slides && !near.slid &&
                         (near.bristle.sticks() || (near.bristle.slips() && way_m < still_below * h_s));
    touch_[at(near.particle)] = stopped ? Touch::sticks : near.touch;
    if (near.touch == Touch::none) continue;
    lambda_n_[at(near.particle)] = near.contact.lambda_n;
    near.bristle.end(near.way_m, cone_N(near));
    memory_.push_back({near.particle, 1, {near.contact.normal, Vec3::Zero()}, 0, near.slid, near.bristle});
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
