// Poses and the skin that follows them: the A-pose to the last bit, rigid limbs, and joints that keep their girth.
#include "body/pose.hpp"

#include "body/mannequins.hpp"
#include "body/measure.hpp"
#include "body/motion.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace toile::internal {
namespace {

using test::joint;
using test::mannequin_of;

constexpr double degree = M_PI / 180;

// What skinning was before dual quaternions: the average of where each joint carries the vertex.
std::vector<Vec3> linear_blend(const Mannequin& m, const Pose& pose) {
  const auto transforms = joint_transforms(m.joints, pose);
  std::vector<Vec3> x(m.positions.size(), Vec3::Zero());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k)
      x[i] += m.skin[i].weight[k] * transforms[static_cast<std::size_t>(m.skin[i].joint[k])](m.positions[i]);
  return x;
}

std::vector<Vec3> skinned(const Mannequin& m, const Pose& pose) {
  std::vector<Vec3> x(m.positions.size());
  SkinnedBody(m).positions(pose, x);
  return x;
}

// A tape around a limb: where it lies in the A-pose, and the joint that it turns with, half-way to `other`.
struct Tape {
  const char* joint;
  const char* other;
  double along;  // of the bone of `joint`, m from it
};

double girth(const Mannequin& m, std::span<const Vec3> x, const Pose& pose, const Tape& tape) {
  const Joint& bone = m.joints[joint(m, tape.joint)];
  const Vec3 direction = (bone.end_m - bone.position_m).normalized();
  const auto transforms = joint_transforms(m.joints, pose);
  const RigidTransform& a = transforms[joint(m, tape.joint)];
  const RigidTransform& b = transforms[joint(m, tape.other)];
  const double sign = a.turn.dot(b.turn) < 0 ? -1 : 1;
  const Quaternion half = Quaternion{a.turn.w + sign * b.turn.w, a.turn.v + sign * b.turn.v}.normalised();
  return girth_at_m(x, m.triangles, a(bone.position_m + tape.along * direction), half * direction);
}

double volume(const Mannequin& m, std::span<const Vec3> x) {
  double sum = 0;
  for (const Triangle& t : m.triangles)
    sum += x[static_cast<std::size_t>(t[0])].dot(
               x[static_cast<std::size_t>(t[1])].cross(x[static_cast<std::size_t>(t[2])])) /
           6;
  return sum;
}

TEST(Quaternion, TurnsLikeAMatrixAndComposes) {
  const Vec3 axis = Vec3(1, -2, 0.5).normalized(), p(0.3, -0.7, 1.1);
  const Quaternion a = rotation_about(axis, 0.8), b = rotation_about(Vec3(0, 1, 0), -2.1);
  const Vec3 expected = Eigen::AngleAxisd(0.8, axis) * (Eigen::AngleAxisd(-2.1, Vec3::UnitY()) * p);
  EXPECT_LT((a * b * p - expected).norm(), 1e-14);
  EXPECT_LT((a.inverse() * (a * p) - p).norm(), 1e-14);
  const Vec3 u(0.2, 0.9, -1.3), v(-2, 0.1, 0.4);
  const Vec3 turned = rotation_between(u, v) * u;
  EXPECT_LT(turned.cross(v).norm(), 1e-14);
  EXPECT_GT(turned.dot(v), 0);
  const Vec3 mirrored = a.mirrored() * Vec3(-p.x(), p.y(), p.z());
  EXPECT_LT((Vec3(-mirrored.x(), mirrored.y(), mirrored.z()) - a * p).norm(), 1e-14);
}

TEST(Pose, OfRestIsTheMannequinToTheLastBit) {
  const Mannequin& m = mannequin_of(MannequinKind::dancer);
  const std::vector<Vec3> x = skinned(m, a_pose(m.joints.size()));
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_EQ(x[i], m.positions[i]) << i;
  // And through the words of movement, planted or free, within rounding.
  for (const Legs legs : {Legs::planted, Legs::free}) {
    const std::vector<Vec3> y = skinned(m, make_pose({}, legs, m.joints));
    for (std::size_t i = 0; i < y.size(); ++i) ASSERT_LT((y[i] - m.positions[i]).norm(), 1e-12) << i;
  }
}

TEST(Pose, OfTheRootAloneMovesTheBodyAsOnePiece) {
  const Mannequin& m = mannequin_of(MannequinKind::dancer);
  Pose pose = a_pose(m.joints.size());
  pose.root_m = {0.3, -0.2, 1.5};
  pose.turns[0] = rotation_about(Vec3(0.6, 0, 0.8), 3.0);
  const std::vector<Vec3> x = skinned(m, pose);
  const Vec3& c = m.joints[0].position_m;
  for (std::size_t i = 0; i < x.size(); ++i)
    ASSERT_LT((x[i] - (pose.turns[0] * (m.positions[i] - c) + c + pose.root_m)).norm(), 1e-12);
}

