#include "rig/retarget.hpp"

#include "core/error.hpp"
#include "rig/ankle_turns.hpp"
#include "rig/feet.hpp"
#include "rig/mend_jumps.hpp"
#include "rig/smoothing.hpp"
#include "rig/spine_bends.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <fmt/printf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace toile::internal {
namespace {

constexpr double smoothing_s = 0.08;  // of the way of the soles to the floor: a change of foot would be a corner
constexpr double facing_s = 0.5;      // over which a recording's front is taken: hips turn to and fro with every step
constexpr std::array<BodyPart, 3> needed = {BodyPart::hips, BodyPart::thigh, BodyPart::shank};
constexpr std::array<std::string_view, 2> sides = {"left ", "right "};

// A skeleton's nodes in the world: their turns without stretch, and where they are.
struct Posed {
  std::vector<Quaternion> turn;
  std::vector<Vec3> place;
};
Posed posed(const Figure& figure, const FigurePose& pose) {
  Posed posed{std::vector<Quaternion>(figure.nodes.size()), std::vector<Vec3>(figure.nodes.size())};
  const std::vector<Affine> world = world_transforms(figure, pose);
  for (const Index node : figure.order) {
    const Index parent = figure.nodes[at(node)].parent;
    const Quaternion& own = pose.nodes[at(node)].turn;
    posed.turn[at(node)] = parent < 0 ? own : posed.turn[at(parent)] * own;
    posed.place[at(node)] = world[at(node)].col(3);
  }
  return posed;
}

// [node] whether it is one of two, or hangs on it.
std::vector<char> moved_by(const Figure& figure, const std::array<Index, 2>& movers) {
  std::vector<char> moved(figure.nodes.size(), 0);
  for (const Index node : figure.order) {
    const Index parent = figure.nodes[at(node)].parent;
    const bool is_mover = node == movers[0] || node == movers[1];
    moved[at(node)] = is_mover || (parent >= 0 && moved[at(parent)] != 0) ? 1 : 0;
  }
  return moved;
}

Vec3 nearest_axis(const Vec3& v) {
  Eigen::Index k = 0;
  v.cwiseAbs().maxCoeff(&k);
  Vec3 axis = Vec3::Zero();
  axis[k] = v[k] < 0 ? -1 : 1;
  return axis;
}

std::string quoted_name(const Figure& figure, Index node) { return '"' + printable(figure.nodes[at(node)].name) + '"'; }

// A person at rest.
class Standing {
 public:
  Standing(const Person& person, std::string_view file, std::string_view what)
      : person_(&person), rest_(posed(*person.figure, person.figure->rest)) {
    for (const BodyPart part : needed)
      for (std::size_t side = 0; side < (part == BodyPart::hips ? 1U : 2U); ++side)
        if (bone(part, side) < 0)
          throw InputError(file, what,
                           std::string(part == BodyPart::hips ? "" : sides[side]) + std::string(to_string(part)) +
                               " among the names of its joints, or in a file of bones",
                           names());
  }

  Index bone(BodyPart part, std::size_t side = 0) const { return person_->bones.of(part, side); }
  const PersonBones& bones() const { return person_->bones; }
  const Figure& figure() const { return *person_->figure; }
  const Quaternion& turn(Index node) const { return rest_.turn[at(node)]; }
  const Vec3& place(Index node) const { return rest_.place[at(node)]; }

  // The axes of its space that point to its left, up and forwards.
  Mat3 axes() const {
    const Index left = bone(BodyPart::thigh, 0), right = bone(BodyPart::thigh, 1);
    const Vec3 knees = 0.5 * (place(bone(BodyPart::shank, 0)) + place(bone(BodyPart::shank, 1)));
    const Vec3 up = nearest_axis(0.5 * (place(left) + place(right)) - knees);
    const Vec3 across = place(left) - place(right);
    const Vec3 x = nearest_axis(across - across.dot(up) * up);
    Mat3 axes;
    axes << x, up, x.cross(up);
    return axes;
  }

  double leg() const {
    double length = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      const Index thigh = bone(BodyPart::thigh, side), shank = bone(BodyPart::shank, side), foot = end(shank, side);
      length += 0.5 * (place(shank) - place(thigh)).norm();
      if (foot >= 0) length += 0.5 * (place(foot) - place(shank)).norm();
    }
    return length;
  }

