// BVH: joints, channels in any order, and what a file may not do.
#include "io/bvh.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace toile::internal {
namespace {

const std::string file =
    "\xef\xbb\xbfhierarchy\r\n"
    "ROOT Bip01 Pelvis {\n  OFFSET 1 2 3\n  CHANNELS 6 Zposition Xposition Yposition Yrotation Xrotation Zrotation\n"
    "  JOINT arm\n  {\n    OFFSET 0 10 0\n    CHANNELS 1 Zrotation\n    End Site\n    { OFFSET 0 5 0 }\n  }\n"
    "  JOINT leg\n  {\n    OFFSET 0 -10 0\n    CHANNELS 0\n  }\n}\n"
    "MOTION\nFrames: 2\nFrame Time: 0.04\n"
    "30 10 20 90 0 0 0\n 30 1.5e1 +20 0 90 90 -90\n";

std::string complaint(const std::string& from, const std::string& to) {
  std::string text = file;
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  text.replace(place, from.size(), to);
  try {
    parse_bvh(text, "a.bvh");
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(Bvh, ReadsJointsAndChannelsInTheirOrder) {
  const BvhMotion read = parse_bvh(file, "a.bvh");
  const Figure& figure = read.figure;
  ASSERT_EQ(figure.nodes.size(), 4U);
  EXPECT_EQ(figure.nodes[0].name, "Bip01 Pelvis");
  EXPECT_EQ(figure.nodes[2].name, "") << "an end site";
  EXPECT_EQ(figure.nodes[2].parent, 1);
  EXPECT_EQ(figure.nodes[3].parent, 0);
  EXPECT_EQ(world_transforms(figure)[2].col(3), Vec3(1, 17, 3));
  ASSERT_EQ(read.track.poses.size(), 2U);
  EXPECT_DOUBLE_EQ(read.track.rate_hz, 25);
  // A quarter about y: positions stand for the offset.
  const auto first = world_transforms(figure, read.track.poses[0]);
  EXPECT_EQ(first[0].col(3), Vec3(10, 20, 30));
  EXPECT_NEAR((first[0].leftCols<3>() * Vec3(0, 0, 1) - Vec3(1, 0, 0)).norm(), 0, 1e-12);
  // R = Rx(90) Rz(90), the first channel outermost; the arm turns back by Rz(-90).
  const auto second = world_transforms(figure, read.track.poses[1]);
  EXPECT_NEAR((second[0].leftCols<3>() * Vec3(1, 0, 0) - Vec3(0, 0, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR((second[1].leftCols<3>() * Vec3(1, 0, 0) - Vec3(1, 0, 0)).norm(), 0, 1e-12);
}

TEST(Bvh, SaysLineExpectedAndGot) {
  EXPECT_EQ(complaint("hierarchy", "NOTHING"), "a.bvh:1: expected HIERARCHY, got \"NOTHING\"");
  EXPECT_EQ(complaint("Xposition", "Wposition"),
            "a.bvh:4: expected Xposition, Yrotation or the like, got \"Wposition\"");
  EXPECT_EQ(complaint("CHANNELS 6", "CHANNELS 9"), "a.bvh:4: expected a whole number up to 6, got \"9\"");
  EXPECT_EQ(complaint("0 10 0", "0 nan 0"), "a.bvh:7: expected a number within 1000000000, got \"nan\"");
  EXPECT_EQ(complaint("0 10 0", "0 1e99 0"), "a.bvh:7: expected a number within 1000000000, got \"1e99\"");
  EXPECT_EQ(complaint("JOINT arm", "JOINT "), "a.bvh:5: expected a joint's name, got the end of the line or the file");
  EXPECT_EQ(complaint("Frames: 2", "Frames: 0"), "a.bvh:19: expected at least one frame, got \"0\"");
  EXPECT_EQ(complaint("Frames: 2", "Frames: 3"), "a.bvh:23: expected a number, got the end of the line or the file");
  EXPECT_EQ(complaint("Frames: 2", "Frames: 1"), "a.bvh:22: expected the end after 1 frames, got \"30\"");
  EXPECT_NE(complaint("Frames: 2", "Frames: 900000000").find("expected at most "), std::string::npos);
  EXPECT_EQ(complaint("0.04", "0"), "a.bvh:20: expected a time of at least 0.0001 s, got \"0.000000\"");
  EXPECT_EQ(complaint("90 0 0 0\n", "90 0 0\n"), "a.bvh:23: expected a number, got the end of the line or the file");
}

TEST(Bvh, SurvivesAFileCutAnywhereAndAnyFlippedByte) {
  for (std::size_t cut = 0; cut + 2 < file.size(); ++cut) {
    try {
      parse_bvh(file.substr(0, cut), "a.bvh");
      ADD_FAILURE() << cut;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("a.bvh:")) << error.what();
    }
  }
  for (std::size_t place = 0; place < file.size(); ++place)
    for (const char byte : std::string("\0 9{}-e\n\xff", 9)) {
      std::string broken = file;
      broken[place] = byte;
      try {
        parse_bvh(broken, "a.bvh");
      } catch (const InputError&) {
        continue;
      }
    }
}

// Depth costs no stack.
TEST(Bvh, BoundsTheNumberOfJoints) {
  std::string text = "HIERARCHY ROOT a\n{ OFFSET 0 0 0 CHANNELS 1 Xrotation\n";
  for (int k = 0; k < 10'000; ++k) text += "JOINT b\n{ OFFSET 0 1 0 CHANNELS 0\n";
  try {
    parse_bvh(text, "a.bvh");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("expected at most 10000 joints"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace toile::internal
