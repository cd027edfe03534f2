#include "step/contact_rows.hpp"

#include "core/stopwatch.hpp"
#include "step/tangents.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace toile {
namespace {

constexpr double rest_share = 0.45;     // of the shortest rest edge: pairs that are neighbours at rest do not repel
constexpr double stiffness_factor = 1;  // c
constexpr double load_share = 0.1;      // of r: how far the load of the last step may press the spring
constexpr double most_growth =
    10;  // a hit in a short step is a huge load for a moment, and would leave a stiffness that no solver likes
constexpr double slowest_slip = 1e-3;  // m/s

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

double drift_along(const LinearSpring& spring, const StepFormula& step) {
  return step.drift_m.empty() ? 0 : along(spring, step.drift_m);
}

}  // namespace

ContactRows::ContactRows(const ClothModel& model, const BodySurface* body, std::span<const Index> merged_particle,
                         double body_offset_m, double body_friction, const ContactRowOptions& options)
    : model_(&model),
      body_(body),
      body_r_m_(options.body_share * body_offset_m),
      body_friction_(body_friction),
      options_(options),
      reach_m_(model.thickness_m),
      topology_(model.mass_kg.size(), model.mesh.triangles, model.topology, merged_particle) {
  scale_.assign(reach_m_.size(), 1);
  measure_reach();
}

void ContactRows::measure_reach() {
  rest_version_ = model_->rest_version;
  std::vector<double> shortest(reach_m_.size(), std::numeric_limits<double>::infinity());
  const ClothMesh& mesh = model_->mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec2 b(model_->membrane[t].b_u, model_->membrane[t].b_v);
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = b.cwiseProduct(mesh.uv[t][(k + 1) % 3] - mesh.uv[t][k]).norm();
      for (const Index corner : mesh.triangles[t]) shortest[at(corner)] = std::min(shortest[at(corner)], length);
    }
  }
  for (std::size_t i = 0; i < reach_m_.size(); ++i)
    reach_m_[i] = std::min(model_->thickness_m[i], rest_share * shortest[i]);
  set_thickness_scale(std::vector<double>(scale_));
}

void ContactRows::set_thickness_scale(std::span<const double> scale) {
  contact_m_.resize(reach_m_.size());
  for (std::size_t i = 0; i < reach_m_.size(); ++i) {
    scale_[i] = scale.empty() ? 1 : scale[i];
    contact_m_[i] = scale_[i] * reach_m_[i];
  }
}

Vec3 ContactRows::relative_velocity(const Pair& pair, const Vec3s& v, double h_s) const {
  Vec3 sum = -pair.body_travel_m / h_s;
  for (std::size_t k = 0; k < 4; ++k) {
    if (pair.spring.particle[k] >= 0) sum += pair.spring.weight[k] * v[at(pair.spring.particle[k])];
  }
  return sum;
}

void ContactRows::detect(const ClothState& state, double h_s) {
  pairs_.clear();
  h_s_ = h_s;
  if (rest_version_ != model_->rest_version) measure_reach();
  if (tree_.triangle_count() == 0) tree_ = TriangleTree(state.x, model_->mesh.triangles);
  // How far ahead pairs are watched does not shrink with a thinned r: how fast they close has nothing to do with it.
  double thickest = 0;
  for (std::size_t i = 0; i < reach_m_.size(); ++i) thickest = std::max({thickest, reach_m_[i], contact_m_[i]});
  const double r_max = std::max(options_.cloth_cloth ? thickest : 0, body_ ? body_r_m_ : 0);
  const double range = (1 + options_.look_ahead) * r_max;

  if (options_.cloth_cloth) {
    const Timed timed(cloth_seconds);
    find_cloth_contacts(topology_, tree_, state.x, {range, 0, options_.region_tolerance}, workspace_, cloth_contacts_);
    for (const ClothContact& contact : cloth_contacts_) {
      double r = std::numeric_limits<double>::infinity(), full = r, friction = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        if (contact.particle[k] < 0) continue;
        const std::size_t i = at(contact.particle[k]);
        full = std::min(full, reach_m_[i]);
        r = std::min(r, contact_m_[i]);
        friction = std::max(friction, model_->friction[at(contact.particle[k])]);
      }
      if (r <= 0) continue;  // contact is switched off here
      Pair pair{{contact.kind,
                 false,
                 {contact.particle[0], contact.particle[1], contact.particle[2], contact.particle[3], -1}},
                {},
                contact.gap_m,
                r,
                friction};
      pair.spring.particle = contact.particle;
      pair.spring.weight = contact.weight;
      pair.spring.direction = contact.normal;
      const double closing = std::max(0.0, -contact.normal.dot(relative_velocity(pair, state.v, h_s))) * h_s;
      if (contact.gap_m <
          r + std::min(options_.look_ahead * std::max(r, full), closing + h_s * h_s * model_->gravity_m_per_s2.norm()))
        pairs_.push_back(pair);
    }
  }
  if (body_) {
    const Timed timed(body_seconds);
    find_body_contacts(topology_, tree_, state.x, *body_, {range, 4 * body_r_m_, options_.region_tolerance}, workspace_,
                       body_contacts_);
    for (const BodyContact& contact : body_contacts_) {
      Pair pair{{contact.kind,
                 true,
                 {contact.particle[0], contact.particle[1], contact.particle[2], contact.body_vertex[0],
                  contact.body_vertex[1]}},
                {},
                contact.gap_m,
                body_r_m_,
                body_friction_};
      for (std::size_t k = 0; k < 3; ++k) {
        pair.spring.particle[k] = contact.particle[k];
        pair.spring.weight[k] = contact.weight[k];
      }
      pair.spring.direction = contact.normal;
      pair.body_parameter = contact.body_parameter;
      pairs_.push_back(pair);
    }
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) { return a.key < b.key; });
}

