// api/hands.cpp: pins, hands, and a body that the caller moves.
#include "api/implementation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile {
namespace {

// Share of an advance() that counts as its end: the last step ends exactly at the target, although its time is a rounded sum.
constexpr double arrived_share = 1 - 1e-9;

void require_particle(std::int32_t particle, std::size_t count) {
  if (particle < 0 || static_cast<std::size_t>(particle) >= count)
    throw internal::InputError("", "particles", "numbers from 0 to " + std::to_string(count - 1),
                               std::to_string(particle));
}

template <class Held>
auto place_of(std::vector<Held>& held, std::int32_t particle) {
  return std::lower_bound(held.begin(), held.end(), particle,
                          [](const Held& one, std::int32_t p) { return one.particle < p; });
}

}  // namespace

internal::Vec3 Simulation::Implementation::along(const Way& way, double t_s) const {
  const double share = (t_s - interaction.from_s) / interaction.length_s;
  if (share >= arrived_share) return way.to;
  return way.from + std::max(0.0, share) * (way.to - way.from);
}

const internal::JoinedColliders::Part& Simulation::Implementation::collider(int number) const {
  const auto all = engine->colliders();
  if (all.empty()) throw internal::Error(internal::ErrorKind::usage, "there is no body");
  if (number < 0 || static_cast<std::size_t>(number) >= all.size())
    throw internal::InputError("", "collider", "a number from 0 to " + std::to_string(all.size() - 1),
                               std::to_string(number));
  return all[static_cast<std::size_t>(number)];
}

void Simulation::Implementation::tell(internal::OutfitRun& run) {
  internal::Events& events = run.events();
  events.pins.resize(scene_pins);
  for (const Held& held : interaction.held) {
    internal::TimedPin timed;
    timed.pin.particle = held.particle;
    timed.pin.on_body = held.on_body;
    timed.pin.path = [this, particle = held.particle](double t_s) {
      return along(place_of(interaction.held, particle)->way, t_s);
    };
    events.pins.push_back(std::move(timed));
  }
  events.drags.resize(scene_drags);
  for (const Hand& hand : interaction.hands) {
    internal::TimedDrag timed;
    timed.drag.particle = hand.particle;
    timed.drag.weight = hand.weight;
    timed.drag.stiffness_N_per_m = hand.stiffness_N_per_m;
    timed.drag.damping_N_s_per_m = hand.damping_N_s_per_m;
    timed.drag.max_force_N = hand.max_force_N;
    timed.drag.target = [this, number = hand.number](double t_s) {
      const auto known = std::find_if(interaction.hands.begin(), interaction.hands.end(),
                                      [&](const Hand& other) { return other.number == number; });
      return along(known->way, t_s);
    };
    timed.to_s = std::numeric_limits<double>::infinity();
    events.drags.push_back(std::move(timed));
  }
}

void Simulation::Implementation::start_motion(internal::OutfitRun& run) {
  if (interaction.moves || (!engine->motion() && interaction.body_to.empty())) return;
  interaction.moves = true;
  interaction.moves_from_s = run.time_s();
  lead_body(run);
}

void Simulation::Implementation::lead_body(internal::OutfitRun& run) {
  run.start_motion([this](double since_s, std::span<internal::Vec3> x) { lead(since_s, x); });
}

// Colliders with a motion follow it; the others move as the caller says.
void Simulation::Implementation::lead(double since_s, std::span<internal::Vec3> x) const {
  if (const auto& motion = engine->motion()) motion->at.function()(since_s, x);
  if (interaction.body_to.empty()) return;
  const double t_s = interaction.moves_from_s + since_s;
  for (const internal::JoinedColliders::Part& part : engine->colliders())
    for (std::size_t i = part.first_vertex; !part.moves && i < part.first_vertex + part.vertices; ++i)
      x[i] = along({interaction.body_from[i], interaction.body_to[i]}, t_s);
}

void Simulation::Implementation::arrived() {
  for (Held& held : interaction.held) held.way.from = held.way.to;
  for (Hand& hand : interaction.hands) hand.way.from = hand.way.to;
  interaction.body_from = interaction.body_to;
}

