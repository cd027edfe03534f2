// A limb of blended skin that bends until its skin passes into itself.
#include "body/skin_folds.hpp"

#include "contact/body_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

constexpr double fold_room_m = 0.006, radius_m = 0.05;
constexpr int rings = 81, around = 32;

// A tube along y with a joint in its middle, blended over 8 cm; caps of one vertex.
struct Limb {
  Figure figure;
  std::vector<Index> vertices;
  std::vector<Triangle> triangles;

  Limb() {
    FigureSkin skin;
    figure.first_influence.push_back(0);
    const auto add = [&](const Vec3& p) {
      const double u = std::clamp((p.y() - 0.36) / 0.08, 0.0, 1.0), w = u * u * (3 - 2 * u);
      figure.modelled.push_back(p);
      figure.influences.push_back({0, 1 - w});
      figure.influences.push_back({1, w});
      figure.first_influence.push_back(figure.influences.size());
    };
    for (int r = 0; r < rings; ++r)
      for (int k = 0; k < around; ++k) {
        const double angle = 2 * std::numbers::pi * k / around;
        add(Vec3(radius_m * std::cos(angle), 0.8 * r / (rings - 1), -radius_m * std::sin(angle)));
      }
    add(Vec3(0, 0, 0));
    add(Vec3(0, 0.8, 0));
    const auto of = [](int r, int k) { return static_cast<Index>(r * around + k % around); };
    for (int k = 0; k < around; ++k) {
      for (int r = 0; r + 1 < rings; ++r) {
        triangles.push_back({of(r, k), of(r, k + 1), of(r + 1, k + 1)});
        triangles.push_back({of(r, k), of(r + 1, k + 1), of(r + 1, k)});
      }
      triangles.push_back({of(0, k + 1), of(0, k), static_cast<Index>(rings * around)});
      triangles.push_back({of(rings - 1, k), of(rings - 1, k + 1), static_cast<Index>(rings * around + 1)});
    }
    for (int node = 0; node < 2; ++node) {
      figure.nodes.push_back({node == 0 ? "upper" : "lower", node - 1});
      NodePose pose;
      pose.translation = node == 0 ? Vec3(0, 0, 0) : Vec3(0, 0.4, 0);
      figure.rest.nodes.push_back(pose);
      Affine to_joint;
      to_joint << Mat3::Identity(), Vec3(0, node == 0 ? 0 : -0.4, 0);
      skin.joints.push_back(node);
      skin.to_joint.push_back(to_joint);
    }
    figure.order = parents_first(figure.nodes, "limb");
    figure.skins.push_back(skin);
    figure.parts.push_back({0, 0, 0, figure.modelled.size()});
    vertices = every_vertex(figure);
  }

  PosedBody body() const {
    return {&figure, vertices, triangles, Mat3::Identity(),
            [this](const FigurePose& pose, std::span<Vec3> x) { pose_vertices(figure, pose, vertices, x); }};
  }
  FigurePose bent(double degrees) const {
    FigurePose pose = figure.rest;
    pose.nodes[1].turn = rotation_about(Vec3(0, 0, 1), degrees * std::numbers::pi / 180);
    return pose;
  }
  int within_itself(std::span<const Vec3> x) const {
    const BodySurface surface({x.begin(), x.end()}, triangles);
    int count = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      count += surface.winding_number(x[i] + 1e-4 * surface.vertex_normal(static_cast<Index>(i))) > 0;
    return count;
  }
};

PoseTrack bending(const Limb& limb, double to_degrees) {
  PoseTrack track;
  track.rate_hz = 30;
  for (int f = 0; f <= 30; ++f) track.poses.push_back(limb.bent(to_degrees * f / 30));
  return track;
}

TEST(SkinFolds, SkinThatPassesIntoItselfMakesRoom) {
  const Limb limb;
  const PoseTrack track = bending(limb, 65);
  const SkinFolds folds(limb.body(), fold_room_m, track);
  std::vector<Vec3> x = all_vertices(limb.figure, track.poses.back());
  const int before = limb.within_itself(x);
  EXPECT_GT(before, 20);
  folds.yield(1, 1, x);
  EXPECT_LE(10 * limb.within_itself(x), before);  // at the bottom of the crease some may stay
  EXPECT_GT(folds.deepest_m(), 0.5 * fold_room_m);
  EXPECT_LE(folds.deepest_m(), 0.008);  // 1 % of the height
}

// Skin that comes near, and is not yet within itself, keeps most of the room.
TEST(SkinFolds, SkinThatFacesSkinKeepsItsRoom) {
  const Limb limb;
  const PoseTrack track = bending(limb, 54);
  const SkinFolds folds(limb.body(), fold_room_m, track);
  const auto narrowest = [&](const std::vector<Vec3>& x) {
    const BodySurface surface(x, limb.triangles);
    double gap = fold_room_m;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const BodyPoint before =
          surface.nearest_opposite(x[i], surface.vertex_normal(static_cast<Index>(i)), fold_room_m);
      if (before.triangle >= 0) gap = std::min(gap, before.gap_m);
    }
    return gap;
  };
  std::vector<Vec3> x = all_vertices(limb.figure, track.poses.back());
  EXPECT_LT(narrowest(x), 0.5 * fold_room_m);
  folds.yield(1, 1, x);
  EXPECT_GT(narrowest(x), 0.8 * fold_room_m);
}

TEST(SkinFolds, WhatIsNotFoldedStaysToTheBit) {
  const Limb limb;
  const PoseTrack track = bending(limb, 30);
  const SkinFolds folds(limb.body(), fold_room_m, track);
  EXPECT_EQ(folds.deepest_m(), 0);
  const std::vector<Vec3> was = all_vertices(limb.figure, track.poses.back());
  std::vector<Vec3> x = was;
  folds.yield(1, 1, x);
  EXPECT_EQ(x, was);
  const SkinFolds deep(limb.body(), fold_room_m, bending(limb, 65));
  x = limb.figure.modelled;
  deep.yield(0, 1, x);
  EXPECT_EQ(x, limb.figure.modelled);
  x = all_vertices(limb.figure, track.poses.back());
  deep.yield(1, 0, x);  // none of the way from rest
  EXPECT_EQ(x, was);
}

TEST(SkinFolds, YieldsWithoutAJumpInSpeed) {
  const Limb limb;
  const PoseTrack track = bending(limb, 65);
  const SkinFolds folds(limb.body(), fold_room_m, track);
  const std::vector<Vec3> still = all_vertices(limb.figure, track.poses.back());
  const auto yielded = [&](double t) {
    std::vector<Vec3> x = still;
    folds.yield(t, 1, x);
    return x;
  };
  double most = 0;
  for (double t = 0.05; t < 0.95; t += 0.0025) {
    const std::vector<Vec3> a = yielded(t - 1e-4), b = yielded(t), c = yielded(t + 1e-4);
    for (std::size_t i = 0; i < b.size(); ++i) most = std::max(most, (a[i] - 2 * b[i] + c[i]).norm() / 1e-4);
  }
  EXPECT_LT(most, 0.01);  // m/s; skin yields at 0.1 m/s
}

}  // namespace
}  // namespace toile::internal
