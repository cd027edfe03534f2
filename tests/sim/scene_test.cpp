// The reader of scenes: defaults, every refusal with its place, and the shape that the documentation shows.
#include "sim/scene.hpp"

#include "sim/setup.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

std::string scene_refusal(const std::string& text) {
  try {
    parse_scene(text, "dir/s.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "(accepted)";
}

void expect_refused(const std::string& text, std::initializer_list<std::string_view> words) {
  const std::string message = scene_refusal(text);
  EXPECT_EQ(message.rfind("dir/s.json:", 0), 0u) << message;
  for (const std::string_view word : words)
    EXPECT_NE(message.find(word), std::string::npos) << '"' << word << "\" is not in: " << message;
}

TEST(Scene, APatternAndABodyAreAComplete) {
  const Scene scene =
      parse_scene(R"({"cloth": [{"pattern": "p.json"}], "body": {"mesh": "../b.obj"}})", "dir/scenes/s.json");
  EXPECT_EQ(scene.name, "s");
  EXPECT_EQ(scene.cloth.at(0).path(), "dir/scenes/p.json") << "paths start at the scene's folder";
  EXPECT_EQ(std::get<SceneMesh>(scene.body.shape).path, "dir/b.obj");
  EXPECT_EQ(scene.cloth[0].fabric.name, "cotton");
  EXPECT_EQ(scene.cloth[0].resolution_m, 0.01);
  EXPECT_EQ(scene.gravity_m_per_s2, Vec3(0, -9.81, 0));
  EXPECT_EQ(scene.fps, 30);
  EXPECT_EQ(scene.seconds, 5);
  EXPECT_TRUE(scene.until_still);
  EXPECT_TRUE(scene.self_contact);
  EXPECT_TRUE(scene.flypaper);
  EXPECT_FALSE(scene.preconditioner.has_value());
  EXPECT_FALSE(scene.body.contact.friction.has_value());
}

TEST(Scene, AnAbsolutePathStaysAsItIs) {
  EXPECT_EQ(parse_scene(R"({"cloth": [{"pattern": "/x/p.json"}]})", "dir/s.json").cloth.at(0).path(), "/x/p.json");
}

TEST(Scene, ReadsEveryKeyInItsUnit) {
  const Scene scene = parse_scene(R"({
    "name": "flag",
    "cloth": [{"name": "flag", "grid": {"width_m": 1.5, "height_m": 0.5, "edge_m": 0.05},
      "fabric": {"base": "silk", "density_kg_per_m2": 0.08},
      "panels": {"flag": {"fabric": "knit", "rest_stretch_u": 0.9, "rest_stretch_v": 1.1}},
      "placement": {"translation_m": [0, 1, 2], "rotation_deg": [90, 0, 0]},
      "pins": [{"near_m": [0, 1, 0], "hold": "fixed"}, {"near_m": [1, 1, 0], "hold": "path", "path_m": [[0, 1, 1, 0], [2, 1, 1.5, 0]]}]}],
    "body": {"cylinder": {"radius_m": 0.3, "height_m": 0.7, "top_m": [0, 0.5, 0]}, "friction": 0.1, "offset_mm": 3},
    "world": {"gravity_m_per_s2": [0, -1, 0], "wind_m_per_s": [0, 0, 0], "air_density_kg_per_m3": 1.2},
    "time": {"fps": 25, "seconds": 2, "step_max_ms": 10, "integrator": "backward_euler", "until_still": true},
    "solver": {"preconditioner": "diagonal", "tolerance": 0.01, "paper_scaling": true, "damping_jacobian": "paper"},
    "contact": {"thickness_mm": 2, "friction": 0.2, "self_contact": false, "strict_start": true, "flypaper": false},
    "output": {"dir": "out/x", "preview": false}})",
                                  "s.json");
  const SceneCloth& cloth = scene.cloth.at(0);
  EXPECT_EQ(cloth.as<SceneGrid>()->width_m, 1.5);
  EXPECT_EQ(cloth.fabric.density_kg_per_m2, 0.08);
  EXPECT_EQ(cloth.fabric.stretch_u_N_per_m, 1200) << "silk's";
  EXPECT_EQ(cloth.panels.at(0).fabric->name, "knit");
  EXPECT_EQ(cloth.panels[0].rest_stretch_u, 0.9);
  EXPECT_EQ(cloth.panels[0].rest_stretch_v, 1.1);
  EXPECT_EQ(cloth.translation_m, Vec3(0, 1, 2));
  EXPECT_EQ(cloth.rotation_deg, Vec3(90, 0, 0));
  EXPECT_EQ(cloth.pins.at(0).hold, ScenePin::Hold::fixed);
  EXPECT_EQ(cloth.pins.at(1).path.at(1).x, Vec3(1, 1.5, 0));
  EXPECT_EQ(std::get<SceneCylinder>(scene.body.shape).radius_m, 0.3);
  EXPECT_EQ(scene.body.contact.friction.value(), 0.1);
  EXPECT_DOUBLE_EQ(scene.body.contact.offset_m.value(), 3e-3);
  EXPECT_EQ(scene.fps, 25);
  EXPECT_DOUBLE_EQ(scene.step_max_s.value(), 0.01);
  EXPECT_TRUE(scene.until_still);
  EXPECT_EQ(scene.preconditioner, Preconditioner::diagonal);
  EXPECT_TRUE(scene.paper_scaling);
  EXPECT_EQ(scene.damping_jacobian, DampingJacobian::paper);
  EXPECT_DOUBLE_EQ(scene.contact_thickness_m.value(), 2e-3);
  EXPECT_FALSE(scene.self_contact);
  EXPECT_FALSE(scene.flypaper);
  EXPECT_TRUE(scene.strict_start);
  EXPECT_EQ(scene.output_dir, "out/x");
  EXPECT_FALSE(scene.preview.value());
}

