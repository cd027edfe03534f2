// A body's measurements in a run: where they are found, what is refused, what they change, what is said of a pattern for somebody else.
#include "body/mannequin.hpp"
#include "garment/lint.hpp"
#include "io/json_value.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/body_figures.hpp"
#include "sim/scene_inputs.hpp"
#include "sim/setup.hpp"
#include "sim/simulate.hpp"
#include "support/paths.hpp"

#include <fmt/printf.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

namespace toile::internal {
namespace {

// The woman as somebody's file, and where her waist is found on it.
struct Person {
  std::string obj;
  double height_m = 0, waist_m = 0;
};
const Person& person() {
  static const Person made = [] {
    const Mannequin mannequin = make_mannequin(MannequinKind::woman);
    Person one;
    for (const Vec3& p : mannequin.positions) {
      one.obj += fmt::sprintf("v %.9f %.9f %.9f\n", p.x(), p.y(), p.z());
      one.height_m = std::max(one.height_m, p.y());
    }
    for (const auto& [a, b, c] : mannequin.triangles) one.obj += fmt::sprintf("f %d %d %d\n", a + 1, b + 1, c + 1);
    one.waist_m = body_figures(mannequin.positions, mannequin.triangles).waist_m;
    return one;
  }();
  return made;
}

// With her waist `lower_m` below where a surface shows it.
std::string tape(double lower_m, const std::string& more = "") {
  const double head_m = 0.25;
  return fmt::sprintf("body:\n  height: %.2f\n  head_l: 25\n  waist_line: %.3f\n", 100 * person().height_m,
                      100 * (person().height_m - head_m - person().waist_m + lower_m)) +
         more;
}

SceneCollider body_of(const Scratch& scratch) {
  SceneCollider body;
  body.worn = true;
  SceneMesh mesh;
  mesh.path = scratch / "woman.obj";
  body.shape = std::move(mesh);
  return body;
}

SceneMesh& mesh_of(SceneCollider& body) { return std::get<SceneMesh>(body.shape); }

std::string body_refusal(const SceneCollider& body) {
  try {
    load_collider(body);
  } catch (const Error& error) {
    return error.what();
  }
  return "(no error)";
}

TEST(Measurements, AreThoseBesideTheMeshOrThoseThatAreNamed) {
  const Scratch scratch;
  scratch.put("woman.obj", person().obj);
  SceneCollider body = body_of(scratch);
  const Collider without = load_collider(body);
  EXPECT_FALSE(without.measurements);
  EXPECT_EQ(measurements_path(mesh_of(body)), "");
  scratch.put("woman.yaml", tape(0));
  const Collider beside = load_collider(body);
  EXPECT_NEAR(*beside.measurements->waist_m(), person().waist_m, 1e-4);
  EXPECT_NE(without.input_hash, beside.input_hash);
  Scene scene;
  scene.body = body;
  const std::vector<std::string> inputs = input_paths(scene);
  EXPECT_NE(std::find(inputs.begin(), inputs.end(), scratch / "woman.yaml"), inputs.end())
      << "`verify` compares it, too";
  mesh_of(body).measurements = scratch.put("other.yml", tape(0.05));
  const Collider other = load_collider(body);
  EXPECT_NEAR(*other.measurements->waist_m(), person().waist_m - 0.05, 1e-4);
  EXPECT_NE(other.input_hash, beside.input_hash);
}

TEST(Measurements, OfAnotherBodyOrBrokenAreRefused) {
  const Scratch scratch;
  scratch.put("woman.obj", person().obj);
  const SceneCollider body = body_of(scratch);
  scratch.put("woman.yaml", fmt::sprintf("body: {height: %.2f}", 101.9 * person().height_m));
  EXPECT_EQ(body_refusal(body), "(no error)");
  scratch.put("woman.yaml", fmt::sprintf("body: {height: %.2f}", 102.1 * person().height_m));
  for (const char* part : {"woman.yaml: body.height: expected ", " cm within 2 %, the height of ", "woman.obj, got "})
    EXPECT_NE(body_refusal(body).find(part), std::string::npos) << body_refusal(body);
  scratch.put("woman.yaml", "body: [");
  EXPECT_NE(body_refusal(body).find("woman.yaml:1:"), std::string::npos) << body_refusal(body);
  scratch.put("woman.yaml", "samples: 4");
  const Collider loaded = load_collider(body);
  EXPECT_FALSE(loaded.measurements);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("holds no measurements"), std::string::npos);
  SceneCollider named = body;
  mesh_of(named).measurements = scratch / "woman.yaml";
  EXPECT_NE(body_refusal(named).find("a mapping with the key \"body\""), std::string::npos) << "what is named is meant";
  mesh_of(named).measurements = scratch / "nowhere.yaml";
  EXPECT_NE(body_refusal(named).find("nowhere.yaml"), std::string::npos);
}

TEST(Measurements, GoBeforeTheSurfaceButNotForThePose) {
  const Mannequin mannequin = make_mannequin(MannequinKind::woman);
  const auto figures_of = [&](const std::string& text) {
    return body_figures(mannequin.positions, mannequin.triangles, parse_measurements(text, "b.yaml"));
  };
  BodyFigures figures =
      figures_of(tape(0.03, "  waist: 77\n  shoulder_w: 40\n  shoulder_incl: 20\n  arm_pose_angle: 80\n"));
  EXPECT_NEAR(figures.waist_m, person().waist_m - 0.03, 1e-4);
  EXPECT_NEAR(*figures.tape_waist_m, figures.waist_m, 1e-12);
  EXPECT_DOUBLE_EQ(figures.waist_girth_m, 0.77);
  EXPECT_NEAR(*figures.shoulder_m, person().height_m - 0.25 - 0.2 * 0.36397, 1e-4);
  EXPECT_NEAR(*figures.arm_down_deg, 80, 1e-9) << "where nothing is found";
  add_arms(figures, find_arms(mannequin.positions, mannequin.triangles));
  EXPECT_GT(*figures.arm_down_deg, 10);
  EXPECT_LT(*figures.arm_down_deg, 60) << "she stands in an A";
  EXPECT_NE(odd_pose(parse_measurements(tape(0, "  arm_pose_angle: 80\n"), "b.yaml"), figures).find("got 80"),
            std::string::npos);
  const std::string right = fmt::sprintf("  arm_pose_angle: %.1f\n", *figures.arm_down_deg + 10);
  EXPECT_EQ(odd_pose(parse_measurements(tape(0, right), "b.yaml"), figures), "");
}

struct Sewn {
  Report report;
  double top_m = 0;  // when it is sewn
};
Sewn sew(const Scratch& scratch, const std::string& pattern, const std::string& body) {
  const Scene scene = parse_scene(R"({"cloth": [{"pattern": ")" + pattern + R"(", "resolution_cm": 5}], "body": )" +
                                      body + R"(, "time": {"seconds": 0.1}})",
                                  "s.json");
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  Sewn sewn{simulate(scene, options)};
  Pc2Reader film(scratch / "out/sewing.pc2");
  Vec3s x;
  film.read(film.samples() - 1, x);
  for (const Vec3& p : x) sewn.top_m = std::max(sewn.top_m, p.y());
  return sewn;
}

TEST(Measurements, AreFoundBesideTheBodyAndHoldTheWaist) {
  const Scratch scratch;
  const std::string body = R"({"mesh": ")" + scratch.put("woman.obj", person().obj) + "\"}";
  const std::string skirt = test::source_path("patterns/skirt.json");
  const double surface_m = sew(scratch, skirt, body).top_m;
  scratch.put("woman.yaml", tape(-0.05));
  const double higher_m = sew(scratch, skirt, body).top_m;
  scratch.put("woman.yaml", tape(0.05));
  const Sewn lower = sew(scratch, skirt, body);
  EXPECT_GT(higher_m, surface_m + 0.02);
  EXPECT_LT(lower.top_m, surface_m - 0.02);
  const bool listed = std::any_of(lower.report.inputs.begin(), lower.report.inputs.end(),
                                  [](const InputFile& file) { return file.path == "../woman.yaml"; });
  EXPECT_TRUE(listed);
}

