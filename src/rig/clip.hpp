// rig/clip.hpp: an animation as keys in time, and the pose of a figure at a time.
//
// A channel moves one property of one node; between keys t_k and t_k+1, with u in [0, 1] and d = t_k+1 - t_k:
//   step      the value at t_k
//   linear    straight; of a turn along the shorter arc
//   cubic     (2u^3 - 3u^2 + 1) v_k + d (u^3 - 2u^2 + u) b_k + (3u^2 - 2u^3) v_k+1 + d (u^3 - u^2) a_k+1,
//             each key with its tangents a (in) and b (out); a turn is normalised after that
// Before the first key and after the last the value is theirs; what no channel moves is at rest.
#pragma once
#include "rig/figure.hpp"

#include <string>
#include <vector>

namespace toile::internal {

struct ClipChannel {
  enum class Moves { translation, turn, scale, weights };
  enum class Between { step, linear, cubic };
  Index node = 0;
  Moves moves = Moves::translation;
  Between between = Between::linear;
  std::vector<double> times;   // s, ascending
  std::vector<double> values;  // [key][in, value, out: cubic alone][component]; a turn is x y z w
};

struct Clip {
  std::string name;
  std::vector<ClipChannel> channels;
  double begin_s = 0, end_s = 0;  // of the keys of all channels
};

FigurePose pose_at(const Clip& clip, const Figure& figure, double t_s);

}  // namespace toile::internal
