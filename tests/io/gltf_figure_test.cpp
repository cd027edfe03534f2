// Skins, morph targets and animations of glTF: what is taken, and what a file may not do.  Their numbers: tests/tools/gltf_pose_test.py.
#include "io/mesh_file.hpp"

#include "core/error.hpp"
#include "rig/same_names.hpp"
#include "support/message_of.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

using test::message_of;

// A triangle on two joints, the second 1 above the first, which hangs 2 below a moved and scaled root; a morph target; an animation.
struct File {
  std::string bin, views, accessors;
  std::size_t count = 0;

  template <class T>
  int add(const std::vector<T>& numbers, const std::string& type, int component, std::size_t width,
          const std::string& more = "") {
    while (bin.size() % 4 != 0) bin += '\0';
    const std::size_t first = bin.size();
    bin.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
    if (count > 0) {
      views += ',';
      accessors += ',';
    }
    views += R"({"buffer":0,"byteOffset":)" + std::to_string(first) + R"(,"byteLength":)" +
             std::to_string(bin.size() - first) + '}';
    accessors += R"({"bufferView":)" + std::to_string(count) + R"(,"componentType":)" + std::to_string(component) +
                 R"(,"count":)" + std::to_string(numbers.size() / width) + R"(,"type":")" + type + '"' + more + '}';
    return static_cast<int>(count++);
  }
  int floats(const std::vector<float>& numbers, const std::string& type, std::size_t width) {
    return add(numbers, type, 5126, width);
  }

  std::string glb(const std::string& rest) const {
    std::string json = R"({"asset":{"version":"2.0"},"accessors":[)" + accessors + R"(],"bufferViews":[)" + views +
                       R"(],"buffers":[{"byteLength":)" + std::to_string(bin.size()) + "}]," + rest + '}';
    while (json.size() % 4 != 0) json += ' ';
    std::string data = bin;
    while (data.size() % 4 != 0) data += '\0';
    std::string bytes = "glTF";
    const auto word = [&](std::size_t value) {
      const auto small = static_cast<std::uint32_t>(value);
      bytes.append(reinterpret_cast<const char*>(&small), 4);
    };
    for (const std::size_t value : {std::size_t{2}, 28 + json.size() + data.size(), json.size()}) word(value);
    bytes += "JSON" + json;
    word(data.size());
    return bytes + std::string("BIN\0", 4) + data;
  }
};

struct Words {
  std::string skin = R"({"joints":[2,3],"inverseBindMatrices":4})";
  std::string nodes =
      R"({"mesh":0,"skin":0,"translation":[5,5,5]},{"name":"root","translation":[0,2,0],"scale":[2,2,2],"children":[2]},)"
      R"({"name":"hip","translation":[0,-2,0],"children":[3]},{"name":"knee","translation":[0,1,0]})";
  std::string channels = R"({"sampler":0,"target":{"node":3,"path":"translation"}})";
  std::string samplers = R"({"input":5,"output":6,"interpolation":"LINEAR"})";
  std::string attributes = R"("POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2)";
  std::vector<float> weights = {1, 0, 0, 0, 0.5F, 0.5F, 0, 0, 0, 2, 0, 0};
  std::vector<std::uint8_t> joints = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
  std::vector<float> times = {0, 1}, moves = {0, 1, 0, 0, 1, 4};
};

std::string file_of(const Words& words) {
  File file;
  file.floats({0, 0, 0, 1, 0.5F, 0, 0, 1, 0}, "VEC3", 3);
  file.add(words.joints, "VEC4", 5121, 4);
  file.floats(words.weights, "VEC4", 4);
  file.floats({0, 0, 0, 0, 0, 0, 0, 0, 1}, "VEC3", 3);
  file.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}, "MAT4",
              16);
  file.floats(words.times, "SCALAR", 1);
  file.floats(words.moves, "VEC3", 3);
  return file.glb(R"("scenes":[{"nodes":[0,1]}],"meshes":[{"primitives":[{"attributes":{)" + words.attributes +
                  R"(},"targets":[{"POSITION":3}]}],"weights":[0.5]}],"skins":[)" + words.skin + R"(],"nodes":[)" +
                  words.nodes + R"(],"animations":[{"name":"kick","samplers":[)" + words.samplers +
                  R"(],"channels":[)" + words.channels + "]}]");
}

