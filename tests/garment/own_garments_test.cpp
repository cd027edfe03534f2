// The garments in patterns/ that draft.py draws: particle counts, symmetry, seams that fit, elastic that holds.
#include "core/error.hpp"
#include "garment/garment_mesh.hpp"
#include "garment/pattern_check.hpp"
#include "garments.hpp"
#include "material/fabric.hpp"
#include "mesh/check.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

struct OwnGarment {
  const char* name;
  int particles, triangles;
};

Pattern load(const char* name) { return load_pattern(test::source_path("patterns/") + name + ".json"); }

class OwnGarments : public testing::TestWithParam<OwnGarment> {};
INSTANTIATE_TEST_SUITE_P(All, OwnGarments,
                         testing::Values(OwnGarment{"man_shirt", 6450, 12654}, OwnGarment{"man_pants", 8757, 17352},
                                         OwnGarment{"short_skirt", 2153, 4020}, OwnGarment{"long_skirt", 4530, 8844},
                                         OwnGarment{"blouse", 5108, 10016}, OwnGarment{"blouse", 5188, 10194},
                                         OwnGarment{"slip", 6480, 12640}, OwnGarment{"hoody", 6290, 12300},
                                         OwnGarment{"coat", 6800, 13000}, OwnGarment{"belt", 340, 508}),
                         [](const auto& which) {
                           return std::string(which.param.name) + "_" + std::to_string(which.param.particles);
                         });

TEST_P(OwnGarments, MeshToTheirCounts) {
  const CountedGarment counted = mesh_garment_to_count(load(GetParam().name), GetParam().particles);
  const WeldedMesh welded = weld(counted.garment);
  EXPECT_NEAR(welded.mesh.particle_count, GetParam().particles, 0.01 * GetParam().particles);
  EXPECT_NEAR(welded.mesh.triangle_count(), GetParam().triangles, 0.03 * GetParam().triangles);
  EXPECT_EQ(welded_count(counted.garment), welded.mesh.particle_count);
  EXPECT_GT(mesh_quality(counted.garment.mesh).min_angle_deg, 30);
  EXPECT_NEAR(mesh_quality(counted.garment.mesh).mean_edge_m, counted.resolution_m, 0.1 * counted.resolution_m);
}

TEST_P(OwnGarments, AreTheirOwnMirrorImages) {
  if (GetParam().name == std::string("coat")) GTEST_SKIP() << "its right front hangs before the left one";
  const Pattern pattern = load(GetParam().name);
  std::vector<std::array<long, 3>> points, images;
  for (const Panel& panel : pattern.panels) {
    for (const PanelEdge& edge : panel.edges) {
      for (const Vec2& p : sample_edge(panel, edge, 4)) {
        const Vec3 x = panel.place(p) / 1e-4;  // the file has 0.01 mm
        const auto round = [](double value) { return std::lround(value); };
        points.push_back({round(x.x()), round(x.y()), round(x.z())});
        images.push_back({round(-x.x()), round(x.y()), round(x.z())});
      }
    }
  }
  for (const auto& image : images) {
    EXPECT_TRUE(std::any_of(points.begin(), points.end(),
                            [&](const auto& p) {
                              return std::abs(p[0] - image[0]) <= 1 && std::abs(p[1] - image[1]) <= 1 &&
                                     p[2] == image[2];
                            }))
        << image[0] << " " << image[1] << " " << image[2] << " (0.1 mm)";
  }
}

bool is_band(const Panel& panel) {
  return panel.name.find("waistband") != std::string::npos || panel.name.find("cuff") != std::string::npos;
}

TEST_P(OwnGarments, HaveSeamsThatFitAndGathersOnlyIntoBands) {
  const Pattern pattern = load(GetParam().name);
  for (const Stitch& stitch : pattern.stitches) {
    const Panel &a = pattern.panels[at(stitch.a.panel)], &b = pattern.panels[at(stitch.b.panel)];
    const double ratio = edge_length_m(a, a.edges[at(stitch.a.edge)]) / edge_length_m(b, b.edges[at(stitch.b.edge)]);
    const std::string where = a.name + " - " + b.name;
    if (is_band(a) == is_band(b)) {
      EXPECT_NEAR(ratio, 1, is_dart(pattern, stitch) ? 1e-3 : 0.02) << where;
    } else {
      EXPECT_GE(is_band(b) ? ratio : 1 / ratio, 0.99) << where;
      EXPECT_LE(is_band(b) ? ratio : 1 / ratio, 1.25) << where;
    }
  }
}

TEST_P(OwnGarments, FaceAwayFromTheBody) {
  for (const Panel& panel : load(GetParam().name).panels) {
    double twice = 0;
    for (const PanelEdge& edge : panel.edges) {
      const std::vector<Vec2> p = sample_edge(panel, edge, 16);
      for (std::size_t k = 0; k + 1 < p.size(); ++k) twice += p[k].x() * p[k + 1].y() - p[k].y() * p[k + 1].x();
    }
    EXPECT_EQ(twice > 0, panel.translation_m.z() > 0) << panel.name;
  }
}

