#include "rig/mend_jumps.hpp"

#include "core/error.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

constexpr double fastest_deg_per_s = 8000, spread_s = 0.05, flickers_s = 0.25;

double degrees_between(const Quaternion& a, const Quaternion& b) {
  const double sign = a.dot(b) < 0 ? -1 : 1;
  const Quaternion apart{b.w * sign - a.w, b.v * sign - a.v}, along{b.w * sign + a.w, b.v * sign + a.v};
  return 4 * ieee_atan2(std::sqrt(apart.dot(apart)), std::sqrt(along.dot(along))) * 180 / std::numbers::pi;
}

// The way from a to b that stays nearest to rest: of quaternions since rest with w >= 0 half of a sphere, in which great arcs stay.  From a leg
// that is turned outwards by 100 degrees to one turned inwards by 90 it leads through the leg to the front, not the shorter way through the back.
Quaternion way_through_rest(const Quaternion& rest, Quaternion a, Quaternion b, double u) {
  if (rest.dot(a) < 0) a = {-a.w, -a.v};
  if (rest.dot(b) < 0) b = {-b.w, -b.v};
  const Quaternion sum{a.w + b.w, a.v + b.v};
  if (!(sum.dot(sum) > 1e-12)) return slerp(a, b, u);  // both half a turn from rest, and opposite
  const Quaternion middle = sum.normalised();
  return u < 0.5 ? slerp(a, middle, 2 * u) : slerp(middle, b, 2 * u - 1);
}

// From the frame before the first jump to the one after the last, of one node.
void spread(const Quaternion& rest, std::size_t node, std::size_t first_jump, std::size_t last_jump, PoseTrack& track) {
  const auto reach = static_cast<std::size_t>(std::max(1.0, std::round(spread_s * track.rate_hz)));
  const std::size_t first = first_jump > reach ? first_jump - reach : 0;
  const std::size_t last = std::min(last_jump + 1 + reach, track.poses.size() - 1);
  const Quaternion from = track.poses[first].nodes[node].turn, to = track.poses[last].nodes[node].turn;
  for (std::size_t f = first + 1; f < last; ++f)
    track.poses[f].nodes[node].turn =
        way_through_rest(rest, from, to, static_cast<double>(f - first) / static_cast<double>(last - first));
}

}  // namespace

void mend_jumps(const Figure& figure, PoseTrack& track, std::vector<std::string>& notes) {
  const double farthest = fastest_deg_per_s / track.rate_hz;
  const auto flickers = static_cast<std::size_t>(std::round(flickers_s * track.rate_hz));
  for (std::size_t node = 0; node < figure.nodes.size(); ++node) {
    std::vector<std::size_t> jumps;
    for (std::size_t f = 0; f + 1 < track.poses.size(); ++f)
      if (degrees_between(track.poses[f].nodes[node].turn, track.poses[f + 1].nodes[node].turn) > farthest)
        jumps.push_back(f);
    if (jumps.empty()) continue;
    for (std::size_t k = 0; k < jumps.size();) {
      const std::size_t first = jumps[k];
      while (k + 1 < jumps.size() && jumps[k + 1] - jumps[k] <= flickers) ++k;
      spread(figure.rest.nodes[node].turn, node, first, jumps[k], track);
      ++k;
    }
    notes.push_back(fmt::sprintf("\"%s\" turns faster than any joint can at %.3f s%s: smoothed over 0.1 s%s",
                                 printable(figure.nodes[node].name), static_cast<double>(jumps[0]) / track.rate_hz,
                                 jumps.size() > 1 ? " and " + std::to_string(jumps.size() - 1) + " times more" : "",
                                 jumps.size() > 1 ? ", and what is between two within 0.25 s" : ""));
  }
}

}  // namespace toile::internal
