// Tubes and ribbons: whole, unstretched, where they are asked to be.
#include "core/elementary.hpp"
#include "mesh/check.hpp"
#include "sim/scene.hpp"
#include "verify/crossings.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace toile::internal {
namespace {

GarmentMesh shaped_cloth(const std::string& shape) {
  const Scene scene = parse_scene("{\"cloth\": [{" + shape + "}]}", "s.json");
  return mesh_cloth(scene.cloth.at(0), "/cloth/0", read_text_file).garment;
}

// How many edges have one triangle only.
int open_edges(const GarmentMesh& garment) {
  std::map<std::pair<Index, Index>, int> triangles;
  for (const Triangle& t : garment.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++triangles[std::minmax(t[k], t[(k + 1) % 3])];
  int open = 0;
  for (const auto& [edge, count] : triangles) {
    EXPECT_LE(count, 2);
    if (count == 1) ++open;
  }
  return open;
}

// The largest strain of an edge against the drawing.
double strain(const GarmentMesh& garment) {
  double most = 0;
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = [&](std::size_t c) {
        return garment.x[static_cast<std::size_t>(garment.mesh.triangles[t][c % 3])];
      };
      const double drawn = (garment.mesh.uv[t][k] - garment.mesh.uv[t][(k + 1) % 3]).norm();
      most = std::max(most, std::abs((corner(k) - corner(k + 1)).norm() / drawn - 1));
    }
  return most;
}

TEST(ClothShapes, ATubeIsClosedAroundAndFacesOutwards) {
  const GarmentMesh tube = shaped_cloth(
      R"("tube": {"radius_m": 0.2, "length_m": 0.5, "edge_m": 0.03}, "placement": {"translation_m": [1, 2, 3]})");
  check_cloth("tube", tube.mesh, tube.x);
  double low = 1e9, high = -1e9;
  for (const Vec3& x : tube.x) {
    EXPECT_NEAR(std::hypot(x.x() - 1, x.z() - 3), 0.2, 1e-12);
    low = std::min(low, x.y());
    high = std::max(high, x.y());
  }
  EXPECT_DOUBLE_EQ(low, 1.75);
  EXPECT_DOUBLE_EQ(high, 2.25);
  const int around = static_cast<int>(std::round(2 * std::numbers::pi * 0.2 / 0.03));
  EXPECT_EQ(open_edges(tube), 2 * around);
  EXPECT_LT(strain(tube), 0.002) << "chords of the circle";
  for (const auto& [a, b, c] : tube.mesh.triangles) {
    const auto at = [&](Index i) { return tube.x[static_cast<std::size_t>(i)]; };
    EXPECT_GT((at(b) - at(a)).cross(at(c) - at(a)).dot(at(a) - Vec3(1, at(a).y(), 3)), 0);
  }
}

TEST(ClothShapes, ARibbonFollowsItsPath) {
  const GarmentMesh straight = shaped_cloth(
      R"("ribbon": {"width_m": 0.1, "edge_m": 0.02, "path_m": [[0, 0, 0], [1, 0, 0]], "across": [0, 1, 0.5]})");
  check_cloth("ribbon", straight.mesh, straight.x);
  EXPECT_LT(strain(straight), 1e-9);
  const Vec3 across = Vec3(0, 1, 0.5).normalized();
  for (const Vec3& x : straight.x) {
    EXPECT_LE(std::abs(x.dot(across)), 0.05 + 1e-12);
    EXPECT_NEAR((x - x.dot(across) * across - Vec3(x.x(), 0, 0)).norm(), 0, 1e-12);
  }
  // Around a cylinder and slowly up: only bent while its breadth is along the axis, which it leaves as it turns.
  const auto helix = [](int points) {
    std::string path;
    for (int k = 0; k <= points; ++k)
      path += (k > 0 ? ", [" : "[") + std::to_string(0.3 * std::cos(0.3 * k)) + ", " + std::to_string(0.02 * k) + ", " +
              std::to_string(0.3 * std::sin(0.3 * k)) + "]";
    return shaped_cloth("\"ribbon\": {\"width_m\": 0.04, \"edge_m\": 0.01, \"across\": [0, 1, 0], \"path_m\": [" +
                        path + "]}");
  };
  const GarmentMesh some = helix(4), turns = helix(24);
  check_cloth("ribbon", turns.mesh, turns.x);
  EXPECT_LT(strain(some), 0.03);
  EXPECT_LT(strain(turns), 0.15)
      << "half its breadth is 0.07 of the radius, and more where the curve through the points is bent more";
  EXPECT_EQ(find_cloth_crossings(turns.mesh.triangles, turns.x).size(), 0u);
}

TEST(ClothShapes, AClosedRibbonMeetsItselfWhateverItsTurns) {
  // A curve in space that does not lie in a plane: carried around it, a direction comes back turned.
  const GarmentMesh ring = shaped_cloth(
      R"("ribbon": {"width_m": 0.05, "edge_m": 0.015, "closed": true,
                   "path_m": [[0.3, 0, 0], [0.2, 0.15, 0.2], [0, 0, 0.3], [-0.2, 0.1, 0.2], [-0.3, -0.1, 0], [0, 0.1, -0.3]]})");
  check_cloth("ring", ring.mesh, ring.x);
  const std::size_t edges = 3 * ring.mesh.triangles.size();
  const int open = open_edges(ring);
  EXPECT_EQ((edges + static_cast<std::size_t>(open)) % 2, 0u);
  // A band: as many edges as particles and triangles together (Euler's number 0).
  EXPECT_EQ((edges + static_cast<std::size_t>(open)) / 2, ring.x.size() + ring.mesh.triangles.size());
  double longest = 0;
  for (const Triangle& t : ring.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(
          longest, (ring.x[static_cast<std::size_t>(t[k])] - ring.x[static_cast<std::size_t>(t[(k + 1) % 3])]).norm());
  EXPECT_LT(longest, 0.035) << "no triangle spans the place where the ends meet";
}

}  // namespace
}  // namespace toile::internal