TEST(Pose, TurnsALimbAboutItsJointAndLeavesTheRest) {
  const Mannequin& m = mannequin_of(MannequinKind::dancer);
  Pose pose = a_pose(m.joints.size());
  pose.turns[joint(m, "elbow_left")] = rotation_about(Vec3(0, 0, 1), 1.2);
  const std::vector<Vec3> x = skinned(m, pose);
  const Vec3& c = m.joints[joint(m, "elbow_left")].position_m;
  int hand = 0, far = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (m.positions[i].x() > 0.60) {
      ++hand;
      ASSERT_LT((x[i] - (pose.turns[joint(m, "elbow_left")] * (m.positions[i] - c) + c)).norm(), 1e-9);
    }
    if (m.positions[i].x() < 0.1) {
      ++far;
      ASSERT_EQ(x[i], m.positions[i]);
    }
  }
  EXPECT_GT(hand, 100);
  EXPECT_GT(far, 1000);
}

TEST(Pose, DoesNotCareWhichOfTwoQuaternionsNamesARotation) {
  const Mannequin& m = mannequin_of(MannequinKind::dancer);
  Pose pose = Motion::named("dance", MannequinKind::dancer).at(4.0), other = pose;
  for (const char* name : {"elbow_left", "chest", "hip_right"}) {
    Quaternion& q = other.turns[joint(m, name)];
    q = {-q.w, -q.v};
  }
  const std::vector<Vec3> x = skinned(m, pose), y = skinned(m, other);
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_LT((x[i] - y[i]).norm(), 1e-12);
}

// Left and right exchanged, and what leans or turns to a side with them: the image in x = 0.
TEST(Pose, OfAMirroredPostureIsTheImage) {
  const Mannequin& m = mannequin_of(MannequinKind::dancer);
  for (const Legs legs : {Legs::planted, Legs::free}) {
    Posture p, image;
    for (std::size_t c = 0; c < channel_count; ++c) p.values[c] = 3.0 + static_cast<double>(c * 7 % 11);
    p(Channel::pelvis_x) = 0.03, p(Channel::pelvis_y) = -0.06, p(Channel::pelvis_z) = 0.02;
    for (const Side side : {Side::left, Side::right}) {
      p(Channel::foot_x, side) = side == Side::left ? -0.02 : 0.03;
      p(Channel::foot_z, side) = side == Side::left ? 0.05 : -0.04;
    }
    const auto first_of_side = static_cast<std::size_t>(Channel::collar);
    for (std::size_t c = 0; c < channel_count; ++c) {
      const bool left = c < first_of_side + side_channels;
      image.values[c] = p.values[c < first_of_side ? c : left ? c + side_channels : c - side_channels];
    }
    for (const Channel c :
         {Channel::turn, Channel::pelvis_x, Channel::pelvis_turn, Channel::pelvis_list, Channel::spine_turn,
          Channel::spine_left, Channel::chest_turn, Channel::chest_left, Channel::neck_turn, Channel::neck_left})
      image(c) = -p(c);
    const auto a = joint_transforms(m.joints, make_pose(p, legs, m.joints));
    const auto b = joint_transforms(m.joints, make_pose(image, legs, m.joints));
    for (std::size_t j = 0; j < m.joints.size(); ++j) {
      std::string name = m.joints[j].name;
      if (const auto left = name.find("_left"); left != std::string::npos)
        name.replace(left, 5, "_right");
      else if (const auto right = name.find("_right"); right != std::string::npos)
        name.replace(right, 6, "_left");
      // Three points of a bone that do not lie on a line, so that a turn about its axis shows.
      for (const Vec3& off : {Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0, 0, 0.1)}) {
        const Vec3 q = m.joints[j].end_m + off;
        const Vec3 expected = a[j](q), got = b[joint(m, name)](Vec3(-q.x(), q.y(), q.z()));
        EXPECT_LT((Vec3(-got.x(), got.y(), got.z()) - expected).norm(), 1e-9) << name;
      }
    }
  }
}

TEST(Pose, RefusesAnotherNumberOfJointsOrVertices) {
  const Mannequin& m = mannequin_of(MannequinKind::dancer);
  const SkinnedBody body(m);
  std::vector<Vec3> x(m.positions.size()), few(3);
  EXPECT_THROW(body.positions(a_pose(3), x), InputError);
  EXPECT_THROW(body.positions(a_pose(m.joints.size()), few), InputError);
}

