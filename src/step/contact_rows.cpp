#include "step/contact_rows.hpp"

#include "core/parallel.hpp"
#include "core/stopwatch.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr std::size_t pair_grain = 64;
constexpr double load_share = 0.1;  // of r: how far the load of the last step may press the spring
constexpr double most_growth =
    10;  // an impact in a short step is a huge load for a moment, and would leave an ill-conditioned stiffness
// But layers cannot be pressed flat: when nearer than this they get stiffer from step to step, until they bear the load.
constexpr double flat = 0.02;  // of r
constexpr double hardens_by = 2, most_hardening = 1000;
// A bristle is dropped when its contact has been open for more steps than this, or by more of r.
constexpr int most_idle_steps = 2;
constexpr double idle_gap = 1.5;
constexpr double most_of_faces = 3;  // stiffness of a row with a face, over the inverse compliance of its pair
constexpr double same_way = 0.9, too_near = 0.1;  // cosine; of r
constexpr double moves_on = 0.5;  // of r: motion of a pair in a step above which its end matters more than its start
constexpr double at_rest = 0.04;  // of r: motion of a pair in a step up to which it does not slide
constexpr double same_side =
    0.7;  // cosine between the normals of a contact before and after its vertex came to another face

// The vertices that own the contact; -1: none.  Edges that slide over edges make new contacts all the time.
std::array<Index, 2> vertices_of(ContactKind kind, bool body, const std::array<Index, 5>& feature) {
  if (body || kind == ContactKind::edge_edge) return {-1, -1};
  return {feature[0], kind == ContactKind::vertex_vertex ? feature[1] : Index{-1}};
}

double drift_along(const LinearSpring& spring, const StepFormula& step) {
  return step.drift_m.empty() ? 0 : along(spring, step.drift_m);
}

}  // namespace

ContactRows::ContactRows(const ClothModel& model, const BodySurface* body, std::span<const Index> merged_particle,
                         const BodyContactOptions& body_contact, const ContactRowOptions& options)
    : model_(&model),
      body_(body),
      body_contact_(body_contact),
      largest_body_r_m_(options.body_share * body_contact.largest_offset_m()),
      options_(options),
      topology_(model.mass_kg.size(), model.mesh.triangles, model.topology, merged_particle),
      distance_(model, topology_) {}

Vec3 ContactRows::relative_velocity(const Pair& pair, const Vec3s& v, double h_s) const {
  Vec3 sum = -pair.body_travel_m / h_s;
  for (std::size_t k = 0; k < 4; ++k) {
    if (pair.spring.particle[k] >= 0) sum += pair.spring.weight[k] * v[at(pair.spring.particle[k])];
  }
  return sum;
}

double ContactRows::friction_of(std::span<const Index> particles) const {
  double friction = 0;
  for (const Index i : particles)
    if (i >= 0) friction = std::max(friction, model_->friction[at(i)]);
  return friction;
}

// Rest lengths may have changed; the hierarchy is that of the first positions.
void ContactRows::ready_for(std::span<const Vec3> x) {
  distance_.update(*model_, topology_);
  if (tree_.triangle_count() == 0) tree_ = TriangleTree(x, model_->mesh.triangles);
}

LayerGap ContactRows::layer_gap(std::span<const Vec3> x) {
  ready_for(x);
  ProximityOptions options;
  options.range_m = layer_gap_reach * distance_.largest_m();
  find_cloth_contacts(topology_, tree_, x, options, workspace_, cloth_contacts_);
  return measure_layer_gap(cloth_contacts_, distance_, x.size());
}