void Simulation::Implementation::update_body() {
  body_x.assign(engine->body_x().begin(), engine->body_x().end());
  if (!interaction.body_to.empty()) body_x = interaction.body_from;
  if (interaction.moves) lead(engine->live().time_s() - interaction.moves_from_s, body_x);
}

void Simulation::pin(std::span<const std::int32_t> particles) {
  translated([&] {
    Implementation& own = *implementation_;
    internal::OutfitRun& run = own.live("pin");
    const internal::Vec3s& x = own.state().x;
    for (const std::int32_t particle : particles) require_particle(particle, x.size());
    for (const std::int32_t particle : particles) {
      const internal::Vec3& here = x[static_cast<std::size_t>(particle)];
      auto& held = own.interaction.held;
      const auto place = place_of(held, particle);
      if (place == held.end() || place->particle != particle)
        held.insert(place, {particle, {here, here}});
      else if (place->on_body)
        *place = {particle, {here, here}};
    }
    own.tell(run);
  });
}

void Simulation::attach(std::span<const std::int32_t> particles) {
  translated([&] {
    Implementation& own = *implementation_;
    internal::OutfitRun& run = own.live("attach");
    own.collider(0);  // throws without a body
    const internal::Vec3s& x = own.state().x;
    for (const std::int32_t particle : particles) require_particle(particle, x.size());
    for (const std::int32_t particle : particles) {
      const internal::Vec3& here = x[static_cast<std::size_t>(particle)];
      auto& held = own.interaction.held;
      const auto place = place_of(held, particle);
      Implementation::Held one{particle, {here, here}, internal::attach(*own.engine->body(), here)};
      if (place == held.end() || place->particle != particle)
        held.insert(place, std::move(one));
      else
        *place = std::move(one);
    }
    own.tell(run);
  });
}

void Simulation::move_pins(std::span<const std::int32_t> particles, std::span<const Point> to_m) {
  translated([&] {
    Implementation& own = *implementation_;
    own.live("move_pins");
    if (particles.size() != to_m.size())
      throw internal::InputError("", "to_m", std::to_string(particles.size()) + " places, one for each particle",
                                 std::to_string(to_m.size()));
    auto& held = own.interaction.held;
    for (std::size_t k = 0; k < particles.size(); ++k) {
      require_finite("to_m", to_m[k]);
      const auto place = place_of(held, particles[k]);
      if (place == held.end() || place->particle != particles[k] || place->on_body)
        throw internal::InputError("", "particles", "particles that are pinned", std::to_string(particles[k]));
    }
    for (std::size_t k = 0; k < particles.size(); ++k) place_of(held, particles[k])->way.to = engine_vector(to_m[k]);
  });
}

void Simulation::release(std::span<const std::int32_t> particles) {
  translated([&] {
    Implementation& own = *implementation_;
    internal::OutfitRun& run = own.live("release");
    for (const std::int32_t particle : particles) require_particle(particle, own.state().x.size());
    std::erase_if(own.interaction.held, [&](const Implementation::Held& held) {
      return std::find(particles.begin(), particles.end(), held.particle) != particles.end();
    });
    own.tell(run);
  });
}

std::vector<std::int32_t> Simulation::pinned() const {
  std::vector<std::int32_t> particles;
  for (const auto& held : implementation_->interaction.held) particles.push_back(held.particle);
  return particles;
}

