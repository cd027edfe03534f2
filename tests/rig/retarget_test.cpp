// A motion of one skeleton on another: other rest pose, other units, other axes, other names.
#include "rig/retarget.hpp"

#include "core/error.hpp"
#include "rig/feet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

constexpr double pi = std::numbers::pi;

struct Bone {
  const char* name;
  Index parent;
  Vec3 place;  // y up, looking along z
};

// Turned into other axes and units; a vertex at every joint, and four under each foot.
Figure figure_of(const std::vector<Bone>& bones, const Quaternion& axes, double scale) {
  Figure figure;
  FigureSkin skin;
  const auto place = [&](const Vec3& p) { return Vec3(scale * (axes * p)); };
  figure.first_influence.push_back(0);
  for (const Bone& bone : bones) {
    const auto number = static_cast<Index>(figure.nodes.size());
    figure.nodes.push_back({bone.name, bone.parent});
    NodePose pose;
    pose.translation = place(bone.place) - (bone.parent < 0 ? Vec3(0, 0, 0) : place(bones[at(bone.parent)].place));
    figure.rest.nodes.push_back(pose);
    Affine to_joint;
    to_joint << Mat3::Identity(), -place(bone.place);
    skin.joints.push_back(number);
    skin.to_joint.push_back(to_joint);
    const bool is_foot = std::string(bone.name).find("oot") != std::string::npos;
    for (const double z : {-0.05, 0.15})
      for (const double x : {-0.04, 0.04}) {
        if (!is_foot) break;
        figure.modelled.push_back(place(Vec3(bone.place.x() + x, 0, z)));
        figure.influences.push_back({number, 1});
        figure.first_influence.push_back(figure.influences.size());
      }
  }
  figure.order = parents_first(figure.nodes, "figure");
  figure.skins.push_back(skin);
  figure.parts.push_back({0, 0, 0, figure.modelled.size()});
  return figure;
}

// Arms level.
const std::vector<Bone> t_pose = {{"Hips", -1, {0, 0.9, 0}},
                                  {"LeftUpLeg", 0, {0.1, 0.85, 0}},
                                  {"LeftLeg", 1, {0.1, 0.45, 0}},
                                  {"LeftFoot", 2, {0.1, 0.08, 0}},
                                  {"LeftToeBase", 3, {0.1, 0.03, 0.12}},
                                  {"RightUpLeg", 0, {-0.1, 0.85, 0}},
                                  {"RightLeg", 5, {-0.1, 0.45, 0}},
                                  {"RightFoot", 6, {-0.1, 0.08, 0}},
                                  {"RightToeBase", 7, {-0.1, 0.03, 0.12}},
                                  {"Spine", 0, {0, 1.0, 0}},
                                  {"LeftArm", 9, {0.2, 1.4, 0}},
                                  {"LeftForeArm", 10, {0.5, 1.4, 0}},
                                  {"LeftHand", 11, {0.75, 1.4, 0}},
                                  {"Head", 9, {0, 1.6, 0}}};
// Arms at 45 degrees; other names, other order of its joints.
const double a = 0.3 / std::sqrt(2.0);
const std::vector<Bone> a_pose = {{"pelvis", -1, {0, 1.0, 0}},
                                  {"torso", 0, {0, 1.1, 0}},
                                  {"left_shoulder", 1, {0.2, 1.5, 0}},
                                  {"left_elbow", 2, {0.2 + a, 1.5 - a, 0}},
                                  {"left_hand", 3, {0.2 + 2 * a, 1.5 - 2 * a, 0}},
                                  {"left_hip", 0, {0.1, 0.95, 0}},
                                  {"left_knee", 5, {0.1, 0.5, 0}},
                                  {"left_foot", 6, {0.1, 0.08, 0}},
                                  {"right_hip", 0, {-0.1, 0.95, 0}},
                                  {"right_knee", 8, {-0.1, 0.5, 0}},
                                  {"right_foot", 9, {-0.1, 0.08, 0}},
                                  {"head", 1, {0, 1.7, 0}}};

const Quaternion z_up = rotation_about(Vec3(1, 0, 0), pi / 2);

Index node(const Figure& figure, const std::string& name) {
  for (std::size_t i = 0; i < figure.nodes.size(); ++i)
    if (figure.nodes[i].name == name) return static_cast<Index>(i);
  ADD_FAILURE() << name;
  return 0;
}
Vec3 place_of(const Figure& figure, const FigurePose& pose, const std::string& name) {
  return world_transforms(figure, pose)[at(node(figure, name))].col(3);
}
Vec3 direction(const Figure& figure, const FigurePose& pose, const std::string& from, const std::string& to) {
  return (place_of(figure, pose, to) - place_of(figure, pose, from)).normalized();
}

