// Lines across a panel: mesh edges follow them, both sides share their points, and what cannot be cut so is refused.
#include "garment/fold_lines.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace toile::internal {
namespace {

constexpr double side_m = 0.2, folded_edge_m = 0.02;
constexpr int side_pieces = 10;  // of each side

// Counter-clockwise; point k * pieces is a corner.
std::vector<Vec2> square() {
  std::vector<Vec2> outline;
  const Vec2 corners[] = {{0, 0}, {side_m, 0}, {side_m, side_m}, {0, side_m}};
  for (int c = 0; c < 4; ++c) {
    for (int k = 0; k < side_pieces; ++k)
      outline.push_back(corners[c] + (corners[(c + 1) % 4] - corners[c]) * k / static_cast<double>(side_pieces));
  }
  return outline;
}

// Straight from one point of the outline to another, cut at edge_m.
FoldLine straight(const std::vector<Vec2>& outline, Index from, Index to) {
  FoldLine line{from, to, {}};
  const Vec2 a = outline[at(from)], b = outline[at(to)];
  const int count = static_cast<int>(std::ceil((b - a).norm() / folded_edge_m - 1e-9));
  for (int k = 1; k < count; ++k) line.between.push_back(a + (b - a) * k / static_cast<double>(count));
  return line;
}

double area(const PlanarMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec2 u = mesh.points[at(t[1])] - mesh.points[at(t[0])], v = mesh.points[at(t[2])] - mesh.points[at(t[0])];
    const double twice = u.x() * v.y() - u.y() * v.x();
    EXPECT_GT(twice, 0);
    sum += 0.5 * twice;
  }
  return sum;
}

int triangles_at(const PlanarMesh& mesh, Index a, Index b) {
  int count = 0;
  for (const Triangle& t : mesh.triangles) {
    const auto has = [&](Index i) { return t[0] == i || t[1] == i || t[2] == i; };
    count += has(a) && has(b) ? 1 : 0;
  }
  return count;
}

void expect_followed(const FoldedPlanarMesh& folded, std::size_t line, const FoldLine& asked) {
  const auto& edges = folded.line.at(line);
  ASSERT_EQ(edges.size(), asked.between.size() + 1);
  EXPECT_EQ(edges.front()[0], asked.from);
  EXPECT_EQ(edges.back()[1], asked.to);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    EXPECT_EQ(triangles_at(folded.mesh, edges[k][0], edges[k][1]), 2) << "an edge of both sides";
    if (k > 0) {
      EXPECT_EQ(edges[k][0], edges[k - 1][1]);
      EXPECT_EQ(folded.mesh.points[at(edges[k][0])], asked.between[k - 1]);
    }
  }
}

std::string complaint(const std::vector<FoldLine>& lines) {
  try {
    triangulate_folded(square(), lines, folded_edge_m);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

TEST(FoldLines, WithoutAnyThePanelIsMeshedAsEver) {
  const PlanarMesh plain = triangulate(square(), folded_edge_m);
  const FoldedPlanarMesh folded = triangulate_folded(square(), {}, folded_edge_m);
  ASSERT_EQ(folded.mesh.points.size(), plain.points.size());
  EXPECT_EQ(std::memcmp(folded.mesh.points.data(), plain.points.data(), plain.points.size() * sizeof(Vec2)), 0);
  EXPECT_EQ(folded.mesh.triangles, plain.triangles);
}

TEST(FoldLines, MeshEdgesFollowAStraightLineACurveAndLinesThatShareACorner) {
  const std::vector<Vec2> outline = square();
  const FoldLine slanted = straight(outline, 3, 27), across = straight(outline, 12, 27);
  FoldLine curve = straight(outline, 33, 17);
  for (Vec2& p : curve.between) p.y() += 2 * p.x() * (side_m - p.x());
  ASSERT_LT(curve.between.front().x(), curve.between.back().x());
  for (const std::vector<FoldLine>& lines :
       {std::vector{slanted}, std::vector{slanted, across}, std::vector{across, slanted}, std::vector{curve}}) {
    const FoldedPlanarMesh folded = triangulate_folded(outline, lines, folded_edge_m);
    ASSERT_EQ(folded.line.size(), lines.size());
    for (std::size_t k = 0; k < lines.size(); ++k) expect_followed(folded, k, lines[k]);
    EXPECT_NEAR(area(folded.mesh), side_m * side_m, 1e-6);
    for (std::size_t i = 0; i < outline.size(); ++i) EXPECT_EQ(folded.mesh.points[i], outline[i]);
    for (std::size_t i = 0; i < folded.mesh.points.size(); ++i)
      EXPECT_GT(triangles_at(folded.mesh, static_cast<Index>(i), static_cast<Index>(i)), 0) << "no loose point " << i;
  }
}

TEST(FoldLines, TheTrianglesBesideALineAreAsGoodAsElsewhere) {
  const std::vector<Vec2> outline = square();
  const std::vector<FoldLine> lines{straight(outline, 5, 25)};
  const PlanarQuality quality = planar_quality(triangulate_folded(outline, lines, folded_edge_m).mesh);
  EXPECT_GT(quality.min_angle_deg, 30);
  EXPECT_LT(quality.max_edge_m, 1.5 * folded_edge_m);
}

TEST(FoldLines, RunningClockwiseChangesNothingButTheOrder) {
  std::vector<Vec2> outline = square();
  std::reverse(outline.begin(), outline.end());
  const FoldLine line = straight(outline, 4, 26);
  const FoldedPlanarMesh folded = triangulate_folded(outline, std::vector{line}, folded_edge_m);
  expect_followed(folded, 0, line);
  EXPECT_NEAR(area(folded.mesh), side_m * side_m, 1e-6);
}

TEST(FoldLines, CrossingLinesAndSidesOfTheOutlineAreRefusedByNumber) {
  const std::vector<Vec2> outline = square();
  const FoldLine up = straight(outline, 5, 25), across = straight(outline, 15, 35);
  EXPECT_NE(complaint({up, across}).find("fold 1"), std::string::npos) << complaint({up, across});
  EXPECT_NE(complaint({across, up}).find("crossed"), std::string::npos);
  EXPECT_NE(complaint({up, up}).find("folds: expected lines"), std::string::npos) << complaint({up, up});
  EXPECT_NE(complaint({{3, 4, {}}}).find("fold 0"), std::string::npos) << "a side";
  EXPECT_NE(complaint({{3, 3, {Vec2(0.1, 0.1), Vec2(0.1, 0.12)}}}).find("ends where it begins"), std::string::npos);
  EXPECT_NE(complaint({{3, 27, {Vec2(0.5, 0.1)}}}).find("folds: expected lines"), std::string::npos)
      << "leaves the panel";
}

}  // namespace
}  // namespace toile::internal