  // Whether its foot at rest lies across the shank, as under one who stands: else a turn from rest is none of the ankle.
  bool stands_on_foot(std::size_t side) const {
    constexpr double upright = 0.77;  // cosine of 40 degrees; a foot stands at 90
    const Vec3 shank = along(BodyPart::shank, BodyPart::foot, side), foot = along(BodyPart::foot, BodyPart::toes, side);
    const double lengths = std::sqrt(shank.squaredNorm() * foot.squaredNorm());
    return lengths > 0 && std::abs(shank.dot(foot)) < upright * lengths;
  }

  // From a joint to the next of its limb; zero where there is none.
  Vec3 along(BodyPart part, BodyPart next, std::size_t side) const {
    const Index from = bone(part, side), to = bone(next, side);
    return from < 0 || to < 0 ? Vec3(0, 0, 0) : Vec3(place(to) - place(from));
  }

 private:
  Index end(Index shank, std::size_t side) const {
    if (bone(BodyPart::foot, side) >= 0) return bone(BodyPart::foot, side);
    for (std::size_t i = 0; i < figure().nodes.size(); ++i)
      if (figure().nodes[i].parent == shank) return static_cast<Index>(i);
    return -1;
  }

  std::string names() const {
    constexpr std::size_t told = 60;
    std::string words;
    for (std::size_t i = 0; i < std::min(figure().nodes.size(), told); ++i)
      if (!figure().nodes[i].name.empty()) words += (words.empty() ? "" : ", ") + printable(figure().nodes[i].name);
    return words.empty() ? "no names" : words;
  }

  const Person* person_;
  Posed rest_;
};

// The smallest turn between two directions; none where one has no length, or they are opposite.
Quaternion between_directions(const Vec3& from, const Vec3& to) {
  const double lengths = std::sqrt(from.squaredNorm() * to.squaredNorm());
  if (!(lengths > 0) || from.dot(to) < -0.999 * lengths) return {};
  return rotation_between(from, to);
}

class Retargeting {
 public:
  Retargeting(const Person& source, const PoseTrack& moves, const Person& target, std::string_view file)
      : source_(source, file, "motion"), target_(target, file, "body"), moves_(moves) {
    mend_jumps(source_.figure(), moves_, notes_);
    leg_ = source_.leg();
    if (!(leg_ > 0) || !(target_.leg() > 0))
      throw InputError(file, leg_ > 0 ? "body" : "motion", "legs with a length", "0");
    pair_bones();
    record();
    set_differences();
  }

  Retargeted run() {
    Retargeted result;
    result.track.rate_hz = moves_.rate_hz;
    for (std::size_t f = 0; f < frames_.size(); ++f) result.track.poses.push_back(pose(f));
    stand_on_floor(result.track);
    result.notes = std::move(notes_);
    return result;
  }

 private:
  // [target's node] the source's, or -1.
  void pair_bones() {
    pair_.assign(target_.figure().nodes.size(), -1);
    std::vector<char> has_part(target_.figure().nodes.size(), 0), source_has(source_.figure().nodes.size(), 0);
    for (std::size_t k = 0; k < body_part_count; ++k)
      for (std::size_t side = 0; side < 2; ++side) pair(static_cast<BodyPart>(k), side, has_part, source_has);
    const std::vector<Index>&own = target_.bones().spine, &given = source_.bones().spine;
    for (std::size_t i = 0; i < own.size(); ++i) {
      has_part[at(own[i])] = 1;
      if (!given.empty()) pair_[at(own[i])] = given[((i + 1) * given.size() + own.size() - 1) / own.size() - 1];
    }
    for (const Index node : given) source_has[at(node)] = 1;
    std::map<std::string_view, Index> by_name;
    for (std::size_t i = 0; i < source_.figure().nodes.size(); ++i)
      if (source_has[i] == 0) by_name.try_emplace(source_.figure().nodes[i].name, static_cast<Index>(i));
    for (std::size_t i = 0; i < pair_.size(); ++i) {
      const std::string& name = target_.figure().nodes[i].name;
      if (has_part[i] != 0 || name.empty()) continue;
      if (const auto found = by_name.find(name); found != by_name.end()) pair_[i] = found->second;
    }
  }

