// A pattern as cloth: shared seam samples, pattern coordinates, which side is right, darts, welding.
#include "garment/garment_mesh.hpp"

#include "core/error.hpp"
#include "garment/panel_mesh.hpp"
#include "garments.hpp"
#include "mesh/check.hpp"
#include "mesh/topology.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <tuple>

namespace toile::internal {
namespace {

// What mesh_garment complains about.
std::string complaint(const Pattern& pattern) {
  try {
    mesh_garment(pattern, 0.02);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

void expect_counter_clockwise(const GarmentMesh& garment) {
  for (const auto& uv : garment.mesh.uv) ASSERT_GT(test::uv_area(uv), 0);
}

// The directions in which the triangles of a panel pass the edge i -> j: +1, -1, or 0 if it is none of theirs.
int direction_of(const GarmentMesh& garment, Index panel, Index i, Index j) {
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
    if (garment.mesh.panel[t] != panel) continue;
    const Triangle& c = garment.mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      if (c[k] == i && c[(k + 1) % 3] == j) return 1;
      if (c[k] == j && c[(k + 1) % 3] == i) return -1;
    }
  }
  return 0;
}

void expect_opposite_directions(const GarmentMesh& garment, Index panel_a, Index panel_b) {
  int edges = 0;
  for (std::size_t k = 0; k + 1 < garment.pairs.size(); ++k) {
    const SeamPair &p = garment.pairs[k], &q = garment.pairs[k + 1];
    if (p.seam != q.seam) continue;
    const int a = direction_of(garment, panel_a, p.a, q.a), b = direction_of(garment, panel_b, p.b, q.b);
    EXPECT_NE(a, 0);
    EXPECT_EQ(a, -b) << garment.seams[at(p.seam)].name;
    ++edges;
  }
  EXPECT_GT(edges, 5);
}

double area_of_panel(const GarmentMesh& garment, Index panel) {
  double area = 0;
  for (std::size_t t = 0; t < garment.mesh.uv.size(); ++t)
    area += garment.mesh.panel[t] == panel ? test::uv_area(garment.mesh.uv[t]) : 0;
  return area;
}

// A cone's panel: a rectangle with a dart of 6 cm cut into its top, apex at (0, 0.1).  Edges 2 and 3 are the dart's legs.
Pattern dart_pattern() {
  Pattern pattern;
  pattern.panels = {test::straight_panel(
      "skirt", {{-0.1, -0.15}, {0.1, -0.15}, {0.1, 0.15}, {0.03, 0.15}, {0, 0.05}, {-0.03, 0.15}, {-0.1, 0.15}},
      {0, 0, 0})};
  pattern.stitches = {test::stitch(0, 3, 0, 4)};
  return pattern;
}

TEST(GarmentMesh, BothSidesOfASeamHaveTheSamplesOfTheLongerEdge) {
  // 22.5 cm of the front eased into 20 cm of the back: at 2 cm, 12 pieces where the back alone would have 10.
  Pattern pattern = test::tube_pattern(0.2, 0.225, 0.1);
  pattern.panels[1] = test::back_rectangle(0.2, 0.2, {0, 0, -0.05});
  const GarmentMesh garment = mesh_garment(pattern, 0.02);
  ASSERT_EQ(garment.seams.size(), 2U);
  EXPECT_EQ(garment.pairs.size(), 2U * 13);
  for (const Index s : {0, 1}) {
    EXPECT_NEAR(garment.seams[at(s)].length_a_m, 0.225, 1e-12);
    EXPECT_NEAR(garment.seams[at(s)].length_b_m, 0.2, 1e-12);
    std::vector<SeamPair> pairs;
    for (const SeamPair& pair : garment.pairs) {
      if (pair.seam == s) pairs.push_back(pair);
    }
    double length = 0;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      length += pairs[k].share_m;
      EXPECT_TRUE(garment.on_panel_edge[at(pairs[k].a)] && garment.on_panel_edge[at(pairs[k].b)]);
      if (k == 0) continue;
      // The surplus is spread evenly, corner on corner.
      EXPECT_NEAR((garment.x[at(pairs[k].a)] - garment.x[at(pairs[k - 1].a)]).norm(), 0.225 / 12, 1e-9);
      EXPECT_NEAR((garment.x[at(pairs[k].b)] - garment.x[at(pairs[k - 1].b)]).norm(), 0.2 / 12, 1e-9);
    }
    EXPECT_NEAR(length, 0.5 * (0.225 + 0.2), 1e-12) << "the shares add up to the seam's mean length";
    EXPECT_EQ(garment.x[at(pairs.front().a)].y() < 0, garment.x[at(pairs.front().b)].y() < 0) << "bottom on bottom";
  }
}

TEST(GarmentMesh, NoParticleBelongsToTwoPanelsBeforeTheWeld) {
  const GarmentMesh garment = mesh_garment(test::tube_pattern(0.2, 0.3, 0.1), 0.02);
  std::vector<Index> owner(garment.x.size(), -1);
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
    for (const Index corner : garment.mesh.triangles[t]) {
      EXPECT_TRUE(owner[at(corner)] < 0 || owner[at(corner)] == garment.mesh.panel[t]);
      owner[at(corner)] = garment.mesh.panel[t];
    }
  }
  for (const Index panel : owner) EXPECT_GE(panel, 0);
  EXPECT_EQ(garment.mesh.panel_names, (std::vector<std::string>{"front", "back"}));
  EXPECT_NO_THROW(check_cloth("tube", garment.mesh, garment.x));
}

