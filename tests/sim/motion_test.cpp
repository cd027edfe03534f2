// Bodies that move, runs that begin where others ended, several pieces of cloth in one scene.
#include "body/mannequin.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "support/run_into.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

namespace toile::internal {
namespace {

// A kerchief on the head of a mannequin that moves.
Scene kerchief(const std::string& motion, const std::string& edge_m = "0.03") {
  return parse_scene(R"({"cloth": [{"name": "kerchief", "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": )" +
                         edge_m +
                         R"(}, "placement": {"translation_m": [0, 1.74, 0], "rotation_deg": [-90, 0, 0]}}],
    "body": {"mannequin": "woman", "motion": ")" +
                         motion + R"("}, "time": {"seconds": 0.4, "drape_seconds": 0.5}})",
                     "s.json");
}

std::vector<Vec3> sample(const std::string& path, int frame) {
  Pc2Reader reader(path);
  std::vector<Vec3> x;
  reader.read(frame < 0 ? reader.samples() + frame : frame, x);
  return x;
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) distance = std::max(distance, (a[i] - b[i]).norm());
  return distance;
}

// The legs of a recording whose left foot is turned round by 160 degrees.
std::string recording_with_a_turned_foot() {
  const auto joint = [](const std::string& name, const std::string& offset, const std::string& below) {
    return "JOINT " + name + "\n{\nOFFSET " + offset + "\nCHANNELS 3 Zrotation Xrotation Yrotation\n" + below + "}\n";
  };
  const std::string end = "End Site\n{\nOFFSET 0 0 5\n}\n";
  const auto leg = [&](const std::string& side, const std::string& x) {
    return joint(
        side + "UpLeg", x + " -5 0",
        joint(side + "Leg", "0 -40 0", joint(side + "Foot", "0 -40 0", joint(side + "ToeBase", "0 -5 12", end))));
  };
  const std::string frame = "0 90 0 0 0 0 0 0 0 0 0 0 0 0 160 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n";
  return "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
         "Yrotation\n" +
         leg("Left", "10") + leg("Right", "-10") + "}\nMOTION\nFrames: 2\nFrame Time: 0.1\n" + frame + frame;
}

TEST(MovingBody, SaysWhatWasMendedInARecordingOfAMannequinToo) {
  const Scratch scratch;
  const std::string path = scratch.put("turned.bvh", recording_with_a_turned_foot());
  const Scene scene = parse_scene(
      R"({"cloth": [{"grid": {"width_m": 0.1, "height_m": 0.1, "edge_m": 0.05}, "placement": {"translation_m": [5, 9, 5]}}],
      "body": {"mannequin": "man", "motion": {"file": ")" +
          path + R"("}},
      "world": {"gravity_m_per_s2": [0, 0, 0]}, "time": {"seconds": 0.1, "drape_seconds": 0}})",
      "s.json");
  const Report report = test::run_into(scratch / "out", scene);
  const auto told = [](const std::string& warning) {
    return warning.find(
               "turned.bvh: \"LeftFoot\" is turned by up to 160 degrees (at 0.000 s), farther than an ankle can") !=
           std::string::npos;
  };
  EXPECT_EQ(std::count_if(report.warnings.begin(), report.warnings.end(), told), 1);
}

TEST(MovingBody, StandsWhileTheClothDrapesAndThenMoves) {
  const Scratch scratch;
  const Report report = test::run_into(scratch / "out", kerchief("twist"));
  EXPECT_EQ(report.ended, "time");
  EXPECT_EQ(report.motion_name, "twist");
  EXPECT_EQ(report.motion.frames, 12);
  EXPECT_EQ(report.motion_first_frame, 14);  // 15 frames of drape, the first of them sample 0
  EXPECT_EQ(report.frames, 27);
  EXPECT_GT(report.motion.body, 0);
  const std::string body = scratch / "out/body.pc2";
  EXPECT_EQ(farthest(sample(body, 0), sample(body, 14)), 0);
  EXPECT_GT(farthest(sample(body, 14), sample(body, -1)), 0.01);
  EXPECT_EQ(report.audit.cloth_body_edges.last, 0);
  EXPECT_FALSE(report.verdict.limits.must_be_still);
}

