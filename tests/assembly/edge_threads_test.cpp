// Hems and tapes: what they add along an edge, their forces and derivatives.
#include "assembly/edge_threads.hpp"

#include "assembly/elements.hpp"
#include "assembly/line_moments.hpp"
#include "material/edge_finish.hpp"
#include "support/bending_stiffness.hpp"
#include "support/fabrics.hpp"
#include "support/finished_sides.hpp"
#include "support/finite_difference.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <numeric>

namespace toile::internal {
namespace {

constexpr double hem_m = 0.02, tape_m = 0.01;

TEST(EdgeFinish, AHemIsTwoMoreLayersOnTheGrainAndATapeTwoAlongTheWarp) {
  const Fabric cotton = test::elastic_cotton();
  const LineStiffness warp = line_stiffness(cotton, {3, 0}, {hem_m, 0}),
                      weft = line_stiffness(cotton, {0, 1}, {hem_m, 0}),
                      bias = line_stiffness(cotton, {1, 1}, {hem_m, 0}),
                      tape = line_stiffness(cotton, {1, 1}, {0, tape_m});
  EXPECT_NEAR(warp.stretch_N, 2 * hem_m * cotton.stretch_u_N_per_m, 1e-9);
  EXPECT_NEAR(weft.stretch_N, 2 * hem_m * cotton.stretch_v_N_per_m, 1e-9);
  // A bias strip of cotton stretches by its shear: 229 N/m.
  EXPECT_NEAR(bias.stretch_N, 2 * hem_m * 4 / (1 / 3000.0 + 1 / 2000.0 + 1 / 60.0), 1e-9);
  EXPECT_NEAR(tape.stretch_N, 2 * tape_m * cotton.stretch_u_N_per_m, 1e-9);
  EXPECT_NEAR(warp.mass_kg_per_m, 2 * hem_m * cotton.density_kg_per_m2, 1e-15);
  // Bent along the warp alone, with the weft free: D_u (1 - nu^2).
  EXPECT_NEAR(warp.bend_N_m2, 2 * hem_m * cotton.bend_u_N_m * (1 - cotton.bend_poisson * cotton.bend_poisson), 1e-12);
}

TEST(EdgeFinish, AnAllowanceIsOneMoreLayerAndStitchedDownABundle) {
  Fabric denim = fabric_preset("denim", "", "");
  const Vec2 bias(1, 1);
  const LineStiffness hem = line_stiffness(denim, bias, {hem_m, 0}),
                      loose = line_stiffness(denim, bias, {0, 0, 2 * hem_m, false}),
                      stitched = line_stiffness(denim, bias, {0, 0, 2 * hem_m, true});
  EXPECT_NEAR(loose.mass_kg_per_m, hem.mass_kg_per_m, 1e-15) << "two layers of half the width";
  EXPECT_NEAR(loose.stretch_N, hem.stretch_N, 1e-9);
  EXPECT_NEAR(loose.bend_N_m2, hem.bend_N_m2, 1e-15);
  EXPECT_EQ(stitched.mass_kg_per_m, loose.mass_kg_per_m);
  EXPECT_EQ(stitched.stretch_N, loose.stretch_N);
  const double V = denim.compression_ratio / (1 + denim.compression_ratio), t = denim.density_kg_per_m2 / 500;
  EXPECT_NEAR(stitched.bend_N_m2 - loose.bend_N_m2, V * t * t * stitched.stretch_N, 1e-12);
  // Where nothing buckles it is the sandwich of interfacing.
  denim.compression_ratio = 1;
  denim.bend_friction_N = 0;
  const Fabric both = fused(denim, denim, t);
  EXPECT_NEAR(2 * denim.bend_u_N_m + layer_coupling_N_m(denim, {1, 0}), both.bend_u_N_m, 1e-12);
}

struct Finished {
  ClothModel model;
  ClothState state;
};

Finished crumpled_and_finished(double size_m, BendElement element = BendElement::plate) {
  test::Sheet sheet = test::equilateral_sheet(0.1, 0.1, 0.02);
  test::finish_sides(sheet, 0.1, {0, 0, hem_m, tape_m}, true);
  const Fabric fabric;
  ModelOptions options;
  options.bend_element = element;
  Finished cloth{build_model(sheet.mesh, {&fabric, 1}, options), {}};
  cloth.state.x = test::crumpled(sheet.x, size_m, 5);
  test::Random random(6);
  for (std::size_t i = 0; i < sheet.x.size(); ++i) cloth.state.v.push_back(random.vector(0.5));
  return cloth;
}

Eigen::VectorXd flat(const Vec3s& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.front().data(), static_cast<Eigen::Index>(3 * x.size()));
}

Vec3s unflat(const Eigen::VectorXd& x) {
  Vec3s points(static_cast<std::size_t>(x.size() / 3));
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = x.segment<3>(static_cast<Eigen::Index>(3 * i));
  return points;
}

TEST(EdgeThreads, ForcesAreMinusTheGradientOfTheEnergyAndDampingFollows) {
  const Finished cloth = crumpled_and_finished(0.004);
  const std::shared_ptr<const BlockPattern> pattern = Elements(cloth.model).pattern();
  EdgeThreads threads(cloth.model, *pattern);
  const Vec3s rest(cloth.state.x.size(), Vec3::Zero());
  const auto energy = [&](const Eigen::VectorXd& x) {
    threads.evaluate(unflat(x), rest);
    return Eigen::VectorXd::Constant(1, threads.energy_J());
  };
  const FiniteDifference difference = finite_difference(energy, flat(cloth.state.x), 0.02);
  threads.evaluate(cloth.state.x, rest);
  Vec3s f(rest.size(), Vec3::Zero());
  threads.add_forces(f);
  ASSERT_GT(flat(f).norm(), 1e-3);
  EXPECT_LT((flat(f) + difference.derivative.row(0).transpose()).norm(), 1e-6 * flat(f).norm());

  // The force of damping is D v.
  threads.evaluate(cloth.state.x, cloth.state.v);
  Vec3s damped(rest.size(), Vec3::Zero()), expected(rest.size(), Vec3::Zero());
  threads.add_forces(damped);
  threads.subtract_stiffness(rest, cloth.state.v, expected);
  EXPECT_LT((flat(damped) - flat(f) - flat(expected)).norm(), 1e-12 * flat(damped).norm());
  EXPECT_GT(flat(expected).norm(), 1e-6);
}

TEST(EdgeThreads, TheMatrixIsTheDerivativeOfPulledThreadsAndNeverIndefinite) {
  for (const bool pulled : {true, false}) {
    Finished cloth = crumpled_and_finished(0.001);
    for (Vec3& x : cloth.state.x) x *= pulled ? 1.2 : 0.8;
    Elements elements(cloth.model);
    EdgeThreads threads(cloth.model, *elements.pattern());
    const Vec3s rest(cloth.state.x.size(), Vec3::Zero());
    threads.evaluate(cloth.state.x, rest);
    BlockMatrix<double> K(elements.pattern());
    for (Block<double>& block : K.blocks()) block = Block<double>::from(Mat3::Zero());
    for (Index i = 0; i < K.rows(); ++i) K.grounded(i).setZero();
    threads.assemble(1, K);  // h^2 K + h D
    K.update_diagonal();
    const Eigen::MatrixXd dense = K.to_dense();
    EXPECT_GT(dense.norm(), 1);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues().minCoeff(), -1e-9 * dense.norm());

    // K u against the product, and for pulled threads against the forces' own derivative.
    test::Random random(9);
    Vec3s u;
    for (std::size_t i = 0; i < rest.size(); ++i) u.push_back(random.vector(1));
    Vec3s product(rest.size(), Vec3::Zero());
    threads.subtract_stiffness(u, u, product);
    EXPECT_LT((dense * flat(u) + flat(product)).norm(), 1e-12 * flat(product).norm());
    if (!pulled) continue;
    Vec3s stiffness(rest.size(), Vec3::Zero());
    threads.subtract_stiffness(u, {}, stiffness);
    const auto force_along = [&](const Eigen::VectorXd& s) {
      Vec3s x = cloth.state.x;
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += s[0] * u[i];
      threads.evaluate(x, rest);
      Vec3s f(rest.size(), Vec3::Zero());
      threads.add_forces(f);
      return flat(f);
    };
    const FiniteDifference difference = finite_difference(force_along, Eigen::VectorXd::Zero(1), 0.01);
    EXPECT_LT((difference.derivative.col(0) - flat(stiffness)).norm(), 1e-6 * flat(stiffness).norm());
  }
}

