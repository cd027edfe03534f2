// Arms and legs of another person's motion: out of the trunk, with room for cloth, without a jump.
#include "body/limb_clearance.hpp"

#include "body/collision_body.hpp"
#include "body/mannequin_figure.hpp"
#include "contact/body_surface.hpp"
#include "mannequins.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace toile::internal {
namespace {

constexpr double room_m = 0.015, rate_hz = 60;

struct Turned {
  BodyPart limb;
  Vec3 axis;
};
const Turned arm_down = {BodyPart::upper_arm, Vec3(0, 0, -1)}, thigh_up = {BodyPart::thigh, Vec3(-1, 0, 0)};

// The woman, one of whose left limbs is turned from the A-pose by `degrees(frame)`.
struct Lowered {
  const Mannequin& woman = test::mannequin_of(MannequinKind::woman);
  SkinnedBody skin{woman};
  Figure figure = mannequin_figure(woman);
  PersonBones bones = person_bones(figure);
  std::vector<Index> vertices = every_vertex(figure);
  PoseTrack track;
  std::vector<std::string> notes;

  Turned turned;

  template <class Degrees>
  Lowered(int frames, const Degrees& degrees, const Turned& limb = arm_down) : turned(limb) {
    track.rate_hz = rate_hz;
    for (int f = 0; f < frames; ++f) {
      track.poses.push_back(figure.rest);
      const Quaternion turn = rotation_about(turned.axis, degrees(f) * std::numbers::pi / 180);
      track.poses.back().nodes[at(bones.of(turned.limb, 0))].turn = turn;
    }
  }

  PosedBody body() const {
    return {&figure, vertices, woman.triangles, Mat3::Identity(),
            [this](const FigurePose& pose, std::span<Vec3> x) { skin.positions(mannequin_pose(figure, pose), x); }};
  }
  void clear() { keep_limbs_clear(body(), bones, room_m, track, notes); }

  std::vector<Vec3> at_frame(std::size_t frame) const {
    std::vector<Vec3> x(vertices.size());
    body().place(track.poses[frame], x);
    return x;
  }
  // Vertices that the limb moves for the most part, an arm alone, and that are within another part of the body, or nearer than a millimetre to it.
  int entered(std::size_t frame) const {
    const std::vector<Vec3> x = at_frame(frame);
    BodySurface surface(x, woman.triangles);
    int count = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const SkinWeights& w = woman.skin[i];
      double share = 0;
      for (std::size_t k = 0; k < 4; ++k)
        if (const Index j = w.joint[k]; w.weight[k] > 0 && is_limb(j)) share += w.weight[k];
      if (share > (turned.limb == BodyPart::thigh ? 0.5 : 0.999))
        count += surface.winding_number(x[i] + 1e-3 * surface.vertex_normal(static_cast<Index>(i))) > 0;
    }
    return count;
  }
  // How far each pose's limb was turned since `was`, degrees.
  std::vector<double> turns_since(const PoseTrack& was) const {
    const auto index = at(bones.of(turned.limb, 0));
    std::vector<double> degrees;
    for (std::size_t f = 0; f < was.poses.size(); ++f) {
      const Quaternion by = track.poses[f].nodes[index].turn * was.poses[f].nodes[index].turn.inverse();
      degrees.push_back(2 * std::asin(std::sqrt(by.v.squaredNorm())) * 180 / std::numbers::pi);
    }
    return degrees;
  }
  Quaternion arm(std::size_t frame, std::size_t side) const {
    return track.poses[frame].nodes[at(bones.of(BodyPart::upper_arm, side))].turn;
  }

 private:
  bool is_limb(Index joint) const {
    for (; joint >= 0; joint = figure.nodes[at(joint)].parent)
      if (joint == bones.of(turned.limb, 0)) return true;
    return false;
  }
};

bool same_bits(const Quaternion& a, const Quaternion& b) { return a.w == b.w && a.v == b.v; }

void expect_left_to_the_bit(Lowered& given) {
  const PoseTrack was = given.track;
  given.clear();
  EXPECT_TRUE(given.notes.empty());
  for (std::size_t f = 0; f < was.poses.size(); ++f)
    for (std::size_t n = 0; n < was.poses[f].nodes.size(); ++n)
      EXPECT_TRUE(same_bits(given.track.poses[f].nodes[n].turn, was.poses[f].nodes[n].turn));
}

TEST(ArmClearance, AnArmInTheTrunkIsMovedOutAndTheOtherIsNot) {
  Lowered given(3, [](int) { return 60.0; });
  EXPECT_GT(given.entered(1), 20);
  const FigurePose was = given.track.poses[1];
  given.clear();
  EXPECT_EQ(given.entered(1), 0);
  ASSERT_EQ(given.notes.size(), 1U);
  EXPECT_EQ(given.notes[0].find("the left arm is turned away from the body by up to "), 0U) << given.notes[0];
  for (std::size_t n = 0; n < was.nodes.size(); ++n)
    if (static_cast<Index>(n) != given.bones.of(BodyPart::upper_arm, 0)) {
      EXPECT_TRUE(same_bits(given.track.poses[1].nodes[n].turn, was.nodes[n].turn)) << given.figure.nodes[n].name;
    }
}

