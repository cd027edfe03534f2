// Parts of a person by the names of joints, as programs write them.
#include "rig/bone_names.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <string_view>

namespace toile::internal {
namespace {

// A chain: names alone count, and which is nearer to the root.
Figure chain(std::initializer_list<std::string_view> names) {
  Figure figure;
  for (const std::string_view name : names) {
    const auto number = static_cast<Index>(figure.nodes.size());
    figure.nodes.push_back({std::string(name), number - 1});
    figure.rest.nodes.emplace_back();
    figure.order.push_back(number);
  }
  return figure;
}

// "hips|thigh left|..." of the parts that are found, by the names of their joints.
std::string found(const Figure& figure) {
  const PersonBones bones = person_bones(figure);
  std::string text;
  for (std::size_t part = 0; part < body_part_count; ++part)
    for (const Index node : bones.node[part]) text += (node < 0 ? "-" : figure.nodes[at(node)].name) + ' ';
  for (const Index node : bones.spine) text += "| " + figure.nodes[at(node)].name + ' ';
  return text;
}

TEST(BoneNames, OfCmu) {
  EXPECT_EQ(
      found(chain({"Hips",       "LHipJoint",     "LeftUpLeg", "LeftLeg",      "LeftFoot",  "LeftToeBase", "RHipJoint",
                   "RightUpLeg", "RightLeg",      "RightFoot", "RightToeBase", "LowerBack", "Spine",       "Spine1",
                   "Neck",       "Neck1",         "Head",      "LeftShoulder", "LeftArm",   "LeftForeArm", "LeftHand",
                   "LThumb",     "RightShoulder", "RightArm",  "RightForeArm", "RightHand"})),
      "Hips - Spine - Neck - Head - LeftShoulder RightShoulder LeftArm RightArm LeftForeArm RightForeArm LeftHand "
      "RightHand "
      "LeftUpLeg RightUpLeg LeftLeg RightLeg LeftFoot RightFoot LeftToeBase RightToeBase | LowerBack | Spine | "
      "Spine1 ");
}

TEST(BoneNames, OfMixamo) {
  EXPECT_EQ(found(chain({"Armature", "mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine2", "mixamorig:LeftShoulder",
                         "mixamorig:LeftArm", "mixamorig:RightUpLeg", "mixamorigRightLeg"})),
            "mixamorig:Hips - mixamorig:Spine - - - - - mixamorig:LeftShoulder - mixamorig:LeftArm - - - - - - "
            "mixamorig:RightUpLeg - "
            "mixamorigRightLeg - - - - | mixamorig:Spine | mixamorig:Spine2 ");
}

TEST(BoneNames, OfMakeHumansRigs) {
  EXPECT_EQ(found(chain({"Root", "Hips", "__UpLeg_L", "UpLeg_L", "LoLeg_L", "Foot_L", "Toe_L", "Spine1", "Clavicle_R",
                         "UpArm_R", "LoArm_R", "Hand_R"})),
            "Hips - Spine1 - - - - - - Clavicle_R - UpArm_R - LoArm_R - Hand_R UpLeg_L - LoLeg_L - Foot_L - Toe_L - | "
            "Spine1 ");
  EXPECT_EQ(found(chain({"root", "spine05", "spine04", "clavicle.L", "shoulder01.L", "upperarm01.L", "upperarm02.L",
                         "lowerarm01.L", "wrist.L", "pelvis.L", "upperleg01.L", "upperleg02.L", "lowerleg01.L",
                         "foot.L", "toe1-1.L"})),
            "root - spine05 - - - - - clavicle.L - upperarm01.L - lowerarm01.L - wrist.L - upperleg01.L - lowerleg01.L "
            "- foot.L - "
            "toe1-1.L - | spine05 | spine04 ");
  EXPECT_EQ(found(chain({"pelvis", "spine_01", "clavicle_r", "upperarm_r", "lowerarm_r", "hand_r", "thigh_r", "calf_r",
                         "foot_r", "ball_r"})),
            "pelvis - spine_01 - - - - - - clavicle_r - upperarm_r - lowerarm_r - hand_r - thigh_r - calf_r - foot_r - "
            "ball_r | spine_01 ");
}

// By joints: a shoulder is where the upper arm begins.
TEST(BoneNames, OfJoints) {
  EXPECT_EQ(found(chain({"root", "hip", "torso", "neck", "left_shoulder", "left_elbow", "left_hand", "left_hip",
                         "left_knee", "left_foot"})),
            "hip - torso - neck - - - - - left_shoulder - left_elbow - left_hand - left_hip - left_knee - left_foot - "
            "- - | torso ");
  EXPECT_EQ(found(chain({"hips", "spine", "chest", "collar_right", "shoulder_right", "elbow_right", "wrist_right",
                         "hip_right", "knee_right", "ankle_right", "toes_right"})),
            "hips - spine - - - - - - collar_right - shoulder_right - elbow_right - wrist_right - hip_right - "
            "knee_right - ankle_right - "
            "toes_right | spine | chest ");
}

TEST(BoneNames, OfNothingThatIsKnown) {
  EXPECT_EQ(found(chain({"Bone", "Bone.001", "", "L", "x_l"})), "- - - - - - - - - - - - - - - - - - - - - - - - ");
}

}  // namespace
}  // namespace toile::internal