TEST(Scene, ReadsSolidsShapesAndPinsThatMove) {
  const Scene scene = parse_scene(R"({
    "cloth": [{"tube": {"radius_m": 0.3, "length_m": 2, "edge_m": 0.04},
               "pins": [{"in_box_m": [[1, -1, -2], [-1, 0, 2]], "hold": "moves", "about_m": [0, 1, 0], "from_s": 0.5, "to_s": 2,
                         "moves": [{"t_s": 1, "shift_m": [1, 0, 0]}, {"t_s": 2, "rotation_deg": [0, 720, 0]}]}]},
              {"ribbon": {"width_m": 0.2, "edge_m": 0.03, "path_m": [[0, 0, 0], [1, 0, 0], [1, 1, 0]], "closed": true, "across": [0, 0, 2]}}],
    "solids": [{"sphere": {"radius_m": 0.4}, "edge_m": 0.05, "inside_out": true, "moves": [{"t_s": 0}, {"t_s": 3, "scale": 0.5}],
                "placement": {"translation_m": [1, 2, 3], "rotation_deg": [0, 90, 0]}},
               {"box": {"size_m": [1, 2, 3]}}, {"revolved": {"profile_m": [[0, 0], [1, 0], [0, 1]]}}, {"mesh": "b.obj"}]})",
                                  "dir/s.json");
  EXPECT_EQ(scene.cloth.at(0).name, "tube");
  EXPECT_EQ(std::get<SceneTube>(scene.cloth[0].kind).length_m, 2);
  const ScenePin& pin = scene.cloth[0].pins.at(0);
  EXPECT_EQ((*pin.in_box_m)[0], Vec3(-1, -1, -2));
  EXPECT_EQ((*pin.in_box_m)[1], Vec3(1, 0, 2));
  EXPECT_EQ(pin.from_s, 0.5);
  EXPECT_EQ(pin.to_s, 2);
  EXPECT_EQ(pin.moves.centre(), Vec3(0, 1, 0));
  ASSERT_EQ(pin.moves.keys().size(), 2u);
  EXPECT_EQ(pin.moves.keys()[1].shift_m, Vec3(1, 0, 0)) << "what a key leaves out is as before";
  EXPECT_EQ(pin.moves.keys()[1].rotation_deg, Vec3(0, 720, 0));
  EXPECT_EQ(scene.cloth.at(1).name, "ribbon");
  EXPECT_TRUE(std::get<SceneRibbon>(scene.cloth[1].kind).closed);
  EXPECT_EQ(std::get<SceneRibbon>(scene.cloth[1].kind).across, Vec3(0, 0, 2));
  ASSERT_EQ(scene.solids.size(), 4u);
  EXPECT_EQ(std::get<SceneSphere>(scene.solids[0].shape).radius_m, 0.4);
  EXPECT_TRUE(scene.solids[0].inside_out);
  EXPECT_EQ(scene.solids[0].moves.centre(), Vec3(1, 2, 3)) << "a solid turns about its own place";
  EXPECT_EQ(scene.solids[0].moves.keys()[1].scale, 0.5);
  EXPECT_EQ(std::get<SceneBox>(scene.solids[1].shape).size_m, Vec3(1, 2, 3));
  EXPECT_EQ(std::get<SceneRevolved>(scene.solids[2].shape).profile_m.size(), 3u);
  EXPECT_EQ(std::get<SceneMesh>(scene.solids[3].shape).path, "dir/b.obj");
  EXPECT_EQ(scene.drape_seconds, 0) << "what moves by itself does not wait for a drape";
}