TEST(MovingBody, OfAMotionThatStandsStillChangesNothing) {
  const Scratch scratch;
  Scene scene = kerchief("stand");
  const Report moving = test::run_into(scratch / "moving", scene);
  scene.body.motion.reset();
  scene.seconds = 0.5 + 0.4;
  const Report still = test::run_into(scratch / "still", scene);
  EXPECT_EQ(moving.state_hash, still.state_hash);
}

// What a mesh can do without a skeleton; and what of it the judge sees, from memory and from the files.
TEST(MovingBody, APersonGivenAsAMeshSwaysByName) {
  const Scratch scratch;
  const Mannequin woman = make_mannequin(MannequinKind::woman);
  SurfaceMesh obj;
  obj.positions = woman.positions;
  obj.triangles = woman.triangles;
  obj.group.assign(obj.triangles.size(), 0);
  obj.group_names = {""};
  obj.object = obj.group;
  obj.object_names = {"woman"};
  write_obj(scratch / "woman.obj", obj);
  Scene scene = kerchief("sway");
  SceneMesh mesh;
  mesh.path = scratch / "woman.obj";
  scene.body.shape = std::move(mesh);
  scene.seconds = 1;
  const Report report = test::run_into(scratch / "out", scene);
  EXPECT_EQ(report.motion_name, "sway");
  EXPECT_EQ(report.motion.frames, 30);
  const std::string body = scratch / "out/body.pc2";
  EXPECT_EQ(farthest(sample(body, 0), sample(body, report.motion_first_frame)), 0);
  EXPECT_GT(farthest(sample(body, 0), sample(body, report.motion_first_frame + 18)), 0.015);
  EXPECT_EQ(report.audit.cloth_body_edges.last, 0);
  EXPECT_EQ(report.audit.slip.first_frame, report.motion_first_frame);
  const VerifyReport audit = verify_directory(scratch / "out");
  EXPECT_EQ(audit.slip.first_frame, report.audit.slip.first_frame);
  scene.body.motion->name = "walk";
  EXPECT_THROW(test::run_into(scratch / "walks", scene), InputError);
}

// A hoop wider than the waist: nothing presses it on, so no friction holds it.
TEST(MovingBody, WhatSlidesDownItIsSaidToHaveSlidOff) {
  const Scratch scratch;
  const auto hoop = [&](const std::string& seconds, const std::string& name) {
    return test::run_into(scratch / name, parse_scene(R"({"cloth": [{"name": "hoop",
      "tube": {"radius_m": 0.15, "length_m": 0.1, "edge_m": 0.03}, "placement": {"translation_m": [0, 1.1, 0]}}],
      "body": {"mannequin": "woman", "motion": "sway"}, "time": {"drape_seconds": 0, "seconds": )" +
                                                          seconds + "}}",
                                                      "s.json"));
  };
  const Report slid = hoop("0.3", "long");
  ASSERT_EQ(slid.verdict.reasons.size(), 1U);
  EXPECT_EQ(slid.verdict.reasons[0].code, "slid_off");
  EXPECT_NE(slid.verdict.reasons[0].detail.find("the edge of"), std::string::npos) << slid.verdict.reasons[0].detail;
  EXPECT_EQ(outcome(slid), Outcome::failed);
  EXPECT_EQ(judge(verify_directory(scratch / "long")).reasons.at(0).detail, slid.verdict.reasons[0].detail);
  const Report short_one = hoop("0.0667", "short");
  EXPECT_TRUE(short_one.verdict.pass) << "3 cm are no slide";
  EXPECT_NEAR(short_one.audit.slip.loops.at(0).drop.last_m, 3 * 9.81 / 900, 0.001) << "two implicit steps of free fall";
}

