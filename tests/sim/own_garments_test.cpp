// The garments that patterns/draft.py draws, hung around the bodies they are drawn for: clear of them, with every thread
// beside them, where they stand.
#include "body/mannequin.hpp"
#include "dress/outfit.hpp"
#include "garment/placement.hpp"
#include "sim/setup.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <map>

namespace toile::internal {
namespace {

BodySurface& body(MannequinKind kind) {
  static std::map<MannequinKind, BodySurface> made;
  auto found = made.find(kind);
  if (found == made.end()) {
    Mannequin m = make_mannequin(kind);
    found = made.try_emplace(kind, std::move(m.positions), std::move(m.triangles)).first;
  }
  return found->second;
}

struct Worn {
  const char* name;
  MannequinKind by;
};

class OwnGarmentOnItsBody : public testing::TestWithParam<Worn> {};
INSTANTIATE_TEST_SUITE_P(All, OwnGarmentOnItsBody,
                         testing::Values(Worn{"man_shirt", MannequinKind::man}, Worn{"man_pants", MannequinKind::man},
                                         Worn{"short_skirt", MannequinKind::dancer},
                                         Worn{"long_skirt", MannequinKind::dancer},
                                         Worn{"blouse", MannequinKind::dancer}, Worn{"blouse", MannequinKind::woman},
                                         Worn{"slip", MannequinKind::woman}, Worn{"hoody", MannequinKind::man},
                                         Worn{"coat", MannequinKind::man}, Worn{"belt", MannequinKind::man}),
                         [](const auto& which) {
                           return std::string(which.param.name) + "_" + std::string(to_string(which.param.by));
                         });

TEST_P(OwnGarmentOnItsBody, StartsClearOfItWithEveryThreadBesideIt) {
  GarmentMesh garment = mesh_garment(load_pattern(test::source_path("patterns/") + GetParam().name + ".json"), 0.02);
  const Placement placement = place_garment(garment, body(GetParam().by));
  EXPECT_EQ(placement.shift_m, Vec3(0, 0, 0)) << "it stands where it should be drawn";
  EXPECT_EQ(placement.blocked, 0);
  EXPECT_EQ(placement.panel_crossings, 0);
}

// Whether p lies in the triangle, both in the plane z = const.
bool covers(const Vec3s& x, const Triangle& t, const Vec3& p) {
  int left = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = x[static_cast<std::size_t>(t[k])], &b = x[static_cast<std::size_t>(t[(k + 1) % 3])];
    left += (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x()) >= 0 ? 1 : -1;
  }
  return left == 3 || left == -3;
}

TEST_P(OwnGarmentOnItsBody, NoPanelIsDrawnOverAnother) {
  // In one plane overlapping panels are no crossing of edges and triangles, so nothing later would see it.
  const GarmentMesh garment =
      mesh_garment(load_pattern(test::source_path("patterns/") + GetParam().name + ".json"), 0.02);
  const ClothMesh& mesh = garment.mesh;
  std::vector<Index> panel_of(garment.x.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const Index i : mesh.triangles[t]) panel_of[static_cast<std::size_t>(i)] = mesh.panel[t];
  }
  for (std::size_t i = 0; i < garment.x.size(); ++i) {
    const Vec3& p = garment.x[i];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.panel[t] == panel_of[i]) continue;
      if (std::abs(garment.x[static_cast<std::size_t>(mesh.triangles[t][0])].z() - p.z()) > 5e-3) continue;
      ASSERT_FALSE(covers(garment.x, mesh.triangles[t], p))
          << mesh.panel_names[static_cast<std::size_t>(panel_of[i])] << " over "
          << mesh.panel_names[static_cast<std::size_t>(mesh.panel[t])];
    }
  }
}

// Of a scene with this cloth, at 3 cm.
LoadedCloth loaded(const std::string& name, const std::string& more = "") {
  const std::string path = test::source_path("patterns/") + name + ".json";
  const Scene scene = parse_scene(
      R"({"cloth": [{"pattern": ")" + path + R"(", "resolution_cm": 3)" + more + R"(}], "body": {"mannequin": "man"}})",
      "s.json");
  return load_cloth(scene, 0, read_text_file);
}

bool is_waistband(const std::string& panel) { return panel.find("waistband") != std::string::npos; }

