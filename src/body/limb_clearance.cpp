#include "body/limb_clearance.hpp"

#include "contact/body_surface.hpp"
#include "rig/smoothing.hpp"

#include <Eigen/LU>

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
constexpr double smooth_s = 0.2;   // T: a fifth of a swing of the arm
constexpr double settle_s = 0.08;  // as a body is put on the floor (rig/retarget.cpp)
constexpr double told_deg = 0.1;
constexpr std::array<std::string_view, 2> side_names = {"left", "right"};

struct Point {
  Vec3 x{0, 0, 0};
  double room = 0, share = 1;
};

enum class Limb { leg, arm };
constexpr BodyPart root_of(Limb limb) { return limb == Limb::leg ? BodyPart::thigh : BodyPart::upper_arm; }
constexpr BodyPart beyond(Limb limb) { return limb == Limb::leg ? BodyPart::shank : BodyPart::forearm; }

// What is to be clear, and the joint that is turned away from the trunk.
struct Stage {
  Limb limb;
  bool root_alone;
  BodyPart away;
  double trunk_share, limb_share;  // of a vertex's weights on limbs: at most, of the trunk; at least, of the limb
};
// The skin about a hip is blended for a hand's breadth, and it is there that a thigh meets the belly: what it moves for the most part is the leg, what
// it moves by a tenth or less stays where it is when it turns.  About a shoulder that is the armpit, where skin yields.
constexpr std::array<Stage, 3> stages = {{{Limb::leg, false, BodyPart::shank, 0.1, 0.5},
                                          {Limb::arm, true, BodyPart::forearm, no_weight, whole_weight},
                                          {Limb::arm, false, BodyPart::hand, no_weight, whole_weight}}};

class Clearing {
 public:
  Clearing(const PosedBody& body, const PersonBones& bones, const Stage& stage, double room_m)
      : body_(&body), bones_(&bones), stage_(stage), x_(body.vertices.size()) {
    for (std::size_t side = 0; side < 2; ++side) {
      share_[side] = shares(bones.of(root_of(stage.limb), side));
      beyond_[side] = shares(bones.of(beyond(stage.limb), side));
      elsewhere_[side] = share_[side];
      if (stage.limb == Limb::leg) {
        const std::vector<double> arm = shares(bones.of(BodyPart::upper_arm, side));
        for (std::size_t i = 0; i < arm.size(); ++i) elsewhere_[side][i] += arm[i];
      }
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
      take_limb(side);
      for (std::size_t k = 0; k < limb_[side].size(); ++k) {
        const Triangle& t = limb_[side][k];
        const double share = (share_[side][at(t[0])] + share_[side][at(t[1])] + share_[side][at(t[2])]) / 3;
        weight_[side].push_back(share >= whole_weight ? 1 : share);
        // Where blended skin counts the rim of the trunk does: the room tapers to nothing there.
        const Vec3 p = point(side, k);
        const bool blended = stage.limb_share < whole_weight;
        const double gap = blended ? surface_.nearest(p, infinite_reach).gap_m : gap_at(p, infinite_reach);
        room_[side].push_back(std::min(room_m, wedge * gap));
      }
    }
  }

  // Degrees by which a limb must be turned.
  double needed(std::size_t side, const FigurePose& pose) {
    set_pose(pose);
    const auto [joint, axis] = turn_of(side, pose);
    if (axis.squaredNorm() == 0) return 0;
    std::vector<Point> tight;  // what is clear as it is may not be once turned: looked at again
    double angle = 0;
    while (true) {
      bool clear = true;
      const Quaternion turn = rotation_about(axis, angle * std::numbers::pi / 180);
      for (std::size_t k = 0; k < limb_[side].size(); ++k) {
        const Vec3 p = point(side, k), turned = angle == 0 ? p : turned_by(joint, turn, p, weight_[side][k]);
        if (!is_tight(turned, room_[side][k])) continue;
        tight.push_back({p, room_[side][k], weight_[side][k]});
        clear = false;
      }
      if (clear) return angle;
      angle = least(joint, axis, tight, angle);
      if (angle < largest_deg) continue;
      // A leg is turned to where there is room, and as far as this is better.  Of an arm a leg is in the way, or the other way is nearer: left to
      // the contacts.
      return stage_.limb == Limb::leg ? largest_deg : 0;
    }
  }