TEST(StartRun, TakesUpADrapeWhereTheBodyBeganToMove) {
  const Scratch scratch;
  test::run_into(scratch / "first", kerchief("twist"));
  Scene scene = kerchief("sway");
  scene.start = scratch / "first";
  scene.drape_seconds = 0;
  const Report report = test::run_into(scratch / "second", scene);
  EXPECT_EQ(report.motion_first_frame, 0);
  EXPECT_LT(farthest(sample(scratch / "first/cloth.pc2", 14), sample(scratch / "second/cloth.pc2", 0)), 1e-6);
}

TEST(StartRun, CarriesADrapeOverToAFinerMesh) {
  const Scratch scratch;
  test::run_into(scratch / "coarse", kerchief("stand", "0.04"));
  Scene scene = kerchief("stand", "0.02");
  scene.start = scratch / "coarse";
  const Report report = test::run_into(scratch / "fine", scene);
  EXPECT_LT(report.audit.stretch.p99, 0.02);
  EXPECT_EQ(report.audit.cloth_body_edges.last, 0);
  // The fine cloth starts on the coarse one: no particle is farther from its triangles than float32 rounds.
  const SurfaceMesh coarse = load_obj(scratch / "coarse/cloth.obj");
  Vec3 low = Vec3::Constant(1e9), high = -low;
  for (const Vec3& p : sample(scratch / "coarse/cloth.pc2", 14)) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (const Vec3& p : sample(scratch / "fine/cloth.pc2", 0)) {
    EXPECT_TRUE((p.array() >= low.array() - 1e-6).all() && (p.array() <= high.array() + 1e-6).all());
  }
}

TEST(StartRun, RefusesWhatDoesNotFit) {
  const Scratch scratch;
  const auto on_cylinder = [](const std::string& name, const std::string& width_m, const std::string& radius_m) {
    return parse_scene(R"({"cloth": [{"name": ")" + name +
                           R"(", "grid": {"height_m": 0.3, "edge_m": 0.05, "width_m": )" + width_m +
                           R"(}, "placement": {"translation_m": [0, 0.01, 0], "rotation_deg": [-90, 0, 0]}}],
      "body": {"cylinder": {"radius_m": )" +
                           radius_m + R"(}}, "time": {"seconds": 0.1}})",
                       "s.json");
  };
  Scene scene = on_cylinder("kerchief", "0.3", "0.1");
  scene.start = scratch / "nothing";
  EXPECT_THROW(test::run_into(scratch / "out", scene), IoError);
  scene.start.clear();
  test::run_into(scratch / "first", scene);
  scene.start = scratch / "first";
  EXPECT_EQ(test::run_into(scratch / "out", scene).ended, "time");

  scene = on_cylinder("scarf", "0.3", "0.1");
  scene.start = scratch / "first";
  try {
    test::run_into(scratch / "out", scene);
    ADD_FAILURE() << "another panel was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a group \"scarf\""), std::string::npos) << error.what();
  }
  scene = on_cylinder("kerchief", "0.6", "0.1");
  scene.start = scratch / "first";
  EXPECT_THROW(test::run_into(scratch / "out", scene), InputError);  // another drawing
  scene = on_cylinder("kerchief", "0.3", "0.11");
  scene.start = scratch / "first";
  EXPECT_THROW(test::run_into(scratch / "out", scene), InputError);  // another body
}

