// What is found wrong with a scene when it is loaded: its file and line are told by whoever read them, and the scene knows none.
#include "io/scratch.hpp"
#include "sim/budget.hpp"
#include "sim/setup.hpp"
#include "support/tube_pattern.hpp"

#include <gtest/gtest.h>

#include <string>

namespace toile::internal {
namespace {

// With the places of its file, and without.
struct Refusal {
  std::string of_a_file, of_a_model;
};
Refusal place_refusal(const std::string& text, const std::string& file = "s.json") {
  const SceneFile read = read_scene(text, file);
  const auto load = [&] {
    require_budget(read.scene, read_text_file, {});
    load_scene(read.scene, read_text_file);
  };
  Refusal said;
  try {
    read.places.complete_errors_of(load);
  } catch (const Error& error) {
    said.of_a_file = error.what();
  }
  try {
    load();
  } catch (const Error& error) {
    said.of_a_model = error.what();
  }
  return said;
}

TEST(ScenePlaces, OfPanelsPinsAndShapes) {
  const std::string grid = "{\"cloth\": [{\"grid\": {}},\n {\"name\": \"b\", \"grid\": {}, ";
  const Refusal panel = place_refusal(grid + "\"panels\": {\n  \"a/c\": {}}}]}");
  EXPECT_EQ(panel.of_a_file,
            "s.json:3:10: /cloth/1/panels/a~1c: expected a panel of the cloth; nearest is \"b\", got \"a/c\"");
  EXPECT_EQ(panel.of_a_model, "cloth: panels: expected a panel of the cloth; nearest is \"b\", got \"a/c\"");

  const Refusal pin = place_refusal(grid + "\"pins\": [\n  {\"near_m\": [0, 0, 0]}, {\"near_m\": [0, 0, 0]}]}]}");
  EXPECT_EQ(pin.of_a_file.rfind(
                "s.json:3:26: /cloth/1/pins/1: expected pins that hold different particles, got particle ", 0),
            0U)
      << pin.of_a_file;
  EXPECT_EQ(pin.of_a_model.rfind("pin 1: expected pins that hold different particles, got particle ", 0), 0U)
      << pin.of_a_model;

  const Refusal moves =
      place_refusal(grid +
                    "\"pins\": [\n {\"in_box_m\": [[-9, -9, -9], [9, 9, 9]], \"hold\": \"moves\", \"moves\": "
                    "[{\"t_s\": 0},\n {\"t_s\": 0.01, \"shift_m\": [9, 0, 0]}]}]}]}");
  EXPECT_EQ(moves.of_a_file.rfind("s.json:3:2: /cloth/1/pins/0/moves/1: expected no point faster than ", 0), 0U)
      << moves.of_a_file;
  EXPECT_EQ(moves.of_a_model.rfind("/moves/1: expected no point faster than ", 0), 0U) << moves.of_a_model;

  const Refusal shape = place_refusal(
      "{\"cloth\": [{\"name\": \"r\",\n \"ribbon\": {\"width_m\": 0.3, \"path_m\": [[0, 0, 0], [0.1, 0, 0], [0, 0.01, "
      "0]]}}]}");
  EXPECT_EQ(shape.of_a_file.rfind("s.json:2:12: /cloth/0/ribbon: path_m: expected ", 0), 0U) << shape.of_a_file;
  EXPECT_EQ(shape.of_a_model.rfind("r: path_m: expected ", 0), 0U) << shape.of_a_model;
}

TEST(ScenePlaces, OfLabelsOfAPattern) {
  const Scratch scratch;
  scratch.put("tube.json", test::tube_pattern_text());
  const Refusal label = place_refusal(
      "{\"cloth\": [\n  {\"pattern\": \"tube.json\", \"resolution_cm\": 4, \"label_heights_m\": {\"wrist\": 1}}]}",
      scratch / "s.json");
  EXPECT_EQ(label.of_a_file,
            scratch / "s.json" +
                ":2:3: /cloth/0/label_heights_m: expected a label that an edge of the pattern carries, got \"wrist\"");
  EXPECT_EQ(label.of_a_model,
            scratch / "tube.json" +
                ": /label_heights_m: expected a label that an edge of the pattern carries, got \"wrist\"");
}

TEST(ScenePlaces, OfLabelsOfAShapeThatHasNone) {
  const Refusal label = place_refusal("{\"cloth\": [\n  {\"grid\": {}, \"label_heights_m\": {\"wrist\": 1}}]}");
  EXPECT_EQ(
      label.of_a_file,
      "s.json:2:3: /cloth/0/label_heights_m: expected a label that an edge of the pattern carries, got \"wrist\"");
}

TEST(ScenePlaces, OfColliders) {
  const std::string cloth = "{\"cloth\": [{\"grid\": {}}],\n";
  const Refusal solid =
      place_refusal(cloth +
                    " \"solids\": [{\"sphere\": {\"radius_m\": 1}},\n"
                    "  {\"capsule\": {\"radius_m\": 0.1, \"from_m\": [1, 0, 0], \"to_m\": [1, 0, 0]}}]}");
  EXPECT_EQ(solid.of_a_file,
            "s.json:3:3: /solids/1: to_m: expected another place than from_m, got the same: that is a sphere");
  EXPECT_EQ(solid.of_a_model, "to_m: expected another place than from_m, got the same: that is a sphere");

  const Refusal body = place_refusal(
      cloth + " \"body\": {\"capsule\": {\"radius_m\": 0.1, \"from_m\": [1, 0, 0], \"to_m\": [1, 0, 0]}}}");
  EXPECT_EQ(body.of_a_file.rfind("s.json:2:10: /body: to_m: expected ", 0), 0U) << body.of_a_file;

  const Refusal fine = place_refusal(cloth + " \"solids\": [{\"sphere\": {\"radius_m\": 1}, \"edge_m\": 0.0005}]}");
  EXPECT_EQ(fine.of_a_file.rfind("s.json:2:13: /solids/0: edge_m: expected at most 2000000 triangles, got ", 0), 0U)
      << fine.of_a_file;
  EXPECT_EQ(fine.of_a_model.rfind("edge_m: expected at most 2000000 triangles, got ", 0), 0U) << fine.of_a_model;

  const Refusal person = place_refusal(
      cloth +
      " \"solids\": [{\"mannequin\": \"woman\", \"moves\": [{\"t_s\": 0}, {\"t_s\": 0.01, \"shift_m\": [9, 0, 0]}]}]}");
  EXPECT_EQ(person.of_a_file.rfind("s.json:2:13: /solids/0/moves/1: expected no point faster than ", 0), 0U)
      << person.of_a_file;
}

TEST(ScenePlaces, OfAPatternAreThoseOfItsOwnFile) {
  const Scratch scratch;
  std::string text = test::tube_pattern_text();
  text.insert(text.rfind('}'),
              ",\n\"toile\": {\"panels\": {\"front\": {\"folds\": [\n"
              "  {\"endpoints\": [0, 2], \"angle_deg\": 90}, {\"endpoints\": [1, 3], \"angle_deg\": 90}]}}}");
  scratch.put("tube.json", text);
  const Refusal fold =
      place_refusal("{\"cloth\": [{\"pattern\": \"tube.json\", \"resolution_cm\": 4}]}", scratch / "s.json");
  EXPECT_NE(fold.of_a_file.find("tube.json:"), std::string::npos) << fold.of_a_file;
  EXPECT_NE(fold.of_a_file.find(": /toile/panels/front/folds/1 (panel front, fold 1): expected a line from one side"),
            std::string::npos)
      << fold.of_a_file;
  EXPECT_EQ(fold.of_a_file, fold.of_a_model);
}

}  // namespace
}  // namespace toile::internal