  void turn(std::size_t side, double degrees, FigurePose& pose) const {
    const Vec3 axis = turn_of(side, pose).second;
    if (axis.squaredNorm() == 0) return;
    const Index root = bones_->of(root_of(stage_.limb), side);
    const Vec3 own = (body_->to_body.transpose() * axis).normalized();
    Quaternion above;
    for (Index node = body_->figure->nodes[at(root)].parent; node >= 0; node = body_->figure->nodes[at(node)].parent)
      above = pose.nodes[at(node)].turn * above;
    Quaternion& turn = pose.nodes[at(root)].turn;
    turn = (above.inverse() * rotation_about(own, degrees * std::numbers::pi / 180) * above * turn).normalised();
  }

  const PosedBody& body() const { return *body_; }
  bool has_limb(std::size_t side) const { return !limb_[side].empty() && !trunk_.empty(); }

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
      if (std::any_of(t.begin(), t.end(), [&](Index i) {
            return elsewhere_[0][at(i)] > stage_.trunk_share || elsewhere_[1][at(i)] > stage_.trunk_share;
          }))
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
  void take_limb(std::size_t side) {
    const auto all = [&](Index i) {
      return share_[side][at(i)] >= stage_.limb_share && !(stage_.root_alone && beyond_[side][at(i)] > no_weight);
    };
    for (std::size_t i = 0; i < x_.size(); ++i)
      if (const auto v = static_cast<Index>(i); all(v)) limb_[side].push_back({v, v, v});
    for (const Triangle& t : body_->triangles)
      if (std::all_of(t.begin(), t.end(), all)) limb_[side].push_back(t);
  }

