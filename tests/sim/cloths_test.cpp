// The kinds of cloth: what is asked of each of them, whatever it is.
#include "core/error.hpp"
#include "io/scratch.hpp"
#include "sim/scene_inputs.hpp"
#include "sim/setup.hpp"
#include "support/scene_texts.hpp"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>
#include <string>

namespace toile::internal {
namespace {

SceneCloth cloth_of(const ClothKind& kind, const std::string& name = {}) {
  SceneCloth cloth;
  cloth.kind = kind;
  cloth.name = name;
  return cloth;
}

// One of every kind that a scene can choose, from the scenes that have every setting.
std::map<std::string, SceneCloth, std::less<>> one_of_each() {
  std::map<std::string, SceneCloth, std::less<>> found;
  for (const std::string_view text : test::scenes_with_every_setting)
    for (const SceneCloth& cloth : parse_scene(text, "s.json").cloth)
      for_each_kind<ClothKind>([&]<class Kind>(const Kind&) {
        if (cloth.as<Kind>() != nullptr) found.emplace(Kind::key, cloth);
      });
  return found;
}

std::string refusal(const SceneCloth& cloth, std::string& path) {
  try {
    mesh_cloth(cloth, "/cloth/2", read_text_file);
  } catch (const InputError& error) {
    path = error.path();
    return error.what();
  }
  return "(no error)";
}

TEST(Cloths, EveryKindIsChosenByItsKeyAndByNoOther) {
  const auto found = one_of_each();
  std::set<std::string_view> keys;
  for_each_kind<ClothKind>([&]<class Kind>(const Kind&) {
    EXPECT_TRUE(keys.insert(Kind::key).second) << Kind::key;
    ASSERT_TRUE(found.contains(Kind::key)) << Kind::key << ": no scene of tests/support/scene_texts.hpp has it";
    EXPECT_EQ(found.find(Kind::key)->second.is_sewn(), Kind::sewn) << Kind::key;
  });
  EXPECT_EQ(keys_of_kinds<ClothKind>().size(), keys.size());
}

TEST(Cloths, SeamAllowancesAreOfPatternsAndTopstitchedOnlyWithAWidth) {
  const auto cloth = [](const std::string& keys) {
    return parse_scene(R"({"cloth": [{)" + keys + R"(}], "body": {"mannequin": "woman"}})", "s.json").cloth.front();
  };
  const auto complaint = [&](const std::string& keys) {
    try {
      cloth(keys);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("(no error)");
  };
  const SceneCloth sewn = cloth(R"("pattern": "p.json", "allowance_mm": 12, "topstitched": true)");
  EXPECT_EQ(sewn.as<ScenePattern>()->finish, (EdgeFinish{0, 0.01, 0.012, true}));
  EXPECT_EQ(cloth(R"("pattern": "p.json")").as<ScenePattern>()->finish, (EdgeFinish{0, 0.01, 0, false}));
  EXPECT_NE(complaint(R"("pattern": "p.json", "allowance_mm": 201)").find("allowance_mm"), std::string::npos);
  EXPECT_NE(complaint(R"("pattern": "p.json", "topstitched": 1)").find("topstitched"), std::string::npos);
  EXPECT_NE(complaint(R"("grid": {"width_m": 1}, "allowance_mm": 12)").find("a pattern beside it"), std::string::npos);
  std::string path;
  EXPECT_NE(refusal(cloth(R"("pattern": "p.json", "topstitched": true)"), path).find("allowance above zero"),
            std::string::npos);
}

TEST(Cloths, AnyKindTakesAnEdgeLength) {
  for (auto [key, cloth] : one_of_each()) {
    cloth.set_edge_m(0.0375);
    EXPECT_EQ(cloth.edge_m(), 0.0375) << key;
    EXPECT_EQ(cloth.resolution_m, 0.0375) << key;
  }
  SceneCloth counted = cloth_of(ScenePattern{"p.json", 500});
  counted.set_edge_m(0.0375);
  EXPECT_FALSE(counted.as<ScenePattern>()->vertices.has_value()) << "they would win over the edge length";
  EXPECT_TRUE(cloth_of(SceneTube{}).has_own_edge());
  EXPECT_FALSE(cloth_of(ScenePattern{}).has_own_edge());
}

TEST(Cloths, WhetherItIsSewnIsOfItsKindAndNotOfAFilesName) {
  EXPECT_TRUE(cloth_of(ScenePattern{}).is_sewn());
  EXPECT_FALSE(cloth_of(SceneClothMesh{"pattern.json"}).is_sewn());
  EXPECT_FALSE(cloth_of(SceneClothArrays{}).is_sewn());
}

TEST(Cloths, AFileIsAnInputOfTheRunWhateverIsInIt) {
  Scene scene;
  for (const auto& [key, cloth] : one_of_each()) scene.cloth.push_back(cloth);
  const std::vector<std::string> paths = input_paths(scene);
  EXPECT_EQ(std::set<std::string>(paths.begin(), paths.end()), (std::set<std::string>{"cloth.obj", "p.json"}));
}

TEST(Cloths, ErrorsAreOfTheFileOrOfThePlaceInTheScene) {
  const Scratch scratch;
  scratch.put("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  std::string path;
  EXPECT_EQ(refusal(cloth_of(SceneClothMesh{scratch / "flat.obj"}, "m"), path),
            scratch / "flat.obj" + ": faces: triangle 0: expected an area above zero, got 0");
  EXPECT_EQ(path, "");
  EXPECT_EQ(refusal(cloth_of(SceneTube{6, 1, 0.5}, "t"), path),
            "t: radius_m: expected at most 32 m around it, got 37.7 m");
  EXPECT_EQ(path, "/cloth/2/tube");
  auto surface = std::make_shared<ClothSurface>();
  surface->x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  surface->triangles = {{0, 1, 2}};
  EXPECT_EQ(refusal(cloth_of(SceneClothArrays{surface}, "a"), path),
            "a: faces: triangle 0: expected an area above zero, got 0");
  EXPECT_EQ(path, "/cloth/2") << "a scene has no word for it";
}

TEST(Cloths, WhatItTakesIsKnownBeforeItIsMade) {
  auto surface = std::make_shared<ClothSurface>();
  surface->x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  surface->triangles = {{0, 1, 2}};
  SceneRibbon ribbon;
  ribbon.path_m = {{0, 0, 0}, {1, 0, 0}, {1.5, 0.5, 0}};
  const std::vector<ClothKind> kinds{SceneGrid{0.5, 0.4, 0.02}, SceneTube{0.2, 0.5, 0.02}, ribbon,
                                     SceneClothArrays{surface}};
  for (const ClothKind& kind : kinds) {
    const SceneCloth cloth = cloth_of(kind, "c");
    const ClothCost cost = cost_of(cloth, read_text_file);
    ASSERT_EQ(cost.parts.size(), 1U);
    const GarmentMesh garment = mesh_cloth(cloth, "", read_text_file).garment;
    const auto particles = static_cast<double>(garment.mesh.particle_count),
               triangles = static_cast<double>(garment.mesh.triangles.size());
    EXPECT_NEAR(cost.parts[0].particles, particles, 0.1 * particles) << cost.parts[0].what;
    EXPECT_NEAR(cost.parts[0].triangles, triangles, 0.1 * triangles) << cost.parts[0].what;
    EXPECT_EQ(cost.parts[0].what.rfind("cloth \"c\"", 0), 0U) << cost.parts[0].what;
    EXPECT_FALSE(cost.seams.has_value());
  }
}

}  // namespace
}  // namespace toile::internal
