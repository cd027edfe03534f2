// body/motion.cpp: motions by name, and how they begin.
#include "body/motion.hpp"

#include "body/mannequin_shape.hpp"
#include "body/movements.hpp"
#include "core/elementary.hpp"
#include "core/error.hpp"

#include <fmt/printf.h>

#include <cmath>
#include <cstdio>

namespace toile::internal {

namespace {

constexpr std::array<std::string_view, 6> known_motions = {"stand", "sway", "walk", "twist", "crouch", "dance"};
constexpr std::array<std::string_view, 3> without_skeleton = {"stand", "sway", "twist"};
constexpr double longest_lead_in_s = 10, full_turn = 6.283185307179586;
// The smooth minimum over six points lies below the lowest one; the sole is so much less deep in the floor.
constexpr double soles_above_m = 0.004;

}  // namespace

std::span<const std::string_view> motion_names() { return known_motions; }

std::span<const std::string_view> motion_names_without_skeleton() { return without_skeleton; }

Motion Motion::named(std::string_view name, MannequinKind kind) {
  Motion m;
  if (name == "stand") {
    m.motion_ = stand_posture;
  } else if (name == "sway") {
    m.motion_ = sway_posture;
    m.period_s_ = sway_period_s;
  } else if (name == "walk") {
    m.motion_ = walk_posture;
    m.period_s_ = walk_period_s;
    m.legs_ = Legs::free;
  } else if (name == "twist") {
    m.motion_ = twist_posture;
    m.period_s_ = twist_period_s;
  } else if (name == "crouch") {
    m.motion_ = crouch_posture;
    m.period_s_ = crouch_period_s;
  } else if (name == "dance") {
    m.motion_ = dance_posture;
    m.period_s_ = dance_period_s;
  } else {
    throw InputError("", "motion",
                     "stand, sway, walk, twist, crouch or dance (did you mean " +
                         std::string(nearest_name(name, known_motions.data(), known_motions.size())) + "?)",
                     printable(name));
  }
  m.name_ = name;
  m.kind_ = kind;
  m.joints_ = mannequin_joints(mannequin_form(kind));
  if (m.legs_ == Legs::free) m.level_pelvis();
  return m;
}

void Motion::set_lead_in_s(double seconds) {
  if (!(seconds >= 0 && seconds <= longest_lead_in_s))
    throw InputError("", "lead-in", "0 to 10 s", fmt::sprintf("%g", seconds));
  lead_in_s_ = seconds;
}

double Motion::share_at(double t_s) const {
  return lead_in_s_ > 0 ? least_jerk(t_s / lead_in_s_) : (t_s < 0 ? 0.0 : 1.0);
}

Posture Motion::posture(double t_s) const {
  const double share = share_at(t_s);
  if (share == 0) return {};
  Posture p = motion_(t_s - lead_in_s_);
  if (share < 1) blend(p, share);
  return p;
}

void Motion::blend(Posture& p, double share) const {
  const Posture full = p;
  p.scale(share);
  if (!level_) return;
  for (const Side side : {Side::left, Side::right}) {
    const double pitch = full(Channel::leg_forward, side) - full(Channel::pelvis_tilt) - full(Channel::knee, side) +
                         full(Channel::ankle, side);
    p(Channel::ankle, side) += share * (share - 1.0) * pitch;
  }
}

void Motion::level_pelvis() {
  constexpr int samples = 96;
  for (int k = 0; k < samples; ++k) {
    const double share = static_cast<double>(k) / samples, angle = 2 * full_turn * share;
    const double y = make_pose(motion_(share * period_s_), legs_, joints_).root_m.y();
    height_[0] += y / samples;
    height_[1] += 2 * y * ieee_cos(angle) / samples;
    height_[2] += 2 * y * ieee_sin(angle) / samples;
  }
  height_[0] += soles_above_m;
  level_ = true;
}

double Motion::level_height(double t_s) const {
  const double angle = 2 * full_turn * (t_s / period_s_ - std::floor(t_s / period_s_));
  return height_[0] + height_[1] * ieee_cos(angle) + height_[2] * ieee_sin(angle);
}

Pose Motion::at(double t_s) const {
  Pose pose = make_pose(posture(t_s), legs_, joints_);
  const double share = share_at(t_s);
  if (level_) pose.root_m.y() = share * share * level_height(t_s - lead_in_s_);
  return pose;
}

}  // namespace toile::internal