  void pair(BodyPart part, std::size_t side, std::vector<char>& has_part, std::vector<char>& source_has) {
    const Index own = target_.bone(part, side), given = source_.bone(part, side);
    if (given >= 0) source_has[at(given)] = 1;
    if (own < 0) return;
    has_part[at(own)] = 1;
    if (part == BodyPart::spine || part == BodyPart::toes) return;
    pair_[at(own)] = given;
    if (given < 0)
      notes_.push_back("the motion has no joint for the body's " + quoted_name(target_.figure(), own) +
                       ", which stays as it is at rest");
  }

  // The source in the target's world: turns since its rest pose, and the way of its hips and feet.
  void record() {
    const Figure& figure = source_.figure();
    const Mat3 to_target = target_.axes() * source_.axes().transpose();
    const Quaternion align = quaternion_of(to_target);
    for (const FigurePose& pose : moves_.poses) {
      Posed frame = posed(figure, pose);
      for (std::size_t i = 0; i < figure.nodes.size(); ++i) {
        frame.turn[i] = align * frame.turn[i] * source_.turn(static_cast<Index>(i)).inverse() * align.inverse();
        frame.place[i] = to_target * frame.place[i];
      }
      frames_.push_back(std::move(frame));
    }
    turn_to_front();
    straighten_spine();
    for (std::size_t side = 0; side < 2; ++side) straighten_ankle(side);
    align_ = align;
    for (std::size_t side = 0; side < 2; ++side) record_foot(side);
  }

  // So that the hips face, in the mean over half a step, as the target does.
  void turn_to_front() {
    const Mat3 axes = target_.axes();
    const Vec3 up = axes.col(1), ahead = axes.col(2);
    Vec3 facing = Vec3::Zero();
    const auto some = static_cast<std::size_t>(std::max(1.0, std::round(facing_s * moves_.rate_hz)));
    for (std::size_t f = 0; f < std::min(some, frames_.size()); ++f)
      facing += frames_[f].turn[at(source_.bone(BodyPart::hips))] * ahead / static_cast<double>(some);
    facing -= facing.dot(up) * up;
    if (facing.squaredNorm() < 0.01) return;  // lying: there is no front
    const double angle = ieee_atan2(facing.cross(ahead).dot(up), facing.dot(ahead));
    const Quaternion back = rotation_about(up, angle);
    for (Posed& frame : frames_)
      for (std::size_t i = 0; i < frame.turn.size(); ++i) {
        frame.turn[i] = back * frame.turn[i];
        frame.place[i] = back * frame.place[i];
      }
  }

  void straighten_spine() {
    std::vector<Index> nodes = {source_.bone(BodyPart::hips)};
    nodes.insert(nodes.end(), source_.bones().spine.begin(), source_.bones().spine.end());
    std::vector<SpineTurns> spines;
    for (const Posed& frame : frames_) {
      SpineTurns& turns = spines.emplace_back();
      for (const Index node : nodes) turns.push_back(frame.turn[at(node)]);
    }
    const SpineBend most = share_bends(spines, target_.axes().col(1), moves_.rate_hz);
    if (most.degrees == 0) return;
    for (std::size_t f = 0; f < frames_.size(); ++f)
      for (std::size_t i = 0; i < nodes.size(); ++i) frames_[f].turn[at(nodes[i])] = spines[f][i];
    notes_.push_back(
        fmt::sprintf("%s bends by up to %.0f degrees (at %.3f s), farther than a spine can in one place: shared by the "
                     "spine's joints",
                     quoted_name(source_.figure(), nodes[most.joint]), most.degrees,
                     static_cast<double>(most.frame) / moves_.rate_hz));
  }

