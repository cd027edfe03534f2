#include "rig/clip.hpp"

#include <algorithm>
#include <array>

namespace toile::internal {
namespace {

using Moves = ClipChannel::Moves;
using Between = ClipChannel::Between;

// Between which keys a time lies, and where.
struct Place {
  std::size_t key = 0, next = 0;
  double u = 0, seconds = 0;
};
Place place_in(const std::vector<double>& times, double t) {
  const auto after = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin());
  if (after == 0) return {};
  if (after == times.size()) return {after - 1, after - 1, 0, 0};
  const double from = times[after - 1], seconds = times[after] - from;
  return {after - 1, after, (t - from) / seconds, seconds};
}

Quaternion turn_from(const double* xyzw) { return Quaternion{xyzw[3], Vec3(xyzw[0], xyzw[1], xyzw[2])}.normalised(); }

class Sampler {
 public:
  Sampler(const ClipChannel& channel, std::size_t width, double t)
      : channel_(&channel), width_(width), place_(place_in(channel.times, t)) {}

  double component(std::size_t c) const {
    const double v = value(place_.key)[c];
    if (channel_->between == Between::step || place_.key == place_.next) return v;
    const double w = value(place_.next)[c], u = place_.u;
    if (channel_->between == Between::linear) return v + u * (w - v);
    const double u2 = u * u, u3 = u2 * u, b = value(place_.key)[width_ + c];
    const double a = *(value(place_.next) - width_ + c);
    return (2 * u3 - 3 * u2 + 1) * v + place_.seconds * (u3 - 2 * u2 + u) * b + (3 * u2 - 2 * u3) * w +
           place_.seconds * (u3 - u2) * a;
  }
  Vec3 vector() const { return {component(0), component(1), component(2)}; }
  Quaternion turn() const {
    if (channel_->between == Between::linear)
      return slerp(turn_from(value(place_.key)), turn_from(value(place_.next)), place_.u);
    const std::array<double, 4> xyzw = {component(0), component(1), component(2), component(3)};
    return turn_from(xyzw.data());
  }

 private:
  const double* value(std::size_t key) const {
    const bool cubic = channel_->between == Between::cubic;
    return channel_->values.data() + (cubic ? (3 * key + 1) * width_ : key * width_);
  }

  const ClipChannel* channel_;
  std::size_t width_;
  Place place_;
};

}  // namespace

FigurePose pose_at(const Clip& clip, const Figure& figure, double t_s) {
  FigurePose pose = figure.rest;
  for (const ClipChannel& channel : clip.channels) {
    NodePose& node = pose.nodes[at(channel.node)];
    switch (channel.moves) {
      case Moves::translation:
        node.translation = Sampler(channel, 3, t_s).vector();
        break;
      case Moves::turn:
        node.turn = Sampler(channel, 4, t_s).turn();
        break;
      case Moves::scale:
        node.stretch = Sampler(channel, 3, t_s).vector().asDiagonal();
        break;
      case Moves::weights: {
        const FigureNode& of = figure.nodes[at(channel.node)];
        const Sampler sampler(channel, at(of.weights), t_s);
        for (Index k = 0; k < of.weights; ++k) pose.weights[at(of.first_weight + k)] = sampler.component(at(k));
        break;
      }
    }
  }
  return pose;
}

}  // namespace toile::internal