  Vec3 point(std::size_t side, std::size_t k) const {
    const Triangle& t = limb_[side][k];
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
  static Vec3 turned_by(const Vec3& about, const Quaternion& turn, const Vec3& p, double share) {
    const Vec3 whole = about + turn * (p - about);
    return share == 1 ? whole : Vec3(p + share * (whole - p));
  }
  bool is_tight(const Vec3& p, double room) const { return gap_at(p, reach_) < room; }

  // The shoulder or hip, and the axis; zero where the limb points there already.
  std::pair<Vec3, Vec3> turn_of(std::size_t side, const FigurePose& pose) const {
    const std::vector<Affine> world = world_transforms(*body_->figure, pose);
    const auto place = [&](BodyPart part, std::size_t of) {
      return Vec3(body_->to_body * world[at(bones_->of(part, of))].col(3));
    };
    const Vec3 root = place(root_of(stage_.limb), side), hips = place(BodyPart::hips, 0);
    const Vec3 shoulders = 0.5 * (place(BodyPart::upper_arm, 0) + place(BodyPart::upper_arm, 1));
    const Vec3 up = (shoulders - hips).normalized(), away = place(stage_.away, side);
    const auto level = [&](const Vec3& v) { return Vec3(v - v.dot(up) * up); };
    const Vec3 to = stage_.limb == Limb::leg ? Vec3(level(root - hips).normalized() - up) : level(away - hips);
    const Vec3 axis = (away - root).cross(to);
    const double length = std::sqrt(axis.squaredNorm());
    return {root, length > 0 ? Vec3(axis / length) : Vec3(0, 0, 0)};
  }

  // From `from` on, of the points that are tight somewhere.
  double least(const Vec3& joint, const Vec3& axis, const std::vector<Point>& tight, double from) const {
    const auto clear = [&](double degrees) {
      const Quaternion turn = rotation_about(axis, degrees * std::numbers::pi / 180);
      return std::none_of(tight.begin(), tight.end(),
                          [&](const Point& p) { return is_tight(turned_by(joint, turn, p.x, p.share), p.room); });
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
  std::array<std::vector<double>, 2> share_, beyond_, elsewhere_, room_,
      weight_;  // shares: of the limb, of what is beyond its first bone, of all limbs that are not the trunk
  std::array<std::vector<Triangle>, 2> limb_;  // points: means of three vertices
  std::vector<Index> trunk_;                   // [vertex of the surface] the body's
  std::vector<char> rim_;
  BodySurface surface_;
  double reach_ = 0;
};

// [frame] of the body's lowest point; of frames without a turn 0.
std::vector<double> lowest(const PosedBody& body, const PoseTrack& track, std::span<const double> turned) {
  std::vector<double> low(track.poses.size(), 0);
  std::vector<Vec3> x(body.vertices.size());
  for (std::size_t f = 0; f < low.size(); ++f) {
    if (turned[f] == 0) continue;
    body.place(track.poses[f], x);
    low[f] = x.front().y();
    for (const Vec3& p : x) low[f] = std::min(low[f], p.y());
  }
  return low;
}

void raise(const PosedBody& body, Index hips, double height_m, FigurePose& pose) {
  Vec3 by = body.to_body.inverse() * Vec3(0, height_m, 0);
  const Index parent = body.figure->nodes[at(hips)].parent;
  if (parent >= 0) by = world_transforms(*body.figure, pose)[at(parent)].leftCols<3>().inverse() * by;
  pose.nodes[at(hips)].translation += by;
}

// Turns limbs by degrees [side][frame].  Legs may have carried the body: it is put down again, so that its lowest point is as high as it was.
void turn_limbs(const Stage& stage, const Clearing& clearing, const PersonBones& bones,
                const std::array<std::vector<double>, 2>& degrees, PoseTrack& track) {
  const PosedBody& body = clearing.body();
  std::vector<double> turned, before;
  for (std::size_t f = 0; f < track.poses.size(); ++f) turned.push_back(std::max(degrees[0][f], degrees[1][f]));
  if (stage.limb == Limb::leg) before = lowest(body, track, turned);
  for (std::size_t f = 0; f < track.poses.size(); ++f)
    for (std::size_t side = 0; side < 2; ++side)
      if (degrees[side][f] > 0) clearing.turn(side, degrees[side][f], track.poses[f]);
  if (stage.limb != Limb::leg) return;
  std::vector<double> up = lowest(body, track, turned);
  for (std::size_t f = 0; f < up.size(); ++f) up[f] = before[f] - up[f];
  up = smoothed(up, settle_s, track.rate_hz);
  for (std::size_t f = 0; f < up.size(); ++f)
    if (up[f] != 0) raise(body, bones.of(BodyPart::hips), up[f], track.poses[f]);
}

}  // namespace

void keep_limbs_clear(const PosedBody& body, const PersonBones& bones, double room_m, PoseTrack& track,
                      std::vector<std::string>& notes) {
  for (std::size_t side = 0; side < 2; ++side)
    for (const BodyPart part : {BodyPart::upper_arm, BodyPart::forearm})
      if (bones.of(part, side) < 0 || bones.of(BodyPart::hips) < 0) return;
  std::array<std::array<std::vector<double>, 2>, 2> turned;
  for (auto& limb : turned) limb.fill(std::vector<double>(track.poses.size(), 0));
  for (const Stage& stage : stages) {
    Clearing clearing(body, bones, stage, room_m);
    std::array<std::vector<double>, 2> degrees;
    degrees.fill(std::vector<double>(track.poses.size(), 0));
    for (std::size_t side = 0; side < 2; ++side) {
      if (bones.of(stage.away, side) < 0 || !clearing.has_limb(side)) continue;
      for (std::size_t f = 0; f < track.poses.size(); ++f) degrees[side][f] = clearing.needed(side, track.poses[f]);
      degrees[side] = smoothed_above(degrees[side], smooth_s, track.rate_hz, track.loops);
      for (std::size_t f = 0; f < track.poses.size(); ++f)
        turned[static_cast<std::size_t>(stage.limb)][side][f] += degrees[side][f];
    }
    turn_limbs(stage, clearing, bones, degrees, track);
  }
  for (std::size_t limb = 0; limb < 2; ++limb)
    for (std::size_t side = 0; side < 2; ++side) {
      const std::vector<double>& angles = turned[limb][side];
      const auto most = std::max_element(angles.begin(), angles.end());
      if (*most < told_deg) continue;
      notes.push_back(fmt::sprintf(
          "the %s %s is turned away from the body by up to %.1f degrees (at %.3f s), to leave %.0f mm for cloth",
          std::string(side_names[side]), limb == 0 ? "leg" : "arm", *most,
          static_cast<double>(most - angles.begin()) / track.rate_hz, 1000 * room_m));
    }
}

}  // namespace toile::internal
