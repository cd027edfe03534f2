#include "body/arm_clearance.hpp"

#include "contact/body_surface.hpp"
#include "rig/feet.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace toile::internal {
namespace {

constexpr double whole_weight = 0.999, no_weight = 0.001;  // shares of a vertex's weights: rounding apart
constexpr double wedge = 0.15;                             // an arm at 45 degrees at rest, hanging at 6
constexpr double deepest_share = 0.1;                      // of the height: farther within it no surface of a body is
constexpr double step_deg = 2, exact_deg = 0.05, largest_deg = 40;
constexpr double smooth_s = 0.2;  // T: a fifth of a swing of the arm
constexpr double told_deg = 0.1;
constexpr std::array<std::string_view, 2> side_names = {"left", "right"};

struct Point {
  Vec3 x{0, 0, 0};
  double room = 0;
};

// What is to be clear, and the joint that is turned away from the trunk.
struct Stage {
  bool upper_arm_alone;
  BodyPart away;
};
constexpr std::array<Stage, 2> stages = {{{true, BodyPart::forearm}, {false, BodyPart::hand}}};

class Clearing {
 public:
  Clearing(const PosedBody& body, const PersonBones& bones, const Stage& stage, double room_m)
      : body_(&body), bones_(&bones), stage_(stage), x_(body.vertices.size()) {
    for (std::size_t side = 0; side < 2; ++side) {
      share_[side] = shares(bones.of(BodyPart::upper_arm, side));
      beyond_[side] = shares(bones.of(BodyPart::forearm, side));
    }
    take_trunk();
    set_pose(body.figure->rest);
    double low = x_.front().y(), high = low;
    for (const Vec3& p : x_) {
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
    reach_ = deepest_share * (high - low);
    for (std::size_t side = 0; side < 2; ++side) {
      take_arm(side);
      for (std::size_t k = 0; k < arm_[side].size(); ++k) {
        const double gap = gap_at(point(side, k), infinite_reach);
        room_[side].push_back(std::min(room_m, wedge * gap));
      }
    }
  }

  // Degrees by which an arm must be turned.
  double needed(std::size_t side, const FigurePose& pose) {
    set_pose(pose);
    const auto [shoulder, axis] = turn_of(side, pose);
    if (axis.squaredNorm() == 0) return 0;
    std::vector<Point> tight;  // what is clear as it is may not be once turned: looked at again
    double angle = 0;
    while (true) {
      bool clear = true;
      const Quaternion turn = rotation_about(axis, angle * std::numbers::pi / 180);
      for (std::size_t k = 0; k < arm_[side].size(); ++k) {
        const Vec3 p = point(side, k), turned = angle == 0 ? p : Vec3(shoulder + turn * (p - shoulder));
        if (!is_tight(turned, room_[side][k])) continue;
        tight.push_back({p, room_[side][k]});
        clear = false;
      }
      if (clear) return angle;
      angle = least(shoulder, axis, tight, angle);
      if (angle >= largest_deg)
        return 0;  // it is a leg that is in the way, or the other way is nearer: left to the contacts
    }
  }

  void turn(std::size_t side, double degrees, FigurePose& pose) {
    const Vec3 axis = turn_of(side, pose).second;
    const Index arm = bones_->of(BodyPart::upper_arm, side);
    const Vec3 own = (body_->to_body.transpose() * axis).normalized();
    Quaternion above;
    for (Index node = body_->figure->nodes[at(arm)].parent; node >= 0; node = body_->figure->nodes[at(node)].parent)
      above = pose.nodes[at(node)].turn * above;
    Quaternion& turn = pose.nodes[at(arm)].turn;
    turn = (above.inverse() * rotation_about(own, degrees * std::numbers::pi / 180) * above * turn).normalised();
  }

  bool has_arm(std::size_t side) const { return !arm_[side].empty() && !trunk_.empty(); }

 private:
  static constexpr double infinite_reach = 1e3;

  // [vertex of the body] how much of its weight is on the node and what hangs on it.
  std::vector<double> shares(Index root) const {
    const Figure& figure = *body_->figure;
    std::vector<char> below(figure.nodes.size(), 0);
    for (const Index node : figure.order) {
      const Index parent = figure.nodes[at(node)].parent;
      below[at(node)] = node == root || (parent >= 0 && below[at(parent)] != 0) ? 1 : 0;
    }
    std::vector<double> of_figure(figure.modelled.size(), 0), share;
    for (const FigurePart& part : figure.parts)
      for (std::size_t i = part.first; i < part.first + part.count; ++i) {
        if (part.skin < 0) of_figure[i] = below[at(part.node)];
        for (std::size_t k = figure.first_influence[i]; k < figure.first_influence[i + 1]; ++k)
          if (below[at(figure.skins[at(part.skin)].joints[at(figure.influences[k].joint)])] != 0)
            of_figure[i] += figure.influences[k].weight;
      }
    for (const Index i : body_->vertices) share.push_back(of_figure[at(i)]);
    return share;
  }

  void take_trunk() {
    std::vector<Index> number(x_.size(), -1);
    std::vector<Triangle> triangles;
    for (const Triangle& t : body_->triangles) {
      if (std::any_of(t.begin(), t.end(),
                      [&](Index i) { return share_[0][at(i)] > no_weight || share_[1][at(i)] > no_weight; }))
        continue;
      Triangle own{};
      for (std::size_t k = 0; k < 3; ++k) {
        Index& n = number[at(t[k])];
        if (n < 0) {
          n = static_cast<Index>(trunk_.size());
          trunk_.push_back(t[k]);
        }
        own[k] = n;
      }
      triangles.push_back(own);
    }
    if (trunk_.empty()) return;
    trunk_x_.resize(trunk_.size());
    for (std::size_t k = 0; k < trunk_.size(); ++k) trunk_x_[k] = Vec3::Zero();
    surface_ = BodySurface(trunk_x_, std::move(triangles));
    rim_.assign(trunk_.size(), 0);
    for (const Edge& e : surface_.topology().edges)
      if (e.triangle[1] < 0) rim_[at(e.a)] = rim_[at(e.b)] = 1;
  }

  // Vertices, and middles of triangles.
  void take_arm(std::size_t side) {
    const auto all = [&](Index i) {
      return share_[side][at(i)] >= whole_weight && !(stage_.upper_arm_alone && beyond_[side][at(i)] > no_weight);
    };
    for (std::size_t i = 0; i < x_.size(); ++i)
      if (const auto v = static_cast<Index>(i); all(v)) arm_[side].push_back({v, v, v});
    for (const Triangle& t : body_->triangles)
      if (std::all_of(t.begin(), t.end(), all)) arm_[side].push_back(t);
  }

  Vec3 point(std::size_t side, std::size_t k) const {
    const Triangle& t = arm_[side][k];
    return (x_[at(t[0])] + x_[at(t[1])] + x_[at(t[2])]) / 3;
  }

  void set_pose(const FigurePose& pose) {
    body_->place(pose, x_);
    if (trunk_.empty()) return;
    for (std::size_t k = 0; k < trunk_.size(); ++k) trunk_x_[k] = x_[at(trunk_[k])];
    surface_.set_motion(trunk_x_, trunk_x_);
  }

  // Infinite out of reach, and where the nearest is the rim of what arms do not move: there is no side of it.
  double gap_at(const Vec3& p, double reach) const {
    const BodyPoint near = surface_.nearest(p, reach);
    if (near.triangle < 0) return infinite_reach;
    bool on_rim = true;
    for (std::size_t k = 0; k < 3; ++k)
      if (near.barycentric[static_cast<Eigen::Index>(k)] > 0)
        on_rim &= rim_[at(surface_.triangle(near.triangle)[k])] != 0;
    return on_rim ? infinite_reach : near.gap_m;
  }
  bool is_tight(const Vec3& p, double room) const { return gap_at(p, reach_) < room; }

  // The shoulder, and the axis; zero where the arm points outwards already.
  std::pair<Vec3, Vec3> turn_of(std::size_t side, const FigurePose& pose) const {
    const std::vector<Affine> world = world_transforms(*body_->figure, pose);
    const auto place = [&](BodyPart part, std::size_t of) {
      return Vec3(body_->to_body * world[at(bones_->of(part, of))].col(3));
    };
    const Vec3 shoulder = place(BodyPart::upper_arm, side), other = place(BodyPart::upper_arm, 1 - side);
    const Vec3 hips = place(BodyPart::hips, 0), up = (0.5 * (shoulder + other) - hips).normalized();
    const Vec3 away = place(stage_.away, side), from_hips = away - hips;
    const Vec3 axis = (away - shoulder).cross(from_hips - from_hips.dot(up) * up);
    const double length = std::sqrt(axis.squaredNorm());
    return {shoulder, length > 0 ? Vec3(axis / length) : Vec3(0, 0, 0)};
  }

  // From `from` on, of the points that are tight somewhere.
  double least(const Vec3& shoulder, const Vec3& axis, const std::vector<Point>& tight, double from) const {
    const auto clear = [&](double degrees) {
      const Quaternion turn = rotation_about(axis, degrees * std::numbers::pi / 180);
      return std::none_of(tight.begin(), tight.end(),
                          [&](const Point& p) { return is_tight(shoulder + turn * (p.x - shoulder), p.room); });
    };
    double low = from, high = from;
    do {
      low = high;
      high = std::min(high + step_deg, largest_deg);
    } while (high < largest_deg && !clear(high));
    while (high - low > exact_deg && high < largest_deg) {
      const double middle = 0.5 * (low + high);
      (clear(middle) ? high : low) = middle;
    }
    return high;
  }

  const PosedBody* body_;
  const PersonBones* bones_;
  Stage stage_;
  std::vector<Vec3> x_, trunk_x_;
  std::array<std::vector<double>, 2> share_, beyond_, room_;  // of upper arm and all beyond, of the forearm and beyond
  std::array<std::vector<Triangle>, 2> arm_;                  // points: means of three vertices
  std::vector<Index> trunk_;                                  // [vertex of the surface] the body's
  std::vector<char> rim_;
  BodySurface surface_;
  double reach_ = 0;
};

// See the head of the header.
std::vector<double> without_corners(const std::vector<double>& least, double rate_hz, bool loops) {
  const std::size_t count = least.size();
  const auto reach = static_cast<std::size_t>(std::max(1.0, std::round(0.5 * smooth_s * rate_hz)));
  std::vector<double>
      long_enough;  // of one that loops: the round before and after, without the pose that is there twice
  const std::size_t round = count - 1, rounds = loops && count > 1 ? (2 * reach + round - 1) / round : 0;
  const std::size_t padding = rounds * round;
  for (std::size_t f = 0; f < count + 2 * padding; ++f) long_enough.push_back(least[padding > 0 ? f % round : f]);
  std::vector<double> most(long_enough.size());
  for (std::size_t f = 0; f < most.size(); ++f) {
    const std::size_t first = f > 2 * reach ? f - 2 * reach : 0, end = std::min(f + 2 * reach + 1, most.size());
    most[f] = *std::max_element(long_enough.begin() + static_cast<std::ptrdiff_t>(first),
                                long_enough.begin() + static_cast<std::ptrdiff_t>(end));
  }
  const std::vector<double> smooth = smoothed(most, smooth_s, rate_hz);
  const auto begin = smooth.begin() + static_cast<std::ptrdiff_t>(padding);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

void keep_arms_clear(const PosedBody& body, const PersonBones& bones, double room_m, PoseTrack& track,
                     std::vector<std::string>& notes) {
  for (std::size_t side = 0; side < 2; ++side)
    for (const BodyPart part : {BodyPart::upper_arm, BodyPart::forearm})
      if (bones.of(part, side) < 0 || bones.of(BodyPart::hips) < 0) return;
  std::array<std::vector<double>, 2> turned;
  turned.fill(std::vector<double>(track.poses.size(), 0));
  for (const Stage& stage : stages) {
    Clearing clearing(body, bones, stage, room_m);
    for (std::size_t side = 0; side < 2; ++side) {
      if (bones.of(stage.away, side) < 0 || !clearing.has_arm(side)) continue;
      std::vector<double> angles;
      for (const FigurePose& pose : track.poses) angles.push_back(clearing.needed(side, pose));
      angles = without_corners(angles, track.rate_hz, track.loops);
      for (std::size_t f = 0; f < angles.size(); ++f) {
        if (angles[f] > 0) clearing.turn(side, angles[f], track.poses[f]);
        turned[side][f] += angles[f];
      }
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const auto most = std::max_element(turned[side].begin(), turned[side].end());
    if (*most < told_deg) continue;
    notes.push_back(fmt::sprintf(
        "the %s arm is turned away from the body by up to %.1f degrees (at %.3f s), to leave %.0f mm for cloth",
        std::string(side_names[side]), *most, static_cast<double>(most - turned[side].begin()) / track.rate_hz,
        1000 * room_m));
  }
}

}  // namespace toile::internal
