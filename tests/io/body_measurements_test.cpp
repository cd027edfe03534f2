// The YAML of a body's measurements: what is read, what follows from it, and every refusal.
#include "io/body_measurements.hpp"
#include "io/scratch.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace toile::internal {
namespace {

const std::string body_text =
    "body:\n  height: 170\n  head_l: 26.5\n  waist_line: 36\n  hips_line: 22.5\n  armscye_depth: 12.5\n  shoulder_w: "
    "40\n"
    "  shoulder_incl: 45\n  waist: 80.25\n  hips: 1e2\n  bust: 95\n  arm_pose_angle: 45.5\n  bum_points: 18\n";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t found = text.find(what);
  EXPECT_NE(found, std::string::npos) << what;
  return text.replace(found, what.size(), by);
}

std::string message_of(const std::string& text) {
  try {
    parse_measurements(text, "b.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

TEST(BodyMeasurements, AreReadInCentimetresAndDegrees) {
  const BodyMeasurements m = parse_measurements(body_text, "b.yaml");
  EXPECT_DOUBLE_EQ(m.height_m, 1.7);
  EXPECT_DOUBLE_EQ(*m.waist_girth_m, 0.8025);
  EXPECT_DOUBLE_EQ(*m.hips_girth_m, 1);
  EXPECT_DOUBLE_EQ(*m.bust_girth_m, 0.95);
  EXPECT_NEAR(*m.neck_m(), 1.435, 1e-12);
  EXPECT_NEAR(*m.waist_m(), 1.075, 1e-12);
  EXPECT_NEAR(*m.armpit_m(), 1.31, 1e-12);
  EXPECT_NEAR(*m.shoulder_m(), 1.235, 1e-12) << "half of 40 cm at 45 degrees below the neck's base";
  EXPECT_NEAR(*m.arm_down_rad, 0.7941, 1e-4);
}

TEST(BodyMeasurements, OnlyTheHeightIsNeeded) {
  const BodyMeasurements m = parse_measurements("body: {height: 170, head_l: 26.5, shoulder_w: 40}", "b.yaml");
  EXPECT_TRUE(m.neck_m());
  EXPECT_FALSE(m.waist_m());
  EXPECT_FALSE(m.shoulder_m()) << "without the slope";
  EXPECT_FALSE(m.armpit_m());
  EXPECT_FALSE(parse_measurements("body: {height: 170, waist_line: 36}", "b.yaml").waist_m()) << "without the head";
}

TEST(BodyMeasurements, MeanTheSameOnAMachineWithDecimalCommas) {
  const CommaLocale comma;
  EXPECT_DOUBLE_EQ(*parse_measurements(body_text, "b.yaml").waist_girth_m, 0.8025);
}

TEST(BodyMeasurements, ThatAreWrongAreRefusedWithPlaceExpectedAndGot) {
  struct Case {
    std::string text;
    std::vector<std::string> parts;
  };
  const std::vector<Case> cases = {
      {"body: [1, 2", {"b.yaml:1:", "expected YAML"}},
      {std::string("body:\0", 6), {"b.yaml", "a NUL byte"}},
      {"", {"b.yaml", "a mapping with the key \"body\"", "got nothing"}},
      {"height: 170", {"b.yaml", "a mapping with the key \"body\""}},
      {"body: 170", {"b.yaml:1:7: body: expected a mapping of measurements, got \"170\""}},
      {replaced(body_text, "  height: 170\n", ""), {"b.yaml:2:3: body.height: expected the height in cm, got none"}},
      {replaced(body_text, "170", "1.70"),
       {"b.yaml:2:11: body.height: expected a number from 50 to 250, got \"1.70\""}},
      {replaced(body_text, "26.5", "-26.5"), {"b.yaml:3:11: body.head_l:", "got \"-26.5\""}},
      {replaced(body_text, "26.5", "26,5"), {"body.head_l:", "got \"26,5\""}},
      {replaced(body_text, "26.5", ".nan"), {"body.head_l:", "got \".nan\""}},
      {replaced(body_text, "26.5", "nan"), {"body.head_l:", "got \"nan\""}},
      {replaced(body_text, "26.5", "[26.5]"), {"body.head_l:", "got a list"}},
      {replaced(body_text, "26.5", ""), {"body.head_l:", "got nothing"}},
      {replaced(body_text, "45.5", "-45"), {"body.arm_pose_angle: expected a number from 0 to 90, got \"-45\""}},
      {body_text + "  waist: 81\n", {"b.yaml:14:3: body.waist: expected it once, got it again"}},
      {body_text + "  height: 171\n", {"body.height: expected it once"}},
      {"body: {height: 60, head_l: 30, waist_line: 20, hips_line: 15}",
       {"body.waist_line: expected height - head_l - waist_line, above 15.0 cm, got 10.0 cm"}},
      {"body: {height: 90, head_l: 10, waist_line: 20, armscye_depth: 25}",
       {"body.armscye_depth: expected height - head_l - armscye_depth, above 60.0 cm, got 55.0 cm"}},
      {"body: {height: 90, head_l: 50}", {"body.head_l: expected height - head_l, above 45.0 cm, got 40.0 cm"}},
      {"body: {height: 90, head_l: 10, waist_line: 20, shoulder_w: 60, shoulder_incl: 50}",
       {"body.shoulder_incl: expected the tips of the shoulders, above 60.0 cm"}}};
  for (const Case& one : cases) {
    const std::string message = message_of(one.text);
    for (const std::string& part : one.parts) EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

TEST(BodyMeasurements, AYamlFileAboutSomethingElseIsKnownForThat) {
  EXPECT_TRUE(holds_measurements(body_text, "b.yaml"));
  EXPECT_FALSE(holds_measurements("renderer: {samples: 4}", "b.yaml"));
  EXPECT_FALSE(holds_measurements("- 1\n- 2\n", "b.yaml"));
  EXPECT_FALSE(holds_measurements("", "b.yaml"));
  EXPECT_THROW(holds_measurements("{", "b.yaml"), InputError);
}

// Aliases of aliases may stand for more than there is room for; nothing here follows them.
TEST(BodyMeasurements, AliasesDoNotExplode) {
  std::string text = "a0: &a0 [x, x]\n";
  for (int k = 1; k < 60; ++k) {
    const std::string before = std::to_string(k - 1), here = std::to_string(k);
    text += "a" + here + ": &a" + here + " [*a" + before + ", *a" + before + "]\n";
  }
  EXPECT_EQ(parse_measurements(text + "body: {height: 170, waist: 80, other: *a59}", "b.yaml").height_m, 1.7);
}

}  // namespace
}  // namespace toile::internal