void ContactRows::begin(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step, double base_h_s,
                        std::span<const Mat3> diagonal) {
  auto memory = memory_.begin();
  for (Pair& pair : pairs_) {
    LinearSpring& spring = pair.spring;
    if (pair.key.body) {
      const Index first = pair.key.feature[3], second = pair.key.feature[4];
      pair.body_travel_m = body_->vertex_travel(first);
      if (second >= 0) pair.body_travel_m += pair.body_parameter * (body_->vertex_travel(second) - pair.body_travel_m);
      spring.body_displacement_m = spring.direction.dot(pair.body_travel_m);
    }
    double inverse_mass = 0, elastic = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (spring.particle[k] < 0) continue;
      const std::size_t i = at(spring.particle[k]);
      const double w2 = spring.weight[k] * spring.weight[k];
      inverse_mass += w2 / model_->mass_kg[i];
      elastic +=
          w2 * (spring.direction.dot(diagonal[i] * spring.direction) - model_->mass_kg[i]);  // h^2 k_n (and damping)
    }
    const double h = base_h_s;
    spring.stiffness_N_per_m =
        stiffness_factor * (1 / inverse_mass + elastic * (h * h) / (step.weight_s * step.weight_s)) / (h * h);
    pair.lambda_N = 0;
    pair.slip_m_per_s.setZero();
    while (memory != memory_.end() && memory->key < pair.key) ++memory;
    const bool lived = memory != memory_.end() && memory->key == pair.key;
    if (lived) {
      pair.lambda_N = memory->lambda_N;
      pair.slip_m_per_s = memory->slip_m_per_s;
      const double load = std::min(memory->lambda_N / (load_share * pair.r_m), most_growth * spring.stiffness_N_per_m);
      spring.stiffness_N_per_m = std::max({spring.stiffness_N_per_m, memory->stiffness, load});
    }
    spring.damping_N_s_per_m = options_.damping_s * spring.stiffness_N_per_m;
    spring.force_N = spring.stiffness_N_per_m * (pair.r_m - pair.gap_m);
    const double predicted = pair.gap_m + step.weight_s * (along(spring, state.v) + along(spring, dv)) -
                             spring.body_displacement_m + drift_along(spring, step);
    pair.active = lived || predicted < pair.r_m;
  }
}

void ContactRows::append_springs(const ClothState& state, double h_s, std::vector<LinearSpring>& springs) const {
  (void)state;
  for (const Pair& pair : pairs_) {
    if (!pair.active) continue;
    springs.push_back(pair.spring);
    if (pair.friction <= 0 || pair.lambda_N <= 0) continue;
    const double drag = std::min(pair.spring.stiffness_N_per_m * h_s,
                                 pair.friction * pair.lambda_N / std::max(pair.slip_m_per_s.norm(), slowest_slip));
    for (const Vec3& t : tangents(pair.spring.direction)) {
      LinearSpring friction = pair.spring;
      friction.direction = t;
      friction.force_N = friction.stiffness_N_per_m = 0;
      friction.body_displacement_m = t.dot(pair.body_travel_m);
      friction.damping_N_s_per_m = drag;
      springs.push_back(friction);
    }
  }
}

ContactRows::Change ContactRows::update(const ClothState& state, std::span<const Vec3> dv, std::span<const Vec3> y,
                                        const StepFormula& step, bool may_drop) {
  Change change;
  for (Pair& pair : pairs_) {
    const LinearSpring& spring = pair.spring;
    pair.predicted_m = pair.gap_m + step.weight_s * (along(spring, state.v) + along(spring, dv)) + along(spring, y) -
                       spring.body_displacement_m + drift_along(spring, step);
    if (pair.active && pair.predicted_m > pair.r_m && may_drop) {
      pair.active = false;
      ++change.dropped;
    } else if (!pair.active && pair.predicted_m < 0.98 * pair.r_m) {
      pair.active = true;
      ++change.added;
    }
    change.active += pair.active ? 1 : 0;
  }
  return change;
}

bool ContactRows::changed() const {
  auto memory = memory_.begin();
  for (const Pair& pair : pairs_) {
    if (!pair.active) continue;
    if (memory == memory_.end() || memory->key != pair.key) return true;
    ++memory;
  }
  return memory != memory_.end();
}

void ContactRows::accept(const ClothState& end_state) {
  memory_.clear();
  for (const Pair& pair : pairs_) {
    if (!pair.active) continue;
    const Vec3 velocity = relative_velocity(pair, end_state.v, h_s_);
    const Vec3& n = pair.spring.direction;
    memory_.push_back({pair.key, pair.spring.stiffness_N_per_m,
                       pair.spring.stiffness_N_per_m * std::max(0.0, pair.r_m - pair.predicted_m),
                       velocity - n.dot(velocity) * n});
  }
}

int ContactRows::active() const {
  return static_cast<int>(std::count_if(pairs_.begin(), pairs_.end(), [](const Pair& pair) { return pair.active; }));
}

}  // namespace toile
