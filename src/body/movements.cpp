// body/movements.cpp: standing, swaying, walking, twisting, crouching.
//
// The walk's hip, knee and ankle follow the curves of level walking at natural cadence [Winter, Biomechanics and Motor
// Control of Human Movement, 4th ed. 2009, ch. 3; Perry & Burnfield, Gait Analysis, 2nd ed. 2010, chs. 4-6], five
// harmonics each.  Curves of the books, put on a skeleton, do not keep a sole on the floor under a pelvis that moves
// smoothly; so all coefficients together were fitted by us: least squares of the distance of the standing foot's sole from the
// floor (scale 2 mm) while the pelvis goes by one sinusoid of twice per stride, of that foot's speed against the belt's
// (0.06 m/s), and of the distance from the books' curves (hip and ankle 1.3, knee 2 degrees).  They end at 2.8, 1.7 and
// 2.1 degrees rms from them.  Pelvis, trunk and arms: amplitudes from the same books, one harmonic each.
#include "body/movements.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {

namespace {

constexpr double two_pi = 6.28318530717958647692;

struct Harmonic {
  double cosine, sine;
};

template <std::size_t n>
struct Series {
  double mean;
  std::array<Harmonic, n> harmonics;

  // `phase` in cycles.
  double operator()(double phase) const {
    double sum = mean;
    for (std::size_t k = 0; k < n; ++k) {
      const double angle = two_pi * static_cast<double>(k + 1) * phase;
      sum += harmonics[k].cosine * ieee_cos(angle) + harmonics[k].sine * ieee_sin(angle);
    }
    return sum;
  }
};

// Degrees against the phase of the stride, which starts with the heel's strike.
constexpr Series<5> hip_flexion{9.83, {{{19.81, -6.09}, {-3.68, -1.26}, {-1.48, 0.63}, {-0.58, 0.05}, {-0.26, 0.11}}}};
constexpr Series<5> knee_in_gait{23.98,
                                 {{{-3.84, -21.21}, {-11.95, 6.90}, {-1.52, 3.23}, {-0.18, 0.34}, {-0.17, -0.02}}}};
constexpr Series<5> ankle_dorsiflexion{0.13,
                                       {{{-2.70, 5.90}, {2.53, -7.22}, {-2.92, 0.27}, {2.29, -0.34}, {0.10, -1.35}}}};
constexpr Series<5> toe_extension{11.34, {{{-10.25, -9.59}, {5.94, 7.14}, {0.00, -4.89}, {-1.02, 2.21}, {1.48, 0.51}}}};

double wave(double phase) { return ieee_cos(two_pi * phase); }

}  // namespace

double least_jerk(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}

Posture stand_posture(double) { return {}; }

Posture sway_posture(double t_s) {
  const double phase = t_s / sway_period_s;
  const double side = wave(phase - 0.25), twice = wave(2 * phase);  // +1: over the left foot; twice a period
  Posture p;
  p(Channel::pelvis_x) = 0.045 * side;
  p(Channel::pelvis_y) = -0.014 - 0.004 * twice;
  p(Channel::pelvis_list) = 3.0 * side;
  p(Channel::pelvis_turn) = 3.0 * wave(phase);
  p(Channel::spine_left) = 3.0 * side;
  p(Channel::chest_left) = 2.0 * side;
  p(Channel::chest_turn) = -4.0 * wave(phase - 0.05);
  p(Channel::neck_left) = -2.0 * side;
  for (const Side s : {Side::left, Side::right}) {
    const double sign = s == Side::left ? 1.0 : -1.0;
    p(Channel::arm_out, s) = -18.0 + 4.0 * sign * side;
    p(Channel::arm_forward, s) = 5.0 * sign * wave(phase - 0.1);
    p(Channel::elbow, s) = 14.0 + 3.0 * twice;
  }
  return p;
}

