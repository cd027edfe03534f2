// body/motion.cpp: motions by name, and how they begin.
#include "body/motion.hpp"

#include "body/mannequin_shape.hpp"
#include "body/movements.hpp"
#include "core/error.hpp"

#include <cmath>
#include <cstdio>

namespace toile {

namespace {

constexpr std::array<std::string_view, 5> names = {"stand", "sway", "walk", "twist", "dance"};
constexpr double longest_lead_in_s = 10;

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

Posture Motion::posture(double t_s) const {
  const double share = lead_in_s_ > 0 ? least_jerk(t_s / lead_in_s_) : (t_s < 0 ? 0.0 : 1.0);
  if (share == 0) return {};
  Posture p = motion_(t_s - lead_in_s_);
  if (share < 1) p.scale(share);
  return p;
}

Pose Motion::at(double t_s) const { return make_pose(posture(t_s), legs_, joints_); }

}  // namespace toile
