// body/motion.cpp: motions by name, and how they begin.
#include "body/motion.hpp"

#include "body/mannequin_shape.hpp"
#include "body/movements.hpp"
#include "core/elementary.hpp"
#include "core/error.hpp"

#include <cmath>
#include <cstdio>

namespace toile {

namespace {

constexpr std::array<std::string_view, 5> names = {"stand", "sway", "walk", "twist", "dance"};
constexpr double longest_lead_in_s = 10, two_pi = 6.283185307179586;

}  // namespace

std::span<const std::string_view> motion_names() { return names; }

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
  } else if (name == "dance") {
    m.motion_ = dance_posture;
    m.period_s_ = dance_period_s;
  } else {
    throw InputError("", "motion",
                     "stand, sway, walk, twist or dance (did you mean " +
                         std::string(nearest_name(name, names.data(), names.size())) + "?)",
                     printable(name));
  }
  m.name_ = name;
  m.kind_ = kind;
  m.joints_ = mannequin_joints(mannequin_form(kind));
  if (m.legs_ == Legs::free) m.level_pelvis();
  return m;
}

void Motion::set_lead_in_s(double seconds) {
  if (!(seconds >= 0 && seconds <= longest_lead_in_s)) {
    char got[32];
    std::snprintf(got, sizeof got, "%g", seconds);
    throw InputError("", "lead-in", "0 to 10 s", got);
  }
  lead_in_s_ = seconds;
}

double Motion::share_at(double t_s) const {
  return lead_in_s_ > 0 ? least_jerk(t_s / lead_in_s_) : (t_s < 0 ? 0.0 : 1.0);
}

Posture Motion::posture(double t_s) const {
  const double share = share_at(t_s);
  if (share == 0) return {};
  Posture p = motion_(t_s - lead_in_s_);
  if (share < 1) p.scale(share);
  return p;
}

void Motion::level_pelvis() {
  constexpr int samples = 96;
  for (int k = 0; k < samples; ++k) {
    const double share = static_cast<double>(k) / samples;
    const double y = make_pose(motion_(share * period_s_), legs_, joints_).root_m.y();
    height_[0] += y / samples;
    for (const std::size_t harmonic : {std::size_t{2}, std::size_t{4}}) {
      const double angle = two_pi * static_cast<double>(harmonic) * share;
      height_[harmonic - 1] += 2 * y * ieee_cos(angle) / samples;
      height_[harmonic] += 2 * y * ieee_sin(angle) / samples;
    }
  }
  level_ = true;
}

double Motion::level_height(double t_s) const {
  const double angle = two_pi * (t_s / period_s_ - std::floor(t_s / period_s_));
  return height_[0] + height_[1] * ieee_cos(2 * angle) + height_[2] * ieee_sin(2 * angle) +
         height_[3] * ieee_cos(4 * angle) + height_[4] * ieee_sin(4 * angle);
}

Pose Motion::at(double t_s) const {
  Pose pose = make_pose(posture(t_s), legs_, joints_);
  const double share = share_at(t_s), in_motion_s = t_s - lead_in_s_;
  if (level_ && share > 0) {
    const double by_soles = share < 1 ? make_pose(motion_(in_motion_s), legs_, joints_).root_m.y() : pose.root_m.y();
    pose.root_m.y() += share * (level_height(in_motion_s) - by_soles);
  }
  return pose;
}

}  // namespace toile