TEST(EdgeThreads, TakePartInTheForcesAndMatrixOfACloth) {
  for (const BendElement element : {BendElement::plate, BendElement::hinge}) {
    const Finished cloth = crumpled_and_finished(0.004, element);
    ASSERT_EQ(cloth.model.threads.size(), cloth.model.mesh.finished.size());
    ClothModel without = cloth.model;
    without.threads.clear();
    Elements all(cloth.model), bare(without);
    EdgeThreads threads(cloth.model, *all.pattern());
    all.evaluate(cloth.model, cloth.state);
    bare.evaluate(without, cloth.state);
    threads.evaluate(cloth.state.x, cloth.state.v);
    Vec3s f(cloth.state.x.size()), g(cloth.state.x.size());
    all.forces(f);
    bare.forces(g);
    threads.add_forces(g);
    EXPECT_EQ(flat(f), flat(g));
    EXPECT_NEAR(all.energy_J(), bare.energy_J() + threads.energy_J(), 1e-15);
    BlockMatrix<double> A(all.pattern()), B(bare.pattern());
    all.assemble(0.01, A);
    bare.assemble(0.01, B);
    threads.assemble(0.01, B);
    B.update_diagonal();
    EXPECT_EQ(A.to_dense(), B.to_dense());
  }
}