TEST(OwnGarmentsTogether, KeepTheirElasticAndTheFoldsOfTheCollar) {
  const LoadedCloth pants = loaded("man_pants"), shirt = loaded("man_shirt");
  ASSERT_FALSE(shirt.garment.mesh.folds.empty());
  Outfit outfit;
  put_behind(outfit, pants.garment, pants.fabrics, pants.rest_stretch);
  const ClothMesh both = over(outfit, shirt.garment).mesh;
  ASSERT_EQ(both.panel_cloth.size(), both.panel_names.size());
  for (std::size_t p = 0; p < both.panel_names.size(); ++p)
    EXPECT_EQ(both.panel_cloth[p].rest_stretch.y() < 1, is_waistband(both.panel_names[p])) << both.panel_names[p];
  ASSERT_EQ(both.folds.size(), shirt.garment.mesh.folds.size());
  for (std::size_t f = 0; f < both.folds.size(); ++f) {
    EXPECT_EQ(both.folds[f].a, shirt.garment.mesh.folds[f].a + pants.garment.mesh.particle_count);
    EXPECT_EQ(both.folds[f].b, shirt.garment.mesh.folds[f].b + pants.garment.mesh.particle_count);
  }
}

TEST(OwnGarmentsTogether, AScenesPanelKeepsWhatItDoesNotName) {
  const LoadedCloth pants =
      loaded("man_pants", R"(, "panels": {"waistband_front": {"rest_stretch_u": 0.9, "fabric": "denim"}})");
  for (std::size_t p = 0; p < pants.rest_stretch.size(); ++p) {
    const std::string& name = pants.garment.mesh.panel_names[p];
    EXPECT_EQ(pants.rest_stretch[p].x(), name == "waistband_front" ? 0.9 : 1.0) << name;
    EXPECT_EQ(pants.rest_stretch[p].y() < 1, is_waistband(name)) << name;
    EXPECT_EQ(pants.fabrics[p].name, name == "waistband_front" ? "denim" : "cotton") << name;
  }
}

// By the pattern, by the scene, and with the scene's distance alone.
TEST(OwnGarmentsTogether, InterfacingIsFusedToThePanelsThatHaveIt) {
  const auto bend_of = [](const LoadedCloth& cloth, const std::string& panel) {
    const auto& names = cloth.garment.mesh.panel_names;
    return cloth.fabrics[static_cast<std::size_t>(std::find(names.begin(), names.end(), panel) - names.begin())]
        .bend_u_N_m;
  };
  const LoadedCloth plain = loaded("man_pants");
  const LoadedCloth scene =
      loaded("man_pants", R"(, "panels": {"waistband_front": {"interfacing": {"base": "cotton", "bend_u_N_m": 1e-4}},
                                   "waistband_back": {"interfacing": "cotton", "interfacing_mm": 1}})");
  EXPECT_EQ(bend_of(plain, "waistband_front"), Fabric{}.bend_u_N_m);
  EXPECT_NEAR(bend_of(scene, "waistband_front"), Fabric{}.bend_u_N_m + 1e-4 + 9e-8 * 1500, 1e-12);
  EXPECT_NEAR(bend_of(scene, "waistband_back"), 2 * Fabric{}.bend_u_N_m + 1e-6 * 1500, 1e-12);
  EXPECT_EQ(bend_of(scene, "left_front"), Fabric{}.bend_u_N_m);

  std::string text = read_text_file(test::source_path("patterns/tshirt.json"));
  const std::string band = R"("band_front": {"fabric": "knit"})";
  ASSERT_NE(text.find(band), std::string::npos);
  text.replace(text.find(band), band.size(),
               R"("band_front": {"fabric": "knit", "interfacing": "silk", "interfacing_mm": 0})");
  const Scene shirt = parse_scene(R"({"cloth": [{"pattern": "p.json", "resolution_cm": 3}]})", "s.json");
  const LoadedCloth own = load_cloth(shirt, 0, [&](const std::string&) { return text; });
  EXPECT_NEAR(bend_of(own, "band_front"), 7e-6 + 1.2e-6, 1e-15);
  EXPECT_NEAR(bend_of(own, "band_back"), 7e-6, 1e-15);
  const Scene wider = parse_scene(
      R"({"cloth": [{"pattern": "p.json", "resolution_cm": 3, "panels": {"band_front": {"interfacing_mm": 1}}}]})",
      "s.json");
  const LoadedCloth apart = load_cloth(wider, 0, [&](const std::string&) { return text; });
  EXPECT_NEAR(bend_of(apart, "band_front"), 8.2e-6 + 1e-6 * 350 * 1200 / 1550, 1e-12)
      << "the pattern's, at the scene's distance";
}

TEST(OwnGarmentsTogether, ADistanceWithoutInterfacingIsRefused) {
  try {
    loaded("man_pants", R"(, "panels": {"waistband_front": {"interfacing_mm": 1}})");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.path(), "/cloth/0/panels/waistband_front");
    EXPECT_EQ(error.place(), "/interfacing_mm");
    EXPECT_NE(std::string(error.what()).find("expected an interfacing"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace toile::internal
