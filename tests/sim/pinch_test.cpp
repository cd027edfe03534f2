// What a body pinches: a sleeve around an elbow that bends until the arm is in itself, and opens again.                 (C7)
#include "core/parallel.hpp"
#include "io/file.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/simulate.hpp"
#include "support/paths.hpp"
#include "verify/crossings.hpp"
#include "verify/verdict.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace toile::internal {
namespace {

TEST(Pinch, ASleeveComesOutOfAnElbowAsItWentIn) {
  const Scratch scratch;
  Scene scene = parse_scene(read_file(test::source_path("scenes/torture/18-elbow.json")), "18-elbow.json");
  scene.cloth.front().set_edge_m(0.018);
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  std::string state_hash;
  for (const int threads : {2, 1}) {
    Report report;
    with_threads(threads, [&] { report = simulate(scene, options); });
    ASSERT_EQ(report.ended, "time");
    EXPECT_GT(report.drape.pinched, 20);
    EXPECT_EQ(report.audit.cloth_cloth_edges.last, 0);
    EXPECT_EQ(report.audit.cloth_body_edges.last, 0);
    EXPECT_LT(report.audit.stretch.max, 0.1);
    if (state_hash.empty()) state_hash = report.state_hash;
    EXPECT_EQ(report.state_hash, state_hash);
  }
  Pc2Reader reader(options.directory + "/cloth.pc2");
  const SurfaceMesh mesh = load_obj(options.directory + "/cloth.obj");
  std::vector<Vec3> before, now;
  double fastest = 0;
  for (int frame = 0; frame < reader.samples(); ++frame) {
    reader.read(frame, now);
    for (std::size_t i = 0; i < before.size(); ++i)
      fastest = std::max(fastest, scene.fps * (now[i] - before[i]).norm());
    if (frame >= 60 + 15) {  // open at 2 s
      EXPECT_TRUE(find_cloth_crossings(mesh.triangles, now).empty()) << frame;
    }
    before = now;
  }
  EXPECT_LT(fastest, 3.0) << "the forearm's tip goes at 1.7 m/s";
}

TEST(Pinch, WhatIsPinchedInTheLastFrameIsAReservation) {
  const Scratch scratch;
  Scene scene = parse_scene(read_file(test::source_path("scenes/torture/18-elbow.json")), "18-elbow.json");
  scene.cloth.front().set_edge_m(0.018);
  scene.seconds = 0.7;                      // the elbow is bent, and the arm in itself
  scene.bend_element = BendElement::hinge;  // a sleeve of plates is not caught
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  const Report report = simulate(scene, options);
  EXPECT_GT(report.audit.cloth_body_edges.last, 0);
  EXPECT_EQ(report.audit.outside_pinches.last, 0);
  for (const Verdict& verdict : {report.verdict, judge(verify_directory(options.directory))}) {
    for (const Reason& reason : verdict.reasons) EXPECT_NE(reason.code, "cloth_body_intersection");
    ASSERT_EQ(verdict.qualifications.size(), 1u);
    EXPECT_EQ(verdict.qualifications[0].code, "pinched_cloth");
  }
}

}  // namespace
}  // namespace toile::internal