std::string complaint(const std::function<void(Words&)>& change) {
  Words words;
  change(words);
  return message_of<InputError>([&] { parse_animated(file_of(words), "a.glb"); });
}

TEST(GltfFigure, StandsAsItsJointsDoAndMovesWithThem) {
  const AnimatedMesh read = parse_animated(file_of({}), "a.glb");
  ASSERT_EQ(read.surface.positions.size(), 3U);
  // The root is at 2 and twice as large: the hip is at -2, the knee at 0; nodes of skinned meshes do not count.
  EXPECT_EQ(read.surface.positions[0], Vec3(0, -2, 0));
  EXPECT_EQ(read.surface.positions[1], Vec3(2, -1, 0));
  EXPECT_EQ(read.surface.positions[2], Vec3(0, 0, 1)) << "half of its morph target, twice as large";
  ASSERT_EQ(read.clips.size(), 1U);
  const std::vector<Vec3> kicked = all_vertices(read.figure, pose_at(read.clips[0], read.figure, 0.5));
  EXPECT_EQ(kicked[0], Vec3(0, -2, 0));
  EXPECT_EQ(kicked[1], Vec3(2, -1, 2)) << "by half of the knee's 4";
  EXPECT_EQ(kicked[2], Vec3(0, 0, 5));
  EXPECT_EQ(
      read.surface.notes,
      std::vector<std::string>{"a.glb: the skin weights of 1 vertex do not sum to 1, and are divided by their sum"});
  EXPECT_EQ(parse_mesh(file_of({}), "a.glb").positions, read.surface.positions);
}

TEST(GltfFigure, SaysWhatDoesNotFit) {
  EXPECT_EQ(complaint([](Words& w) { w.joints[5] = 2; }),
            "a.glb: /meshes/0/primitives/0, vertex 1: expected joints below 2, got 2");
  EXPECT_EQ(complaint([](Words& w) { w.weights[4] = -1; }),
            "a.glb: /meshes/0/primitives/0, vertex 1: expected weights of 0 or more, got -1.000000");
  EXPECT_EQ(complaint([](Words& w) { w.attributes = R"("POSITION":0)"; }),
            "a.glb: /meshes/0/primitives/0/attributes/JOINTS_0: expected joints, as its node has a skin, got none");
  EXPECT_EQ(complaint([](Words& w) { w.attributes += R"(,"WEIGHTS_1":2)"; }),
            "a.glb: /meshes/0/primitives/0/attributes/JOINTS_1: expected joints, as its node has a skin, got none");
  EXPECT_EQ(complaint([](Words& w) { w.skin = R"({"joints":[2,9]})"; }),
            "a.glb: /skins/0/joints: expected nodes below 4, got 9");
  EXPECT_EQ(complaint([](Words& w) { w.skin = R"({"joints":[2,3,1],"inverseBindMatrices":4})"; }),
            "a.glb: /skins/0/inverseBindMatrices: expected 3, one for each joint, got 2");
  EXPECT_EQ(complaint([](Words& w) { w.channels = R"({"sampler":0,"target":{"node":7,"path":"rotation"}})"; }),
            "a.glb: /animations/0/channels/0/target/node: expected a node below 4, got 7");
  EXPECT_EQ(complaint([](Words& w) { w.channels = R"({"sampler":3,"target":{"node":3,"path":"scale"}})"; }),
            "a.glb: /animations/0/channels/0/sampler: expected a number below 1, got 3");
  EXPECT_EQ(complaint([](Words& w) { w.samplers = R"({"input":5,"output":6,"interpolation":"CUBICSPLINE"})"; }),
            "a.glb: /animations/0/channels/0: expected 18 numbers for its 2 keys, got 6");
  EXPECT_EQ(complaint([](Words& w) { w.samplers = R"({"input":5,"output":6,"interpolation":"SOFT"})"; }),
            "a.glb: /animations/0/channels/0: expected an interpolation of LINEAR, STEP or CUBICSPLINE, got \"SOFT\"");
  EXPECT_EQ(complaint([](Words& w) {
              w.times = {1, 1};
            }),
            "a.glb: /animations/0/channels/0, key 1: expected times that ascend, from 0 to 1e5 s, got 1.000000");
  // A ring beside the scene, which no walk from its roots would find.
  EXPECT_NE(complaint([](Words& w) {
              w.nodes += R"(,{"name":"a","children":[5]},{"name":"b","children":[4]})";
            }).find("expected a node that hangs on a root"),
            std::string::npos);
}

