#include "sim/fabric_measurements_file.hpp"

#include "io/scratch.hpp"
#include "material/laboratory_units.hpp"
#include "sim/fabric_file.hpp"
#include "sim/scene.hpp"
#include "support/message_of.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

std::string refusal(const std::string& text) {
  return toile::test::message_of<InputError>([&] { parse_fabric_measurements(text, "m.json"); });
}

TEST(FabricMeasurements, AreReadInTheirUnits) {
  const FabricMeasurements m = parse_fabric_measurements(R"({
    "name": "n", "base": "wool", "weight_g_per_m2": [200, 210], "thickness_mm": 0.5, "friction": 0.3, "drape_percent": 40,
    "chord_N_per_m": [5, 20],
    "cantilever": {"warp_bending_length_mm": 20, "weft_overhang_mm": [40, 42], "bias_bending_length_mm": 18},
    "fast": {"bending_length_warp_mm": 21, "bending_rigidity_weft_uN_m": 9, "E5_warp_percent": 0.2, "E20_warp_percent": 0.6,
             "E100_weft_percent": 3, "EB5_percent": 2},
    "kes": {"B_warp_gf_cm2_per_cm": 0.1, "2HB_weft_gf_cm_per_cm": 0.05, "G_gf_per_cm_deg": 1, "2HG_gf_per_cm": 2,
            "EMT_warp_percent": 5, "LT_warp": 0.6, "EMT_weft_percent": 7, "WT_weft_gf_cm_per_cm2": 10},
    "tensile": {"warp": [[0, 0], [0.5, 20], [1, 60]]}})",
                                                         "m.json")
                                   .measured;
  EXPECT_EQ(m.name, "n");
  EXPECT_EQ(m.base, "wool");
  const auto expect = [](const Readings& readings, std::vector<double> values) {
    ASSERT_EQ(readings.size(), values.size());
    for (std::size_t k = 0; k < values.size(); ++k) EXPECT_NEAR(readings[k] / values[k], 1, 1e-9);
  };
  expect(m.weight_kg_per_m2, {0.2, 0.21});
  expect(m.thickness_m, {5e-4});
  expect(m.friction, {0.3});
  expect(m.drape, {0.4});
  expect(m.warp.cantilever_m, {0.02});
  expect(m.weft.cantilever_m, {0.02, 0.021});
  expect(m.bias_cantilever_m, {0.018});
  expect(m.warp.fast_bending_m, {0.021});
  expect(m.weft.fast_bending_N_m, {9e-6});
  expect(m.warp.fast_extension[0], {0.002});
  expect(m.warp.fast_extension[1], {0.006});
  expect(m.weft.fast_extension[2], {0.03});
  expect(m.fast_bias_extension, {0.02});
  expect(m.warp.kes_bending_N_m, {9.80665e-6});
  expect(m.weft.kes_hysteresis_N, {4.903325e-4});
  expect(m.kes_shear_N_per_m, {56.1879656});
  expect(m.kes_shear_hysteresis_N_per_m, {1.96133});
  expect(m.warp.kes_extension, {0.05});
  expect(m.warp.kes_linearity, {0.6});
  expect(m.weft.kes_work_N_per_m, {9.80665});
  EXPECT_EQ(m.warp.curve, (std::vector<std::array<double, 2>>{{0.005, 20}, {0.01, 60}}));
  EXPECT_EQ(m.chord_N_per_m, (std::array<double, 2>{5, 20}));
}