struct Moved {
  Figure source, target;
  Retargeted result;
};
// `at_frame` poses the source, whose axes and units are its own; 60 frames.
Moved moved(const Quaternion& axes, const std::function<void(int, const Figure&, FigurePose&)>& at_frame,
            double rate_hz = 30) {
  Moved moved{figure_of(t_pose, axes, 100), figure_of(a_pose, {}, 1), {}};
  PoseTrack track;
  track.rate_hz = rate_hz;
  for (int frame = 0; frame < 60; ++frame) {
    track.poses.push_back(moved.source.rest);
    at_frame(frame, moved.source, track.poses.back());
  }
  moved.result = retarget({&moved.source, person_bones(moved.source)}, track,
                          {&moved.target, person_bones(moved.target)}, "a.bvh");
  return moved;
}

TEST(Retarget, LimbsPointWhereTheRecordingsDo) {
  for (const Quaternion& axes : {Quaternion{}, z_up}) {
    const Moved m = moved(axes, [&](int frame, const Figure& figure, FigurePose& pose) {
      const auto turn = [&](const char* name, const Vec3& axis, double angle) {
        pose.nodes[at(node(figure, name))].turn = rotation_about(axes * axis, angle);
      };
      turn("LeftArm", {0, 0, 1}, -0.02 * frame);
      turn("LeftForeArm", {0, 1, 0}, -0.01 * frame);
      turn("LeftUpLeg", {1, 0, 0}, -0.01 * frame);
      turn("LeftLeg", {1, 0, 0}, 0.02 * frame);
      turn("Spine", {0, 1, 0}, 0.01 * frame);
    });
    ASSERT_EQ(m.result.track.poses.size(), 60U);
    const FigurePose& pose = m.result.track.poses[50];
    FigurePose given = m.source.rest;
    const auto turn = [&](const char* name, const Vec3& axis, double angle) {
      given.nodes[at(node(m.source, name))].turn = rotation_about(axes * axis, angle);
    };
    turn("LeftArm", {0, 0, 1}, -1);
    turn("LeftForeArm", {0, 1, 0}, -0.5);
    turn("LeftUpLeg", {1, 0, 0}, -0.5);
    turn("LeftLeg", {1, 0, 0}, 1);
    turn("Spine", {0, 1, 0}, 0.5);
    for (const auto& [own, from, to, from2, to2] :
         {std::tuple("upper arm", "left_shoulder", "left_elbow", "LeftArm", "LeftForeArm"),
          {"forearm", "left_elbow", "left_hand", "LeftForeArm", "LeftHand"},
          {"thigh", "left_hip", "left_knee", "LeftUpLeg", "LeftLeg"},
          {"shank", "left_knee", "left_foot", "LeftLeg", "LeftFoot"},
          {"still", "right_hip", "right_knee", "RightUpLeg", "RightLeg"}}) {
      const Vec3 wanted = axes.inverse() * direction(m.source, given, from2, to2);
      EXPECT_LT((direction(m.target, pose, from, to) - wanted).norm(), 1e-9) << own;
    }
  }
}

// Legs of 0.87 against 0.77: the way is as much longer; on the floor all the time, though the recording's floor slopes.
TEST(Retarget, GoesByTheLengthOfTheLegsOnTheFloor) {
  const Moved m = moved({}, [](int frame, const Figure&, FigurePose& pose) {
    pose.nodes[0].translation += Vec3(0, 0.1 * frame, 0.5 * frame);
  });
  const Vec3 way =
      place_of(m.target, m.result.track.poses.back(), "pelvis") - place_of(m.target, m.target.rest, "pelvis");
  EXPECT_NEAR(way.z(), 0.005 * 59 * 0.87 / 0.77, 1e-9);
  for (const FigurePose& pose : m.result.track.poses)
    for (const Vec3& x : all_vertices(m.target, pose)) EXPECT_NEAR(x.y(), 0, 1e-3);
}

TEST(Retarget, JumpsAreJumps) {
  const Moved m = moved({}, [](int frame, const Figure&, FigurePose& pose) {
    const double t = (frame - 30) / 9.0;
    if (std::abs(t) < 1) pose.nodes[0].translation.y() += 30 * (1 - t * t);
  });
  std::vector<double> low;
  for (const FigurePose& pose : m.result.track.poses) low.push_back(all_vertices(m.target, pose).front().y());
  EXPECT_NEAR(low[30], (0.3 - 0.03 * 0.77) * 0.87 / 0.77, 0.02);
  EXPECT_NEAR(low[10], 0, 1e-3);
  EXPECT_NEAR(low[50], 0, 1e-3);
}

// A recording that begins in a corner, looking back: the body begins where it stands, looking ahead.
TEST(Retarget, BeginsWhereTheBodyStands) {
  const Moved m = moved({}, [](int frame, const Figure&, FigurePose& pose) {
    pose.nodes[0].translation += Vec3(300, 0, -200 - frame);
    pose.nodes[0].turn = rotation_about(Vec3(0, 1, 0), pi);
  });
  EXPECT_LT((place_of(m.target, m.result.track.poses[0], "pelvis") - Vec3(0, 1, 0)).norm(), 1e-3);
  EXPECT_LT((direction(m.target, m.result.track.poses[0], "left_hip", "right_hip") - Vec3(-1, 0, 0)).norm(), 1e-9);
  EXPECT_NEAR(place_of(m.target, m.result.track.poses.back(), "pelvis").z(), 0.59 * 0.87 / 0.77, 1e-9);
}