TEST(GarmentMesh, EveryTriangleIsCounterClockwiseInItsPatternAndNoneIsStretched) {
  const GarmentMesh garment = mesh_garment(test::tube_pattern(0.2, 0.3, 0.1), 0.02);
  expect_counter_clockwise(garment);
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& c = garment.mesh.triangles[t];
      EXPECT_NEAR((garment.x[at(c[k])] - garment.x[at(c[(k + 1) % 3])]).norm(),
                  (garment.mesh.uv[t][k] - garment.mesh.uv[t][(k + 1) % 3]).norm(), 1e-12);
    }
  }
}

TEST(GarmentMesh, TheWarpRunsUpThePanelOnBothSidesOfTheBody) {
  const GarmentMesh garment = mesh_garment(test::tube_pattern(0.2, 0.3, 0.1), 0.02);
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = garment.x[at(garment.mesh.triangles[t][k])];
      EXPECT_NEAR(garment.mesh.uv[t][k].x(), p.y(), 1e-12);
      EXPECT_NEAR(garment.mesh.uv[t][k].y(), garment.mesh.panel[t] == 0 ? -p.x() : p.x(), 1e-12);
    }
  }
}

TEST(GarmentMesh, AClockwisePanelIsMirroredSoThatBothFaceAwayFromTheBody) {
  const GarmentMesh garment = mesh_garment(test::tube_pattern(0.2, 0.3, 0.1), 0.02);
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
    const double z = test::normal_of(garment.x, garment.mesh.triangles[t]).z();
    EXPECT_GT(garment.mesh.panel[t] == 0 ? z : -z, 0);
  }
}

TEST(GarmentMesh, WeldedSeamsArePassedInOppositeDirections) {
  const GarmentMesh garment = mesh_garment(test::tube_pattern(0.2, 0.3, 0.1), 0.02);
  expect_opposite_directions(garment, 0, 1);
  const WeldedMesh welded = weld(garment);
  const Topology topology = build_topology(welded.mesh.particle_count, welded.mesh.triangles);
  // A tube has two rims and nothing else open: Euler's number is 0.
  EXPECT_EQ(static_cast<Index>(topology.edges.size()), welded.mesh.particle_count + welded.mesh.triangle_count());
}

