// body/dance.cpp: a dance of 13.1 s as keys in time: a reach, leg lifts to the side and front, a turn and a fast spin.
//
// Each channel runs from key to key on the path of least jerk and rests at each; between keys of equal value it holds.
// The spin takes 0.94 s for one turn, so that its fastest moment is 1.875 / 0.94 = 2 turns a second.
#include "body/movements.hpp"

#include <cmath>
#include <initializer_list>
#include <vector>

namespace toile::internal {

namespace {

struct Key {
  double t_s, value;
};

struct Track {
  Channel channel;
  bool on_left, on_right;
  std::vector<Key> keys;  // ascending; 0 before the first and after the last, which are 0
};

constexpr double spin_from_s = 9.95, spin_s = 0.94;

const std::vector<Track>& tracks() {
  using enum Channel;
  static const std::vector<Track> all = {
      // Down a little all the time, so that no knee is stretched; deeper before the lifts and the spin.
      {pelvis_y,
       true,
       false,
       {{0.0, -0.018},
        {0.5, -0.055},
        {1.2, -0.026},
        {4.1, -0.026},
        {4.6, -0.045},
        {5.2, -0.018},
        {9.0, -0.018},
        {9.7, -0.065},
        {10.3, -0.020},
        {11.2, -0.018},
        {11.8, -0.040},
        {12.5, -0.018},
        {13.1, -0.018}}},
      // Weight over the right foot, over the left, over the middle.
      {pelvis_x,
       true,
       false,
       {{1.0, 0},
        {1.8, -0.085},
        {4.1, -0.085},
        {5.1, 0.085},
        {6.9, 0.085},
        {7.6, 0},
        {9.3, 0},
        {9.9, -0.06},
        {10.9, -0.06},
        {11.6, 0}}},
      {turn, true, false, {{7.2, 0}, {9.3, 360}, {spin_from_s, 360}, {spin_from_s + spin_s, 720}, {13.1, 720}}},

      // The lifts: left to the side, right to the front, the left knee up in the spin.
      {leg_out, true, false, {{1.7, 0}, {2.6, 42}, {3.1, 42}, {4.0, 0}, {9.8, 0}, {10.2, 10}, {10.6, 10}, {11.2, 0}}},
      {leg_forward, true, false, {{1.7, 0}, {2.6, 6}, {3.1, 6}, {4.0, 0}, {9.8, 0}, {10.2, 38}, {10.6, 38}, {11.2, 0}}},
      {knee,
       true,
       false,
       {{1.7, 0}, {2.2, 24}, {2.8, 4}, {3.3, 12}, {4.0, 0}, {9.8, 0}, {10.2, 64}, {10.6, 64}, {11.2, 0}}},
      {ankle,
       true,
       false,
       {{2.0, 0}, {2.6, -28}, {3.1, -28}, {3.7, 0}, {9.95, 0}, {10.3, -20}, {10.6, -20}, {10.95, 0}}},
      {leg_forward, false, true, {{5.0, 0}, {5.8, 58}, {6.2, 58}, {7.0, 0}}},
      {leg_out, false, true, {{5.0, 0}, {5.8, 5}, {6.2, 5}, {7.0, 0}}},
      {knee, false, true, {{5.0, 0}, {5.5, 38}, {6.0, 12}, {6.3, 20}, {7.0, 0}}},
      {ankle, false, true, {{5.3, 0}, {5.8, -28}, {6.2, -28}, {6.7, 0}}},
      {pelvis_list, true, false, {{1.7, 0}, {2.6, 5}, {3.1, 5}, {4.0, 0}, {5.0, 0}, {5.8, -3}, {6.2, -3}, {7.0, 0}}},
      {pelvis_tilt, true, false, {{5.0, 0}, {5.8, -7}, {6.2, -7}, {7.0, 0}, {11.0, 0}, {11.7, 5}, {12.6, 0}}},

      // The trunk follows.
      {spine_left, true, false, {{1.7, 0}, {2.6, -4}, {3.1, -4}, {4.0, 0}, {7.2, 0}, {8.2, 6}, {9.2, 0}}},
      {chest_left, true, false, {{0.2, 0}, {0.9, 8}, {1.8, -8}, {3.0, -4}, {4.2, 0}, {7.2, 0}, {8.2, 7}, {9.2, 0}}},
      {chest_turn,
       true,
       false,
       {{0.3, 0},
        {1.0, 12},
        {1.9, -6},
        {3.2, 0},
        {4.3, 14},
        {5.2, -8},
        {6.4, 0},
        {7.2, 10},
        {8.2, -4},
        {9.3, 0},
        {9.8, 16},
        {10.5, -6},
        {11.3, 0}}},
      {spine_forward, true, false, {{4.1, 0}, {4.7, 8}, {5.5, -4}, {6.4, 0}, {10.9, 0}, {11.6, -8}, {12.6, 0}}},
      {chest_forward, true, false, {{4.1, 0}, {4.7, 6}, {5.5, -3}, {6.4, 0}, {10.9, 0}, {11.6, -9}, {12.6, 0}}},
      {neck_left, true, false, {{0.2, 0}, {0.9, 8}, {1.8, -6}, {3.2, 0}, {7.4, 0}, {8.2, 8}, {9.0, 0}}},
      {neck_forward, true, false, {{4.2, 0}, {4.8, 8}, {5.8, -6}, {6.8, 0}, {11.0, 0}, {11.7, -12}, {12.6, 0}}},
      {neck_turn,
       true,
       false,
       {{0.3, 0}, {1.0, -10}, {2.2, 16}, {3.4, 0}, {7.2, 0}, {7.6, 18}, {8.6, 0}, {9.9, 0}, {10.1, -20}, {10.6, 0}}},

      // Arms: out, one up, low and round, wide in the turn, gathered in the spin, high at the end.
      {arm_out,
       true,
       false,
       {{0.0, -14},
        {0.9, 40},
        {1.9, 34},
        {3.1, 42},
        {4.2, 4},
        {4.8, -10},
        {5.7, 30},
        {6.3, 30},
        {7.2, 6},
        {8.1, 38},
        {9.2, 30},
        {9.9, 8},
        {10.8, 8},
        {11.7, 48},
        {12.2, 48},
        {13.1, -14}}},
      {arm_out,
       false,
       true,
       {{0.0, -14},
        {1.2, 30},
        {2.4, 54},
        {3.1, 54},
        {4.3, 4},
        {4.8, -10},
        {5.7, 44},
        {6.3, 44},
        {7.2, 6},
        {8.1, 38},
        {9.2, 30},
        {9.9, 8},
        {10.8, 8},
        {11.7, 48},
        {12.2, 48},
        {13.1, -14}}},
      {collar,
       true,
       false,
       {{0.3, 0},
        {0.9, 6},
        {3.2, 6},
        {4.2, 0},
        {7.4, 0},
        {8.1, 5},
        {9.4, 0},
        {10.9, 0},
        {11.7, 12},
        {12.2, 12},
        {13.0, 0}}},
      {collar,
       false,
       true,
       {{0.3, 0},
        {2.3, 10},
        {3.1, 10},
        {4.2, 0},
        {7.4, 0},
        {8.1, 5},
        {9.4, 0},
        {10.9, 0},
        {11.7, 12},
        {12.2, 12},
        {13.0, 0}}},
      {arm_across,
       true,
       false,
       {{4.0, 0}, {4.8, 18}, {5.7, -4}, {7.0, 0}, {9.3, 0}, {9.95, 34}, {10.7, 34}, {11.4, 0}}},
      {arm_across,
       false,
       true,
       {{4.0, 0}, {4.8, 18}, {5.7, -4}, {7.0, 0}, {9.3, 0}, {9.95, 34}, {10.7, 34}, {11.4, 0}}},
      {arm_forward, true, false, {{4.0, 0}, {4.8, 12}, {5.7, 0}, {9.4, 0}, {9.95, 14}, {10.7, 14}, {11.4, 0}}},
      {arm_forward, false, true, {{4.0, 0}, {4.8, 12}, {5.7, 0}, {9.4, 0}, {9.95, 14}, {10.7, 14}, {11.4, 0}}},
      {elbow,
       true,
       false,
       {{0.0, 16},
        {0.9, 12},
        {1.6, 26},
        {3.1, 12},
        {4.8, 34},
        {5.7, 14},
        {7.3, 30},
        {8.1, 14},
        {9.3, 20},
        {9.95, 84},
        {10.7, 84},
        {11.5, 16},
        {12.2, 24},
        {13.1, 16}}},
      {elbow,
       false,
       true,
       {{0.0, 16},
        {1.2, 20},
        {2.4, 30},
        {3.1, 20},
        {4.8, 34},
        {5.7, 14},
        {7.3, 30},
        {8.1, 14},
        {9.3, 20},
        {9.95, 84},
        {10.7, 84},
        {11.5, 16},
        {12.2, 24},
        {13.1, 16}}},
      {wrist, true, false, {{0.2, 0}, {0.7, 16}, {1.2, -10}, {2.2, 8}, {3.2, 0}, {7.4, 0}, {8.0, -14}, {8.8, 0}}},
      {wrist, false, true, {{0.2, 0}, {1.0, 16}, {1.9, -10}, {2.8, 8}, {3.6, 0}, {7.4, 0}, {8.0, -14}, {8.8, 0}}},

      // Feet closer than in the A-pose: one foot carries.
      {foot_x, true, false, {{0.0, -0.025}, {13.1, -0.025}}},
      {foot_x, false, true, {{0.0, -0.025}, {13.1, -0.025}}},
  };
  return all;
}

double value_at(const std::vector<Key>& keys, double t_s) {
  if (t_s <= keys.front().t_s) return keys.front().value;
  for (std::size_t k = 1; k < keys.size(); ++k) {
    const Key &a = keys[k - 1], &b = keys[k];
    if (t_s < b.t_s) return a.value + (b.value - a.value) * least_jerk((t_s - a.t_s) / (b.t_s - a.t_s));
  }
  return keys.back().value;
}

}  // namespace

Posture dance_posture(double t_s) {
  const double rounds = std::floor(t_s / dance_period_s);
  const double in_round = t_s - rounds * dance_period_s;
  Posture p;
  for (const Track& track : tracks()) {
    const double value = value_at(track.keys, in_round);
    if (track.on_left) p(track.channel, Side::left) = value;
    if (track.on_right) p(track.channel, Side::right) = value;
  }
  p(Channel::turn) += 720.0 * rounds;
  return p;
}

}  // namespace toile::internal
