// Every setting of a scene, walked by its description: reader, hash, schema and documents know it, and agree.
#include "sim/settings_catalogue.hpp"

#include "io/file.hpp"
#include "sim/scene.hpp"
#include "sim/setup.hpp"
#include "support/json_schema.hpp"
#include "support/paths.hpp"
#include "support/scene_texts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

using Kind = SettingNode::Kind;
using test::scenes_with_every_setting;
using test::with;

std::string settings_refusal(const std::string& text) {
  try {
    parse_scene(text, "s.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::string hash_of(const std::string& text) { return hex_of(settings_hash(parse_scene(text, "s.json"))); }

std::string text_of(double x) {
  JsonText text(0);
  text.value(x);
  return text.str();
}

// A setting as it is given in a scene.
struct Given {
  const Json* scene;
  const Json* value;
  const SettingNode* node;
  std::string name, pointer;  // name: "cloth[].grid.width_m", or "fabric.friction" wherever there is a fabric
};

using Visit = std::function<void(const Given&)>;

void walk(const Json& scene, const Json& object, const SettingNode& node, const std::string& name,
          const std::string& pointer, const Visit& visit) {
  for (const SettingNode& one : node.inside) {
    const Json* value = object.find(one.setting.key);
    if (value == nullptr) continue;
    const std::string key(one.setting.key), there = pointer + '/' + key;
    const std::string named = one.shared.empty() ? (name.empty() ? "" : name + '.') + key : std::string(one.shared);
    if (one.is_leaf()) visit({&scene, value, &one, named, there});
    if (one.kind == Kind::object && value->is_object()) walk(scene, *value, one, named, there, visit);
    if (one.kind == Kind::list)
      for (std::size_t k = 0; k < value->array().size(); ++k)
        walk(scene, value->array()[k], one, named + "[]", there + '/' + std::to_string(k), visit);
    if (one.kind == Kind::table)
      for (const auto& [table_key, member] : value->object())
        walk(scene, member, one, named + "{}", there + '/' + table_key, visit);
  }
}

void for_each_given(const Visit& visit) {
  const SettingNode settings = scene_settings();
  for (const std::string_view text : scenes_with_every_setting) {
    const Json scene = Json::parse(text, "s.json");
    walk(scene, scene, settings, "", "", visit);
  }
}

// The names of all leaves, as `walk` makes them.
void names_of(const SettingNode& node, const std::string& name, std::set<std::string>& names) {
  for (const SettingNode& one : node.inside) {
    const std::string key(one.setting.key);
    const std::string named = one.shared.empty() ? (name.empty() ? "" : name + '.') + key : std::string(one.shared);
    if (one.is_leaf()) {
      names.insert(named);
    } else {
      names_of(one, named + (one.kind == Kind::list ? "[]" : one.kind == Kind::table ? "{}" : ""), names);
    }
  }
}

// The single values of a setting, with the node that says what they may be.
void for_each_value(const Given& given, const std::function<void(const Given&)>& visit) {
  const SettingNode& node = *given.node;
  const auto inside = [&](const Json& value, std::size_t k, const SettingNode& of) {
    return Given{given.scene, &value.array()[k], &of, given.name, given.pointer + '/' + std::to_string(k)};
  };
  switch (node.kind) {
    case Kind::vector:
    case Kind::wholes:
      for (std::size_t k = 0; k < given.value->array().size(); ++k) visit(inside(*given.value, k, node));
      return;
    case Kind::box:
      for (std::size_t c = 0; c < 2; ++c) {
        const Given corner = inside(*given.value, c, node);
        for (std::size_t k = 0; k < 3; ++k)
          visit({given.scene, &corner.value->array()[k], &node, given.name, corner.pointer + '/' + std::to_string(k)});
      }
      return;
    case Kind::rows:
      for (std::size_t r = 0; r < given.value->array().size(); ++r) {
        const Given row = inside(*given.value, r, node);
        for (std::size_t k = 0; k < node.inside.size(); ++k)
          visit({given.scene, &row.value->array()[k], &node.inside[k], given.name,
                 row.pointer + '/' + std::to_string(k)});
      }
      return;
    case Kind::numbers:
      for (const auto& [key, value] : given.value->object())
        visit({given.scene, &value, &node, given.name, given.pointer + '/' + key});
      return;
    default:
      visit(given);
  }
}

// Other values that may be meant: the first that its scene can have is taken.
std::vector<std::string> others(const Given& given) {
  std::vector<std::string> texts;
  const Json& value = *given.value;
  if (value.is_number()) {
    const double x = value.number();
    const bool whole = given.node->kind == Kind::whole || given.node->kind == Kind::wholes;
    for (const double y : {1.25 * x, 0.75 * x, x + 0.125, x - 0.125, x + 1, x - 1})
      if (y != x && (!whole || y == std::floor(y)) && given.node->range.contains(y)) texts.push_back(text_of(y));
  } else if (value.is_boolean()) {
    texts.emplace_back(value.boolean() ? "false" : "true");
  } else if (!given.node->names.empty()) {
    for (const std::string& name : given.node->names)
      if (name != value.string()) texts.push_back('"' + name + '"');
  } else {
    texts.push_back('"' + value.string() + "-other\"");
  }
  return texts;
}

TEST(Settings, ScenesOfTheTestsGiveEveryOne) {
  std::set<std::string> all, given;
  names_of(scene_settings(), "", all);
  for_each_given([&](const Given& one) { given.insert(one.name); });
  for (const std::string& name : all) EXPECT_EQ(given.count(name), 1U) << name << " is in no scene of the tests";
  EXPECT_EQ(count_settings(scene_settings()), all.size());
  for (const std::string_view text : scenes_with_every_setting) EXPECT_EQ(settings_refusal(std::string(text)), "");
}

TEST(Settings, AnotherValueIsAnotherHashUnlessItHasNoPartInTheResult) {
  std::set<std::string> without;
  for_each_given([&](const Given& setting) {
    if (!setting.node->setting.in_result) without.insert(setting.name);
    if (setting.node->kind == Kind::path) return;  // what the file holds counts
    const std::string before = hash_of(with(*setting.scene, "none", ""));
    for_each_value(setting, [&](const Given& one) {
      for (const std::string& other : others(one)) {
        const std::string text = with(*one.scene, one.pointer, other);
        if (!settings_refusal(text).empty()) continue;  // an end before its beginning
        EXPECT_EQ(hash_of(text) != before, setting.node->setting.in_result) << one.pointer << ": " << other;
        return;
      }
      // Each way to hold has keys of its own.
      EXPECT_EQ(one.name, "cloth[].pins[].hold") << one.pointer << " cannot be changed";
    });
  });
  EXPECT_EQ(without, (std::set<std::string>{"name", "output.dir", "output.preview", "output.picture_frames"}));
}

// With one row, element or key less there is another scene, too.
TEST(Settings, OneElementLessIsAnotherHash) {
  int tried = 0;
  for_each_given([&](const Given& setting) {
    if (!setting.node->setting.in_result || (!setting.value->is_array() && !setting.value->is_object())) return;
    if (setting.node->kind == Kind::vector || setting.node->kind == Kind::box) return;
    const std::string last = setting.value->is_array() ? std::to_string(setting.value->array().size() - 1)
                                                       : setting.value->object().back().first;
    const std::string text = with(*setting.scene, setting.pointer + '/' + last, "");
    if (!settings_refusal(text).empty()) return;
    ++tried;
    EXPECT_NE(hash_of(text), hash_of(with(*setting.scene, "none", ""))) << setting.pointer;
  });
  EXPECT_GE(tried, 4);
}

TEST(Settings, ScenesThatWereToldByTheSameNumbersHaveTheirOwnHashes) {
  const auto differ = [](const std::string& one, const std::string& other) {
    EXPECT_NE(hash_of(one), hash_of(other)) << one << "\n" << other;
  };
  differ(R"({"cloth": [{"grid": {"width_m": 0.5, "height_m": 0.5, "edge_m": 0.05}}]})",
         R"({"cloth": [{"tube": {"radius_m": 0.5, "length_m": 0.5, "edge_m": 0.05}}]})");
  differ(R"({"cloth": [{"grid": {}}]})", R"({"cloth": [{"grid": {}, "fabric": {"base": "cotton"}, "name": "other"}]})");
  differ(R"({"cloth": [{"grid": {}}], "time": {"seconds": 5}})", R"({"cloth": [{"grid": {}}]})");
  differ(R"({"cloth": [{"grid": {}, "pins": [{"near_m": [0, 0, 0]}]}, {"grid": {}, "name": "b"}]})",
         R"({"cloth": [{"grid": {}}, {"grid": {}, "name": "b", "pins": [{"near_m": [0, 0, 0]}]}]})");
  differ(R"({"cloth": [{"grid": {}, "pins": [{"near_m": [0, 0, 0], "hold": "path", "path_m": [[0, 0, 0, 0]]}]}]})",
         R"({"cloth": [{"grid": {}, "pins": [{"near_m": [0, 0, 0], "hold": "moves", "moves": [{"t_s": 0}]}]}]})");
  differ(R"({"cloth": [{"grid": {}}], "start": "a"})", R"({"cloth": [{"grid": {}}]})");
  differ(R"({"cloth": [{"grid": {}}], "solids": [{"mesh": "a.obj"}]})",
         R"({"cloth": [{"grid": {}}], "body": {"mesh": "a.obj"}})");
  differ(R"({"cloth": [{"grid": {}}], "body": {"mannequin": "woman"}})", R"({"cloth": [{"grid": {}}]})");
  differ(R"({"cloth": [{"grid": {}}], "body": {"mannequin": "woman", "motion": "walk"}})",
         R"({"cloth": [{"grid": {}}], "body": {"mannequin": "woman", "motion": "a/walk"}})");
  // Of a mesh, too, a motion's name is one, and what looks like a path is none.
  differ(R"({"cloth": [{"grid": {}}], "body": {"mesh": "b.obj", "motion": "sway"}})",
         R"({"cloth": [{"grid": {}}], "body": {"mesh": "b.obj", "motion": "twist"}})");
  differ(R"({"cloth": [{"grid": {}}], "body": {"mesh": "b.obj", "motion": "sway"}})",
         R"({"cloth": [{"grid": {}}], "body": {"mesh": "b.obj", "motion": "./sway"}})");
}

TEST(Settings, EveryValueOutOfItsRangeIsRefusedAtItsPlaceAndByTheSchema) {
  const std::string schema_text = scene_schema(scene_settings());
  const Json schema_json = Json::parse(schema_text, "schema");
  const test::JsonSchema schema(schema_json);
  std::size_t tried = 0;
  const auto expect_refused = [&](const Given& one, const std::string& other, bool by_schema = true) {
    const std::string text = with(*one.scene, one.pointer, other), message = settings_refusal(text);
    EXPECT_EQ(message.rfind("s.json:", 0), 0U) << one.pointer << ": " << other << ": " << message;
    EXPECT_NE(message.find(": " + one.pointer), std::string::npos) << other << ": " << message;
    EXPECT_NE(message.find("expected "), std::string::npos) << message;
    EXPECT_NE(message.find(", got "), std::string::npos) << message;
    if (by_schema) {
      EXPECT_FALSE(schema.allows(Json::parse(text, "s.json"))) << one.pointer << ": " << other;
    }
    ++tried;
  };
  for_each_given([&](const Given& setting) {
    if (setting.node->kind != Kind::text && setting.node->kind != Kind::path) expect_refused(setting, "\"\"");
    if (!setting.node->setting.may_be_null) expect_refused(setting, "null");
    for_each_value(setting, [&](const Given& one) {
      const SettingNode& node = *one.node;
      if (!one.value->is_number()) return;
      ASSERT_TRUE(std::isfinite(node.range.least) && std::isfinite(node.range.most)) << one.pointer;
      const double beyond = std::max(1e-9, 1e-6 * std::abs(node.range.most));
      expect_refused(one, text_of(node.range.most + beyond));
      expect_refused(one, text_of(node.range.least - std::max(1e-13, 1e-6 * std::abs(node.range.least))));
      if (node.range.above) expect_refused(one, text_of(node.range.least));
      if (node.kind == Kind::whole || node.kind == Kind::wholes)
        expect_refused(one, text_of(one.value->number() + 0.5));
      expect_refused(one, "true");
    });
    if (!setting.node->names.empty()) {
      expect_refused(setting, "\"" + setting.node->names.front() + "x\"");
      EXPECT_NE(settings_refusal(with(*setting.scene, setting.pointer, "\"" + setting.node->names.front() + "x\""))
                    .find("nearest is \"" + setting.node->names.front()),
                std::string::npos);
    }
  });
  EXPECT_GT(tried, 500U);
}

TEST(Settings, AMisspeltKeyIsRefusedWithTheNearest) {
  for_each_given([&](const Given& one) {
    const std::string key(one.node->setting.key), around = one.pointer.substr(0, one.pointer.size() - key.size() - 1);
    const std::string text = with(*one.scene, one.pointer, R"(0, ")" + key + R"(q": 0)");
    const std::string message = settings_refusal(text);
    EXPECT_NE(message.find(": " + around + '/' + key + "q: "), std::string::npos) << message;
    EXPECT_NE(message.find("nearest: \"" + key + '"'), std::string::npos) << message;
  });
}

TEST(Settings, TheSchemaAllowsEveryScene) {
  const Json schema_json = Json::load(test::source_path("docs/scene.schema.json"));
  const test::JsonSchema schema(schema_json);
  for (const std::string_view text : scenes_with_every_setting)
    EXPECT_TRUE(schema.allows(Json::parse(text, "s.json"))) << text;
  int scenes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source_path("scenes"))) {
    if (entry.path().extension() != ".json") continue;
    EXPECT_TRUE(schema.allows(Json::load(entry.path().string()))) << entry.path();
    ++scenes;
  }
  EXPECT_GT(scenes, 20);
}

// `make settings` makes them so.
TEST(Settings, TheDocumentsAreCurrent) {
  const SettingNode settings = scene_settings();
  EXPECT_EQ(read_file(test::source_path("docs/scene.schema.json")), scene_schema(settings));
  const std::string page = read_file(test::source_path("docs/scenes.md"));
  const std::size_t from = page.find(settings_begin), to = page.find(settings_end);
  ASSERT_LT(from, to);
  const std::size_t begin = from + settings_begin.size();
  EXPECT_EQ(page.substr(begin, to - begin), "\n\n" + settings_table(settings) + "\n");
  // And the table is of all keys.
  for_each_setting(settings, "", [&](const std::string& path, const SettingNode& node) {
    const std::string key(node.setting.key);
    EXPECT_TRUE(page.find("| `" + path + "` |") != std::string::npos ||
                page.find("| `" + key + "` |") != std::string::npos)
        << path;
    EXPECT_FALSE(node.setting.meaning.empty()) << path;
  });
}

TEST(Settings, AKeyOfANumberSaysItsUnit) {
  const std::set<std::string> pure = {"friction",          "bend_set",          "bend_poisson", "compression_ratio",
                                      "doubling_strain_u", "doubling_strain_v", "strain_limit", "rest_stretch_u",
                                      "rest_stretch_v",    "vertices",          "scale",        "newton_iterations",
                                      "tolerance",         "relinearisations",  "share"};
  for_each_setting(scene_settings(), "", [&](const std::string& path, const SettingNode& node) {
    if (node.kind != Kind::number && node.kind != Kind::whole) return;
    EXPECT_NE(unit_of(node.setting.key).empty(), pure.count(std::string(node.setting.key)) == 0) << path;
  });
}

// What runs without a scene is what runs for a scene that says nothing.
TEST(Settings, TheDefaultsOfTheLibraryAreThoseOfAScene) {
  const Scene scene = parse_scene(R"({"cloth": [{"grid": {}}], "body": {"mannequin": "woman"}})", "s.json");
  const Fabric& fabric = scene.cloth.front().fabric;
  const StepOptions said = step_options(scene, scene.cloth.front().edge_m()), bare;
  EXPECT_EQ(said.pcg.preconditioner, bare.pcg.preconditioner);
  EXPECT_EQ(said.pcg.tolerance, bare.pcg.tolerance);
  EXPECT_EQ(said.pcg.procedure, bare.pcg.procedure);
  EXPECT_EQ(said.integrator, bare.integrator);
  EXPECT_EQ(said.newton_iterations, bare.newton_iterations);
  EXPECT_EQ(said.relinearisations, bare.relinearisations);
  EXPECT_EQ(said.rows.cloth_cloth, bare.rows.cloth_cloth);
  EXPECT_EQ(said.flypaper, bare.flypaper);
  const Scene on_a_shape = parse_scene(R"({"cloth": [{"grid": {}}], "body": {"sphere": {"radius_m": 1}}})", "s.json");
  EXPECT_EQ(step_options(on_a_shape, 0.02).body.offset_m, bare.body.offset_m);
  EXPECT_EQ(said.body.offset_m, 1.5e-3) << "of a person";
  EXPECT_EQ(said.body.friction, bare.body.friction);
  EXPECT_EQ(scene.air.density_kg_per_m3, AirOptions{}.density_kg_per_m3);
  EXPECT_EQ(scene.gravity_m_per_s2, ModelOptions{}.gravity_m_per_s2);
  EXPECT_EQ(SceneDrag{}.stiffness_N_per_m, Drag{}.stiffness_N_per_m);
  EXPECT_EQ(SceneMotion{}.fps, SampleOptions{}.rate_hz);
  EXPECT_EQ(fabric.density_kg_per_m2, Fabric{}.density_kg_per_m2);
  // The numbers themselves: a change of one is a change of every run.
  EXPECT_EQ(bare.pcg.tolerance, 1e-2);
  EXPECT_EQ(bare.relinearisations, 6);
  EXPECT_TRUE(bare.flypaper);
  EXPECT_EQ(AirOptions{}.density_kg_per_m3, 1.2);
  for (const char* solver : {R"("preconditioner": "diagonal")", R"("procedure": "paper_1998")"}) {
    const std::string text = std::string(R"({"cloth": [{"grid": {}}], "solver": {)") + solver + "}}";
    EXPECT_EQ(step_options(parse_scene(text, "s.json"), 0.02).pcg.tolerance, 1e-3) << solver;
  }
}

TEST(Settings, ThePlaceOfTheOutputIsKept) {
  const SceneFile read = read_scene("{\"cloth\": [{\"grid\": {}}],\n \"output\": {\"dir\": \"../x\"}}", "s.json");
  EXPECT_STREQ(read.places.complete(InputError("output.dir", "", "a", "b").of("/output/dir")).what(),
               "s.json:2:20: /output/dir: expected a, got b");
}

}  // namespace
}  // namespace toile::internal