// A foot that is 20 degrees off the floor at rest is flat where it stands.
TEST(Retarget, SolesAreFlatWhereTheyStand) {
  const Moved m = moved({}, [](int, const Figure& figure, FigurePose& pose) {
    for (const char* foot : {"LeftFoot", "RightFoot"})
      pose.nodes[at(node(figure, foot))].turn = rotation_about(Vec3(1, 0, 0), pi / 9);
  });
  for (const Vec3& x : all_vertices(m.target, m.result.track.poses[30])) EXPECT_NEAR(x.y(), 0, 1e-6);
}

// A knee that flips from one frame to the next: within 0.1 s, and told.
TEST(Retarget, MendsWhatNoJointCanDo) {
  const Moved m = moved(
      {},
      [](int frame, const Figure& figure, FigurePose& pose) {
        pose.nodes[at(node(figure, "LeftUpLeg"))].turn = rotation_about(Vec3(1, 0, 0), frame < 30 ? -1.5 : 1.5);
        pose.nodes[at(node(figure, "LeftArm"))].turn = rotation_about(Vec3(0, 0, 1), 0.05 * frame);
      },
      120);
  ASSERT_EQ(m.result.notes.size(), 1U);
  EXPECT_EQ(m.result.notes[0], "\"LeftUpLeg\" turns faster than any joint can at 0.242 s: smoothed over 0.1 s");
  const auto knee = [&](int frame) {
    return direction(m.target, m.result.track.poses[static_cast<std::size_t>(frame)], "left_hip", "left_knee");
  };
  for (int frame = 20; frame < 40; ++frame) EXPECT_LT(std::acos(knee(frame).dot(knee(frame + 1))), 0.3) << frame;
  EXPECT_LT((knee(20) - knee(23)).norm(), 1e-9);
}

// A foot turned back to front, toes and all, as where its markers are swapped.
TEST(Retarget, AFootThatNoAnkleCanTurnIsLedBack) {
  const auto turned = [](double radians) {
    return moved({}, [radians](int, const Figure& figure, FigurePose& pose) {
      pose.nodes[at(node(figure, "LeftFoot"))].turn = rotation_about(Vec3(0, 1, 0), radians);
    });
  };
  const Moved broken = turned(2.8), still = turned(0), real = turned(0.5);
  ASSERT_EQ(broken.result.notes.size(), 1U);
  EXPECT_EQ(broken.result.notes[0],
            "\"LeftFoot\" is turned by up to 160 degrees (at 0.000 s), farther than an ankle can: led back");
  EXPECT_TRUE(real.result.notes.empty());
  const auto foot = [](const Moved& m) {
    return m.result.track.poses.back().nodes[at(node(m.target, "left_foot"))].turn;
  };
  EXPECT_NEAR(std::abs(foot(broken).dot(foot(still))), 1, 1e-12);
  EXPECT_LT(std::abs(foot(real).dot(foot(still))), 0.98);
}

// From a leg turned outwards by 100 degrees to one turned inwards by 90: through the front, which is the longer way.
TEST(Retarget, AJumpGoesTheWayThatAJointCanGo) {
  const Moved m = moved(
      {},
      [](int frame, const Figure& figure, FigurePose& pose) {
        pose.nodes[at(node(figure, "LeftUpLeg"))].turn =
            rotation_about(Vec3(0, 1, 0), (frame < 30 ? 100 : -90) * pi / 180);
      },
      120);
  for (const FigurePose& pose : m.result.track.poses) {
    const Quaternion& turn = pose.nodes[at(node(m.target, "left_hip"))].turn;
    EXPECT_GE(std::abs(turn.w), std::cos(50 * pi / 180) - 1e-9);  // never more than 100 degrees from rest
  }
}

TEST(Retarget, SaysWhatIsMissing) {
  const Figure none = figure_of({{"Bone", -1, {0, 1, 0}}}, {}, 1), target = figure_of(a_pose, {}, 1);
  PoseTrack track;
  track.poses = {none.rest};
  try {
    retarget({&none, person_bones(none)}, track, {&target, person_bones(target)}, "a.bvh");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "a.bvh: motion: expected hips among the names of its joints, or in a file of bones, got Bone");
  }
  const Moved m = moved({}, [](int, const Figure&, FigurePose&) {});
  EXPECT_TRUE(m.result.notes.empty());
  Figure source = figure_of(t_pose, {}, 100);
  source.nodes[at(node(source, "Head"))].name = "Kopf";
  track.poses = {source.rest};
  const Retargeted headless =
      retarget({&source, person_bones(source)}, track, {&target, person_bones(target)}, "a.bvh");
  ASSERT_EQ(headless.notes.size(), 1U);
  EXPECT_NE(headless.notes[0].find("\"head\""), std::string::npos);
}

}  // namespace
}  // namespace toile::internal