int Simulation::grab(const Grip& grip) {
  return translated([&] {
    Implementation& own = *implementation_;
    internal::OutfitRun& run = own.live("grab");
    const auto& triangles = own.mesh().triangles;
    if (grip.face < 0 || static_cast<std::size_t>(grip.face) >= triangles.size())
      throw internal::InputError("", "face", "a number from 0 to " + std::to_string(triangles.size() - 1),
                                 std::to_string(grip.face));
    double sum = 0;
    for (const double b : grip.barycentric) sum += b;
    if (!(std::abs(sum - 1) < 1e-6))
      throw internal::InputError("", "barycentric", "three shares that add up to 1", std::to_string(sum));
    require_above_zero("stiffness_N_per_m", grip.stiffness_N_per_m);
    require_at_least_zero("damping_N_s_per_m", grip.damping_N_s_per_m);
    if (!(grip.max_force_N > 0))  // it may be infinite
      throw internal::InputError("", "max_force_N", "a force above zero", std::to_string(grip.max_force_N));
    Implementation::Hand hand;
    hand.number = own.interaction.hands_ever++;
    hand.particle = triangles[static_cast<std::size_t>(grip.face)];
    hand.weight = grip.barycentric;
    hand.stiffness_N_per_m = grip.stiffness_N_per_m;
    hand.damping_N_s_per_m = grip.damping_N_s_per_m;
    hand.max_force_N = grip.max_force_N;
    internal::Vec3 here = internal::Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      here += hand.weight[k] * own.state().x[static_cast<std::size_t>(hand.particle[k])];
    hand.way = {here, here};
    own.interaction.hands.push_back(hand);
    own.tell(run);
    return static_cast<int>(hand.number);
  });
}

namespace {

template <class Hands>
auto hand_of(Hands& hands, int number) {
  const auto known = std::find_if(hands.begin(), hands.end(), [&](const auto& hand) { return hand.number == number; });
  if (known == hands.end())
    throw internal::InputError("", "hand", "the number of a hand that holds the cloth", std::to_string(number));
  return known;
}

}  // namespace

void Simulation::drag(int hand, const Point& to_m) {
  translated([&] {
    require_finite("to_m", to_m);
    hand_of(implementation_->interaction.hands, hand)->way.to = engine_vector(to_m);
  });
}

void Simulation::let_go(int hand) {
  translated([&] {
    Implementation& own = *implementation_;
    own.interaction.hands.erase(hand_of(own.interaction.hands, hand));
    own.tell(own.engine->live());
  });
}

void Simulation::set_collider(int collider, std::span<const Point> vertices_m) {
  translated([&] {
    Implementation& own = *implementation_;
    own.live("set_body");
    const internal::JoinedColliders::Part& part = own.collider(collider);
    if (part.moves) throw internal::Error(internal::ErrorKind::usage, "set_body: this body has a motion of its own");
    if (vertices_m.size() != part.vertices)
      throw internal::InputError("", "vertices_m", std::to_string(part.vertices) + " vertices",
                                 std::to_string(vertices_m.size()));
    for (const Point& p : vertices_m) require_finite("vertices_m", p);
    if (own.interaction.body_from.empty()) own.interaction.body_from = own.interaction.body_to = own.body_x;
    const auto to = engine_vectors(vertices_m);
    std::copy(to.begin(), to.end(), own.interaction.body_to.begin() + static_cast<std::ptrdiff_t>(part.first_vertex));
  });
}

void Simulation::set_friction(int collider, double friction) {
  translated([&] {
    require_at_least_zero("friction", friction);
    implementation_->collider(collider);
    implementation_->live("set_friction").set_friction(collider, friction);
  });
}

void Simulation::set_stiffness(std::int32_t panel, const Stiffness& share) {
  translated([&] {
    implementation_->live("set_stiffness").set_stiffness(panel, {share.stretch, share.shear, share.bend});
  });
}

void Simulation::set_pressure(std::int32_t panel, double Pa) {
  translated([&] {
    require_pressure("Pa", Pa);
    implementation_->live("set_pressure").set_pressure(panel, Pa);
  });
}

void Simulation::set_gravity(const Point& m_per_s2) {
  translated([&] {
    require_finite("m_per_s2", m_per_s2);
    implementation_->live("set_gravity").set_gravity(engine_vector(m_per_s2));
  });
}

void Simulation::set_wind(const Point& m_per_s) {
  translated([&] {
    require_finite("m_per_s", m_per_s);
    implementation_->live("set_wind").set_wind(engine_vector(m_per_s));
  });
}

}  // namespace toile