TEST(SeveralCloths, LieOnEachOtherAndAreObjectsOfOneFile) {
  const Scratch scratch;
  const Scene scene = parse_scene(R"({"cloth": [
    {"name": "lower", "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.03},
     "placement": {"translation_m": [0, 0.005, 0], "rotation_deg": [-90, 0, 0]}},
    {"name": "upper", "grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.03}, "fabric": "silk",
     "placement": {"translation_m": [0, 0.02, 0], "rotation_deg": [-90, 30, 0]},
     "pins": [{"near_m": [0.1, 0.02, 0.1]}]}],
    "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.5}}, "time": {"seconds": 1}})",
                                  "s.json");
  const Report report = test::run_into(scratch / "out", scene);
  EXPECT_EQ(report.ended, "time");
  EXPECT_EQ(report.panels, 2);
  EXPECT_EQ(report.audit.cloth_cloth_edges.max, 0);
  EXPECT_EQ(report.audit.cloth_body_edges.last, 0);
  const SurfaceMesh mesh = load_obj(scratch / "out/cloth.obj");
  ASSERT_EQ(mesh.object_names, (std::vector<std::string>{"lower", "upper"}));
  // Over the middle of the cylinder the upper one is on top, by about a fabric's thickness.
  const std::vector<Vec3> end = sample(scratch / "out/cloth.pc2", -1);
  std::array<double, 2> height{0, 0};
  std::array<int, 2> count{0, 0};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index i : mesh.triangles[t]) {
      const Vec3& p = end[static_cast<std::size_t>(i)];
      if (p.x() * p.x() + p.z() * p.z() > 0.05 * 0.05) continue;
      height[static_cast<std::size_t>(mesh.object[t])] += p.y();
      ++count[static_cast<std::size_t>(mesh.object[t])];
    }
  ASSERT_GT(count[0], 0);
  ASSERT_GT(count[1], 0);
  EXPECT_NEAR(height[1] / count[1] - height[0] / count[0], 2.5e-3, 1.2e-3);
}

TEST(Events, AHandPullsTheClothAndLetsGo) {
  const Scratch scratch;
  const auto scene = [](const std::string& drags) {
    return parse_scene(R"({"cloth": [{"name": "cloth", "grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.04},
      "placement": {"translation_m": [0, 1, 0]}, "pins": [{"near_m": [-0.1, 1.1, 0]}, {"near_m": [0.1, 1.1, 0]}])" +
                           drags + R"(}], "time": {"seconds": 1.5}})",
                       "s.json");
  };
  test::run_into(scratch / "free", scene(""));
  test::run_into(
      scratch / "pulled",
      scene(
          R"(, "drags": [{"near_m": [0, 0.9, 0], "path_m": [[0, 0, 0.9, 0], [0.3, 0, 0.95, 0.15], [0.6, 0, 0.95, 0.15]],
               "stiffness_N_per_m": 200, "damping_N_s_per_m": 1}])"));
  const auto lowest = [&](const std::string& name, int frame) {
    Vec3 best(0, 9, 0);
    for (const Vec3& p : sample(scratch / (name + "/cloth.pc2"), frame))
      if (std::abs(p.x()) < 0.03 && p.y() < best.y()) best = p;
    return best;
  };
  EXPECT_GT(lowest("pulled", 18).z(), 0.1);             // the hand has it
  EXPECT_LT(std::abs(lowest("free", 18).z()), 0.02);    // and without it, it hangs
  EXPECT_LT(std::abs(lowest("pulled", -1).z()), 0.06);  // it has let go, and the cloth swings back
}

TEST(Events, AClothThatShrinksDuringTheRunIsJudgedByWhatItBecame) {
  const Scratch scratch;
  const Report report = test::run_into(scratch / "out", parse_scene(R"({"cloth": [{"name": "cloth",
      "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.03}, "placement": {"translation_m": [0, 1, 0]},
      "panels": {"cloth": {"rest_stretch_path": [[0.2, 1, 1], [0.8, 1, 0.8]]}},
      "pins": [{"near_m": [0, 1.15, 0]}]}], "time": {"seconds": 2}})",
                                                                    "s.json"));
  EXPECT_EQ(report.ended, "time");
  const auto width = [&](int frame) {
    double low = 9, high = -9;
    for (const Vec3& p : sample(scratch / "out/cloth.pc2", frame)) {
      low = std::min(low, p.x());
      high = std::max(high, p.x());
    }
    return high - low;
  };
  EXPECT_LT(width(-1), 0.83 * width(0));  // v is the weft, across
  ASSERT_EQ(report.rest_stretch.size(), 1u);
  EXPECT_DOUBLE_EQ(report.rest_stretch[0].second[0], 0.8);  // the first axis of vt is the weft
  EXPECT_LT(report.audit.stretch.p99, 0.02);
}

}  // namespace
}  // namespace toile::internal