TEST(GarmentMesh, APanelSewnRightToWrongIsTurnedOver) {
  // Both panels drawn counter-clockwise, one behind the other, so the back one shows its wrong side outwards as drawn.
  Pattern pattern = test::tube_pattern(0.2, 0.3, 0.1);
  pattern.panels[1] = test::front_rectangle(0.2, 0.3, {0, 0, -0.05});
  pattern.panels[1].name = "back";
  pattern.stitches = {test::stitch(0, 1, 1, 1, true), test::stitch(0, 3, 1, 3, true)};
  const GarmentMesh garment = mesh_garment(pattern, 0.02);
  expect_counter_clockwise(garment);
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
    const double z = test::normal_of(garment.x, garment.mesh.triangles[t]).z();
    EXPECT_GT(garment.mesh.panel[t] == 0 ? z : -z, 0);
  }
  for (const SeamPair& pair : garment.pairs) EXPECT_NEAR(garment.x[at(pair.a)].y(), garment.x[at(pair.b)].y(), 1e-9);
  expect_opposite_directions(garment, 0, 1);
  const WeldedMesh welded = weld(garment);
  EXPECT_NO_THROW(build_topology(welded.mesh.particle_count, welded.mesh.triangles));
  EXPECT_NEAR(area_of_panel(garment, 1), 0.06, 1e-9);
}

TEST(GarmentMesh, ATwistedSeamIsRefusedByName) {
  Pattern pattern = test::tube_pattern(0.2, 0.3, 0.02);
  pattern.stitches[1].right_wrong = true;
  const std::string message = complaint(pattern);
  EXPECT_NE(message.find("front.3 - back.1"), std::string::npos) << message;
  EXPECT_NE(message.find("twisted"), std::string::npos) << message;
  EXPECT_EQ(message.find("front.1 - back.3"), std::string::npos) << message;
}

TEST(GarmentMesh, ATwistThatLeavesTwoSidesIsRefusedByWhereThePanelsArePlaced) {
  // Both seams the other way round: following them finds no contradiction, but their ends lie at the opposite ends.
  Pattern pattern = test::tube_pattern(0.2, 0.3, 0.02);
  for (Stitch& stitch : pattern.stitches) stitch.right_wrong = true;
  const std::string message = complaint(pattern);
  EXPECT_NE(message.find("front.1 - back.3"), std::string::npos) << message;
  EXPECT_NE(message.find("opposite ends"), std::string::npos) << message;
}

TEST(GarmentMesh, AOneSidedSurfaceIsRefusedByNameWhereThePlacementSaysNothing) {
  // Far apart, the ends of the twisted seam are nearly as far from each other either way: only following the seams round tells.
  Pattern pattern = test::tube_pattern(0.2, 0.3, 1.0);
  pattern.stitches[1].right_wrong = true;
  const std::string message = complaint(pattern);
  EXPECT_NE(message.find("front.3 - back.1"), std::string::npos) << message;
  EXPECT_NE(message.find("opposite ways"), std::string::npos) << message;
}

TEST(GarmentMesh, ADartKeepsItsApex) {
  const GarmentMesh garment = mesh_garment(dart_pattern(), 0.02);
  expect_counter_clockwise(garment);
  const int pieces = static_cast<int>(std::ceil(std::hypot(0.03, 0.1) / 0.02));
  EXPECT_EQ(garment.pairs.size(), static_cast<std::size_t>(pieces)) << "the apex is no pair";
  Index apex = -1;
  for (std::size_t i = 0; i < garment.x.size(); ++i) {
    if ((garment.x[i] - Vec3(0, 0.05, 0)).norm() < 1e-12) apex = static_cast<Index>(i);
  }
  ASSERT_GE(apex, 0);
  EXPECT_EQ(garment.merged[at(apex)], apex);
  for (const SeamPair& pair : garment.pairs) {
    EXPECT_NE(pair.a, apex);
    EXPECT_NE(pair.b, apex);
    EXPECT_NEAR(garment.x[at(pair.a)].x(), -garment.x[at(pair.b)].x(), 1e-9);
    EXPECT_NEAR(garment.x[at(pair.a)].y(), garment.x[at(pair.b)].y(), 1e-9);
  }
  const WeldedMesh welded = weld(garment);
  EXPECT_EQ(welded.mesh.particle_count, garment.mesh.particle_count - pieces);
  const Topology topology = build_topology(welded.mesh.particle_count, welded.mesh.triangles);
  EXPECT_EQ(static_cast<Index>(topology.edges.size()) + 1, welded.mesh.particle_count + welded.mesh.triangle_count())
      << "a disc";
}

