// `toile export`, and meshes of every format on the command line, as a user has them.
#include "cli/program.hpp"
#include "io/json.hpp"
#include "io/mesh_file.hpp"
#include "io/mesh_writer.hpp"
#include "support/tangled_starts.hpp"
#include "verify/crossings.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace toile::internal {
namespace {

using test::Ended;
using test::run_toile;

TEST(ExportCommand, WritesWhatItNamesAndSaysWhatItCannot) {
  const Scratch scratch;
  scratch.put("s.json",
              R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.1}}], "time": {"seconds": 0.1}})");
  ASSERT_EQ(run_toile(scratch, {"run", "s.json", "--quiet", "--out", "runs/sheet"}).exit_code, 0);
  Ended ended = run_toile(scratch, {"export", "runs/sheet/", "--to", "gltf"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.out, "out/sheet.glb\n");
  EXPECT_GT(load_mesh(scratch / "out/sheet.glb").triangles.size(), 4U);
  ended = run_toile(scratch, {"export", "runs/sheet", "--to", "ply", "--all", "--json"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  const Json json = Json::parse(ended.out, "stdout");
  EXPECT_EQ(json.at("files").array().size(), static_cast<std::size_t>(json.at("frames").integer()));
  EXPECT_EQ(json.at("files").array()[0].string(), "out/sheet_ply/cloth_0000.ply");
  EXPECT_TRUE(std::filesystem::exists(scratch / "out/sheet_ply/cloth_0002.ply"));
  ended = run_toile(scratch, {"export", "runs/sheet", "--out", "a.obj", "--frame", "0", "--quiet"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.out, "");

  const auto refused = [&](std::vector<std::string> words, int code, const char* why) {
    words.insert(words.begin(), {"export", "runs/sheet"});
    const Ended wrong = run_toile(scratch, words);
    EXPECT_EQ(wrong.exit_code, code) << why;
    EXPECT_EQ(wrong.err_lines(), 1) << wrong.err;
    EXPECT_NE(wrong.err.find(why), std::string::npos) << wrong.err;
  };
  refused({}, 2, "expected a format, obj, ply, gltf, pc2, mdd or usda");
  refused({"--to", "usd"}, 2, "expected obj, ply, gltf, pc2, mdd or usda, got usd");
  refused({"--to", "ply", "--all", "--frame", "1"}, 2, "--all");
  refused({"--to", "ply", "--frame", "9"}, 3, "frame: expected 0 to 2, got 9");
  refused({"--to", "ply", "--of", "body"}, 6, "body.obj");
  refused({"--to", "gltf", "--out", "a.gltf"}, 2, "expected a file that ends in .glb, got a.gltf");
  refused({"--to", "ply", "--out", "a"}, 2, "expected a file that ends in .ply, got a");
  refused({"--out", "runs/sheet/cloth.obj"}, 6, "is a file of the run");
}

TEST(UntangleCommand, APlyIsReadAndWrittenAndAGltfToo) {
  const Scratch scratch;
  const test::TangledStart start = test::tangled_start(1, 0);
  SurfaceMesh mesh;
  mesh.positions = start.x;
  mesh.triangles = start.triangles;
  for (const std::string ending : {".ply", ".glb"}) {
    mesh_writer_for(ending)->write(scratch / ("cloth" + ending), mesh);
    const Ended ended = run_toile(scratch, {"untangle", "cloth" + ending});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const SurfaceMesh after = load_mesh(scratch / ("out/cloth_untangled" + ending));
    EXPECT_EQ(after.triangles, mesh.triangles);
    EXPECT_EQ(find_cloth_crossings(after.triangles, after.positions).size(), 0U);
  }
  const Ended ended = run_toile(scratch, {"untangle", "cloth.ply", "--out", "a.stl"});
  EXPECT_EQ(ended.exit_code, 2) << ended.err;
}

TEST(CheckCommand, MeshesOfEveryFormatAreLookedAt) {
  const Scratch scratch;
  SurfaceMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.texcoords = {{0, 0}, {1, 0}, {1, 1}, {5, 5}, {6, 6}, {5, 6}};
  mesh.texcoord = {{0, 1, 2}, {3, 4, 5}};
  for (const std::string ending : {".obj", ".ply", ".glb"}) {
    mesh_writer_for(ending)->write(scratch / ("m" + ending), mesh);
    const Ended ended = run_toile(scratch, {"check", "m" + ending, "--json"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const Json file = Json::parse(ended.out, "stdout").at("files").array()[0];
    EXPECT_EQ(file.at("triangles").integer(), 2);
    EXPECT_EQ(file.at("joined_vertices").integer(), ending == ".obj" ? 0 : 2);
    EXPECT_EQ(file.at("not_a_cloth").string(), "");
  }
}

}  // namespace
}  // namespace toile::internal