TEST(FabricMeasurements, ThatAreWrongAreRefusedWithFilePlaceExpectedAndGot) {
  struct Case {
    const char* text;
    std::vector<std::string> words;
  };
  const std::vector<Case> cases = {
      {"{", {"m.json:1:2"}},
      {"[]", {"m.json:1:1: expected an object"}},
      {"{}", {"m.json:1:1: expected at least one figure, say \"weight_g_per_m2\", got none"}},
      {R"({"name": "a", "base": "silk"})", {"at least one figure"}},
      {R"({"name": ""})", {"m.json:1:10: /name: expected a name"}},
      {R"({"base": "coton", "friction": 1})", {"/base", "nearest is \"cotton\"", "\"coton\""}},
      {R"({"weight_kg_per_m2": 0.15})", {"weight_g_per_m2", "weight_kg_per_m2"}},
      {R"({"weight_g_per_m2": 0.15})",
       {"m.json:1:21: /weight_g_per_m2: expected a number of at least 5 and at most 5000, got 0.15"}},
      {R"({"weight_g_per_m2": -118})", {"/weight_g_per_m2", "got -118"}},
      {R"({"weight_g_per_m2": 1e999})", {"m.json:1:21", "a finite number"}},
      {R"({"weight_g_per_m2": NaN})", {"m.json:1:21"}},
      {R"({"weight_g_per_m2": null})", {"/weight_g_per_m2", "a number or a list of readings"}},
      {R"({"weight_g_per_m2": "118"})", {"/weight_g_per_m2", "a number or a list of readings", "\"118\""}},
      {R"({"weight_g_per_m2": []})", {"/weight_g_per_m2", "at least one reading", "an empty array"}},
      {"{\"weight_g_per_m2\": [118,\n 0]}", {"m.json:2:2: /weight_g_per_m2/1", "at least 5", "got 0"}},
      {R"({"weight_g_per_m2": [118, [1]]})", {"/weight_g_per_m2/1"}},
      {R"({"weight_g_per_m2": 118, "weight_g_per_m2": 119})", {"each key once"}},
      {R"({"thickness_mm": 240})", {"/thickness_mm", "at most 50"}},
      {R"({"drape_percent": 0.55})", {"/drape_percent", "at least 1", "0.55"}},
      {R"({"drape_percent": 101})", {"/drape_percent", "at most 100"}},
      {R"({"friction": 35})", {"/friction", "at most 5"}},
      {R"({"cantilever": 20})", {"/cantilever", "an object"}},
      {R"({"cantilever": {}})", {"at least one figure"}},
      {R"({"cantilever": {"warp_bending_length_cm": 2.0}})", {"/cantilever", "warp_bending_length_mm"}},
      {R"({"cantilever": {"warp_bending_length_mm": 0.02}})", {"/cantilever/warp_bending_length_mm", "at least 2"}},
      {R"({"cantilever": {"warp_bending_length_mm": 20, "warp_overhang_mm": 40}})",
       {"/cantilever/warp_overhang_mm", "either \"warp_bending_length_mm\" or \"warp_overhang_mm\", got both"}},
      {R"({"fast": {"bending_length_weft_mm": 20, "bending_rigidity_weft_uN_m": 9}})",
       {"/fast/bending_rigidity_weft_uN_m", "either", "both"}},
      {R"({"fast": {"E5_warp_percent": 0.9, "E20_warp_percent": 0.6}})",
       {"/fast/E20_warp_percent", "more than under the smaller load, 0.9 %", "got 0.6 %"}},
      {R"({"fast": {"E5_warp_percent": 0.9, "E100_warp_percent": [0.9, 0.9]}})", {"/fast/E100_warp_percent"}},
      {R"({"fast": {"EB5_percent": 0}})", {"/fast/EB5_percent", "got 0"}},
      {R"({"kes": {"EMT_warp_percent": 5}})",
       {"/kes/EMT_warp_percent", "LT_warp", "WT_warp_gf_cm_per_cm2", "got neither"}},
      {R"({"kes": {"LT_warp": 0.6}})", {"/kes/LT_warp", "\"EMT_warp_percent\" beside it", "got none"}},
      {R"({"kes": {"EMT_warp_percent": 5, "LT_warp": 0.6, "WT_warp_gf_cm_per_cm2": 9}})", {"either", "both"}},
      {R"({"kes": {"EMT_warp_percent": 5, "LT_warp": 1.2}})", {"/kes/LT_warp", "at most 1"}},
      {R"({"kes": {"B_gf_cm2_per_cm": 0.1}})", {"/kes", "B_warp_gf_cm2_per_cm"}},
      {R"({"kes": {"B_warp_gf_cm2_per_cm": 1e9}})", {"/kes/B_warp_gf_cm2_per_cm", "at most 200"}},
      {R"({"kes": {"2HB_warp_gf_cm_per_cm": -0.1}})", {"/kes/2HB_warp_gf_cm_per_cm", "got -0.1"}},
      {R"({"tensile": {"warp": []}})", {"/tensile/warp", "at least one point"}},
      {R"({"tensile": {"warp": [[0, 0]]}})", {"/tensile/warp", "at least one point"}},
      {R"({"tensile": {"warp": [[1]]}})", {"/tensile/warp/0", "two numbers [strain in %, force in N/m]"}},
      {R"({"tensile": {"warp": [[1, 20], [0.9, 30]]}})",
       {"/tensile/warp/1/0", "a strain above that before, 1 %", "got 0.9"}},
      {R"({"tensile": {"warp": [[1, 20], [2, 20]]}})", {"/tensile/warp/1/1", "a force above that before, 20 N/m"}},
      {R"({"tensile": {"warp": [[1, -20]]}})", {"/tensile/warp/0/1", "got -20"}},
      {R"({"tensile": {"wrap": [[1, 20]]}})", {"/tensile", "warp"}},
      {R"({"friction": 1, "chord_N_per_m": [50, 10]})", {"/chord_N_per_m/1", "above 50 N/m", "got 10"}},
      {R"({"friction": 1, "chord_N_per_m": 30})", {"/chord_N_per_m", "two forces [from, to]"}},
  };
  for (const Case& wrong : cases) {
    const std::string message = refusal(wrong.text);
    EXPECT_TRUE(message.starts_with("m.json:1:") || message.starts_with("m.json:2:")) << message;
    EXPECT_NE(message.find("expected "), std::string::npos) << message;
    EXPECT_NE(message.find(", got "), std::string::npos) << message;
    for (const std::string& word : wrong.words)
      EXPECT_NE(message.find(word), std::string::npos) << '"' << word << "\" is not in: " << message;
  }
}