  // With all that hangs on the foot.
  void straighten_ankle(std::size_t side) {
    const Index shank = source_.bone(BodyPart::shank, side), foot = source_.bone(BodyPart::foot, side);
    if (foot < 0 || !source_.stands_on_foot(side)) return;
    std::vector<AnkleTurn> ankle;
    for (const Posed& frame : frames_) ankle.push_back({frame.turn[at(shank)], frame.turn[at(foot)]});
    const AnkleFault most = hold_ankle(ankle, moves_.rate_hz);
    if (most.degrees == 0) return;
    const Figure& figure = source_.figure();
    const std::vector<char> of_foot = moved_by(figure, {foot, foot});
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      std::vector<Quaternion>& turn = frames_[f].turn;
      const Quaternion was = turn[at(foot)], back = ankle[f].foot * was.inverse();
      if (was.w == ankle[f].foot.w && was.v == ankle[f].foot.v) continue;
      for (std::size_t i = 0; i < turn.size(); ++i)
        if (of_foot[i] != 0) turn[i] = back * turn[i];
    }
    notes_.push_back(fmt::sprintf("%s is turned by up to %.0f degrees (at %.3f s), farther than an ankle can: led back",
                                  quoted_name(figure, foot), most.degrees,
                                  static_cast<double>(most.frame) / moves_.rate_hz));
  }

  void record_foot(std::size_t side) {
    const Index foot = source_.bone(BodyPart::foot, side);
    if (foot < 0) return;
    RecordedFoot& recorded = feet_.emplace_back();
    const Quaternion upright = quaternion_of(target_.axes()).inverse();  // y is up
    for (const Posed& frame : frames_) {
      recorded.ankle.push_back(upright * frame.place[at(foot)]);
      recorded.turn.push_back(upright * frame.turn[at(foot)] * upright.inverse());
    }
    standing_.push_back(standing_frames(recorded, leg_, moves_.rate_hz));
    foot_number_[side] = static_cast<int>(feet_.size()) - 1;
  }

  Quaternion limb(BodyPart part, BodyPart next, std::size_t side) const {
    return between_directions(target_.along(part, next, side), align_ * source_.along(part, next, side));
  }

  Quaternion foot(std::size_t side) const {
    const Vec3 up = target_.axes().col(1);
    const auto level = [&](Vec3 v) { return Vec3(v - v.dot(up) * up); };
    const Vec3 own = level(target_.along(BodyPart::foot, BodyPart::toes, side));
    const Vec3 given = level(align_ * source_.along(BodyPart::foot, BodyPart::toes, side));
    Quaternion turn = between_directions(own, given);
    if (foot_number_[side] >= 0) {
      const auto number = static_cast<std::size_t>(foot_number_[side]);
      const Vec3 normal = quaternion_of(target_.axes()) * sole_normal(feet_[number], standing_[number]);
      turn = between_directions(up, normal) * turn;
    }
    return turn;
  }

  void set_differences() {
    difference_.assign(pair_.size(), {});
    std::vector<char> given(pair_.size(), 0);
    const auto set = [&](BodyPart part, std::size_t side, const Quaternion& turn) {
      const Index node = target_.bone(part, side);
      if (node < 0) return;
      difference_[at(node)] = turn;
      given[at(node)] = 1;
    };
    for (std::size_t k = 0; k < body_part_count; ++k)
      for (std::size_t side = 0; side < 2; ++side) set(static_cast<BodyPart>(k), side, {});
    for (const Index node : target_.bones().spine) given[at(node)] = 1;
    for (std::size_t side = 0; side < 2; ++side) {
      const Quaternion forearm = limb(BodyPart::forearm, BodyPart::hand, side);
      set(BodyPart::upper_arm, side, limb(BodyPart::upper_arm, BodyPart::forearm, side));
      set(BodyPart::forearm, side, forearm);
      set(BodyPart::hand, side, forearm);
      set(BodyPart::thigh, side, limb(BodyPart::thigh, BodyPart::shank, side));
      set(BodyPart::shank, side, limb(BodyPart::shank, BodyPart::foot, side));
      set(BodyPart::foot, side, foot(side));
    }
    for (const Index node : target_.figure().order) {  // fingers as their hand
      const Index parent = target_.figure().nodes[at(node)].parent;
      if (given[at(node)] == 0 && parent >= 0) difference_[at(node)] = difference_[at(parent)];
    }
  }

  FigurePose pose(std::size_t frame) const {
    const Figure& figure = target_.figure();
    FigurePose pose = figure.rest;
    std::vector<Quaternion> world(figure.nodes.size());
    for (const Index node : figure.order) {
      const Index parent = figure.nodes[at(node)].parent;
      const Quaternion above = parent < 0 ? Quaternion{} : world[at(parent)];
      NodePose& own = pose.nodes[at(node)];
      if (const Index given = pair_[at(node)]; given >= 0) {
        world[at(node)] = frames_[frame].turn[at(given)] * difference_[at(node)] * target_.turn(node);
        own.turn = (above.inverse() * world[at(node)]).normalised();
      }
      world[at(node)] = above * own.turn;
    }
    const Index hips = source_.bone(BodyPart::hips);
    const Vec3 way = frames_[frame].place[at(hips)] - frames_.front().place[at(hips)];
    move_hips(pose, target_.leg() / leg_ * way);
    return pose;
  }

  // By a shift in the world.
  void move_hips(FigurePose& pose, const Vec3& by) const {
    const Index hips = target_.bone(BodyPart::hips), parent = target_.figure().nodes[at(hips)].parent;
    Vec3 own = by;
    if (parent >= 0) own = world_transforms(target_.figure())[at(parent)].leftCols<3>().inverse() * by;
    pose.nodes[at(hips)].translation += own;
  }

  // The vertices that feet move most.
  std::vector<Index> soles() const {
    const Figure& figure = target_.figure();
    const std::vector<char> of_foot =
        moved_by(figure, {target_.bone(BodyPart::foot, 0), target_.bone(BodyPart::foot, 1)});
    std::vector<Index> vertices;
    for (const FigurePart& part : figure.parts)
      for (std::size_t i = part.first; i < part.first + part.count; ++i) {
        Index mover = part.node;
        double most = 0;
        for (std::size_t k = figure.first_influence[i]; k < figure.first_influence[i + 1]; ++k) {
          if (figure.influences[k].weight <= most) continue;
          most = figure.influences[k].weight;
          mover = figure.skins[at(part.skin)].joints[at(figure.influences[k].joint)];
        }
        if (of_foot[at(mover)] != 0) vertices.push_back(static_cast<Index>(i));
      }
    return vertices;
  }

  std::vector<double> lower_ankle() const {
    std::vector<double> lower(frames_.size(), 0);
    for (std::size_t k = 0; k < feet_.size(); ++k)
      for (std::size_t f = 0; f < lower.size(); ++f) {
        const double height = feet_[k].ankle[f].y();
        lower[f] = k == 0 ? height : std::min(lower[f], height);
      }
    return lower;
  }

  void stand_on_floor(PoseTrack& track) const {
    const std::vector<Index> vertices = soles();
    if (vertices.empty()) return;
    const Vec3 up = target_.axes().col(1);
    std::vector<Vec3> x(vertices.size());
    const auto lowest = [&](const FigurePose& pose) {
      pose_vertices(target_.figure(), pose, vertices, x);
      double low = x.front().dot(up);
      for (const Vec3& p : x) low = std::min(low, p.dot(up));
      return low;
    };
    const double floor = lowest(target_.figure().rest);
    std::vector<double> heights, raise;
    for (const FigurePose& pose : track.poses) heights.push_back(lowest(pose));
    std::vector<double> in_air = clearance(heights, target_.leg(), track.rate_hz);
    // Feet that are turned wrongly lift the soles; then ankles stay where they are.
    const std::vector<double> recorded = clearance(lower_ankle(), leg_, track.rate_hz);
    for (std::size_t f = 0; f < in_air.size(); ++f) in_air[f] = std::min(in_air[f], target_.leg() / leg_ * recorded[f]);
    for (std::size_t f = 0; f < heights.size(); ++f) raise.push_back(floor + in_air[f] - heights[f]);
    raise = smoothed(raise, smoothing_s, track.rate_hz);
    for (std::size_t f = 0; f < track.poses.size(); ++f) move_hips(track.poses[f], raise[f] * up);
  }

  Standing source_, target_;
  PoseTrack moves_;
  double leg_ = 0;
  Quaternion align_;
  std::vector<Index> pair_;
  std::vector<Quaternion> difference_;
  std::vector<Posed> frames_;
  std::vector<RecordedFoot> feet_;
  std::vector<std::vector<char>> standing_;
  std::array<int, 2> foot_number_ = {-1, -1};
  std::vector<std::string> notes_;
};

}  // namespace

Retargeted retarget(const Person& source, const PoseTrack& moves, const Person& target, std::string_view file) {
  return Retargeting(source, moves, target, file).run();
}

}  // namespace toile::internal
