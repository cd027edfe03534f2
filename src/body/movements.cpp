// body/movements.cpp: standing, swaying, walking, twisting.
//
// The walk's hip, knee and ankle follow the curves of level walking at natural cadence [Winter, Biomechanics and Motor
// Control of Human Movement, 4th ed. 2009, ch. 3; Perry & Burnfield, Gait Analysis, 2nd ed. 2010, chs. 4-6]: values read
// at every 5 to 10 % of the stride, then fitted by us with 5 or 6 harmonics (rms error below 0.4 degrees).  Within the
// published bands hip and ankle are bent so that the standing foot lies flat and runs back evenly, as a belt does.  Pelvis, trunk and
// arms: amplitudes from the same books, one harmonic each.
#include "body/movements.hpp"

#include <algorithm>
#include <cmath>

namespace toile {

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
constexpr Series<5> hip_flexion{12.10,
                                {{{19.95, -4.01}, {-3.19, -1.28}, {-0.52, 0.61}, {-0.41, -0.24}, {-0.10, 0.25}}}};
constexpr Series<5> knee_flexion{23.27,
                                 {{{-2.41, -19.55}, {-13.42, 6.38}, {-1.26, 3.72}, {-0.31, 0.46}, {-0.08, 0.30}}}};
constexpr Series<6> ankle_dorsiflexion{
    -1.05, {{{-1.86, 5.49}, {1.82, -7.60}, {-2.30, 0.55}, {1.91, -0.79}, {-0.07, -0.73}, {0.36, 0.26}}}};
constexpr Series<5> toe_extension{7.95, {{{-6.14, -7.00}, {4.31, 4.60}, {1.16, -4.29}, {-0.68, 0.68}, {0.96, -0.42}}}};

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
  p(Channel::spine_turn) = -1.0 * turn;
  p(Channel::chest_turn) = -1.1 * turn;
  p(Channel::neck_turn) = 1.1 * turn;
  p(Channel::spine_left) = 0.5 * list;  // list lifts the left side; the spine leans back over the standing leg
  p(Channel::chest_left) = 0.4 * list;
  p(Channel::chest_forward) = 1.0;
  for (const Side s : {Side::left, Side::right}) {
    const double own = s == Side::left ? phase : phase + 0.5;
    const double sign = s == Side::left ? 1.0 : -1.0;
    p(Channel::leg_forward, s) = hip_flexion(own) + 2.0;  // the pelvis tilts forwards
    p(Channel::knee, s) = knee_flexion(own);
    p(Channel::ankle, s) = ankle_dorsiflexion(own);
    p(Channel::toes, s) = toe_extension(own);
    // The leg stays upright seen from the front and points ahead while the pelvis lists, turns and sways.
    p(Channel::leg_out, s) = -2.2 - sign * (list + sway_m / 0.87 * 360.0 / two_pi);
    p(Channel::leg_turn, s) = -sign * turn;
    p(Channel::arm_out, s) = -19.0;
    p(Channel::arm_forward, s) = 1.0 - 17.0 * wave(own - 0.02);
    p(Channel::elbow, s) = 22.0 - 11.0 * wave(own - 0.05);
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

}  // namespace toile