TEST(GarmentMesh, WeldJoinsWholeClassesAndKeepsThePatternOfBothPanels) {
  // Four panels whose corners meet in one point: a class of four.
  Pattern pattern;
  const double w = 0.1;
  for (const auto& [name, x, y] : {std::tuple{"a", 0.0, 0.0}, {"b", 1.0, 0.0}, {"c", 1.0, 1.0}, {"d", 0.0, 1.0}}) {
    pattern.panels.push_back(test::straight_panel(name, {{0, 0}, {w, 0}, {w, w}, {0, w}}, {x * 0.11, y * 0.11, 0}));
  }
  pattern.stitches = {test::stitch(0, 1, 1, 3), test::stitch(1, 2, 2, 0), test::stitch(2, 3, 3, 1),
                      test::stitch(3, 0, 0, 2)};
  const GarmentMesh garment = mesh_garment(pattern, 0.02);
  std::map<Index, int> members;
  for (std::size_t i = 0; i < garment.merged.size(); ++i) {
    EXPECT_LE(garment.merged[i], static_cast<Index>(i)) << "the smallest member stands for the class";
    EXPECT_EQ(garment.merged[at(garment.merged[i])], garment.merged[i]);
    ++members[garment.merged[i]];
  }
  EXPECT_EQ(std::count_if(members.begin(), members.end(), [](const auto& m) { return m.second == 4; }), 1);
  EXPECT_EQ(std::count_if(members.begin(), members.end(), [](const auto& m) { return m.second == 2; }), 4 * 5);
  const WeldedMesh welded = weld(garment);
  EXPECT_EQ(welded.mesh.particle_count, static_cast<Index>(members.size()));
  std::vector<int> classes(members.size(), 0);  // that became a particle
  for (std::size_t i = 0; i < garment.merged.size(); ++i) {
    ASSERT_GE(welded.particle_of[i], 0);
    ASSERT_LT(welded.particle_of[i], welded.mesh.particle_count);
    if (garment.merged[i] == static_cast<Index>(i)) ++classes[at(welded.particle_of[i])];
    EXPECT_EQ(welded.particle_of[i], welded.particle_of[at(garment.merged[i])]);
  }
  EXPECT_EQ(std::count(classes.begin(), classes.end(), 1), static_cast<std::ptrdiff_t>(classes.size()));
  // Neighbours have numbers near each other, also across the seams: the square of 11 x 11 particles has them within some rows.
  for (const Triangle& t : welded.mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(std::abs(t[k] - t[(k + 1) % 3]), 40);
  }
  ASSERT_EQ(welded.mesh.uv.size(), garment.mesh.uv.size());
  for (std::size_t t = 0; t < garment.mesh.uv.size(); ++t) {
    EXPECT_EQ(welded.mesh.uv[t], garment.mesh.uv[t]);
    EXPECT_EQ(welded.mesh.panel[t], garment.mesh.panel[t]);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(welded.mesh.triangles[t][k], welded.particle_of[at(garment.mesh.triangles[t][k])]);
  }
  const Topology topology = build_topology(welded.mesh.particle_count, welded.mesh.triangles);
  EXPECT_EQ(static_cast<Index>(topology.edges.size()) + 1, welded.mesh.particle_count + welded.mesh.triangle_count())
      << "a disc";
}

TEST(GarmentMesh, TheAreaInThePatternIsThatOfThePanels) {
  const GarmentMesh tube = mesh_garment(test::tube_pattern(0.2, 0.3, 0.1), 0.017);
  EXPECT_NEAR(area_of_panel(tube, 0), 0.06, 1e-9);
  EXPECT_NEAR(area_of_panel(tube, 1), 0.06, 1e-9);
  const GarmentMesh dart = mesh_garment(dart_pattern(), 0.02);
  EXPECT_NEAR(area_of_panel(dart, 0), 0.2 * 0.3 - 0.5 * 0.06 * 0.1, 1e-9);
}

