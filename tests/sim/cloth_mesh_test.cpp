// Cloth that is modelled already, wind in time, and pins on what was sewn.
#include "sim/cloth_mesh.hpp"

#include "core/error.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/cloths.hpp"
#include "sim/simulate.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace toile::internal {
namespace {

// Two squares of 0.2 m side by side, upright, the seam between them split; `scale` is of the drawing.
std::string two_squares(double scale, bool flipped = false) {
  const auto vt = [&](double x, double y) {
    return "vt " + std::to_string((flipped ? -x : x) * scale) + ' ' + std::to_string(y * scale) + '\n';
  };
  return "v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0.2 0.2 0\nv 0.2 0 0\nv 0.4 0 0\nv 0.2 0.2 0\nv 0.4 0.2 0\nv 9 9 9\n" +
         vt(0, 0) + vt(0.2, 0) + vt(0, 0.2) + vt(0.2, 0.2) + vt(0.5, 0) + vt(0.7, 0) + vt(0.5, 0.2) + vt(0.7, 0.2) +
         "g left\nf 1/1 2/2 4/4\nf 1/1 4/4 3/3\ng right\nf 5/5 6/6 8/8\nf 5/5 8/8 7/7\n";
}

struct Read {
  ClothSurface surface;
  std::vector<std::string> warnings;
  GarmentMesh garment;
};

Read read(const std::string& text, RestShape rest = RestShape::automatic, double unit_m = 1) {
  Read made;
  made.surface = surface_of_mesh(parse_obj(text, "g.obj"), "g.obj", unit_m, rest, made.warnings);
  SceneCloth cloth;
  cloth.name = "g";
  made.garment = cloth_of_surface(made.surface, cloth);
  return made;
}

template <class Work>
std::string complaint(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

// Of face `t`, how the threads lie: lengths of w_u and w_v, and w_u itself.
std::pair<Vec3, Vec3> threads(const GarmentMesh& garment, std::size_t t) {
  const MaterialFrame frame = material_frame(garment.mesh.uv[t]);
  Vec3 w_u = Vec3::Zero(), w_v = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& x = garment.x[static_cast<std::size_t>(garment.mesh.triangles[t][k])];
    w_u += frame.alpha[static_cast<Eigen::Index>(k)] * x;
    w_v += frame.beta[static_cast<Eigen::Index>(k)] * x;
  }
  return {w_u, w_v};
}

TEST(ClothOfMesh, SplitVerticesAreOneAndGroupsArePanels) {
  const Read made = read(two_squares(1));
  EXPECT_EQ(made.surface.x.size(), 6U);
  EXPECT_EQ(made.surface.panel_names, (std::vector<std::string>{"left", "right"}));
  EXPECT_EQ(made.surface.panel, (std::vector<Index>{0, 0, 1, 1}));
  ASSERT_EQ(made.warnings.size(), 2U);
  EXPECT_NE(made.warnings[0].find("2 vertices"), std::string::npos);
  EXPECT_NE(made.warnings[1].find("1 vertices that no face uses"), std::string::npos);
}

TEST(ClothOfMesh, ItsEdgesAreAsLongAsTheyAre) {
  SceneCloth cloth;
  cloth.kind = SceneClothMesh{"g.obj"};
  const TextSource in_memory = [](const std::string&) { return two_squares(1); };
  EXPECT_NEAR(mesh_cloth(cloth, "", in_memory).edge_m, (0.2 + 0.2 + 0.2 * std::sqrt(2.0)) / 3, 1e-6);
}

TEST(ClothOfMesh, ADrawingInMetresIsHowItWasCut) {
  for (const bool flipped : {false, true}) {
    const Read made = read(two_squares(1.1, flipped));
    for (std::size_t t = 0; t < 4; ++t) {
      const auto [w_u, w_v] = threads(made.garment, t);
      EXPECT_NEAR((w_u - Vec3(0, 1 / 1.1, 0)).norm(), 0, 1e-6) << "the warp runs up the drawing";
      EXPECT_NEAR(w_v.norm(), 1 / 1.1, 1e-6);
      EXPECT_GT(material_frame(made.garment.mesh.uv[t]).area_m2, 0);
    }
  }
}

TEST(ClothOfMesh, ADrawingOfATextureSaysOnlyWhereTheWarpRuns) {
  const Read made = read(two_squares(4));
  EXPECT_NE(made.warnings.back().find("not in metres"), std::string::npos);
  for (std::size_t t = 0; t < 4; ++t) {
    const auto [w_u, w_v] = threads(made.garment, t);
    EXPECT_NEAR((w_u - Vec3(0, 1, 0)).norm(), 0, 1e-9);
    EXPECT_NEAR((w_v - Vec3(-1, 0, 0)).norm(), 0, 1e-9);
  }
  const Read asked = read(two_squares(4), RestShape::drawing);
  EXPECT_NEAR(threads(asked.garment, 0).first.norm(), 0.25, 1e-6) << "unless the user says that it is";
  EXPECT_EQ(asked.warnings.size(), 2U);
}

TEST(ClothOfMesh, WithoutADrawingItIsAtRestAsItStarts) {
  const Read made = read("v 0 0 0\nv 0.3 0 0.1\nv 0.1 0.2 0\nf 1 2 3\n");
  EXPECT_NE(made.warnings.back().find("not every face has vt"), std::string::npos);
  const auto [w_u, w_v] = threads(made.garment, 0);
  EXPECT_NEAR(w_u.norm(), 1, 1e-9);
  EXPECT_NEAR(w_v.norm(), 1, 1e-9);
  EXPECT_NEAR(w_u.dot(w_v), 0, 1e-9);
  EXPECT_GT(w_u.y(), 0.9);
  EXPECT_NE(complaint([] { read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", RestShape::drawing); }).find("vt"),
            std::string::npos);
}

TEST(ClothOfMesh, UnitsAreThoseOfTheFile) {
  const Read made = read("v 0 0 0\nv 30 0 0\nv 0 20 0\nf 1 2 3\n", RestShape::start, 0.01);
  EXPECT_EQ(made.surface.x[1], Vec3(0.3, 0, 0));
}

struct Film {
  Report report;
  Vec3s last;
};

Film filmed(const Scratch& scratch, const std::string& text) {
  const std::string path = scratch.put("s.json", text);
  RunOptions options;
  options.directory = scratch / "out";
  Film film{simulate(parse_scene(text, path), options), {}};
  Pc2Reader reader(scratch / "out/cloth.pc2");
  reader.read(reader.samples() - 1, film.last);
  return film;
}

TEST(ClothOfMesh, HangsFromItsPinsInAScene) {
  const Scratch scratch;
  scratch.put("g.obj", two_squares(1));
  const Film film = filmed(scratch, R"({"cloth": [{"mesh": ")" + (scratch / "g.obj") +
                                        R"(", "pins": [{"near_m": [0, 0.2, 0]}]}], "time": {"seconds": 1}})");
  EXPECT_EQ(film.report.panels, 2);
  EXPECT_EQ(film.report.warnings.size(), 2U);
  EXPECT_NEAR((film.last[2] - Vec3(0, 0.2, 0)).norm(), 0, 1e-6);
  EXPECT_LT(film.last[5].y(), -0.05) << "the far corner swings down";
}