TEST(FabricMeasurements, AnErrorOfTheFitHasItsPlaceInTheFile) {
  const Scratch scratch;
  const std::string drape = scratch.put("m.json", "{\"weight_g_per_m2\": 100,\n \"drape_percent\": [2, 3]}"),
                    work = scratch.put("w.json", R"({"kes": {"EMT_warp_percent": 5, "WT_warp_gf_cm_per_cm2": 90}})");
  EXPECT_NE(toile::test::message_of<InputError>([&] {
              fit_fabric_file(drape);
            }).find("m.json:2:19: /drape_percent: expected a mean from "),
            std::string::npos);
  EXPECT_NE(toile::test::message_of<InputError>([&] {
              fit_fabric_file(work);
            }).find("w.json:1:58: /kes/WT_warp_gf_cm_per_cm2: expected a linearity"),
            std::string::npos);
}

// ---- a fabric in a file ---------------------------------------------------------------------------------------------------

const char* const some = R"({"base": "wool", "weight_g_per_m2": [200, 210], "friction": 0.3, "name": "a \"b\"",
  "cantilever": {"warp_bending_length_mm": 20}, "kes": {"B_warp_gf_cm2_per_cm": 0.5, "2HB_warp_gf_cm_per_cm": 0.1}})";

TEST(FabricFile, WhatIsWrittenIsReadToTheSameNumbers) {
  const Scratch scratch;
  const FabricFit fit = fit_fabric_file(scratch.put("m.json", some));
  const std::string text = to_json(fit);
  EXPECT_TRUE(is_fabric_fit(text));
  const Fabric read = read_fabric_file(scratch.put("f.json", text));
  EXPECT_EQ(read.name, "wool");
  EXPECT_EQ(read.density_kg_per_m2, fit.fabric.density_kg_per_m2);
  EXPECT_EQ(read.density_kg_per_m2, 0.205);
  EXPECT_EQ(read.bend_u_N_m, fit.fabric.bend_u_N_m);
  EXPECT_EQ(read.bend_v_N_m, fabric_preset("wool", "", "").bend_v_N_m);
  EXPECT_EQ(read.friction, 0.3);
  EXPECT_EQ(read.thickness_m, fabric_preset("wool", "", "").thickness_m);
  const Json json = Json::parse(text, "");
  EXPECT_EQ(json.at("name").string(), "a \"b\"");
  EXPECT_EQ(json.at("fabric").object().size(), 4u) << "the base and what was measured";
  EXPECT_EQ(json.at("uncertainty").object().size(), 3u);
  EXPECT_TRUE(json.at("sources").at("shear_N_per_m").at("uncertainty").is_null());
  EXPECT_EQ(json.at("sources").at("bend_u_N_m").at("methods").array().size(), 2u);
  EXPECT_EQ(json.at("flags").array().front().at("code").string(), "sources_disagree");
  EXPECT_NEAR(json.at("measured").at("bend_friction_N").at("value").number(), 4.903e-4, 1e-9);
  EXPECT_TRUE(json.at("drape").at("measured_percent").is_null());
  // In a scene, as it is.
  const std::size_t begin = text.find("\"fabric\": {"), end = text.find('}', begin) + 1;
  const Scene scene = parse_scene("{\"cloth\": [{\"grid\": {}, " + text.substr(begin, end - begin) + "}]}", "s.json");
  EXPECT_EQ(scene.cloth.front().fabric.bend_u_N_m, read.bend_u_N_m);
}

