// For whom a pattern was cut, from its labels and from how its sleeves hang.
#include "garment/pattern_figures.hpp"
#include "garments.hpp"
#include "io/body_measurements.hpp"
#include "io/file.hpp"
#include "pattern_text.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

namespace toile::internal {
namespace {

// A person 1.7 m tall whose waist is at 1.07 m and 80 cm round, her shoulders at 1.38 m, her arms 45 degrees down.
BodyFigures person() {
  BodyFigures body;
  body.low_m = Vec3(-0.6, 0, -0.15);
  body.high_m = Vec3(0.6, 1.7, 0.15);
  body.waist_m = 1.07;
  body.tape_waist_m = 1.07;
  body.shoulder_m = 1.38;
  body.waist_girth_m = 0.8;
  body.arm_down_deg = 45;
  body.arm_roots_m = {Vec3(0.2, 1.3, 0), Vec3(-0.2, 1.3, 0)};
  return body;
}

// A band of two panels around the waist, its upper edges labelled; top at `top_cm`, `girth_cm` round.
Pattern band(double top_cm, double girth_cm, const std::string& label = "lower_interface",
             const std::string& more = "") {
  const std::string w = std::to_string(girth_cm / 2);
  const std::string corners = "[[0, 0], [" + w + ", 0], [" + w + ", 10], [0, 10]]";
  const std::string edges = R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3], "label": ")" +
                            label + R"("}, {"endpoints": [3, 0]}])";
  const auto panel = [&](const char* z) {
    return pattern_text::panel(corners, edges, "[-20, " + std::to_string(top_cm - 10) + ", " + z + "]");
  };
  return pattern_text::parse(pattern_text::file(R"({"front": )" + panel("20") + R"(, "back": )" + panel("-20") + "}",
                                                "[]", R"({"units_in_meter": 100})", "", more));
}

TEST(PatternFigures, AWaistIsWhereTheLabelledEdgesAre) {
  const PatternFigures figures = pattern_figures(band(107, 84));
  EXPECT_NEAR(*figures.waist_m, 1.07, 1e-12);
  EXPECT_NEAR(*figures.waist_girth_m, 0.84, 1e-12);
  EXPECT_FALSE(figures.shoulder_m);
  EXPECT_FALSE(pattern_figures(band(107, 84, "hem")).waist_m);
  Pattern dress = band(107, 84);
  dress.stitches.push_back({{0, 2}, {1, 2}, false, 0});
  EXPECT_FALSE(pattern_figures(dress).waist_m) << "something is sewn to it: the lower end of a bodice";
  EXPECT_TRUE(pattern_figures(dress).waist_girth_m);
  const PatternFigures armholes = pattern_figures(band(139, 84, "left_armhole"));
  EXPECT_NEAR(*armholes.shoulder_m, 1.39, 1e-12);
  EXPECT_FALSE(armholes.waist_girth_m);
}

TEST(PatternFigures, AnElasticWaistSaysNothingOfTheGirth) {
  const std::string elastic = R"(, "toile": {"panels": {"front": {"rest_stretch_v": 0.8}}})";
  EXPECT_FALSE(pattern_figures(band(107, 60, "lower_interface", elastic)).waist_girth_m);
}

TEST(PatternFigures, AWaistThatHangsElsewhereOrIsNarrowerIsAnotherBodys) {
  EXPECT_TRUE(misfits(band(107.5, 84), person()).empty());
  EXPECT_TRUE(misfits(band(107.5, 180), person()).empty()) << "ease";
  for (const double top_cm : {102.0, 112.0}) {
    const std::vector<Misfit> found = misfits(band(top_cm, 84), person());
    ASSERT_EQ(found.size(), 1U) << top_cm;
    EXPECT_EQ(found[0].code, reason::other_body);
    EXPECT_NE(found[0].expected.find("waist at about " + std::to_string(static_cast<int>(top_cm)) + ".0 cm"),
              std::string::npos)
        << found[0].expected;
    EXPECT_EQ(found[0].got, "107.0 cm above its feet");
  }
  const std::vector<Misfit> narrow = misfits(band(107, 70), person());
  ASSERT_EQ(narrow.size(), 1U);
  EXPECT_EQ(narrow[0].expected, "a waist of at most 75.3 cm");
  EXPECT_EQ(narrow[0].got, "80.0 cm");
  EXPECT_EQ(misfits(band(143, 84, "right_armhole"), person()).size(), 1U);
  EXPECT_TRUE(misfits(band(138.6, 84, "right_armhole"), person()).empty());
}

TEST(PatternFigures, HeightsCountFromTheFeet) {
  BodyFigures raised = person();
  for (Vec3* p : {&raised.low_m, &raised.high_m}) p->y() += 3;
  raised.waist_m += 3;
  *raised.tape_waist_m += 3;
  EXPECT_TRUE(misfits(band(107, 84), raised).empty());
}

TEST(PatternFigures, WithoutATapeHeightsAreNotCompared) {
  BodyFigures body = person();
  body.tape_waist_m.reset();
  EXPECT_TRUE(misfits(band(115, 84), body).empty()) << "a waist that was found on a surface is where it is narrowest";
}