TEST(GarmentMesh, LabelledEdgesKeepTheirParticlesInOrder) {
  Pattern pattern = test::tube_pattern(0.2, 0.3, 0.1);
  pattern.panels[0].edges[2].label = "upper_interface";
  const GarmentMesh garment = mesh_garment(pattern, 0.02);
  ASSERT_EQ(garment.labels.size(), 1U);
  EXPECT_EQ(garment.labels[0].label, "upper_interface");
  const std::vector<Index>& edge = garment.labels[0].particles;
  ASSERT_EQ(edge.size(), 11U);
  for (std::size_t k = 0; k < edge.size(); ++k) {
    EXPECT_NEAR(garment.x[at(edge[k])].x(), 0.1 - 0.02 * static_cast<double>(k), 1e-9);
    EXPECT_NEAR(garment.x[at(edge[k])].y(), 0.15, 1e-12);
  }
}

TEST(GarmentMesh, TheShirtAtOneCentimetreHasItsKnownSize) {
  const std::string path = test::shared_path("patterns/garmentcode/shirt_mean_specification.json");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no sample file " << path;
  const Pattern pattern = load_pattern(path);
  const GarmentMesh garment = mesh_garment(pattern, 0.01);
  EXPECT_EQ(garment.mesh.particle_count, 7744);
  EXPECT_EQ(garment.mesh.triangle_count(), 14514);
  EXPECT_EQ(garment.pairs.size(), 361U);
  EXPECT_EQ(garment.seams.size(), 18U);
  expect_counter_clockwise(garment);
  for (Index p = 0; p < static_cast<Index>(pattern.panels.size()); ++p) {
    // The outline is cut into straight pieces, so curved edges cost or gain a little.
    double twice = 0;
    const Panel& panel = pattern.panels[at(p)];
    for (const PanelEdge& edge : panel.edges) {
      const std::vector<Vec2> points = sample_edge(panel, edge, 500);
      for (std::size_t k = 0; k + 1 < points.size(); ++k)
        twice += points[k].x() * points[k + 1].y() - points[k].y() * points[k + 1].x();
    }
    EXPECT_NEAR(area_of_panel(garment, p) / std::abs(0.5 * twice), 1, 1e-3) << panel.name;
  }
  const WeldedMesh welded = weld(garment);
  EXPECT_NO_THROW(build_topology(welded.mesh.particle_count, welded.mesh.triangles));
  EXPECT_EQ(welded.mesh.uv, garment.mesh.uv);
  const MeshQuality quality = mesh_quality(garment.mesh);
  EXPECT_NEAR(quality.mean_edge_m, 0.0101, 2e-4);
  EXPECT_GT(quality.min_angle_deg, 20);
}

TEST(PanelMesher, KeepsWhatIsAskedForAgainAndNamesTheFirstPanelThatFails) {
  Pattern pattern;
  pattern.panels = {test::front_rectangle(0.3, 0.2, Vec3::Zero()), test::back_rectangle(0.3, 0.2, Vec3::Zero())};
  const auto same = [](const PanelMesh& a, const PanelMesh& b) {
    return a.edge_points == b.edge_points && a.folded.mesh.points == b.folded.mesh.points &&
           a.folded.mesh.triangles == b.folded.mesh.triangles;
  };
  PanelMesher used(pattern);
  used.mesh(0.02, std::array{0.02, 0.02});
  EXPECT_THROW(used.mesh(0.02, std::array{0.02, 1e-9}), InputError);
  const auto again = used.mesh(0.02, std::array{0.02, 0.03});
  PanelMesher fresh(pattern);
  const auto once = fresh.mesh(0.02, std::array{0.02, 0.03});
  EXPECT_TRUE(same(again[0], once[0]));
  EXPECT_TRUE(same(again[1], once[1]));
  PanelMesher other(pattern);
  EXPECT_FALSE(same(other.mesh(0.02, std::array{0.02, 0.02})[1], once[1]));
  try {
    used.mesh(0.02, std::array{1e-9, 1e-9});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("panel front"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace toile::internal