TEST(Scene, RefusesShapesAndSolidsThatAreNone) {
  const auto with_cloth = [](const std::string& cloth) { return R"({"cloth": [{)" + cloth + "}]}"; };
  const auto with_solid = [](const std::string& solid) {
    return R"({"cloth": [{"grid": {}}], "solids": [{)" + solid + "}]}";
  };
  const auto with_pin = [&](const std::string& pin) { return with_cloth(R"("grid": {}, "pins": [{)" + pin + "}]"); };
  expect_refused(with_cloth(R"("grid": {}, "tube": {})"), {"/cloth/0", "one of", "2 of them"});
  expect_refused(with_cloth(R"("tube": {"radius_m": 0.01, "edge_m": 0.02})"),
                 {"/cloth/0/tube", "at most its radius_m"});
  expect_refused(with_cloth(R"("ribbon": {"path_m": [[0, 0, 0]]})"),
                 {"/cloth/0/ribbon/path_m", "at least 2 points", "got 1"});
  expect_refused(with_cloth(R"("ribbon": {"path_m": [[0, 0, 0], [0, 0, 0]]})"),
                 {"/cloth/0/ribbon/path_m/1", "another place"});
  expect_refused(with_cloth(R"("ribbon": {"closed": true, "path_m": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0]]})"),
                 {"/cloth/0/ribbon/path_m", "only once"});
  expect_refused(
      with_cloth(R"("ribbon": {"edge_m": 0.5, "closed": true, "path_m": [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]]})"),
      {"/cloth/0/ribbon", "a sixth"});
  expect_refused(with_pin(R"("in_box_m": [[0, 0, 0]])"), {"/cloth/0/pins/0/in_box_m", "two corners"});
  expect_refused(with_pin(R"("in_box_m": [[0, 0, 0], [1, 1, 1]], "near_m": [0, 0, 0])"), {"/pins/0/near_m", "both"});
  expect_refused(with_pin(R"("in_box_m": [[0, 0, 0], [1, 1, 1]], "hold": "path", "path_m": [[0, 0, 0, 0]])"),
                 {"path_m", "moves"});
  expect_refused(with_pin(R"("near_m": [0, 0, 0], "hold": "moves")"), {"/pins/0", "moves"});
  expect_refused(with_pin(R"("near_m": [0, 0, 0], "moves": [{"t_s": 0}])"), {"/pins/0/moves", "beside it"});
  expect_refused(with_pin(R"("near_m": [0, 0, 0], "hold": "moves", "moves": [{"t_s": 1}, {"t_s": 1}])"),
                 {"/moves/1/t_s", "ascend"});
  expect_refused(with_pin(R"("near_m": [0, 0, 0], "from_s": 2, "to_s": 1)"), {"/pins/0", "lets go after"});
  expect_refused(with_pin(R"("near_m": [0, 0, 0], "hold": "path", "path_m": [[0, 0, 0, 0], [0.1, 0, 11, 0]])"),
                 {"/pins/0/path_m/1", "at most 100 m/s", "got 110 m/s"});
  expect_refused(with_solid(""), {"/solids/0", "none of them"});
  expect_refused(with_solid(R"("sphere": {"radius_m": 1}, "box": {"size_m": [1, 1, 1]})"), {"/solids/0", "2 of them"});
  expect_refused(with_solid(R"("sphere": {})"), {"/solids/0/sphere", "radius_m"});
  expect_refused(with_solid(R"("box": {"size_m": [1, 0, 1]})"), {"/solids/0/box/size_m/1", "at least 0.001"});
  expect_refused(with_solid(R"("revolved": {"profile_m": [[0, 0, 0]]})"), {"/profile_m/0", "two numbers"});
}

