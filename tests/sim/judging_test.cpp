// What a run may be said to have come to: no pass before gravity, no rest in free fall, no silent move of a start.
#include "body/mannequin.hpp"
#include "body/measure.hpp"
#include "dress/start_state.hpp"
#include "dress/untangle.hpp"
#include "garment/garments.hpp"
#include "io/json.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/falling.hpp"
#include "sim/setup.hpp"
#include "sim/simulate.hpp"
#include "support/tangled_starts.hpp"
#include "support/tube_pattern.hpp"
#include "verify/verify.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace toile::internal {
namespace {

Report judged(const Scratch& scratch, const Scene& scene) {
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  return simulate(scene, options);
}

std::vector<std::string> codes(const std::vector<Reason>& reasons) {
  std::vector<std::string> found;
  for (const Reason& reason : reasons) found.push_back(reason.code);
  return found;
}

bool has(const std::vector<Reason>& reasons, std::string_view code) {
  return std::any_of(reasons.begin(), reasons.end(), [&](const Reason& reason) { return reason.code == code; });
}

// A tube of 1 m around, 20 cm high from y = 0 up, sewn about an upright cylinder.
Scene tube_around(const Scratch& scratch, const std::string& body, const std::string& more = "") {
  scratch.put("tube.json", test::tube_pattern_text());
  return parse_scene(
      R"({"cloth": [{"name": "tube", "pattern": "tube.json", "resolution_cm": 5}], "body": {"cylinder": )" + body +
          "}" + more + R"(, "time": {"seconds": 10}})",
      scratch / "s.json");
}
const char* const cylinder_inside = R"({"radius_m": 0.155, "height_m": 1, "top_m": [0, 0.6, 0]})";

TEST(Judging, NothingPassesBeforeGravityHasActed) {
  const Scratch scratch;
  Scene scene = tube_around(scratch, cylinder_inside);
  scene.seconds = 0.1;
  Report report = judged(scratch, scene);
  EXPECT_EQ(outcome(report), Outcome::failed);
  ASSERT_FALSE(report.verdict.reasons.empty());
  EXPECT_EQ(report.verdict.reasons.front().code, "not_settled");
  EXPECT_NE(report.verdict.reasons.front().detail.find("0.0667 s after the weld"), std::string::npos)
      << report.verdict.reasons.front().detail;
  EXPECT_EQ(report.ended, "time");
  EXPECT_TRUE(has(judge(verify_directory(scratch / "out")).reasons, "not_settled")) << "the judge repeats it";
  scene.seconds = 0.6;
  EXPECT_FALSE(has(judged(scratch, scene).verdict.reasons, "not_settled"));
}

TEST(Judging, AGarmentBesideItsBodyNeverTouchedItAndEndsEarly) {
  const Scratch scratch;
  const Report report =
      judged(scratch, tube_around(scratch, R"({"radius_m": 0.155, "height_m": 1, "top_m": [1000, 21, -500]})"));
  EXPECT_EQ(codes(report.verdict.reasons), std::vector<std::string>{"never_touched"});
  EXPECT_EQ(report.ended, "never_touched");
  EXPECT_EQ(outcome(report), Outcome::failed);
  EXPECT_LT(report.frames, 30);
  const Json json = Json::load(scratch / "out/report.json");
  EXPECT_TRUE(json.at("limits").at("still_mm_per_s").is_null()) << "of what falls rest is not asked";
  const VerifyReport audit = verify_directory(scratch / "out");
  EXPECT_FALSE(audit.must_be_still);
  EXPECT_EQ(codes(judge(audit).reasons), std::vector<std::string>{"never_touched"});
}

TEST(Judging, AGarmentThatSlidesOffItsBodyFellOff) {
  const Scratch scratch;
  Scene scene = tube_around(scratch, cylinder_inside);
  scene.body.contact.friction = 0;
  const Report report = judged(scratch, scene);
  EXPECT_EQ(codes(report.verdict.reasons), std::vector<std::string>{"fell_off"});
  EXPECT_LT(report.frames, 90);
  EXPECT_GT(report.frames, 15);
}

TEST(Judging, AGarmentThatFallsToAFloorIsWaitedFor) {
  const Scratch scratch;
  const Report report = judged(
      scratch,
      tube_around(scratch, R"({"radius_m": 0.155, "height_m": 1, "top_m": [1000, 21, -500]})",
                  R"(, "solids": [{"box": {"size_m": [4, 0.2, 4]}, "placement": {"translation_m": [0, -1.5, 0]}}])"));
  EXPECT_FALSE(has(report.verdict.reasons, "never_touched"));
  EXPECT_FALSE(has(report.verdict.reasons, "fell_off"));
  EXPECT_EQ(report.ended, "still") << report.verdict.reasons.front().detail;
}

// A garment as one particle, with a speed.
struct Falling {
  std::vector<OutfitPart> parts;
  ClothState state;
  void add(const Vec3& x, const Vec3& v = Vec3::Zero()) {
    OutfitPart part;
    part.particles = 1;
    parts.push_back(part);
    state.x.push_back(x);
    state.v.push_back(v);
  }
  // The part that is lost beside a ball of 1 m about the origin; -1: none.
  Index lost(const BodyAt& moves = {}) const {
    const SolidMesh solid = ball(1, 0.3);
    FallWatch watch(Vec3(0, -10, 0), solid.triangles, moves, 2, 0.1);
    const auto found = watch.find(parts, state, solid.positions);
    return found ? found->part : -1;
  }
};

Index lost_at(const Vec3& x, const Vec3& v = Vec3::Zero(), const BodyAt& moves = {}) {
  Falling falling;
  falling.add(x, v);
  return falling.lost(moves);
}

TEST(FallWatch, LosesWhatIsBelowEverythingAndRisesNoMore) {
  EXPECT_EQ(lost_at({0, -1.5, 0}), 0);
  EXPECT_EQ(lost_at({0, -1.5, 0}, {0, -20, 0}), 0);
  EXPECT_EQ(lost_at({0, -0.5, 0}), -1) << "beside or within it";
  EXPECT_EQ(lost_at({0, 5, 0}), -1) << "it will land on it";
  EXPECT_EQ(lost_at({0, -1.5, 0}, {0, 3, 0}), 0) << "0.45 m up";
  EXPECT_EQ(lost_at({0, -1.5, 0}, {0, 4, 0}), -1) << "0.8 m up";
}

TEST(FallWatch, LosesWhatIsTooFarAsideForItsFall) {
  EXPECT_EQ(lost_at({30, 2, 0}), 0);
  EXPECT_EQ(lost_at({0, 2, -30}), 0);
  EXPECT_EQ(lost_at({9, 2, 0}), -1) << "3 m of fall, 8 m aside";
  EXPECT_EQ(lost_at({30, 2, 0}, {-20, 0, 0}), -1) << "thrown at it";
}

TEST(FallWatch, TakesSolidsThatMoveAtAllTheirPlaces) {
  const SolidMesh solid = ball(1, 0.3);
  const auto sinks = [&](double speed) {
    return [&solid, speed](double t_s, std::span<Vec3> x) {
      for (std::size_t i = 0; i < x.size(); ++i) x[i] = solid.positions[i] - Vec3(0, speed * t_s, 0);
    };
  };
  EXPECT_EQ(lost_at({0, -3, 0}, Vec3::Zero(), sinks(0)), 0);
  EXPECT_EQ(lost_at({0, -3, 0}, Vec3::Zero(), sinks(2)), -1) << "4 m down within 2 s";
}

TEST(FallWatch, WhatHangsInAGarmentThatIsCaughtIsCaught) {
  Falling both;
  both.add({0.9, -0.4, 0});
  both.add({0.9, -1.5, 0});
  EXPECT_EQ(both.lost(), 1) << "wholly below the other";
  both.parts[0].particles = 2;  // the first hangs down to where the second hooks in
  both.state.x.insert(both.state.x.begin() + 1, Vec3(0.9, -1.6, 0));
  both.state.v.push_back(Vec3::Zero());
  EXPECT_EQ(both.lost(), -1);
  Falling falling;  // two that fall together catch nothing
  falling.add({0, -1.5, 0});
  falling.add({0, -1.6, 0});
  EXPECT_EQ(falling.lost(), 0);
}

// ---- untangling ---------------------------------------------------------------------------------------------------------

TEST(Untangle, LeavesWhatIsHeldWhereItIsToTheBit) {
  for (const int kind : {0, 1, 4}) {
    const test::TangledStart start = test::tangled_start(kind, 0);
    SCOPED_TRACE(start.name);
    UntangleOptions options;
    options.most_iterations = 30;
    // Every third particle of the first half, also in the midst of what crosses.
    for (std::size_t i = 0; i < start.x.size() / 2; i += 3) options.held.push_back(static_cast<Index>(i));
    Vec3s x = start.x;
    const UntangleReport report = untangle(start.triangles, x, start.body.triangles, start.body.positions, options);
    EXPECT_GT(report.iterations, 0);
    EXPECT_GT(report.largest_move, 0) << "the others may move";
    for (const Index i : options.held) ASSERT_EQ(x[at(i)], start.x[at(i)]) << i;
  }
}

TEST(Untangle, MovesTheOtherSheetOffOneThatIsHeld) {
  const test::TangledStart start = test::tangled_start(1, 0);  // a corner through a sheet
  Vec3s x = start.x;
  UntangleOptions options;
  const Topology topology = build_topology(static_cast<Index>(x.size()), start.triangles);
  std::vector<Index> sheet(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) sheet[i] = static_cast<Index>(i);
  for (bool more = true; more;) {
    more = false;
    for (const Edge& e : topology.edges) {
      const Index low = std::min(sheet[at(e.a)], sheet[at(e.b)]);
      more |= sheet[at(e.a)] != low || sheet[at(e.b)] != low;
      sheet[at(e.a)] = sheet[at(e.b)] = low;
    }
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    if (sheet[i] == 0) options.held.push_back(static_cast<Index>(i));
  ASSERT_LT(options.held.size(), x.size());
  EXPECT_TRUE(untangle(start.triangles, x, {}, {}, options).resolved);
  for (const Index i : options.held) ASSERT_EQ(x[at(i)], start.x[at(i)]);
}

// A sheet that stands by `deep` in one that is pinned at its rim.
Scene pinned_and_pierced(double deep_m) {
  return parse_scene(R"({"cloth": [
    {"name": "lying", "grid": {"width_m": 0.4, "height_m": 0.4, "edge_m": 0.02},
     "placement": {"rotation_deg": [-90, 0, 0]}, "pins": [{"in_box_m": [[-1, -1, -1], [1, 1, -0.15]]}, {"in_box_m": [[-1, -1, 0.15], [1, 1, 1]]},
      {"in_box_m": [[-0.1, -1, -0.1], [0.1, 1, 0.1]]}]},
    {"name": "standing", "grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.02},
     "placement": {"translation_m": [0.005, )" +
                         std::to_string(0.1 - deep_m) +
                         R"(, 0.007], "rotation_deg": [0, 90, 0]}, "pins": [{"near_m": [0, 0.3, 0.1], "from_s": 0.2}]}],
    "time": {"seconds": 0.1}})",
                     "s.json");
}

TEST(Judging, UntanglingMovesNoPinnedParticle) {
  const Scratch scratch;
  const Scene scene = pinned_and_pierced(0.013);
  const Report report = judged(scratch, scene);
  EXPECT_GT(report.start.cloth_cloth, 5);
  EXPECT_EQ(report.start.cloth_cloth_left, 0);
  Pc2Reader frames(scratch / "out/cloth.pc2");
  Vec3s first;
  frames.read(0, first);
  const LoadedCloth lying = load_cloth(scene, 0, read_text_file);
  ASSERT_GT(lying.pins.size(), 100u);
  for (const TimedPin& pin : lying.pins) {
    const auto i = at(pin.pin.particle);
    for (Eigen::Index k = 0; k < 3; ++k)
      ASSERT_EQ(first[i][k], static_cast<double>(static_cast<float>(lying.garment.x[i][k]))) << i;
  }
}

TEST(Judging, APinHoldsFromItsFirstMomentOnly) {
  Events events;
  TimedPin now, later;
  now.pin.particle = 7;
  later.pin.particle = 3;
  later.from_s = 0.1;
  events.pins = {now, later};
  EXPECT_EQ(held_from_the_start(events), std::vector<Index>{7});
}

TEST(Judging, AStartThatWasMovedFarIsAPassWithAReservation) {
  for (const double deep_m : {0.013, 0.13}) {
    const Scratch scratch;
    const Report report = judged(scratch, pinned_and_pierced(deep_m));
    ASSERT_EQ(report.start.cloth_cloth_left, 0) << deep_m;
    const bool far = report.start.largest_move_mm > 60;
    EXPECT_EQ(far, deep_m > 0.1) << report.start.largest_move_mm << " mm: no test";
    EXPECT_EQ(has(report.verdict.qualifications, "moved_by_untangling"), far);
    EXPECT_TRUE(report.verdict.pass);
    EXPECT_EQ(outcome(report), Outcome::passed);
    const Json json = Json::load(scratch / "out/report.json");
    EXPECT_EQ(json.at("verdict").string(), "pass");
    EXPECT_EQ(json.at("qualifications").array().size(), far ? 1u : 0u);
    const Verdict judged = judge(verify_directory(scratch / "out"));
    EXPECT_TRUE(judged.pass);
    EXPECT_EQ(codes(judged.qualifications), codes(report.verdict.qualifications));
    if (!far) continue;
    const std::string& detail = report.verdict.qualifications.front().detail;
    EXPECT_EQ(detail, judged.qualifications.front().detail);
    EXPECT_EQ(detail.find("standing: untangling moved it by up to "), 0u) << detail;
    EXPECT_EQ(judgement_line(judged), "pass, with reservations: moved_by_untangling");
  }
}

// What is worn keeps its numbers when the next garment is welded around it: pins that hold it find it by them.
TEST(Weld, PutsWhatIsWornBeforeWhatIsNew) {
  Pattern pattern = test::tube_pattern(0.5, 0.4, 0.6);
  Outfit outfit;
  const std::vector<Fabric> fabrics(2);
  const std::vector<Vec2> rest_stretch(2, Vec2(1, 1));
  GarmentMesh worn = mesh_garment(pattern, 0.03);
  const WeldedMesh welded = weld(worn);
  Vec3s x(at(welded.mesh.particle_count));
  for (std::size_t i = 0; i < worn.x.size(); ++i) x[at(welded.particle_of[i])] = worn.x[i];
  worn.mesh = welded.mesh;
  worn.x = x;
  worn.pairs.clear();
  put_behind(outfit, worn, fabrics, rest_stretch);
  const GarmentMesh both = over(outfit, mesh_garment(pattern, 0.02));
  const WeldedMesh together = weld(both);
  const Index held = outfit.mesh.particle_count;
  ASSERT_GT(together.mesh.particle_count, held);
  for (Index i = 0; i < held; ++i) ASSERT_LT(together.particle_of[at(i)], held) << i;
}

TEST(Judging, AGarmentWithAWaistThatLiesBelowTheHipsIsNotWorn) {
  const Mannequin woman = make_mannequin();
  const std::vector<OutfitPart> parts{{"shirt", 0, 1, 2}, {"skirt", 1, 1, 2}};
  const auto found = [&](double skirt_top_m, std::vector<Belonging> belongings) {
    const Vec3s cloth{{0, 1.4, 0}, {0, 0.3, 0}, {0, skirt_top_m, 0}, {0, 0.2, 0}};
    return slid_down(parts, belongings, cloth, trunk_levels(woman.positions, woman.triangles));
  };
  const double hips_m = hips(woman.positions, woman.triangles).height_m;
  ASSERT_GT(hips_m, 0.7);
  const Belonging nowhere, waist{1.26, false};
  ASSERT_TRUE(found(hips_m - 0.01, {nowhere, waist}));
  EXPECT_EQ(found(hips_m - 0.01, {nowhere, waist})->part, 1);
  EXPECT_NE(found(hips_m - 0.01, {nowhere, waist})->where.find("126.0 cm"), std::string::npos);
  EXPECT_FALSE(found(hips_m + 0.01, {nowhere, waist}));
  EXPECT_FALSE(found(0.3, {nowhere, nowhere})) << "nothing of it belongs at the waist: stockings";
  EXPECT_FALSE(found(0.9, {waist, nowhere}));

  const double waist_m = waist_height_m(woman.positions, woman.triangles);
  const Belonging dress{1.26, true}, top{0, true};
  for (const Belonging& bodice : {dress, top}) {
    ASSERT_TRUE(found(waist_m - 0.01, {nowhere, bodice}));
    EXPECT_NE(found(waist_m - 0.01, {nowhere, bodice})->where.find("its bodice too"), std::string::npos);
    EXPECT_FALSE(found(waist_m + 0.01, {nowhere, bodice}));
  }
}

// It would lie on the floor until its folds rest, for four seconds.  A ring of 120 cm that is drawn at the waist falls straight; 2 cm higher it comes to
// lean on one hip, and goes down askew.  With a tape it leans at the first height, and falls past without touching at the second.
TEST(Judging, ASkirtThatHasComePastTheHipsEndsEarlyAndBothGirthsAreSaid) {
  for (const auto& [drawn_cm, frames] : {std::pair{"88", 50}, std::pair{"90", 300}}) {
    const Scratch scratch;
    const std::string at = std::string(R"({"translation": [0, )") + drawn_cm + ", ";
    std::ofstream(scratch / "skirt.json") << R"({"pattern": {"panels": {
    "front": )" << at << R"(25], "rotation": [0, 0, 0], "vertices": [[-30,0],[30,0],[30,20],[-30,20]],
      "edges": [{"endpoints": [0,1]}, {"endpoints": [1,2]}, {"endpoints": [2,3], "label": "lower_interface"}, {"endpoints": [3,0]}]},
    "back": )" << at << R"(-25], "rotation": [0, 0, 0], "vertices": [[-30,0],[-30,20],[30,20],[30,0]],
      "edges": [{"endpoints": [0,1]}, {"endpoints": [1,2], "label": "lower_interface"}, {"endpoints": [2,3]}, {"endpoints": [3,0]}]}},
    "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}], [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 0}]]},
    "properties": {"units_in_meter": 100}})";
    const Report report = judged(scratch, parse_scene(R"({"cloth": [{"pattern": ")" + (scratch / "skirt.json") +
                                                          R"(", "resolution_cm": 5, "tape_mm": 0}],
          "body": {"mannequin": "woman"}, "time": {"seconds": 10},
          "solids": [{"box": {"size_m": [2, 0.1, 2]}, "placement": {"translation_m": [0, -0.1, 0]}}]})",
                                                      "s.json"));
    ASSERT_EQ(report.verdict.reasons.size(), 1u);
    EXPECT_EQ(report.ended, "fell_off");
    EXPECT_EQ(report.verdict.reasons.front().code, "fell_off");
    EXPECT_NE(report.verdict.reasons.front().detail.find("its waist is 120.0 cm round"), std::string::npos)
        << report.verdict.reasons.front().detail;
    EXPECT_LT(report.frames, frames) << "drawn at " << drawn_cm;
  }
}

TEST(Judging, WhereAGarmentBelongsIsReadFromItsLabels) {
  GarmentMesh garment = mesh_garment(test::tube_pattern(0.5, 0.4, 0.6), 0.05);
  EXPECT_EQ(belonging_of(garment).waist_girth_m, 0);
  EXPECT_FALSE(belonging_of(garment).bodice);
  LabelledEdge edge{"lower_interface", {}};
  for (Index i = 0; i < 3; ++i) {
    garment.x[at(i)] = Vec3(0.1 * i, 1, 0);
    edge.particles.push_back(i);
  }
  garment.labels.push_back(edge);
  EXPECT_NEAR(belonging_of(garment).waist_girth_m, 0.2, 1e-15);
  EXPECT_FALSE(belonging_of(garment).bodice);
  for (const char* label : {"left_collar", "right_armhole", "strapless_top"}) {
    garment.labels.back().label = label;
    EXPECT_TRUE(belonging_of(garment).bodice) << label;
    EXPECT_EQ(belonging_of(garment).waist_girth_m, 0);
  }
}

}  // namespace
}  // namespace toile::internal
