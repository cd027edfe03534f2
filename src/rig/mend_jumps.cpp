#include "rig/mend_jumps.hpp"

#include "core/error.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

constexpr double fastest_deg_per_s = 8000, spread_s = 0.05;

double degrees_between(const Quaternion& a, const Quaternion& b) {
  const double sign = a.dot(b) < 0 ? -1 : 1;
  const Quaternion apart{b.w * sign - a.w, b.v * sign - a.v}, along{b.w * sign + a.w, b.v * sign + a.v};
  return 4 * ieee_atan2(std::sqrt(apart.dot(apart)), std::sqrt(along.dot(along))) * 180 / std::numbers::pi;
}

// Between frame and the one after it, of one node.
void spread(std::size_t node, std::size_t frame, PoseTrack& track) {
  const auto reach = static_cast<std::size_t>(std::max(1.0, std::round(spread_s * track.rate_hz)));
  const std::size_t first = frame > reach ? frame - reach : 0;
  const std::size_t last = std::min(frame + 1 + reach, track.poses.size() - 1);
  const Quaternion from = track.poses[first].nodes[node].turn, to = track.poses[last].nodes[node].turn;
  for (std::size_t f = first + 1; f < last; ++f)
    track.poses[f].nodes[node].turn =
        slerp(from, to, static_cast<double>(f - first) / static_cast<double>(last - first));
}

}  // namespace

void mend_jumps(const Figure& figure, PoseTrack& track, std::vector<std::string>& notes) {
  const double farthest = fastest_deg_per_s / track.rate_hz;
  for (std::size_t node = 0; node < figure.nodes.size(); ++node) {
    std::size_t jumps = 0;
    double first_s = 0;
    for (std::size_t f = 0; f + 1 < track.poses.size(); ++f) {
      if (degrees_between(track.poses[f].nodes[node].turn, track.poses[f + 1].nodes[node].turn) <= farthest) continue;
      if (jumps++ == 0) first_s = static_cast<double>(f) / track.rate_hz;
      spread(node, f, track);
    }
    if (jumps > 0)
      notes.push_back(fmt::sprintf("\"%s\" turns faster than any joint can at %.3f s%s: smoothed over 0.1 s",
                                   printable(figure.nodes[node].name), first_s,
                                   jumps > 1 ? " and " + std::to_string(jumps - 1) + " times more" : ""));
  }
}

}  // namespace toile::internal
