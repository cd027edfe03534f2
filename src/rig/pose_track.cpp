#include "rig/pose_track.hpp"

#include "core/error.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::internal {
namespace {

// A node's pose is 128 bytes: 1 GiB.
constexpr double most_node_poses = 1 << 23;

// Weights of the poses before, at, next and after for u between at and next.
using Weights = std::array<double, 4>;
Weights catmull_rom(double u, bool first, bool last) {
  const double r = 1 - u, h10 = u * r * r, h11 = -u * u * r;
  const double m0 = first ? 1.0 : 0.5, m1 = last ? 1.0 : 0.5;
  Weights w = {0, (1 + 2 * u) * r * r, u * u * (3 - 2 * u), 0};
  w[2] += m0 * h10;
  w[first ? 1 : 0] -= m0 * h10;
  w[last ? 2 : 3] += m1 * h11;
  w[1] -= m1 * h11;
  return w;
}

template <class Part>
auto sum(const std::array<const FigurePose*, 4>& poses, const Weights& w, const Part& part) {
  auto total = part(*poses[0]);
  total *= w[0];
  for (std::size_t k = 1; k < 4; ++k) total += w[k] * part(*poses[k]);
  return total;
}

Quaternion turn_among(const std::array<const FigurePose*, 4>& poses, const Weights& w, std::size_t node) {
  const Quaternion& at = poses[1]->nodes[node].turn;
  Quaternion total{0, Vec3::Zero()};
  for (std::size_t k = 0; k < 4; ++k) {
    const Quaternion& q = poses[k]->nodes[node].turn;
    const double weight = at.dot(q) < 0 ? -w[k] : w[k];
    total.w += weight * q.w;
    total.v += weight * q.v;
  }
  return total.normalised();
}

}  // namespace

void check_track_size(double poses, std::size_t nodes, std::string_view file) {
  const double most = std::floor(most_node_poses / std::max(1.0, static_cast<double>(nodes)));
  if (!(poses <= most))
    throw InputError(file, "motion", fmt::sprintf("at most %.0f poses of %d joints", most, nodes),
                     fmt::sprintf("%.6g", poses));
}

PoseTrack track_of(const Clip& clip, const Figure& figure, double rate_hz, std::string_view file) {
  const double seconds = clip.end_s - clip.begin_s, steps = std::max(1.0, std::round(seconds * rate_hz));
  check_track_size(steps + 1, figure.nodes.size(), file);
  PoseTrack track;
  if (!(seconds > 0)) {
    track.rate_hz = rate_hz;
    track.poses.push_back(pose_at(clip, figure, clip.begin_s));
    return track;
  }
  track.rate_hz = steps / seconds;
  for (double k = 0; k <= steps; ++k) track.poses.push_back(pose_at(clip, figure, clip.begin_s + k / steps * seconds));
  return track;
}

FigurePose pose_at(const PoseTrack& track, double t_s) {
  const std::size_t count = track.poses.size();
  if (count == 1) return track.poses.front();
  const std::size_t intervals = count - 1;
  double place = std::max(t_s, 0.0) * track.rate_hz;
  const auto all = static_cast<double>(intervals);
  place = track.loops ? place - all * std::floor(place / all) : std::min(place, all);
  const auto i = std::min(static_cast<std::size_t>(place), intervals - 1);
  const double u = place - static_cast<double>(i);
  if (u == 0) return track.poses[i];
  const bool first = !track.loops && i == 0, last = !track.loops && i + 1 == intervals;
  const std::size_t before = i > 0 ? i - 1 : (track.loops ? intervals - 1 : 0);
  const std::size_t next = track.loops ? (i + 1) % intervals : i + 1;
  const std::size_t after = track.loops ? (i + 2) % intervals : std::min(i + 2, intervals);
  const std::array<const FigurePose*, 4> poses = {&track.poses[before], &track.poses[i], &track.poses[next],
                                                  &track.poses[after]};
  const Weights w = catmull_rom(u, first, last);
  FigurePose pose = track.poses[i];
  for (std::size_t n = 0; n < pose.nodes.size(); ++n) {
    pose.nodes[n].translation = sum(poses, w, [&](const FigurePose& p) { return Vec3(p.nodes[n].translation); });
    pose.nodes[n].stretch = sum(poses, w, [&](const FigurePose& p) { return Mat3(p.nodes[n].stretch); });
    pose.nodes[n].turn = turn_among(poses, w, n);
  }
  for (std::size_t m = 0; m < pose.weights.size(); ++m)
    pose.weights[m] = sum(poses, w, [&](const FigurePose& p) { return p.weights[m]; });
  return pose;
}

FigurePose between(const FigurePose& from, const FigurePose& to, double share) {
  if (share >= 1) return to;
  if (share <= 0) return from;
  FigurePose pose = from;
  for (std::size_t n = 0; n < pose.nodes.size(); ++n) {
    NodePose& node = pose.nodes[n];
    const NodePose& end = to.nodes[n];
    node.translation += share * (end.translation - node.translation);
    node.stretch += share * (end.stretch - node.stretch);
    node.turn = slerp(node.turn, end.turn, share);
  }
  for (std::size_t m = 0; m < pose.weights.size(); ++m) pose.weights[m] += share * (to.weights[m] - pose.weights[m]);
  return pose;
}

}  // namespace toile::internal
