// Pressure on triangles: the law itself, on closed cloth a gradient, and panel by panel.
#include "assembly/pressure.hpp"

#include "assembly/elements.hpp"
#include "support/bodies.hpp"
#include "support/finite_difference.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace toile::internal {
namespace {

constexpr double Pa = 300;

// A crumpled ball, drawn as nothing that could be cut: only the triangles count here.
struct Ball {
  explicit Ball(int levels, double crumple_m = 0.02) {
    const BodySurface surface = test::sphere(Vec3(0.3, -0.2, 0.1), 0.2, levels);
    mesh.triangles = {surface.triangles().begin(), surface.triangles().end()};
    mesh.particle_count = static_cast<Index>(surface.positions().size());
    mesh.panel.assign(mesh.triangles.size(), 0);
    mesh.panel_names = {"ball"};
    mesh.uv.assign(mesh.triangles.size(), {Vec2(0, 0), Vec2(0.1, 0), Vec2(0, 0.1)});
    const Fabric fabric;
    model = build_model(mesh, {&fabric, 1});
    elements.emplace(model);
    state.x = test::crumpled({surface.positions().begin(), surface.positions().end()}, crumple_m, 7);
    state.v.assign(state.x.size(), Vec3::Zero());
  }
  Vec3s forces(const std::vector<double>& panel_Pa = {Pa}) {
    Pressure pressure([&](double, std::span<double> of) { std::copy(panel_Pa.begin(), panel_Pa.end(), of.begin()); },
                      panel_Pa.size());
    Vec3s f(state.x.size(), Vec3::Zero());
    if (!pressure.acts(0)) return f;
    pressure.prepare(model, *elements->pattern());
    pressure.evaluate(state, 0);
    pressure.add_forces(f);
    return f;
  }
  Eigen::VectorXd flat() const {
    return Eigen::Map<const Eigen::VectorXd>(state.x.front().data(), 3 * static_cast<Eigen::Index>(state.x.size()));
  }
  void set(const Eigen::VectorXd& flat) {
    for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] = flat.segment<3>(3 * static_cast<Eigen::Index>(i));
  }
  double volume() const {
    double six_volumes = 0;
    for (const auto& [i, j, k] : mesh.triangles)
      six_volumes += state.x[at(i)].dot(state.x[at(j)].cross(state.x[at(k)]));
    return six_volumes / 6;
  }
  ClothMesh mesh;
  ClothModel model;
  ClothState state;
  std::optional<Elements> elements;
};

TEST(Pressure, OnAClosedClothIsMinusTheGradientOfMinusPTimesTheVolume) {
  Ball ball(2);
  const Vec3s f = ball.forces();
  const Eigen::VectorXd x = ball.flat();
  const FiniteDifference energy = finite_difference(
      [&](const Eigen::VectorXd& at) {
        ball.set(at);
        return Eigen::VectorXd::Constant(1, -Pa * ball.volume());
      },
      x, 0.05);
  ASSERT_GT(energy.derivative.norm(), 1);
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_LT((f[i] + energy.derivative.block<1, 3>(0, 3 * static_cast<Eigen::Index>(i)).transpose()).norm(),
              1e-8 * energy.derivative.norm());
}

TEST(Pressure, OnAClosedClothHasNoSumAndNoMoment) {
  Ball ball(3);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  double size = 0;
  const Vec3s f = ball.forces();
  for (std::size_t i = 0; i < f.size(); ++i) {
    sum += f[i];
    moment += ball.state.x[i].cross(f[i]);
    size += f[i].norm();
  }
  EXPECT_GT(size, 0.9 * Pa * 4 * 3.14 * 0.2 * 0.2);
  EXPECT_LT(sum.norm(), 1e-12 * size);
  EXPECT_LT(moment.norm(), 1e-12 * size);
}

TEST(Pressure, OnAFlatSheetIsItsAreaTimesItTowardsTheRightSide) {
  const test::Sheet sheet = test::equilateral_sheet(0.2, 0.1, 0.02);
  Ball holder(0);
  holder.mesh = sheet.mesh;
  const Fabric fabric;
  holder.model = build_model(sheet.mesh, {&fabric, 1});
  holder.elements.emplace(holder.model);
  holder.state.x = sheet.x;
  Vec3 sum = Vec3::Zero();
  for (const Vec3& f : holder.forces({Pa})) sum += f;
  EXPECT_LT((sum - Vec3(0, Pa * 0.2 * 0.1, 0)).norm(), 1e-12);
  sum.setZero();
  for (const Vec3& f : holder.forces({-Pa})) sum += f;
  EXPECT_LT((sum - Vec3(0, -Pa * 0.2 * 0.1, 0)).norm(), 1e-12);
}

TEST(Pressure, IsThatOfEachPanel) {
  test::Sheet sheet = test::equilateral_sheet(0.2, 0.1, 0.02);
  test::add_panel(sheet, "right", [](const Vec2& uv) { return uv.x() > 0.1; });
  Ball holder(0);
  holder.mesh = sheet.mesh;
  const std::vector<Fabric> fabrics(2);
  holder.model = build_model(sheet.mesh, fabrics);
  holder.elements.emplace(holder.model);
  holder.state.x = sheet.x;
  const Vec3s f = holder.forces({0, Pa});
  double left = 0, right = 0;
  for (std::size_t i = 0; i < f.size(); ++i) (sheet.x[i].x() < 0.08 ? left : right) += f[i].y();
  EXPECT_EQ(left, 0);
  EXPECT_NEAR(right, Pa * 0.1 * 0.1, 0.15 * Pa * 0.1 * 0.1);  // the boundary of the panels is a zigzag
}

// Why A has nothing of it: assembly/pressure.hpp.
TEST(Pressure, ItsDerivativeOnAClosedClothIsSymmetricWithEigenvaluesOfBothSigns) {
  Ball ball(1);
  const Eigen::VectorXd x = ball.flat();
  const FiniteDifference K = finite_difference(
      [&](const Eigen::VectorXd& at) {
        ball.set(at);
        const Vec3s f = ball.forces();
        return Eigen::VectorXd(-Eigen::Map<const Eigen::VectorXd>(f.front().data(), at.size()));
      },
      x, 0.05);
  EXPECT_LT((K.derivative - K.derivative.transpose()).norm(), 1e-8 * K.derivative.norm());
  const Eigen::MatrixXd symmetric = 0.5 * (K.derivative + K.derivative.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(symmetric, Eigen::EigenvaluesOnly);
  EXPECT_LT(eigen.eigenvalues().minCoeff(), -0.1 * eigen.eigenvalues().maxCoeff());
  EXPECT_NEAR(eigen.eigenvalues().sum(), 0, 1e-6 * eigen.eigenvalues().maxCoeff());
}

TEST(Pressure, OfZeroDoesNotAct) {
  Pressure pressure([](double end_s, std::span<double> of) { of[1] = end_s < 1 ? 0 : 5; }, 2);
  EXPECT_FALSE(pressure.acts(0.5));
  EXPECT_TRUE(pressure.acts(1.5));
}

}  // namespace
}  // namespace toile::internal