TEST(FabricFile, OfTheKeysOfASceneAloneIsTakenToo) {
  const Scratch scratch;
  const Fabric fabric = read_fabric_file(scratch.put("f.json", R"({"base": "silk", "shear_N_per_m": 33})"));
  EXPECT_EQ(fabric.shear_N_per_m, 33);
  EXPECT_EQ(fabric.name, "silk");
  EXPECT_EQ(fabric_of("denim", "--fabric").density_kg_per_m2, 0.35);
  EXPECT_EQ(fabric_of(scratch / "f.json", "--fabric").shear_N_per_m, 33);
}

TEST(FabricFile, ThatIsWrongIsRefusedWithFileKeyExpectedAndGot) {
  const Scratch scratch;
  const auto refused = [&](const char* text, std::vector<std::string> words) {
    const std::string path = scratch.put("f.json", text);
    const std::string message = toile::test::message_of<InputError>([&] { read_fabric_file(path); });
    words.emplace_back("f.json:1:");
    for (const std::string& word : words)
      EXPECT_NE(message.find(word), std::string::npos) << '"' << word << "\" is not in: " << message;
  };
  refused("[]", {"an object with the keys of a fabric"});
  refused(R"({"shear_N_per": 3})", {"nearest: \"shear_N_per_m\"", "got \"shear_N_per\""});
  refused(R"({"fabric": {"bend_u_N_m": -1}})", {"/fabric/bend_u_N_m", "got -1"});
  refused(R"({"fabric": "silk"})", {"/fabric", "an object"});
  refused(R"({"fabric": {"base": "sikl"}})", {"/fabric/base", "nearest is \"silk\""});
  refused(R"({"fabric": {}, "cloth": []})", {"cloth"});
  refused(R"({"weight_g_per_m2": 118})", {"expected a fabric, got laboratory figures: toile fit-fabric"});
  EXPECT_THROW(read_fabric_file(scratch / "none.json"), IoError);
  EXPECT_NE(
      toile::test::message_of<InputError>([] { fabric_of("sikl", "--fabric"); }).find("--fabric: expected a fabric"),
      std::string::npos);
}

}  // namespace
}  // namespace toile::internal