TEST(ArmClearance, TheTurnIsTheLeast) {
  Lowered given(3, [](int) { return 60.0; });
  const double before = given.arm(1, 0).dot(rotation_about(Vec3(0, 0, 1), 0));
  given.clear();
  EXPECT_GT(given.arm(1, 0).dot(rotation_about(Vec3(0, 0, 1), 0)), before);  // nearer to the A-pose
  // Half a degree back it has less room than it should: it is turned again.
  for (FigurePose& pose : given.track.poses) {
    Quaternion& turn = pose.nodes[at(given.bones.of(BodyPart::upper_arm, 0))].turn;
    turn = rotation_about(Vec3(0, 0, 1), -0.5 * std::numbers::pi / 180) * turn;
  }
  given.notes.clear();
  given.clear();
  EXPECT_EQ(given.notes.size(), 1U);
}

TEST(ArmClearance, WhatIsClearIsLeftToTheBit) {
  Lowered given(5, [](int f) { return -10.0 * f; });
  expect_left_to_the_bit(given);
}

// An arm that swings in within half a second: turned before it comes, never with a jump, and not at all long before.
TEST(ArmClearance, IsTurnedWithoutAJumpInSpeed) {
  const auto degrees = [](int f) { return 60.0 * std::pow(std::sin(std::numbers::pi * f / 120.0), 16); };
  Lowered given(121, degrees);
  const PoseTrack was = given.track;
  given.clear();
  const auto index = at(given.bones.of(BodyPart::upper_arm, 0));
  const std::vector<double> turned = given.turns_since(was);
  EXPECT_GT(turned[60], 5);
  EXPECT_TRUE(same_bits(given.arm(10, 0), was.poses[10].nodes[index].turn));
  for (std::size_t f = 1; f + 1 < turned.size(); ++f)
    EXPECT_LT(std::abs(turned[f + 1] - 2 * turned[f] + turned[f - 1]), 0.05 * turned[60]) << f;
  for (std::size_t f = 45; f < 76; ++f) EXPECT_EQ(given.entered(f), 0) << f;
}

TEST(ArmClearance, AFigureWithoutArmsIsLeftAlone) {
  Lowered given(2, [](int) { return 60.0; });
  const PoseTrack was = given.track;
  given.bones.node[static_cast<std::size_t>(BodyPart::forearm)][1] = -1;
  given.clear();
  EXPECT_TRUE(same_bits(given.arm(1, 0), was.poses[1].nodes[at(given.bones.of(BodyPart::upper_arm, 0))].turn));
}

// A thigh against the belly, by more than hips bend.
TEST(LegClearance, AThighInTheBellyIsTurnedOutAndTheOtherIsNot) {
  Lowered given(
      3, [](int) { return 135.0; }, thigh_up);
  const int before = given.entered(1);
  EXPECT_GT(before, 50);
  const PoseTrack was = given.track;
  given.clear();
  EXPECT_LT(given.entered(1), before / 4);
  ASSERT_EQ(given.notes.size(), 1U);
  EXPECT_EQ(given.notes[0].find("the left leg is turned away from the body by up to "), 0U) << given.notes[0];
  for (std::size_t n = 0; n < was.poses[1].nodes.size(); ++n)
    if (static_cast<Index>(n) != given.bones.of(BodyPart::thigh, 0)) {
      EXPECT_TRUE(same_bits(given.track.poses[1].nodes[n].turn, was.poses[1].nodes[n].turn))
          << given.figure.nodes[n].name;
    }
}

// Who crouches on the leg that is turned stands on it again; who stands on the other leg stays where it stands.
TEST(LegClearance, TheBodyIsPutDownAgain) {
  const auto low = [](const std::vector<Vec3>& x) {
    double least = x.front().y();
    for (const Vec3& p : x) least = std::min(least, p.y());
    return least;
  };
  for (const bool both : {false, true}) {
    Lowered given(
        3, [](int) { return 135.0; }, thigh_up);
    for (FigurePose& pose : given.track.poses) {
      if (!both) break;
      for (std::size_t side = 0; side < 2; ++side) {
        pose.nodes[at(given.bones.of(BodyPart::thigh, side))].turn =
            rotation_about(thigh_up.axis, 0.75 * std::numbers::pi);
        pose.nodes[at(given.bones.of(BodyPart::shank, side))].turn =
            rotation_about(-thigh_up.axis, 0.75 * std::numbers::pi);
      }
    }
    const double before = low(given.at_frame(1));
    const Vec3 hips = given.track.poses[1].nodes[at(given.bones.of(BodyPart::hips))].translation;
    given.clear();
    EXPECT_NEAR(low(given.at_frame(1)), before, 1e-6);
    const Vec3 moved = given.track.poses[1].nodes[at(given.bones.of(BodyPart::hips))].translation - hips;
    EXPECT_EQ(moved.norm() > 0.01, both);
    EXPECT_EQ(moved.norm() == 0, !both);
  }
}

// From behind the body to the front, as in a walk and on a stair.
TEST(LegClearance, AStrideIsLeftToTheBit) {
  Lowered given(
      13, [](int f) { return -30.0 + 10.0 * f; }, thigh_up);
  expect_left_to_the_bit(given);
}

TEST(LegClearance, IsTurnedWithoutAJumpInSpeed) {
  const auto degrees = [](int f) { return 135.0 * std::pow(std::sin(std::numbers::pi * f / 120.0), 8); };
  Lowered given(121, degrees, thigh_up);
  const PoseTrack was = given.track;
  given.clear();
  const std::vector<double> turned = given.turns_since(was);
  EXPECT_GT(turned[60], 5);
  EXPECT_EQ(turned[10], 0);
  for (std::size_t f = 1; f + 1 < turned.size(); ++f)
    EXPECT_LT(std::abs(turned[f + 1] - 2 * turned[f] + turned[f - 1]), 0.05 * turned[60]) << f;
}

}  // namespace
}  // namespace toile::internal
