// body/movements.hpp: the postures of each motion over time, without a beginning or an end.
//
// Every function has the period beside it; `turn` of dance_posture grows by 720 degrees in each.
#pragma once
#include "body/posture.hpp"

namespace toile::internal {

constexpr double walk_period_s = 1.06;   // a stride: two steps
constexpr double twist_period_s = 1.25;  // 0.8 Hz
constexpr double sway_period_s = 2.8;
constexpr double crouch_period_s = 4;
constexpr double dance_period_s = 13.1;  // 393 frames at 30 per second

// u^3 (10 - 15 u + 6 u^2), held at 0 and 1 outside [0, 1]: C2, the path of least jerk between two rests
// [Flash & Hogan, The coordination of arm movements, J. Neurosci. 5(7), 1985].  Its slope is at most 1.875.
double least_jerk(double u);

Posture stand_posture(double t_s);
Posture sway_posture(double t_s);
Posture walk_posture(double t_s);
Posture twist_posture(double t_s);
Posture crouch_posture(double t_s);
Posture dance_posture(double t_s);

}  // namespace toile::internal
