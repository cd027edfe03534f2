// Plain solids: closed, outwards, of the size and fineness asked for.
#include "body/solid_shapes.hpp"

#include "body/body_parts.hpp"

#include "core/error.hpp"
#include "mesh/check.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace toile::internal {
namespace {

constexpr double pi = std::numbers::pi;

double volume(const SolidMesh& solid) {
  double six = 0;
  for (const auto& [a, b, c] : solid.triangles) {
    const auto at = [&](Index i) { return solid.positions[static_cast<std::size_t>(i)]; };
    six += at(a).dot(at(b).cross(at(c)));
  }
  return six / 6;
}

double longest_edge(const SolidMesh& solid) {
  double longest = 0;
  for (const Triangle& t : solid.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, (solid.positions[static_cast<std::size_t>(t[k])] -
                                   solid.positions[static_cast<std::size_t>(t[(k + 1) % 3])])
                                      .norm());
  return longest;
}

TEST(SolidShapes, TheCylinderHasThePapersCounts) {
  const SolidMesh solid = rounded_cylinder(0.2, 0.5, Vec3(0, 1, 0));
  EXPECT_EQ(solid.positions.size(), 322u);
  EXPECT_EQ(solid.triangles.size(), 640u);
  check_closed("cylinder", solid.positions, solid.triangles);  // also: outwards
  double low = 1, high = 0, radius = 0;
  for (const Vec3& p : solid.positions) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
    radius = std::max(radius, std::hypot(p.x(), p.z()));
  }
  EXPECT_EQ(high, 1);
  EXPECT_DOUBLE_EQ(low, 0.5);
  EXPECT_NEAR(radius, 0.2, 1e-12);
}

TEST(SolidShapes, ABallIsRoundAndAsFineAsAsked) {
  for (const double edge : {0.1, 0.03}) {
    const SolidMesh solid = ball(0.3, edge);
    check_closed("ball", solid.positions, solid.triangles);
    for (const Vec3& p : solid.positions) EXPECT_NEAR(p.norm(), 0.3, 1e-15);
    EXPECT_LE(longest_edge(solid), edge);
    EXPECT_GT(longest_edge(solid), 0.45 * edge);
    EXPECT_NEAR(volume(solid), 4 * pi / 3 * 0.027, edge * edge);
  }
}

TEST(SolidShapes, ABlockIsItsSize) {
  const SolidMesh solid = block(Vec3(1, 2, 3));
  check_closed("block", solid.positions, solid.triangles);
  EXPECT_DOUBLE_EQ(volume(solid), 6);
}

TEST(SolidShapes, WhatIsRevolvedIsClosedEitherWayRound) {
  struct Revolved {
    std::vector<Vec2> profile;
    double volume;
  };
  const Revolved cone{{{0, 0}, {0.1, 0}, {0, 0.3}}, pi / 3 * 0.01 * 0.3};
  const Revolved washer{{{0.1, 0}, {0.2, 0}, {0.2, 0.05}, {0.1, 0.05}}, pi * (0.04 - 0.01) * 0.05};  // a closed curve
  for (const Revolved& one : {cone, washer})
    for (const bool reversed : {false, true}) {
      std::vector<Vec2> profile = one.profile;
      if (reversed) std::reverse(profile.begin(), profile.end());
      SolidMesh solid = revolved(profile, 0.01);
      check_closed("revolved", solid.positions, solid.triangles);
      EXPECT_NEAR(volume(solid), one.volume, 2e-3 * one.volume);
      EXPECT_LE(longest_edge(solid), 0.01 * std::sqrt(2.0) + 1e-12) << "the diagonal";
      turn_inside_out(solid);
      EXPECT_LT(volume(solid), 0);
    }
}

TEST(SolidShapes, RefuseAnOutlineThatMakesNoSolid) {
  using Profile = std::vector<Vec2>;
  for (const Profile& profile :
       {Profile{{0, 0}, {0, 1}}, Profile{{0, 0}, {-1, 0}, {0, 1}}, Profile{{0, 0}, {1, 0}, {1, 0}, {0, 1}},
        Profile{{0, 0}, {1, 0}, {0, 0.5}, {1, 1}, {0, 1}}, Profile{{0, 0}, {1, 0}, {1, 1}}}) {
    try {
      revolved(profile, 0.1);
      ADD_FAILURE() << "accepted " << profile.size() << " points";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("profile"), std::string::npos) << error.what();
    }
  }
}

TEST(SolidShapes, AreAsFineAsAskedOrRefused) {
  const std::vector<Vec2> hoop = {{10, 0}, {10.005, 0}, {10, 0.005}};
  const SolidMesh fine = revolved(hoop, 0.008);
  EXPECT_EQ(fine.positions.size(), 3u * 7858u) << "2 pi 10.005 / 0.008 around";
  EXPECT_EQ(fine.triangles.size(), 2 * fine.positions.size());
  const auto refused = [](const auto& make) {
    try {
      make();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(
      refused([] { return ball(1, 1e-3); }).find("edge_m: expected at most 2000000 triangles, got at least 2097152"),
      std::string::npos);
  EXPECT_NE(refused([&] { return revolved(hoop, 5e-5); }).find("edge_m"), std::string::npos);
  const std::vector<Vec2> needle = {{0, 0}, {1e-3, 50}, {0, 100}};
  EXPECT_NE(refused([&] { return revolved(needle, 1e-5); }).find("edge_m"), std::string::npos);
}

TEST(SolidShapes, AFileIsTakenWhole) {  // parts that a body would not have too
  SurfaceMesh file;
  const SolidMesh large = block(Vec3(1, 1, 1)), small = block(Vec3(0.01, 0.01, 0.01));
  file.positions.push_back(Vec3(7, 7, 7));  // used by no face
  for (const SolidMesh& part : {large, small}) {
    const auto first = static_cast<Index>(file.positions.size());
    for (const Vec3& x : part.positions) file.positions.push_back(x + Vec3(2.0 * first, 0, 0));
    for (const auto& [a, b, c] : part.triangles) file.triangles.push_back({a + first, b + first, c + first});
  }
  const SolidMesh whole = whole_of(file, solid_parts(file, "file", 1).triangles);
  check_closed("whole", whole.positions, whole.triangles);
  EXPECT_EQ(whole.positions.size(), 16u);
  EXPECT_EQ(whole.positions.front(), file.positions[1]);
  EXPECT_NEAR(volume(whole), 1 + 1e-6, 1e-12);
}

}  // namespace
}  // namespace toile::internal