void ContactRows::detect(const ClothState& state, double h_s) {
  pairs_.clear();
  h_s_ = h_s;
  ready_for(state.x);
  // The look-ahead does not shrink with a thinned r: it depends on the closing speed only.
  const double r_max = std::max(options_.cloth_cloth ? distance_.largest_m() : 0, body_ ? largest_body_r_m_ : 0);
  const double range = (1 + options_.look_ahead) * r_max;

  if (options_.cloth_cloth) {
    const Timed timed(cloth_seconds);
    find_acting_edges();
    find_cloth_contacts(topology_, tree_, state.x, {range, 0, options_.region_tolerance, acting_edges_}, workspace_,
                        cloth_contacts_, &near_);
    for (const ClothContact& contact : cloth_contacts_) {
      if (!pinched_.empty() && all_pinched(contact.particle, pinched_)) continue;
      const auto [full, r] = distance_.between(contact.kind, contact.particle);
      if (r <= 0) continue;  // contact is switched off here
      const std::size_t other = contact.kind == ContactKind::edge_edge ? 2 : 1;
      const double friction =
          model_->friction_between(contact.particle[0], contact.particle[other], friction_of(contact.particle));
      Pair pair{{contact.kind,
                 false,
                 {contact.particle[0], contact.particle[1], contact.particle[2], contact.particle[3], -1}},
                {},
                contact.gap_m,
                r,
                friction};
      pair.spring.particle = contact.particle;
      pair.spring.weight = contact.weight;
      pair.spring.direction = pair.normal = contact.normal;
      pair.weight = contact.weight;
      const double closing = std::max(0.0, -contact.normal.dot(relative_velocity(pair, state.v, h_s))) * h_s;
      if (contact.gap_m <
          r + std::min(options_.look_ahead * std::max(r, full), closing + h_s * h_s * model_->gravity_m_per_s2.norm()))
        pairs_.push_back(pair);
    }
  }
  if (body_) {
    const Timed timed(body_seconds);
    find_body_contacts(topology_, tree_, state.x, *body_, {range, 4 * largest_body_r_m_, options_.region_tolerance},
                       workspace_, body_contacts_);
    for (const BodyContact& contact : body_contacts_) {
      if (!pinched_.empty() && all_pinched(contact.particle, pinched_)) continue;
      const Index collider = body_->collider_of_vertex(contact.body_vertex[0]);
      Pair pair{{contact.kind,
                 true,
                 {contact.particle[0], contact.particle[1], contact.particle[2], contact.body_vertex[0],
                  contact.body_vertex[1]}},
                {},
                contact.gap_m,
                options_.body_share * body_contact_.offset_of(collider),
                body_contact_.friction_of(collider, friction_of(contact.particle))};
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

// At rest, a row of two edges that presses a fold flat would vanish in the next step, as the edges are then flat; the fold would rise, and the
// row return, for ever.  Where edges slide over each other the row has to go: flat sheets would catch on it.
void ContactRows::find_acting_edges() {
  acting_edges_.clear();
  for (const Memory& memory : memory_) {
    if (memory.key.body || memory.key.kind != ContactKind::edge_edge || !memory.rests) continue;
    acting_edges_.push_back({memory.key.feature[0], memory.key.feature[1]});
    acting_edges_.push_back({memory.key.feature[2], memory.key.feature[3]});
  }
}

void ContactRows::begin(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step, double base_h_s,
                        std::span<const Mat3> diagonal) {
  auto memory = memory_.begin();
  kept_.assign(memory_.size(), 0);
  parallel_for(pairs_.size(), pair_grain,
               [&](std::size_t p) { place(pairs_[p], state, dv, step, base_h_s, diagonal); });
  for (Pair& pair : pairs_) {
    LinearSpring& spring = pair.spring;
    while (memory != memory_.end() && memory->key < pair.key) ++memory;
    const bool known = memory != memory_.end() && memory->key == pair.key;
    const bool lived = known && memory->idle_steps == 0;
    if (lived) {
      double most = most_growth * spring.stiffness_N_per_m;
      if (!pair.key.body && pair.gap_m < flat * pair.r_m)
        most = std::max(most, std::min(hardens_by * memory->stiffness, most_hardening * spring.stiffness_N_per_m));
      const double load = std::min(memory->lambda_N / (load_share * pair.r_m), most);
      spring.stiffness_N_per_m = std::max({spring.stiffness_N_per_m, memory->stiffness, load});
    }
    spring.damping_N_s_per_m = options_.damping_s * spring.stiffness_N_per_m;
    spring.force_N = spring.stiffness_N_per_m * (pair.r_m - pair.gap_m);
    const double predicted = pair.gap_m + step.weight_s * (along(spring, state.v) + along(spring, dv)) -
                             spring.body_displacement_m + drift_along(spring, step);
    pair.active = !pair.passes_by && (lived || predicted < pair.r_m);
    pair.lambda_N = 0;
    pair.loaded = false;
    pair.bristle = {};
    pair.idle_steps = most_idle_steps;
    if (known) carry_on(pair, static_cast<std::size_t>(memory - memory_.begin()));
  }
  take_over_contacts();
}

// Sets the pair's position, the direction of its spring, and its least stiffness.
void ContactRows::place(Pair& pair, const ClothState& state, std::span<const Vec3> dv, const StepFormula& step,
                        double base_h_s, std::span<const Mat3> diagonal) const {
  LinearSpring& spring = pair.spring;
  if (!pair.key.body && pair.key.kind != ContactKind::vertex_face) aim_at_the_end(pair, state, dv, step);
  const double to_base = (base_h_s * base_h_s) / (step.weight_s * step.weight_s);  // h^2 K, of the frame's own step
  double inverse_mass = 0, elastic_kg = 0, compliance = 0;
  pair.start_m.setZero();
  for (std::size_t k = 0; k < 4; ++k) {
    if (spring.particle[k] < 0) continue;
    const std::size_t i = at(spring.particle[k]);
    const double m = model_->mass_kg[i], w2 = spring.weight[k] * spring.weight[k];
    const Mat3 elastic = to_base * (diagonal[i] - m * Mat3::Identity());
    const Vec3& n = spring.direction;
    pair.start_m += spring.weight[k] * state.x[i];
    inverse_mass += w2 / m;
    elastic_kg += w2 * n.dot(elastic * n);
    compliance += w2 * n.dot((m * Mat3::Identity() + elastic).inverse() * n);
  }
  double effective_kg = 1 / inverse_mass + elastic_kg;
  if (!pair.key.body) {
    const bool face = pair.key.kind == ContactKind::vertex_face;
    effective_kg = std::min(effective_kg, (face ? most_of_faces : 1) / compliance);
  }
  spring.stiffness_N_per_m = effective_kg / (base_h_s * base_h_s);
  if (!pair.key.body) {
    pair.gap_m = spring.direction.dot(pair.start_m);
    return;
  }
  const Index first = pair.key.feature[3], second = pair.key.feature[4];
  pair.body_travel_m = body_->vertex_travel(first);
  if (second >= 0) pair.body_travel_m += pair.body_parameter * (body_->vertex_travel(second) - pair.body_travel_m);
  spring.body_displacement_m = spring.direction.dot(pair.body_travel_m);
}

// A contact continues with its load and friction.
void ContactRows::carry_on(Pair& pair, std::size_t memory) {
  const Memory& before = memory_[memory];
  kept_[memory] = 1;
  pair.loaded = before.idle_steps == 0;
  pair.lambda_N = pair.loaded ? before.lambda_N : 0;
  pair.idle_steps = before.idle_steps;
  pair.bristle = before.bristle;
  pair.bristle.carry_on(pair.spring.direction, pair.spring.stiffness_N_per_m);
  pair.bristle.decide(before.way_m, pair.friction * pair.lambda_N);
}

// The normal of two edges, or of a vertex and an edge, turns while they pass each other: the hem of a sliding sheet comes to lie over the
// vertices in front of it, and a row along the direction to them would be a wall.  Such a row takes its normal from the end of the step,
// as far as it is known.
void ContactRows::aim_at_the_end(Pair& pair, const ClothState& state, std::span<const Vec3> dv,
                                 const StepFormula& step) const {
  LinearSpring& spring = pair.spring;
  spring.direction = pair.normal;
  spring.weight = pair.weight;
  pair.passes_by = false;
  std::array<Vec3, 4> end;
  Vec3 way = Vec3::Zero();
  for (std::size_t k = 0; k < 4 && spring.particle[k] >= 0; ++k) {
    const std::size_t i = at(spring.particle[k]);
    const Vec3 moved = step.drift(spring.particle[k]) + step.weight_s * (state.v[i] + dv[i]);
    end[k] = state.x[i] + moved;
    way += pair.weight[k] * moved;
  }
  // A pair that hardly moves does not pass, and needs no guess of its end.
  if (way.norm() < moves_on * pair.r_m) return;
  std::array<double, 4> weight = pair.weight;
  if (pair.key.kind == ContactKind::edge_edge) {
    EdgeEdge closest;
    if (!interior_edge_edge(end[0], end[1], end[2], end[3], closest)) return;
    weight = {1 - closest.s, closest.s, closest.t - 1, -closest.t};
  } else if (pair.key.kind == ContactKind::vertex_edge) {
    const Vec3 edge = end[2] - end[1];
    const double t = std::clamp((end[0] - end[1]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    weight = {1, t - 1, -t, 0};
  }
  Vec3 between = Vec3::Zero();
  for (std::size_t k = 0; k < 4 && spring.particle[k] >= 0; ++k) between += weight[k] * end[k];
  const double distance = between.norm(), turned = between.dot(pair.normal);
  if (distance >= pair.r_m) {  // other pairs have taken over, unless it only moved away
    pair.passes_by = turned < same_way * distance;
    return;
  }
  // Through each other, or too near for a reliable direction: keep the normal of the start.
  if (turned <= 0 || distance < too_near * pair.r_m) return;
  spring.weight = weight;
  spring.direction = between / distance;
}

// A vertex that moves to the next face, or to the edge between two, gets another pair, which continues the same contact.
void ContactRows::take_over_contacts() {
  orphans_.clear();
  for (std::size_t m = 0; m < memory_.size(); ++m) {
    if (kept_[m] != 0) continue;
    for (const Index vertex : vertices_of(memory_[m].key.kind, memory_[m].key.body, memory_[m].key.feature)) {
      if (vertex >= 0) orphans_.push_back({vertex, m});
    }
  }
  if (orphans_.empty()) return;
  std::sort(orphans_.begin(), orphans_.end());
  for (Pair& pair : pairs_) {
    if (pair.bristle.begun()) continue;
    for (const Index vertex : vertices_of(pair.key.kind, pair.key.body, pair.key.feature)) {
      if (vertex < 0 || pair.bristle.begun()) continue;
      auto orphan = std::lower_bound(orphans_.begin(), orphans_.end(), Orphan{vertex, 0});
      const auto fits = [&] {
        return kept_[orphan->memory] == 0 && memory_[orphan->memory].normal.dot(pair.spring.direction) >= same_side;
      };
      while (orphan != orphans_.end() && orphan->vertex == vertex && !fits()) ++orphan;
      if (orphan == orphans_.end() || orphan->vertex != vertex) continue;
      // At rest the next pair is as stiff as this one was: else the vertex would move back until the same load has its old gap.
      const Memory& before = memory_[orphan->memory];
      if (before.rests) {
        LinearSpring& spring = pair.spring;
        spring.stiffness_N_per_m = std::max(spring.stiffness_N_per_m, before.stiffness);
        spring.damping_N_s_per_m = options_.damping_s * spring.stiffness_N_per_m;
        spring.force_N = spring.stiffness_N_per_m * (pair.r_m - pair.gap_m);
      }
      carry_on(pair, orphan->memory);
    }
  }
}

void ContactRows::append_springs(std::vector<LinearSpring>& springs) const {
  for (const Pair& pair : pairs_) {
    if (!pair.active) continue;
    springs.push_back(pair.spring);
    if (pair.friction > 0) pair.bristle.append_springs(pair.spring, pair.body_travel_m, options_.damping_s, springs);
  }
}

ContactRows::Change ContactRows::update(const ClothState& state, std::span<const Vec3> dv, std::span<const Vec3> y,
                                        const StepFormula& step, bool may_drop) {
  Change change;
  for (Pair& pair : pairs_) {
    const LinearSpring& spring = pair.spring;
    Vec3 way = -pair.body_travel_m;
    for (std::size_t k = 0; k < 4; ++k) {
      if (spring.particle[k] < 0) continue;
      const std::size_t i = at(spring.particle[k]);
      way += spring.weight[k] * (step.weight_s * (state.v[i] + dv[i]) + y[i] + step.drift(spring.particle[k]));
    }
    const Vec3& n = spring.direction;
    pair.predicted_m = pair.gap_m + n.dot(way);
    if (pair.active && pair.predicted_m > pair.r_m && may_drop) {
      pair.active = false;
      ++change.dropped;
    } else if (!pair.active && !pair.passes_by && pair.predicted_m < 0.98 * pair.r_m) {
      pair.active = true;
      ++change.added;
    }
    change.active += pair.active ? 1 : 0;
    if (!pair.active || pair.friction <= 0) continue;
    if (!pair.bristle.begun()) pair.bristle.carry_on(n, spring.stiffness_N_per_m);
    if (!pair.loaded) pair.lambda_N = spring.stiffness_N_per_m * std::max(0.0, pair.r_m - pair.predicted_m);
    change.turned_back += pair.bristle.decide(way - n.dot(way) * n, pair.friction * pair.lambda_N) ? 1 : 0;
  }
  return change;
}

bool ContactRows::changed() const {
  auto memory = memory_.begin();
  const auto skip_idle = [&] {
    while (memory != memory_.end() && memory->idle_steps > 0) ++memory;
  };
  skip_idle();
  for (const Pair& pair : pairs_) {
    if (!pair.active) continue;
    if (memory == memory_.end() || memory->key != pair.key) return true;
    ++memory;
    skip_idle();
  }
  return memory != memory_.end();
}

void ContactRows::accept(const ClothState& end_state) {
  memory_.clear();
  for (const Pair& pair : pairs_) {
    const int idle = pair.active ? 0 : pair.idle_steps + 1;
    if (idle > most_idle_steps || (idle > 0 && pair.predicted_m > idle_gap * pair.r_m)) continue;
    Vec3 way = -pair.start_m - pair.body_travel_m;
    for (std::size_t k = 0; k < 4; ++k) {
      if (pair.spring.particle[k] >= 0) way += pair.spring.weight[k] * end_state.x[at(pair.spring.particle[k])];
    }
    const Vec3& n = pair.spring.direction;
    way -= n.dot(way) * n;
    const double k = pair.spring.stiffness_N_per_m, lambda = k * std::max(0.0, pair.r_m - pair.predicted_m);
    const bool rests = idle == 0 && way.norm() < at_rest * pair.r_m;
    memory_.push_back({pair.key, k, lambda, pair.bristle, way, n, idle, rests});
    Bristle& bristle = memory_.back().bristle;
    // An open contact keeps its stretch: it may close again at once.
    if (idle == 0 && bristle.begun()) bristle.end(way, pair.friction * lambda);
  }
}

double ContactRows::stored_J() const {
  double sum = 0;
  for (const Memory& memory : memory_) {
    if (memory.idle_steps == 0) sum += memory.lambda_N * memory.lambda_N / (2 * memory.stiffness);
  }
  return sum;
}

int ContactRows::active() const {
  return static_cast<int>(std::count_if(pairs_.begin(), pairs_.end(), [](const Pair& pair) { return pair.active; }));
}

}  // namespace toile::internal