TEST(GltfFigure, ChoosesAClipByNameOrNumberAndNeverGuesses) {
  const std::vector<Clip> clips = {{"walk", {}}, {"run", {}}, {"run", {}}, {"1", {}}};
  const auto says = [&](std::string_view choice) {
    return message_of<InputError>([&] { chosen_clip(clips, choice, "a.glb"); });
  };
  EXPECT_EQ(&chosen_clip(clips, "walk", "a.glb"), clips.data());
  EXPECT_EQ(&chosen_clip(clips, "2", "a.glb"), &clips[2]);
  EXPECT_EQ(&chosen_clip(clips, "1", "a.glb"), &clips[3]) << "a name goes before a number";
  const std::vector<Clip> one(clips.begin(), clips.begin() + 1);
  EXPECT_EQ(&chosen_clip(one, "", "a.glb"), one.data()) << "the only one needs no choice";
  EXPECT_EQ(
      says(""),
      "a.glb: clip: expected the choice of one of its animations by --clip (0 walk, 1 run, 2 run, 3 1), got none");
  EXPECT_EQ(says("jump"), "a.glb: clip: expected one of 0 walk, 1 run, 2 run, 3 1, got \"jump\"");
  EXPECT_EQ(says("run"),
            "a.glb: clip: expected a number, as several have this name (0 walk, 1 run, 2 run, 3 1), got \"run\"");
  EXPECT_EQ(message_of<InputError>([&] { chosen_clip({}, "", "a.glb"); }),
            "a.glb: clip: expected a file with an animation, got none");
}

TEST(GltfFigure, AClipOfAnotherFileMovesNodesOfItsNames) {
  const AnimatedMesh body = parse_animated(file_of({}), "a.glb");
  Words words;  // the same skeleton in another order, without a surface on it
  words.nodes = R"({"mesh":0},{"name":"knee"},{"name":"toe"},{"name":"hip"})";
  words.attributes = R"("POSITION":0)";
  words.channels =
      R"({"sampler":0,"target":{"node":1,"path":"translation"}},{"sampler":0,"target":{"node":2,"path":"scale"}})";
  const AnimatedMesh other = parse_animated(file_of(words), "b.glb");
  std::size_t left_out = 0;
  const Clip clip = clip_for(body.figure, other.clips[0], other.figure, "b.glb", left_out);
  EXPECT_EQ(left_out, 1U);
  ASSERT_EQ(clip.channels.size(), 1U);
  EXPECT_EQ(clip.channels[0].node, 3);
  words.nodes = R"({"mesh":0},{"name":"shin"},{"name":"toe"},{"name":"hip"})";
  const AnimatedMesh stranger = parse_animated(file_of(words), "c.glb");
  EXPECT_EQ(
      message_of<InputError>([&] { clip_for(body.figure, stranger.clips[0], stranger.figure, "c.glb", left_out); }),
      "c.glb: animation kick: expected nodes with the names of the body's skeleton, got none, but \"shin\"");
}

TEST(GltfFigure, SurvivesAnyFlippedByte) {
  const std::string whole = file_of({});
  for (std::size_t place = 4; place < whole.size(); ++place)
    for (const char byte : std::string("\0\1\"-9[},\x7f\xff", 10)) {
      std::string broken = whole;
      broken[place] = byte;
      try {
        const AnimatedMesh read = parse_animated(broken, "a.glb");
        for (const Clip& clip : read.clips) pose_at(clip, read.figure, 0.5);
      } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("a.glb")) << place << ": " << error.what();
      }
    }
}

}  // namespace
}  // namespace toile::internal
