// `toile untangle` as a user runs it.
#include "cli/program.hpp"
#include "io/json.hpp"
#include "io/obj.hpp"
#include "support/tangled_starts.hpp"
#include "verify/crossings.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace toile::internal {
namespace {

using test::Ended;
using test::run_toile;

void put(const Scratch& scratch, std::string_view name, const Vec3s& x, const std::vector<Triangle>& triangles) {
  SurfaceMesh mesh;
  mesh.positions = x;
  mesh.triangles = triangles;
  write_obj(scratch / name, mesh);
}

SurfaceMesh get(const Scratch& scratch, std::string_view name) { return load_obj(scratch / name); }

TEST(UntangleCommand, ACornerThroughASheetIsFreeInTheFile) {
  const Scratch scratch;
  const test::TangledStart start = test::tangled_start(1, 0);
  put(scratch, "cloth.obj", start.x, start.triangles);
  const Ended ended = run_toile(scratch, {"untangle", "cloth.obj", "--json"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const Json json = Json::parse(ended.out, "stdout");
  EXPECT_TRUE(json.at("resolved").boolean());
  EXPECT_EQ(json.at("out").string(), "out/cloth_untangled.obj");
  const SurfaceMesh before = get(scratch, "cloth.obj"), after = get(scratch, "out/cloth_untangled.obj");
  EXPECT_EQ(after.triangles, before.triangles);
  EXPECT_EQ(after.positions.size(), before.positions.size());
  EXPECT_GT(find_cloth_crossings(before.triangles, before.positions).size(), 0u);
  EXPECT_EQ(find_cloth_crossings(after.triangles, after.positions).size(), 0u);
}

TEST(UntangleCommand, ABodyInAFileAndItsUnit) {
  const Scratch scratch;
  test::TangledStart start = test::tangled_start(6, 0);
  for (Vec3& p : start.x) p *= 100;
  for (Vec3& p : start.body.positions) p *= 100;
  put(scratch, "sleeve.obj", start.x, start.triangles);
  put(scratch, "arm.obj", start.body.positions, start.body.triangles);
  const Ended ended =
      run_toile(scratch, {"untangle", "sleeve.obj", "--body", "arm.obj", "--body-unit", "cm", "--out", "free.obj"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("free.obj"), std::string::npos) << ended.out;
  const SurfaceMesh after = get(scratch, "free.obj"), arm = get(scratch, "arm.obj");
  EXPECT_EQ(find_body_crossings(after.triangles, after.positions, arm.triangles, arm.positions).size(), 0u);
  EXPECT_NEAR((after.positions[0] - start.x[0]).norm(), 1, 4) << "centimetres";
}

TEST(UntangleCommand, AnInputIsNeverAnOutput) {
  const Scratch scratch;
  const test::TangledStart start = test::tangled_start(1, 0);
  put(scratch, "cloth.obj", start.x, start.triangles);
  const std::string before = scratch.get("cloth.obj");
  const Ended ended = run_toile(scratch, {"untangle", "cloth.obj", "--out", "./cloth.obj"});
  EXPECT_EQ(ended.exit_code, 6);
  EXPECT_EQ(ended.err_lines(), 1) << ended.err;
  EXPECT_EQ(scratch.get("cloth.obj"), before);
}

TEST(UntangleCommand, QuadsNamesAndCommentsStay) {
  const Scratch scratch;
  // Two strips of quads, one standing through the other.
  std::string text = "# strips\no lying\n";
  const auto vertex = [&](double x, double y, double z) {
    text += "v " + std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z) + '\n';
  };
  for (int i = 0; i <= 8; ++i) {
    vertex(0.1 * i, 0, -0.31);
    vertex(0.1 * i, 0, 0.29);
  }
  for (int i = 0; i <= 4; ++i) {
    vertex(0.42, 0.1 * i - 0.08, -0.1);
    vertex(0.43, 0.1 * i - 0.08, 0.1);
  }
  std::string faces;
  for (int i = 0; i < 8; ++i)
    faces += "f " + std::to_string(2 * i + 1) + ' ' + std::to_string(2 * i + 2) + ' ' + std::to_string(2 * i + 4) +
             ' ' + std::to_string(2 * i + 3) + '\n';
  faces += "o standing\nusemtl felt\n";
  for (int i = 9; i < 13; ++i)
    faces += "f " + std::to_string(2 * i + 1) + ' ' + std::to_string(2 * i + 2) + ' ' + std::to_string(2 * i + 4) +
             ' ' + std::to_string(2 * i + 3) + '\n';
  scratch.put("strips.obj", text + faces);
  const Ended ended = run_toile(scratch, {"untangle", "strips.obj", "--quiet"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.out, "");
  const std::string out = scratch.get("out/strips_untangled.obj");
  EXPECT_EQ(out.substr(0, 17), "# strips\no lying\n");
  EXPECT_EQ(out.substr(out.size() - faces.size()), faces);
}

TEST(UntangleCommand, WhatIsLeftIsNamedAndKeptUnderAnotherName) {
  const Scratch scratch;
  test::TangledStart start;
  test::Random random(7);
  test::add_crumpled_sheet(start, random, 0.03);
  put(scratch, "crumpled.obj", start.x, start.triangles);
  const Ended ended = run_toile(scratch, {"untangle", "crumpled.obj", "--out", "flat.obj", "--json"});
  if (ended.exit_code == 0) GTEST_SKIP() << "it can be untangled now: take a harder one";
  EXPECT_EQ(ended.exit_code, 5);
  EXPECT_EQ(ended.err_lines(), 1);
  for (const char* word : {"crumpled.obj", "crossings are left in", "contours", "triangle ", " through triangle "})
    EXPECT_NE(ended.err.find(word), std::string::npos) << ended.err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "flat.obj"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "flat_still_tangled.obj"));
  const Json json = Json::parse(ended.out, "stdout");
  EXPECT_FALSE(json.at("resolved").boolean());
  EXPECT_EQ(json.at("exit_code").number(), 5);
}

TEST(UntangleCommand, WrongInputIsRefusedInOneLine) {
  const Scratch scratch;
  scratch.put("bad.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  Ended ended = run_toile(scratch, {"untangle", "bad.obj"});
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_EQ(ended.err_lines(), 1);
  EXPECT_NE(ended.err.find("bad.obj: triangle 0: expected an area above zero"), std::string::npos) << ended.err;
  ended = run_toile(scratch, {"untangle", "none.obj"});
  EXPECT_EQ(ended.exit_code, 6);
  ended = run_toile(scratch, {"untangle"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
}

}  // namespace
}  // namespace toile::internal