bool tells(const Report& report, const std::string& what) {
  return std::any_of(report.warnings.begin(), report.warnings.end(),
                     [&](const std::string& warning) { return warning.find(what) != std::string::npos; });
}

TEST(Measurements, ARunSaysThatThePatternIsForSomebodyElse) {
  const Scratch scratch;
  const std::string body = R"({"mesh": ")" + scratch.put("woman.obj", person().obj) + "\"}";
  const std::string skirt = test::source_path("patterns/skirt.json");
  EXPECT_FALSE(tells(sew(scratch, skirt, body).report, "other_body"));
  scratch.put("woman.yaml", tape(0.1));
  EXPECT_TRUE(
      tells(sew(scratch, skirt, body).report, "other_body: the pattern is cut for a body with its waist at about"));
}

// The T-shirt as a template of 2021: its origin at the pelvis.  At 5 cm it is a coarse thing; where it is, is what counts.
TEST(Measurements, ATemplateOf2021IsRaisedToTheBodyAndTheReportSaysBy) {
  const Scratch scratch;
  JsonValue root(Json::load(test::source_path("patterns/tshirt.json")));
  const double raise_cm = 68 * person().height_m;
  for (auto& [name, panel] : *root.member("pattern").member("panels").object()) {
    JsonValue& y = (*panel.member("translation").array())[1];
    y = JsonValue(*y.number() - raise_cm);
  }
  JsonValue parameter;
  parameter.member("value") = JsonValue(1.0);
  root.member("parameters").member("length") = parameter;
  const std::string pattern = scratch.put("template.json", to_text(root));
  const Sewn legacy = sew(scratch, pattern, R"({"mannequin": "woman"})");
  EXPECT_TRUE(tells(legacy.report, fmt::sprintf("raised by %.1f cm, 0.68 of the body's height", raise_cm)));
  const Sewn standing = sew(scratch, test::source_path("patterns/tshirt.json"), R"({"mannequin": "woman"})");
  EXPECT_FALSE(tells(standing.report, "raised by"));
  EXPECT_NEAR(legacy.top_m, standing.top_m, 0.01);
}

}  // namespace
}  // namespace toile::internal