TEST(Pose, IsTheSameOnOneThreadAndOnMany) {
  const Mannequin& m = mannequin_of(MannequinKind::dancer);
  const Pose pose = Motion::named("dance", MannequinKind::dancer).at(11.3);
  const std::vector<Vec3> many = skinned(m, pose);
  with_threads(1, [&] {
    const std::vector<Vec3> one = skinned(m, pose);
    for (std::size_t i = 0; i < one.size(); ++i) ASSERT_EQ(one[i], many[i]);
  });
}

// A twist is what wrings linear blending like a sweet's wrapper: half-way it averages a limb with its image.
TEST(Pose, KeepsTheGirthOfAWrungArmWhereLinearBlendingPinchesIt) {
  const Mannequin& m = mannequin_of(MannequinKind::dancer);
  const Joint& arm = m.joints[joint(m, "shoulder_left")];
  Pose pose = a_pose(m.joints.size());
  pose.turns[joint(m, "elbow_left")] = rotation_about((arm.end_m - arm.position_m).normalized(), 150 * degree);
  const Tape elbow{"elbow_left", "shoulder_left", 0};
  const double rest = girth(m, m.positions, a_pose(m.joints.size()), elbow);
  EXPECT_NEAR(girth(m, skinned(m, pose), pose, elbow), rest, 0.10 * rest);
  EXPECT_LT(girth(m, linear_blend(m, pose), pose, elbow), 0.60 * rest);
}

struct Worst {
  double least = 1, most = 1;
  void add(double ratio) {
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
};

class BodyInPose : public testing::TestWithParam<MannequinKind> {};

TEST_P(BodyInPose, KeepsGirthsAndVolumeThroughAllMotions) {
  const Mannequin& m = mannequin_of(GetParam());
  const SkinnedBody body(m);
  const Tape tapes[] = {{"elbow_left", "shoulder_left", 0},
                        {"elbow_right", "shoulder_right", 0},
                        {"knee_left", "hip_left", 0},
                        {"knee_right", "hip_right", 0},
                        {"shoulder_left", "shoulder_left", 0.11},
                        {"shoulder_right", "shoulder_right", 0.11},
                        {"hip_left", "hip_left", 0.13},
                        {"hip_right", "hip_right", 0.13},
                        {"hips", "hips", -0.07},   // above the crotch
                        {"chest", "chest", 0.04},  // under the arms
                        {"spine", "spine", 0.00}};
  const Pose rest = a_pose(m.joints.size());
  std::vector<Worst> worst(std::size(tapes)), linear(std::size(tapes));
  Worst volumes;
  std::vector<double> girths;
  for (const Tape& tape : tapes) girths.push_back(girth(m, m.positions, rest, tape));
  std::vector<Vec3> x(m.positions.size());
  for (const std::string_view name : motion_names()) {
    const Motion motion = Motion::named(name, GetParam());
    const int frames = static_cast<int>((motion.loop_start_s() + motion.period_s()) / 0.25);
    for (int f = 1; f <= frames; ++f) {
      const Pose pose = motion.at(0.25 * f);
      body.positions(pose, x);
      const std::vector<Vec3> old = linear_blend(m, pose);
      volumes.add(volume(m, x) / volume(m, m.positions));
      for (std::size_t k = 0; k < std::size(tapes); ++k) {
        // A thigh lifted to the side or front enters the level section around the hips.
        if (tapes[k].joint == std::string_view("hips") && (name == "dance" || name == "crouch")) continue;
        worst[k].add(girth(m, x, pose, tapes[k]) / girths[k]);
        linear[k].add(girth(m, old, pose, tapes[k]) / girths[k]);
      }
    }
  }
  for (std::size_t k = 0; k < std::size(tapes); ++k) {
    EXPECT_GT(worst[k].least, 0.90) << tapes[k].joint;
    EXPECT_LT(worst[k].most, 1.10) << tapes[k].joint;
  }
  EXPECT_LT(linear[0].least, 0.90);  // linear blending would pinch the bent elbow by more than a tenth,
  EXPECT_LT(linear[2].least, 0.90);  // and the knee
  EXPECT_GT(volumes.least, 0.95);
  EXPECT_LT(volumes.most, 1.05);
}

INSTANTIATE_TEST_SUITE_P(Kinds, BodyInPose, testing::Values(MannequinKind::dancer, MannequinKind::man),
                         [](const auto& kind) { return std::string(to_string(kind.param)); });

}  // namespace
}  // namespace toile::internal
