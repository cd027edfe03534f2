// A garment cut finer is the same surface: area, outline, seams, folds, labels and gathers.
#include "garment/refine.hpp"

#include "garments.hpp"
#include "mesh/check.hpp"
#include "mesh/topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

namespace toile::internal {
namespace {

// A tube with its waist labelled, a folded seam, a fold line in front, and a gathered tier below the back.
GarmentMesh tube(double edge_m) {
  Pattern pattern = test::tube_pattern(0.2, 0.16, 0.1);
  pattern.panels[0].edges[2].label = "lower_interface";
  pattern.stitches[0].angle_rad = 0.5;
  PanelFold fold;
  fold.line.start = 0;
  fold.line.end = 2;
  fold.angle_rad = 1;
  pattern.panels[0].folds.push_back(fold);
  finish_other_edges(pattern, {0.02, 0.01});
  pattern.panels.push_back(test::back_rectangle(0.4, 0.1, {0, -0.2, -0.05}));
  pattern.panels.back().name = "tier";
  pattern.stitches.push_back(test::stitch(1, 0, 2, 2));
  return mesh_garment(pattern, edge_m);
}

double longest_edge_m(const ClothMesh& mesh) { return mesh_quality(mesh).max_edge_m; }

double area_m2(const GarmentMesh& garment, Index panel) {
  double area = 0;
  for (std::size_t t = 0; t < garment.mesh.uv.size(); ++t)
    if (garment.mesh.panel[t] == panel) area += test::uv_area(garment.mesh.uv[t]);
  return area;
}

using Edge = std::pair<Index, Index>;
std::map<Edge, int> triangles_at(const ClothMesh& mesh) {
  std::map<Edge, int> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  return edges;
}

TEST(Refine, HalvesLongEdgesAndLeavesTheOthers) {
  const GarmentMesh coarse = tube(0.04);
  const RefinedGarment fine = refine(coarse, 0.01);
  EXPECT_LE(longest_edge_m(fine.garment.mesh), 0.01 * std::numbers::sqrt2 + 1e-12);
  EXPECT_GT(mesh_quality(fine.garment.mesh).min_angle_deg, 0.4 * mesh_quality(coarse.mesh).min_angle_deg);
  ASSERT_EQ(fine.garment.mesh.particle_count, coarse.mesh.particle_count + static_cast<Index>(fine.ends.size()));
  EXPECT_TRUE(std::equal(coarse.x.begin(), coarse.x.end(), fine.garment.x.begin()));
  const RefinedGarment same = refine(coarse, longest_edge_m(coarse.mesh) / std::numbers::sqrt2);
  EXPECT_TRUE(same.ends.empty());
  EXPECT_EQ(same.garment.mesh.triangles, coarse.mesh.triangles);
}

TEST(Refine, KeepsEveryPanelsAreaAndSide) {
  const GarmentMesh coarse = tube(0.03), fine = refine(coarse, 0.008).garment;
  for (Index panel = 0; panel < 3; ++panel) EXPECT_NEAR(area_m2(fine, panel), area_m2(coarse, panel), 1e-12);
  for (const auto& uv : fine.mesh.uv) EXPECT_GT(test::uv_area(uv), 0);
}

// Placed panels are flat: the length of every edge in space is that in the drawing, in every triangle that has it.
TEST(Refine, HalvesTheDrawingAsItHalvesTheCloth) {
  const GarmentMesh fine = refine(tube(0.03), 0.008).garment;
  for (std::size_t t = 0; t < fine.mesh.uv.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 side = fine.x[at(fine.mesh.triangles[t][(k + 1) % 3])] - fine.x[at(fine.mesh.triangles[t][k])];
      EXPECT_NEAR(side.norm(), (fine.mesh.uv[t][(k + 1) % 3] - fine.mesh.uv[t][k]).norm(), 1e-12);
    }
}

// Both sides of a seam are halved alike, also where the seam is eased and one side's edges are shorter than the limit.
TEST(Refine, WeldsToOneSurfaceWithTheOutlineOfTheCoarseOne) {
  for (const double edge_m : {0.02, 0.0105, 0.007}) {
    const GarmentMesh coarse = tube(0.03), fine = refine(coarse, edge_m).garment;
    const WeldedMesh before = weld(coarse), after = weld(fine);
    EXPECT_NO_THROW(build_topology(after.mesh.particle_count, after.mesh.triangles));
    const auto euler = [](const WeldedMesh& welded) {
      return welded.mesh.particle_count - static_cast<Index>(triangles_at(welded.mesh).size()) +
             welded.mesh.triangle_count();
    };
    EXPECT_EQ(euler(after), euler(before));
    // An edge of one triangle is of the rim.
    const auto rim_m = [](const GarmentMesh& garment, const WeldedMesh& welded) {
      const auto edges = triangles_at(welded.mesh);
      double length = 0;
      for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
          const Triangle& corners = welded.mesh.triangles[t];
          if (edges.at(std::minmax(corners[k], corners[(k + 1) % 3])) == 1)
            length += (garment.mesh.uv[t][(k + 1) % 3] - garment.mesh.uv[t][k]).norm();
        }
      return length;
    };
    EXPECT_NEAR(rim_m(fine, after), rim_m(coarse, before), 1e-9);
  }
}

TEST(Refine, KeepsTheLengthOfASeamInItsPairs) {
  const GarmentMesh coarse = tube(0.03), fine = refine(coarse, 0.008).garment;
  EXPECT_GT(fine.pairs.size(), 2 * coarse.pairs.size());
  for (Index seam = 0; seam < 3; ++seam) {
    const auto length = [&](const GarmentMesh& garment) {
      double sum = 0;
      for (const SeamPair& pair : garment.pairs) sum += pair.seam == seam ? pair.share_m : 0;
      return sum;
    };
    EXPECT_NEAR(length(fine), length(coarse), 1e-12) << seam;
  }
  std::set<Edge> merged;
  for (const SeamPair& pair : fine.pairs) {
    EXPECT_EQ(fine.merged[at(pair.a)], fine.merged[at(pair.b)]);
    EXPECT_GT(pair.share_m, 0);
  }
}

TEST(Refine, AndWeldKeepFinishedEdges) {
  const GarmentMesh coarse = tube(0.03), fine = refine(coarse, 0.008).garment;
  const auto length = [](const GarmentMesh& garment, double FinishedEdge::*width) {
    double sum = 0;
    for (const FinishedEdge& edge : garment.mesh.finished)
      if (edge.*width > 0) sum += (garment.x[at(edge.a)] - garment.x[at(edge.b)]).norm();
    return sum;
  };
  EXPECT_GT(fine.mesh.finished.size(), coarse.mesh.finished.size());
  EXPECT_NEAR(length(coarse, &FinishedEdge::tape_m), 0.2, 1e-12) << "the labelled edge";
  for (const auto width : {&FinishedEdge::hem_m, &FinishedEdge::tape_m})
    EXPECT_NEAR(length(fine, width), length(coarse, width), 1e-12);
  const WeldedMesh welded = weld(fine);
  const auto edges = triangles_at(welded.mesh);
  ASSERT_EQ(welded.mesh.finished.size(), fine.mesh.finished.size());
  for (const FinishedEdge& edge : welded.mesh.finished) EXPECT_TRUE(edges.contains(std::minmax(edge.a, edge.b)));
}

TEST(Refine, LabelsFoldsAndOutlinesFollow) {
  const GarmentMesh coarse = tube(0.03), fine = refine(coarse, 0.008).garment;
  const auto edges = triangles_at(fine.mesh);
  ASSERT_EQ(fine.labels.size(), 1U);
  const std::vector<Index>& waist = fine.labels.front().particles;
  double length = 0;
  for (std::size_t k = 1; k < waist.size(); ++k) {
    EXPECT_EQ(edges.count(std::minmax(waist[k - 1], waist[k])), 1U);
    length += (fine.x[at(waist[k])] - fine.x[at(waist[k - 1])]).norm();
  }
  EXPECT_NEAR(length, 0.2, 1e-12);
  double folded = 0;
  for (const FoldedEdge& fold : fine.mesh.folds) {
    EXPECT_EQ(edges.count(std::minmax(fold.a, fold.b)), 1U);
    folded += (fine.x[at(fold.b)] - fine.x[at(fold.a)]).norm();
  }
  EXPECT_NEAR(folded, 0.16 + std::hypot(0.2, 0.16), 1e-12) << "the seam and the fold";
  for (const auto& [edge, triangles] : edges) {
    if (triangles != 1) continue;
    EXPECT_TRUE(fine.on_panel_edge[at(edge.first)] && fine.on_panel_edge[at(edge.second)]);
  }
}

// The rest shape of a gather stays the surface that it was: triangles agree on the edges that they share.
TEST(Refine, KeepsTheRestShapeOfAGather) {
  const GarmentMesh coarse = tube(0.03), fine = refine(coarse, 0.005).garment;
  ASSERT_EQ(fine.mesh.gathered_uv.size(), fine.mesh.uv.size());
  const auto rest_area = [](const GarmentMesh& garment) {
    double area = 0;
    for (const auto& uv : garment.mesh.gathered_uv) area += test::uv_area(uv);
    return area;
  };
  EXPECT_LT(rest_area(coarse), 0.98 * (area_m2(coarse, 0) + area_m2(coarse, 1) + area_m2(coarse, 2)));
  EXPECT_NEAR(rest_area(fine), rest_area(coarse), 1e-12);
  std::map<Edge, double> length;
  for (std::size_t t = 0; t < fine.mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& rest = fine.mesh.gathered_uv[t];
      const double side = (rest[(k + 1) % 3] - rest[k]).norm();
      const Edge edge = std::minmax(fine.mesh.triangles[t][k], fine.mesh.triangles[t][(k + 1) % 3]);
      EXPECT_NEAR(length.try_emplace(edge, side).first->second, side, 1e-12);
    }
}

// A seam left open stays open to the next pair that is closed.
TEST(Refine, LeavesOpenSeamsOpen) {
  GarmentMesh coarse = tube(0.03);
  const std::vector<Index> open = {1, 2};
  coarse.leave_open(open);
  const GarmentMesh fine = refine(coarse, 0.015).garment;
  const WeldedMesh welded = weld(fine);
  EXPECT_NO_THROW(build_topology(welded.mesh.particle_count, welded.mesh.triangles));
  EXPECT_EQ(welded_count(fine) - static_cast<int>(triangles_at(welded.mesh).size()) + fine.mesh.triangle_count(),
            weld(coarse).mesh.particle_count - static_cast<int>(triangles_at(weld(coarse).mesh).size()) +
                coarse.mesh.triangle_count());
}

}  // namespace
}  // namespace toile::internal