Posture walk_posture(double t_s) {
  const double phase = t_s / walk_period_s;  // of the left leg
  Posture p;
  const double over = wave(phase - 0.20);  // +1: weight on the left foot
  const double turn = -4.5 * wave(phase), list = 3.5 * over, sway_m = 0.016 * over;
  p(Channel::pelvis_x) = sway_m;
  p(Channel::pelvis_turn) = turn;
  p(Channel::pelvis_list) = list;
  p(Channel::pelvis_tilt) = 2.0;
  p(Channel::spine_turn) = -0.85 * turn;
  p(Channel::chest_turn) = -0.9 * turn;
  p(Channel::neck_turn) = 0.75 * turn;
  p(Channel::spine_left) = 0.5 * list;  // list lifts the left side; the spine leans back over the standing leg
  p(Channel::chest_left) = 0.4 * list;
  p(Channel::chest_forward) = 1.0;
  for (const Side s : {Side::left, Side::right}) {
    const double own = s == Side::left ? phase : phase + 0.5;
    const double sign = s == Side::left ? 1.0 : -1.0;
    p(Channel::leg_forward, s) = hip_flexion(own) + 2.0;  // the pelvis tilts forwards
    p(Channel::knee, s) = knee_in_gait(own);
    p(Channel::ankle, s) = ankle_dorsiflexion(own);
    p(Channel::toes, s) = toe_extension(own);
    // The leg stays upright seen from the front and points ahead while the pelvis lists, turns and sways.
    p(Channel::leg_out, s) = -2.2 - sign * (list + sway_m / 0.87 * 360.0 / two_pi);
    p(Channel::leg_turn, s) = -sign * turn;
    p(Channel::arm_out, s) = -19.0;
    p(Channel::arm_forward, s) = 1.0 - 12.5 * wave(own - 0.02);
    p(Channel::elbow, s) = 22.0 - 9.0 * wave(own - 0.05);
  }
  return p;
}

Posture twist_posture(double t_s) {
  const double phase = t_s / twist_period_s;
  const double turn = wave(phase - 0.25), late = wave(phase - 0.33);
  Posture p;
  p(Channel::pelvis_y) = -0.016;
  p(Channel::pelvis_turn) = 9.0 * turn;
  p(Channel::spine_turn) = 14.0 * turn;
  p(Channel::chest_turn) = 17.0 * turn;
  p(Channel::neck_turn) = -14.0 * turn;
  p(Channel::pelvis_x) = 0.010 * turn;
  for (const Side s : {Side::left, Side::right}) {
    const double sign = s == Side::left ? 1.0 : -1.0;
    p(Channel::collar, s) = 6.0;
    p(Channel::arm_out, s) = 29.0;
    p(Channel::arm_across, s) = 4.0 + 5.0 * sign * late;
    p(Channel::elbow, s) = 10.0 - 4.0 * sign * late;
  }
  return p;
}

// Down, a rest, up, a rest.  At its lowest the skin passes through itself wherever the body folds: forearm and upper arm, upper
// arm and trunk, thigh and belly, calf and thigh.
Posture crouch_posture(double t_s) {
  constexpr double way_s = 1.2, low_s = 0.8;
  const double t = t_s - crouch_period_s * std::floor(t_s / crouch_period_s);
  const double share = least_jerk(t / way_s) - least_jerk((t - way_s - low_s) / way_s);
  Posture p;
  p(Channel::pelvis_y) = -0.016 - 0.54 * share;
  p(Channel::pelvis_z) = -0.15 * share;
  p(Channel::pelvis_tilt) = 25.0 * share;
  p(Channel::spine_forward) = 20.0 * share;
  p(Channel::neck_forward) = -15.0 * share;
  for (const Side s : {Side::left, Side::right}) {
    p(Channel::foot_turn, s) = 15.0 * share;  // knees apart
    p(Channel::arm_out, s) = -34.0 * share;
    p(Channel::arm_forward, s) = 80.0 * share;
    p(Channel::elbow, s) = 145.0 * share;
  }
  return p;
}

}  // namespace toile::internal