TEST(Wind, BlowsWhenItsPathSaysSo) {
  const Scratch scratch;
  const auto scene = [](const char* path) {
    return R"({"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.05}, "fabric": "silk",
      "pins": [{"in_box_m": [[-1, 0.149, -1], [1, 0.151, 1]]}]}], "time": {"seconds": 1}, "world": {)" +
           std::string(path) + "}}";
  };
  const auto far = [&](const char* path) {
    double z = 0;
    for (const Vec3& x : filmed(scratch, scene(path)).last) z = std::max(z, std::abs(x.z()));
    return z;
  };
  EXPECT_LT(far(R"("wind_path": [[0, 0, 0, 0]])"), 1e-3);
  EXPECT_GT(far(R"("wind_path": [[0.2, 0, 0, 0], [0.4, 0, 0, 8]])"), 0.05);
  EXPECT_EQ(far(R"("wind_path": [[0, 0, 0, 8]])"), far(R"("wind_m_per_s": [0, 0, 8])"));
  EXPECT_GT(far(R"("gravity_path": [[0, 0, -9.81, 0], [0.1, 0, -1, 9]])"), 0.1);
}

// A tube of two panels on a cylinder, held where it is on; it goes on to the same bits when it is resumed.
TEST(Pins, HoldASewnGarmentWhereItIsOn) {
  const Scratch scratch;
  const std::string pattern = test::source_path("patterns/skirt.json");
  const std::string text = R"({"cloth": [{"pattern": ")" + pattern + R"(", "resolution_cm": 5,
    "pins": [{"near_m": [0.5, 0.6, 0], "hold": "moves", "moves": [{"t_s": 0.5}, {"t_s": 1, "shift_m": [0.2, 0.2, 0]}]}]}],
    "body": {"mannequin": "woman"}, "time": {"seconds": 1.5, "until_still": false}})";
  const Film film = filmed(scratch, text);
  Pc2Reader reader(scratch / "out/cloth.pc2");
  Vec3s first;
  reader.read(0, first);
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < first.size(); ++i)
    if ((first[i] - Vec3(0.5, 0.6, 0)).norm() < (first[nearest] - Vec3(0.5, 0.6, 0)).norm()) nearest = i;
  EXPECT_NEAR((film.last[nearest] - first[nearest] - Vec3(0.2, 0.2, 0)).norm(), 0, 1e-5);

  RunOptions options;
  options.directory = scratch / "parts";
  options.checkpoints.every_frames = 1;
  long asked = 0;
  const Scene scene = parse_scene(text, "s.json");
  // Once in the middle of what hangs.
  int shown = 0;
  options.progress = [&](const Progress& progress) { shown += progress.phase == "draping" ? 1 : 0; };
  options.stop = [&] { return ++asked > 0 && shown > 20; };
  EXPECT_EQ(simulate(scene, options).ended, reason::interrupted);
  options.stop = {};
  options.resume = true;
  EXPECT_EQ(simulate(scene, options).state_hash, film.report.state_hash);
}

}  // namespace
}  // namespace toile::internal
