// Targets, rigs and weights as MakeHuman and MPFB keep them, and files of bones.
#include "io/makehuman.hpp"

#include "core/error.hpp"
#include "io/bone_parts.hpp"
#include "support/message_of.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace toile::internal {
namespace {

using test::message_of;

// Four corners about (0, 1, 0) are a group, a triangle of three others is not.
SurfaceMesh mesh() {
  SurfaceMesh mesh;
  mesh.positions = {{-1, 1, 0}, {1, 1, 0}, {0, 0, 0}, {0, 2, 0}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {4, 5, 6}};
  mesh.group = {0, 0, 1};
  mesh.group_names = {"joint-a", "body"};
  return mesh;
}
const std::string rig = R"({"Root": {"parent": "", "head": {"strategy": "CUBE", "cube_name": "joint-a"}},)"
                        R"( "Arm": {"parent": "Root", "head": {"strategy": "MEAN", "vertex_indices": [4, 5]}},)"
                        R"( "Hand": {"parent": "Arm", "head": {"strategy": "VERTEX", "vertex_index": 6}}})";
const std::string weights = R"({"weights": {"Root": [[0, 1], [4, 1]], "Hand": [[4, 3], [5, 1]], "Arm": []}})";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

TEST(MakeHuman, JointsAreWhereTheMeshSays) {
  for (const std::string& text : {rig, R"({"version": 110, "bones": )" + rig + '}'}) {
    std::vector<std::string> notes;
    const Figure figure = makehuman_figure(mesh(), {text, "rig.a.json"}, {weights, "weights.a.json"}, notes);
    const std::vector<Affine> world = world_transforms(figure);
    ASSERT_EQ(world.size(), 3U);
    EXPECT_EQ(world[0].col(3), Vec3(0, 1, 0));
    EXPECT_EQ(world[1].col(3), Vec3(5.5, 5, 5));
    EXPECT_EQ(world[2].col(3), Vec3(5, 6, 5));
    EXPECT_EQ(all_vertices(figure, figure.rest)[4], Vec3(5, 5, 5));
    EXPECT_EQ(notes.size(), 1U) << "one vertex has a weight of 4";
    FigurePose pose = figure.rest;
    pose.nodes[2].translation += Vec3(0, 0, 4);
    EXPECT_EQ(all_vertices(figure, pose)[4], Vec3(5, 5, 8)) << "by three quarters";
    EXPECT_EQ(all_vertices(figure, pose)[3], Vec3(0, 2, 0)) << "on the root";
  }
}

TEST(MakeHuman, SaysWhatDoesNotFit) {
  const auto of = [](const std::string& a, const std::string& b) {
    return message_of<InputError>([&] {
      std::vector<std::string> notes;
      makehuman_figure(mesh(), {a, "r.json"}, {b, "w.json"}, notes);
    });
  };
  EXPECT_NE(of(with(rig, "\"joint-a\"", "\"joint-b\""), weights).find("expected a group of the mesh, got \"joint-b\""),
            std::string::npos);
  EXPECT_NE(of(with(rig, "\"parent\": \"Root\"", "\"parent\": \"Toor\""), weights).find("expected a bone of this rig"),
            std::string::npos);
  EXPECT_NE(of(with(rig, "\"parent\": \"\"", "\"parent\": \"Hand\""), weights).find("hangs on itself"),
            std::string::npos);
  EXPECT_NE(
      of(with(rig, "\"vertex_index\": 6", "\"vertex_index\": 7"), weights).find("expected a vertex below 7, got 7"),
      std::string::npos);
  EXPECT_NE(of(with(rig, "MEAN", "MIDDLE"), weights).find("expected CUBE, MEAN or VERTEX"), std::string::npos);
  EXPECT_NE(of(rig, with(weights, "\"Root\"", "\"Leg\"")).find("expected a bone of the rig"), std::string::npos);
  EXPECT_NE(of(rig, with(weights, "[4, 3]", "[4, -3]")).find("expected a weight of 0 or more"), std::string::npos);
  EXPECT_NE(of(rig, with(weights, "[4, 3]", "[9, 3]")).find("expected a vertex below 7, got 9"), std::string::npos);
  EXPECT_EQ(weights_beside("a/rig.cmu.json"), "a/weights.cmu.json");
  EXPECT_EQ(weights_beside("a/bones.json"), "");
}

TEST(MakeHuman, TargetsMoveVerticesByTheirShare) {
  SurfaceMesh shaped = mesh();
  apply_target("# words\r\n0 1 2 -3\r\n\n6 .5 0 0 # more\n", "a.target", 0.5, shaped);
  EXPECT_EQ(shaped.positions[0], Vec3(-0.5, 2, -1.5));
  EXPECT_EQ(shaped.positions[6], Vec3(5.25, 6, 5));
  const auto of = [&](const std::string& text) {
    return message_of<InputError>([&] { apply_target(text, "a.target", 1, shaped); });
  };
  EXPECT_EQ(of("0 1 2 3\n7 0 0 0\n"), "a.target:2: expected a vertex below 7, got \"7 0 0 0\"");
  EXPECT_EQ(of("0 1 2\n"), "a.target:1: expected three numbers after the vertex, got the end of the line");
  EXPECT_EQ(of("0 1 nan 2\n"), "a.target:1: expected three numbers after the vertex, got \"nan 2\"");
  EXPECT_EQ(of("0 1 2 3 4\n"), "a.target:1: expected the end of the line, got \"4\"");
}

TEST(MakeHuman, StandsOnTheFloorByItsBody) {
  SurfaceMesh shaped = mesh();
  put_on_floor(shaped);
  EXPECT_EQ(shaped.positions[4], Vec3(5, 0, 5));
  EXPECT_EQ(shaped.positions[2], Vec3(0, -5, 0)) << "helpers go with it";
  shaped.group_names[1] = "skin";
  put_on_floor(shaped);
  EXPECT_EQ(shaped.positions[4], Vec3(5, 0, 5)) << "without a group of that name nothing";
}

TEST(BoneParts, SayWhatNamesDoNot) {
  Figure figure;
  for (const char* name : {"Bone", "Bone.001", "Kopf", "head"}) figure.nodes.push_back({name});
  figure.order = {0, 1, 2, 3};
  PersonBones body = person_bones(figure), motion = body;
  const auto read = [&](const std::string& text) {
    read_bone_parts(text, "b.json", {&figure, &body}, {&figure, &motion});
  };
  read(
      R"({"body": {"hips": "Bone", "right thigh": "Bone.001", "spine": ["Bone", "Bone.001"], "head": null}, "motion": {"head": "Kopf"}})");
  EXPECT_EQ(body.of(BodyPart::hips), 0);
  EXPECT_EQ(body.of(BodyPart::thigh, 1), 1);
  EXPECT_EQ(body.of(BodyPart::head), -1);
  EXPECT_EQ(body.spine, (std::vector<Index>{0, 1}));
  EXPECT_EQ(motion.of(BodyPart::head), 2);
  const auto says = [&](const std::string& text) { return message_of<InputError>([&] { read(text); }); };
  EXPECT_NE(says(R"({"body": {"hip": "Bone"}})").find("hips"), std::string::npos);
  EXPECT_NE(says(R"({"body": {"hips": "Bome"}})").find("nearest is \"Bone\""), std::string::npos);
  EXPECT_NE(says(R"({"body": {"hips": ["Bone"]}})").find("expected one joint"), std::string::npos);
}

}  // namespace
}  // namespace toile::internal