TEST(Scene, NamesThePlaceOfEveryRefusal) {
  expect_refused(R"({})", {"\"cloth\"", "missing"});
  expect_refused(R"({"cloth": []})", {"/cloth", "at least one"});
  expect_refused(R"({"cloth": [{}]})", {"/cloth/0", "one of \"pattern\", \"mesh\", \"grid\"", "none of them"});
  expect_refused(R"({"cloth": [{"grid": {}, "pattern": "p"}]})", {"/cloth/0", "2 of them"});
  expect_refused(R"({"cloth": [{"grid": {"edge_m": 0}}]})", {"/cloth/0/grid/edge_m", "of at least 0.0005", "got 0"});
  expect_refused(R"({"cloth": [{"grid": {"edge_m": 0.0005, "width_m": 10, "height_m": 10}}]})",
                 {"/cloth/0/grid", "2 million"});
  expect_refused(R"({"cloth": [{"grid": {}, "pins": [{"near_m": [0, 0]}]}]})",
                 {"/cloth/0/pins/0/near_m", "three numbers"});
  expect_refused(R"({"cloth": [{"grid": {}, "pins": [{"near_m": [0, 0, 0], "hold": "path"}]}]})",
                 {"/cloth/0/pins/0", "path_m"});
  expect_refused(
      R"({"cloth": [{"grid": {}, "pins": [{"near_m": [0, 0, 0], "hold": "path", "path_m": [[1, 0, 0, 0], [1, 0, 0, 0]]}]}]})",
      {"path_m", "ascend"});
  expect_refused(R"({"cloth": [{"grid": {}, "mesh_unit": "cm"}]})", {"/cloth/0/mesh_unit", "a mesh beside it"});
  expect_refused(R"({"cloth": [{"mesh": "a.obj", "vertices": 100}]})", {"/cloth/0/vertices", "a pattern beside it"});
  expect_refused(R"({"cloth": [{"mesh": "a.obj", "resolution_cm": 2}]})",
                 {"/cloth/0/resolution_cm", "a pattern beside it", "got 2"});
  expect_refused(R"({"cloth": [{"grid": {}, "resolution_cm": 2}]})",
                 {"/cloth/0/resolution_cm", "a pattern beside it: other shapes have an edge_m"});
  expect_refused(R"({"cloth": [{"grid": {}}], "world": {"wind_path": [[1, 0, 0, 0], [1, 2, 0, 0]]}})",
                 {"/world/wind_path", "ascend"});
  expect_refused(R"({"cloth": [{"grid": {}}], "body": {"mesh": "b.obj", "mannequin": "woman"}})",
                 {"/body", "2 of them"});
  expect_refused(R"({"cloth": [{"grid": {}}], "body": {"mannequin": "womn"}})",
                 {"/body/mannequin", "nearest is \"woman\""});
  expect_refused(R"({"cloth": [{"grid": {}}], "body": {"mannequin": "woman", "unit": "cm"}})", {"/body/unit"});
  expect_refused(R"({"cloth": [{"grid": {}}], "time": {"integrator": "rk4"}})", {"/time/integrator", "backward_euler"});
  expect_refused(R"({"cloth": [{"grid": {}}], "solver": {"preconditioner": "block_jacbi"}})",
                 {"/solver/preconditioner", "nearest is \"block_jacobi\""});
  for (const char* count : {"2.5", "-1", "11"})
    expect_refused(std::string(R"({"cloth": [{"grid": {}}], "solver": {"relinearisations": )") + count + "}}",
                   {"/solver/relinearisations"});
  expect_refused(R"({"cloth": [{"grid": {}}], "output": {"preview": 1}})", {"/output/preview"});
}

TEST(Scene, TakesTheLineOfTheValueThatIsWrong) {
  EXPECT_EQ(
      scene_refusal("{\"cloth\": [{\"grid\": {},\n\"fabric\": {\n\"bend_u_N_m\": -1e-5}}]}").rfind("dir/s.json:3:", 0),
      0u);
}

// Times of events count from the first frame: what comes before it, inner drapes and growth, has what the paths begin with.
TEST(Scene, BeginsWithTheFirstGravityAndWindOfTheirPaths) {
  const auto options = [](const std::string& world) {
    const std::string text = R"({"cloth": [{"grid": {}}], "world": )" + world + "}";
    return run_options(parse_scene(text, "s.json"), StepOptions{});
  };
  const OutfitRunOptions in_time =
      options(R"({"gravity_path": [[1, 0, -1, 0], [2, 0, -2, 0]], "wind_path": [[0, 3, 0, 0], [1, 0, 0, 0]]})");
  EXPECT_EQ(in_time.model.gravity_m_per_s2, Vec3(0, -1, 0));
  EXPECT_EQ(in_time.air.wind_m_per_s, Vec3(3, 0, 0));
  const OutfitRunOptions constant = options(R"({"gravity_m_per_s2": [0, -5, 0], "wind_m_per_s": [1, 0, 0]})");
  EXPECT_EQ(constant.model.gravity_m_per_s2, Vec3(0, -5, 0));
  EXPECT_EQ(constant.air.wind_m_per_s, Vec3(1, 0, 0));
}

}  // namespace
}  // namespace toile::internal