// z = S_uu u^2/2 + S_vv v^2/2 + S_uv u v, finished along u: E = EI S_uu^2/2 per length from the middle of the first edge to that of the last.
TEST(LineMoments, OfConstantCurvatureAreExactAndOfThatAlongTheLineOnly) {
  test::Sheet sheet = test::equilateral_sheet(0.12, 0.12, 0.02);
  test::Random random(7);
  for (std::size_t t = 0; t < sheet.mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {  // skew triangles; sides stay where they are
      Vec2& uv = sheet.mesh.uv[t][k];
      const double bump = uv.x() * (0.12 - uv.x()) * uv.y() * (0.12 - uv.y());
      uv += bump * Vec2(90, 40);
      sheet.x[at(sheet.mesh.triangles[t][k])] = Vec3(uv.x(), 0, -uv.y());
    }
  }
  const ClothMesh plain = sheet.mesh;
  test::finish_sides(sheet, 0.12, {0, 0, hem_m, tape_m}, false);
  const Fabric fabric = test::elastic_cotton();
  const double EI = line_stiffness(fabric, {1, 0}, {hem_m, tape_m}).bend_N_m2;
  for (const BendElement element : {BendElement::plate, BendElement::hinge}) {
    ModelOptions options;
    options.bend_element = element;
    const ClothModel with = build_model(sheet.mesh, {&fabric, 1}, options),
                     without = build_model(plain, {&fabric, 1}, options);
    ASSERT_EQ(with.line_bends.size(), 5U);
    const Eigen::MatrixXd K = test::bending_stiffness(with, sheet.x) - test::bending_stiffness(without, sheet.x);
    for (const Vec3& S : {Vec3(3, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 4), Vec3(1, -2, 3)}) {
      Eigen::VectorXd z(static_cast<Eigen::Index>(sheet.x.size()));
      for (std::size_t i = 0; i < sheet.x.size(); ++i) {
        const double u = sheet.x[i].x(), v = -sheet.x[i].z();
        z[static_cast<Eigen::Index>(i)] = 0.5 * S[0] * u * u + 0.5 * S[1] * v * v + S[2] * u * v;
      }
      const double expected = 0.5 * EI * S[0] * S[0] * 0.1;
      EXPECT_NEAR(0.5 * z.dot(K * z), expected, 1e-9 * EI) << S.transpose();
    }
  }
}