// Girth of the two halves of a band, m: as cut, and as the elastic wants to be.
std::pair<double, double> waistband(const Pattern& pattern) {
  double cut = 0, relaxed = 0;
  for (const Panel& panel : pattern.panels) {
    if (panel.name.find("waistband") == std::string::npos) continue;
    double low = 1, high = -1;
    for (const Vec2& p : panel.corners) {
      low = std::min(low, p.x());
      high = std::max(high, p.x());
    }
    cut += high - low;
    relaxed += panel.rest_stretch.y() * (high - low);
  }
  return {cut, relaxed};
}

TEST(OwnGarments, WaistbandsCloseWithEaseAndThenHoldByElastic) {
  for (const auto& [name, waist_m] : {std::pair("man_pants", 0.818), {"short_skirt", 0.675}, {"long_skirt", 0.675}}) {
    const auto [cut, relaxed] = waistband(load(name));
    EXPECT_GT(cut, waist_m + 2 * 3.14 * 0.004) << name << ": sewn 4 mm off the body";
    EXPECT_LT(relaxed, 0.95 * waist_m) << name;
    EXPECT_GT(relaxed, 0.85 * waist_m) << name << ": elastic, not a corset";
  }
}

const Panel& panel_of(const Pattern& pattern, const std::string& name) {
  return *std::find_if(pattern.panels.begin(), pattern.panels.end(), [&](const Panel& p) { return p.name == name; });
}

TEST(OwnGarments, ASlipHangsOnTheBias) {
  const Pattern slip = load("slip");
  for (const char* name : {"front", "back"}) {
    const Panel& panel = panel_of(slip, name);
    const Vec3 warp = panel.place(Vec2(0, 1)) - panel.place(Vec2(0, 0));
    EXPECT_NEAR(std::abs(warp.x()), std::sqrt(0.5), 1e-9) << name;
    EXPECT_NEAR(warp.y(), std::sqrt(0.5), 1e-9) << name;
  }
}

TEST(OwnGarments, ACoatLapsRightOverLeft) {
  const Pattern coat = load("coat");
  const Panel &left = panel_of(coat, "left_front"), &right = panel_of(coat, "right_front");
  double least = 1, most = -1;
  for (const Vec2& p : left.corners) least = std::min(least, left.place(p).x());
  for (const Vec2& p : right.corners) most = std::max(most, right.place(p).x());
  EXPECT_NEAR(least, -0.09, 1e-9);
  EXPECT_NEAR(most, 0.09, 1e-9);
  EXPECT_NEAR(right.place(Vec2(0, 0)).z() - left.place(Vec2(0, 0)).z(), 0.04, 1e-9) << "no panel through another";
}

TEST(MeshToCount, IsTheSameAsThatEdgeLengthOrNearItAndSaysWhatItCannotReach) {
  const Pattern skirt = load("long_skirt");
  const CountedGarment counted = mesh_garment_to_count(skirt, 1000);
  EXPECT_NEAR(welded_count(counted.garment), 1000, 10);
  EXPECT_NEAR(welded_count(mesh_garment(skirt, counted.resolution_m)), 1000, 60);
  const auto complaint = [&](const Pattern& pattern, int particles) -> std::string {
    try {
      mesh_garment_to_count(pattern, particles);
      return "(no error)";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_NE(complaint(skirt, 19).find("from 20 to 2,000,000, got 19"), std::string::npos) << complaint(skirt, 19);
  // So few that a row more or less is all.
  std::string first;
  for (int particles = 20; particles < 60 && first.empty(); ++particles) {
    const std::string answer = complaint(test::tube_pattern(0.2, 0.1, 0.1), particles);
    if (answer != "(no error)") first = answer;
  }
  EXPECT_NE(first.find("vertices: expected a number of particles that this pattern can be cut into, within 1 %, got "),
            std::string::npos)
      << first;
  EXPECT_NE(first.find("; the nearest found is "), std::string::npos) << first;
}

TEST(MeshToCount, ReachesCountsBetweenTheJumpsOfTwoEqualPanels) {
  const Pattern tube = test::tube_pattern(0.3, 0.2, 0.1);
  int reached = 0;
  for (int particles = 500; particles < 540; ++particles) {
    try {
      reached += welded_count(mesh_garment_to_count(tube, particles).garment) > 0 ? 1 : 0;
    } catch (const InputError&) {
    }
  }
  EXPECT_GE(reached, 30) << "of 40; fewer without the mixture";
}

TEST(MeshToCount, GivesTheSameBitsTwice) {
  const Pattern blouse = load("blouse");
  const CountedGarment a = mesh_garment_to_count(blouse, 700), b = mesh_garment_to_count(blouse, 700);
  EXPECT_EQ(a.resolution_m, b.resolution_m);
  EXPECT_EQ(a.garment.mesh.triangles, b.garment.mesh.triangles);
  ASSERT_EQ(a.garment.x.size(), b.garment.x.size());
  for (std::size_t i = 0; i < a.garment.x.size(); ++i) EXPECT_EQ(a.garment.x[i], b.garment.x[i]);
}

}  // namespace
}  // namespace toile::internal