TEST(PatternFigures, SleevesThatHangOtherwiseThanTheArmsAreOfAnotherPose) {
  const Pattern shirt = load_pattern(test::source_path("patterns/tshirt.json"));
  const double drawn_deg = *sleeves_down_deg(shirt, person());
  BodyFigures body = person();
  for (const double off_deg : {0.0, 14.0, -14.0, 16.0, -16.0, 45.0}) {
    body.arm_down_deg = drawn_deg + off_deg;
    const std::vector<Misfit> found = misfits(shirt, body);
    ASSERT_EQ(found.size(), std::abs(off_deg) > pose_agrees_deg ? 1U : 0U) << off_deg;
    if (found.empty()) continue;
    EXPECT_EQ(found[0].code, reason::other_pose);
    EXPECT_NE(found[0].expected.find(std::to_string(std::lround(drawn_deg))), std::string::npos) << found[0].expected;
    EXPECT_NE(found[0].got.find(std::to_string(std::lround(*body.arm_down_deg))), std::string::npos) << found[0].got;
  }
  body.arm_down_deg.reset();
  EXPECT_TRUE(misfits(shirt, body).empty());
  EXPECT_FALSE(sleeves_down_deg(load_pattern(test::source_path("patterns/skirt.json")), person()));
}

TEST(PatternFigures, SleevesWithoutLabelsAreThoseBeyondTheArms) {
  Pattern shirt = load_pattern(test::source_path("patterns/tshirt.json"));
  const double labelled_deg = *sleeves_down_deg(shirt, person());
  for (Panel& panel : shirt.panels) panel.label.clear();
  EXPECT_NEAR(*sleeves_down_deg(shirt, person()), labelled_deg, 1e-12);
  Pattern lowered = shirt;
  lowered.legacy_frame = true;
  for (Panel& panel : lowered.panels) panel.translation_m.y() -= 0.68 * 1.7;
  EXPECT_NEAR(*sleeves_down_deg(lowered, person()), labelled_deg, 1e-12) << "in the frame of 2021";
  BodyFigures nobody = person();
  nobody.arm_roots_m.reset();
  EXPECT_FALSE(sleeves_down_deg(shirt, nobody));
}

// A trunk and its left sleeve, which is 30 cm long and turned by `turn_deg` in the frontal plane; its hem is cut slanting by `slant_cm`.
Pattern one_sleeve(double turn_deg, double slant_cm, const std::string& corners = "") {
  const std::string slanted =
      "[[0, -10], [30, " + std::to_string(-10 + slant_cm) + "], [30, " + std::to_string(10 + slant_cm) + "], [0, 10]]";
  const std::string turn = "[0, 0, " + std::to_string(turn_deg) + "]";
  const std::string sleeve =
      pattern_text::panel(corners.empty() ? slanted : corners, pattern_text::square_edges, "[25, 135, 10]", turn);
  const std::string trunk =
      pattern_text::panel(pattern_text::square_corners, pattern_text::square_edges, "[-20, 80, 10]");
  Pattern pattern = pattern_text::parse(pattern_text::file("{\"trunk\": " + trunk + ", \"sleeve\": " + sleeve + "}",
                                                           "[" + pattern_text::stitch("trunk", 1, "sleeve", 3) + "]"));
  pattern.panels[0].label = "body";
  pattern.panels[1].label = "arm";
  return pattern;
}

TEST(PatternFigures, ASleeveIsDrawnAlongAnAxisOfItsPanelWhateverItsHem) {
  for (const double turn_deg : {-45.5, -20.0, -60.0})
    for (const double slant_cm : {0.0, 12.0, -12.0, 30.0, -30.0})
      EXPECT_NEAR(*sleeves_down_deg(one_sleeve(turn_deg, slant_cm), person()), -turn_deg, 1e-9) << slant_cm;
  EXPECT_NEAR(*sleeves_down_deg(one_sleeve(44.5, 0, "[[-10, 0], [-10, -30], [10, -30], [10, 0]]"), person()), 45.5,
              1e-9)
      << "along y, as a cuff";
  EXPECT_NEAR(*sleeves_down_deg(one_sleeve(0, 12), person()), 0, 1e-9) << "arms that are level";
  EXPECT_NEAR(*sleeves_down_deg(one_sleeve(0, -30), person()), 45, 1e-9) << "not turned, and drawn slanting";
}

// 60 random patterns of GarmentCode with the measurements of the bodies that they are cut for, and of the others.
TEST(PatternFigures, RandomPatternsAreKnownForTheirOwnBodies) {
  const std::string folder = test::shared_path("patterns/random");
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no folder " << folder;
  const std::vector<std::string> names = {"mean_all", "mean_female", "mean_male"};
  std::vector<BodyFigures> bodies;
  for (const std::string& name : names) {
    const std::string path = test::shared_path("bodies/garmentcode/") + name + ".yaml";
    const BodyMeasurements m = parse_measurements(read_file(path), path);
    BodyFigures body;
    body.high_m.y() = m.height_m;
    body.tape_waist_m = m.waist_m();
    body.shoulder_m = m.shoulder_m();
    body.waist_girth_m = *m.waist_girth_m;
    body.arm_down_deg = *m.arm_down_rad * 180 / std::numbers::pi;
    bodies.push_back(body);
  }
  int patterns = 0, others = 0, known = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() != ".json" || stem.find("_mean_") == std::string::npos) continue;
    ++patterns;
    const Pattern pattern = load_pattern(entry.path().string());
    for (std::size_t k = 0; k < names.size(); ++k) {
      const std::vector<Misfit> found = misfits(pattern, bodies[k]);
      if (stem.ends_with(names[k])) {
        EXPECT_TRUE(found.empty()) << stem << ": " << found[0].code << " " << found[0].expected << ", " << found[0].got;
        continue;
      }
      ++others;
      known += found.empty() ? 0 : 1;
    }
  }
  EXPECT_EQ(patterns, 60);
  RecordProperty("known_of_others", known);
  EXPECT_GE(known, others - 6) << "of " << others;
}

}  // namespace
}  // namespace toile::internal