TEST(LineMoments, TurnAtACornerAndGoOnAcrossASeam) {
  const auto joints = [](bool all_sides, bool two_panels) {
    test::Sheet sheet = test::equilateral_sheet(0.1, 0.1, 0.02);
    if (two_panels) {
      test::add_panel(sheet, "second", [](const Vec2& p) { return p.x() > 0.05; });
      for (std::size_t t = 0; t < sheet.mesh.triangles.size(); ++t)  // drawn elsewhere, and turned
        if (sheet.mesh.panel[t] == 1)
          for (Vec2& uv : sheet.mesh.uv[t]) uv = Vec2(3 - uv.y(), 1 + uv.x());
    }
    test::finish_sides(sheet, 0.1, {0, 0, hem_m, 0}, false);
    if (all_sides)
      for (const Triangle& t : sheet.mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
          if (sheet.x[at(t[k])].x() > 0.1 - 1e-9 && sheet.x[at(t[(k + 1) % 3])].x() > 0.1 - 1e-9)
            sheet.mesh.finished.push_back({t[k], t[(k + 1) % 3], hem_m, 0});
    const Fabric fabric;
    return build_model(sheet.mesh, {&fabric, 1}).line_bends.size();
  };
  const std::size_t rows = 6;  // of the right-hand side's edges
  EXPECT_EQ(joints(false, false), 4U);
  EXPECT_EQ(joints(true, false), 4U + rows - 1);
  EXPECT_EQ(joints(false, true), 4U);
}

TEST(LineMoments, ForcesAreMinusTheGradientOfTheEnergy) {
  for (const BendElement element : {BendElement::plate, BendElement::hinge}) {
    Finished cloth = crumpled_and_finished(0.004, element);
    Elements elements(cloth.model);
    const Vec3s rest(cloth.state.x.size(), Vec3::Zero());
    const auto energy = [&](const Eigen::VectorXd& x) {
      elements.evaluate(cloth.model, {unflat(x), rest});
      return elements.energy_J();
    };
    test::Random random(12);
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * rest.size()));
    for (Eigen::Index i = 0; i < direction.size(); ++i) direction[i] = random(-1, 1);
    const Eigen::VectorXd x = flat(cloth.state.x);
    constexpr double step = 1e-7;
    const double slope = (energy(x + step * direction) - energy(x - step * direction)) / (2 * step);
    energy(x);
    Vec3s f(rest.size());
    elements.forces(f);
    EXPECT_NEAR(slope, -flat(f).dot(direction), 1e-5 * flat(f).norm());
    // A step's matrix is as stiff for them, and follows a panel's share of stiffness.
    std::vector<double> before;
    for (const BendRest& bend : cloth.model.bend) before.push_back(bend.plate_N_m);
    set_panel_stiffness(cloth.model, 0, {1, 1, 3});
    for (std::size_t h = 0; h < before.size(); ++h)
      EXPECT_NEAR(cloth.model.bend[h].plate_N_m, 3 * before[h], 1e-9 * before[h] + 1e-18);
    const double three = line_stiffness_N_m(cloth.model, cloth.model.line_bends.front());
    EXPECT_NEAR(three, 3 * cloth.model.line_bends.front().stiffness_N_m, 1e-12 * three);
  }
}

TEST(EdgeThreads, FollowRestStretchAndTheSharesOfStiffness) {
  Finished cloth = crumpled_and_finished(0);
  const Vec3s rest(cloth.state.x.size(), Vec3::Zero());
  EdgeThreads threads(cloth.model, *Elements(cloth.model).pattern());
  threads.evaluate(cloth.state.x, rest);
  EXPECT_NEAR(threads.energy_J(), 0, 1e-18);
  // Ten edges of 2 cm, along the warp, that want to be a tenth shorter: E = K (1/b - 1)^2 b L / 2.
  set_panel_rest_stretch(cloth.model, 0, {0.9, 1});
  threads.pack(cloth.model);
  threads.evaluate(cloth.state.x, rest);
  const double K = cloth.model.threads[0].stretch_N, expected = 0.5 * K * (1 / 0.9 - 1) * (1 / 0.9 - 1) * 0.9 * 0.2;
  EXPECT_NEAR(threads.energy_J(), expected, 1e-9 * expected);
  set_panel_stiffness(cloth.model, 0, {3, 1, 1});
  threads.pack(cloth.model);
  threads.evaluate(cloth.state.x, rest);
  EXPECT_NEAR(threads.energy_J(), 3 * expected, 1e-9 * expected);
  set_finishes(cloth.model, 0.5);
  threads.pack(cloth.model);
  threads.evaluate(cloth.state.x, rest);
  EXPECT_NEAR(threads.energy_J(), 1.5 * expected, 1e-9 * expected);
}

TEST(EdgeThreads, WeighWhatTheirClothWeighs) {
  test::Sheet sheet = test::equilateral_sheet(0.1, 0.1, 0.02);
  const Fabric fabric;
  const ClothModel plain = build_model(sheet.mesh, {&fabric, 1});
  test::finish_sides(sheet, 0.1, {0, 0, hem_m, tape_m}, false);
  const ClothModel finished = build_model(sheet.mesh, {&fabric, 1});
  const auto mass = [](const ClothModel& model) {
    return std::accumulate(model.mass_kg.begin(), model.mass_kg.end(), 0.0);
  };
  EXPECT_NEAR(mass(finished) - mass(plain), 0.1 * 2 * (hem_m + tape_m) * fabric.density_kg_per_m2, 1e-12);
}

}  // namespace
}  // namespace toile::internal
