// The gathered system of a whole cloth: against naive scatter, finite differences, and the invariances of physics.
#include "assembly/elements.hpp"

#include "core/parallel.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <cstring>

namespace toile::internal {
namespace {

using test::Sheet;

struct Cloth {
  ClothModel model;
  ClothState state;
};

Cloth crumpled_cloth(double size_m, std::uint64_t seed, BendElement element = BendElement::plate) {
  const Sheet sheet = test::equilateral_sheet(0.1, 0.1, 0.02);
  Fabric fabric = fabric_preset("cotton", "", "");
  ModelOptions options;
  options.bend_element = element;
  Cloth cloth{build_model(sheet.mesh, {&fabric, 1}, options), {}};
  cloth.state.x = test::crumpled(sheet.x, size_m, seed);
  test::Random random(seed + 1);
  for (std::size_t i = 0; i < sheet.x.size(); ++i) cloth.state.v.push_back(random.vector(0.5));
  return cloth;
}

void set_mass(const ClothModel& model, BlockMatrix<double>& A) {
  for (Index i = 0; i < A.rows(); ++i) A.grounded(i) = model.mass_kg[static_cast<std::size_t>(i)] * Mat3::Identity();
}

// The textbook loop over elements, in the order in which the gather must add.
std::vector<Mat3> scattered_blocks(const Cloth& cloth, const Elements& elements, double h) {
  std::vector<Mat3> blocks(static_cast<std::size_t>(elements.pattern()->block_count()), Mat3::Zero());
  const ClothModel& model = cloth.model;
  for (std::size_t t = 0; t < model.mesh.triangles.size(); ++t) {
    const MembraneResponse& r = elements.membrane(static_cast<Index>(t));
    const FMatrix H{h * h * r.K.uu + h * r.D.uu, h * h * r.K.uv + h * r.D.uv, h * h * r.K.vv + h * r.D.vv};
    for (Eigen::Index a = 0; a < 3; ++a) {
      for (Eigen::Index b = 0; b < 3; ++b) {
        const Index i = model.mesh.triangles[t][static_cast<std::size_t>(a)],
                    j = model.mesh.triangles[t][static_cast<std::size_t>(b)];
        if (i >= j) continue;
        const Vec3 &alpha = model.membrane[t].alpha, &beta = model.membrane[t].beta;
        blocks[static_cast<std::size_t>(elements.pattern()->slot(i, j))] +=
            alpha[a] * alpha[b] * H.uu + alpha[a] * beta[b] * H.uv + beta[a] * alpha[b] * H.uv.transpose() +
            beta[a] * beta[b] * H.vv;
      }
    }
  }
  for (std::size_t k = 0; k < model.topology.hinges.size(); ++k) {
    const Hinge& hinge = model.topology.hinges[k];
    const BendResponse& r = elements.bend(static_cast<Index>(k));
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        if (hinge.particle[a] >= hinge.particle[b]) continue;
        blocks[static_cast<std::size_t>(elements.pattern()->slot(hinge.particle[a], hinge.particle[b]))] +=
            ((h * h + h * model.bend[k].tau_s) * (model.bend[k].kappa_N_m + model.bend[k].plate_N_m) * r.g[a]) *
            r.g[b].transpose();
      }
    }
  }
  return blocks;
}

TEST(Elements, GatherEqualsNaiveScatterToTheBit) {
  const Cloth cloth = crumpled_cloth(0.006, 11);
  Elements elements(cloth.model);
  elements.evaluate(cloth.model, cloth.state);
  BlockMatrix<double> A(elements.pattern());
  set_mass(cloth.model, A);
  elements.assemble(0.01, A);
  const std::vector<Mat3> expected = scattered_blocks(cloth, elements, 0.01);
  for (std::size_t s = 0; s < expected.size(); ++s) {
    const Mat3 got = A.below(static_cast<Slot>(s)).to_mat3().transpose();
    EXPECT_EQ(0, std::memcmp(got.data(), expected[s].data(), sizeof(Mat3))) << "block " << s;
  }
}

TEST(Elements, SameBitsForOneTwoAndFiveThreads) {
  const Cloth cloth = crumpled_cloth(0.006, 12);
  std::vector<std::vector<Vec3>> forces;
  std::vector<Eigen::MatrixXd> matrices;
  for (const int threads : {1, 2, 5}) {
    with_threads(threads, [&] {
      Elements elements(cloth.model);
      elements.evaluate(cloth.model, cloth.state);
      BlockMatrix<double> A(elements.pattern());
      set_mass(cloth.model, A);
      elements.assemble(0.01, A);
      Vec3s f(cloth.state.x.size());
      elements.forces(f);
      forces.push_back(f);
      matrices.push_back(A.to_dense());
    });
  }
  for (std::size_t k = 1; k < forces.size(); ++k) {
    EXPECT_EQ(0, std::memcmp(forces[0].data(), forces[k].data(), forces[0].size() * sizeof(Vec3)));
    EXPECT_EQ(0, std::memcmp(matrices[0].data(), matrices[k].data(),
                             static_cast<std::size_t>(matrices[0].size()) * sizeof(double)));
  }
}

TEST(Elements, ForceIsMinusTheGradientOfTheEnergy) {
  Cloth cloth = crumpled_cloth(0.004, 13);
  for (Vec3& v : cloth.state.v) v.setZero();
  Elements elements(cloth.model);
  elements.evaluate(cloth.model, cloth.state);
  Vec3s f(cloth.state.x.size());
  elements.forces(f);
  double largest = 0;
  for (const Vec3& f_i : f) largest = std::max(largest, f_i.cwiseAbs().maxCoeff());
  ASSERT_GT(largest, 1e-3);
  for (const std::size_t i : {std::size_t{0}, std::size_t{7}, std::size_t{20}}) {
    for (int c = 0; c < 3; ++c) {
      double best = 1e300;
      for (const double step : {1e-5, 1e-6, 1e-7, 1e-8}) {
        const double x = cloth.state.x[i][c];
        cloth.state.x[i][c] = x + step;
        elements.evaluate(cloth.model, cloth.state);
        const double up = elements.energy_J();
        cloth.state.x[i][c] = x - step;
        elements.evaluate(cloth.model, cloth.state);
        const double down = elements.energy_J();
        cloth.state.x[i][c] = x;
        best = std::min(best, std::abs(-(up - down) / (2 * step) - f[i][c]));
      }
      EXPECT_LT(best, 1e-6 * largest) << "particle " << i << " axis " << c;
    }
  }
}

TEST(Elements, InternalForcesHaveNoNetForceAndNoNetTorque) {
  const Cloth cloth = crumpled_cloth(0.008, 14);
  Elements elements(cloth.model);
  elements.evaluate(cloth.model, cloth.state);
  Vec3s f(cloth.state.x.size());
  elements.forces(f);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double size = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    force += f[i];
    torque += cloth.state.x[i].cross(f[i]);
    size += f[i].norm();
  }
  ASSERT_GT(size, 1);
  EXPECT_LT(force.norm(), 1e-12 * size);
  EXPECT_LT(torque.norm(), 1e-12 * size);
}

TEST(Elements, AIsPositiveDefiniteOnAThousandCrumpledStates) {
  const Sheet sheet = test::equilateral_sheet(0.05, 0.05, 0.0125);
  Fabric fabric = fabric_preset("denim", "", "");
  for (const DampingJacobian jacobian : {DampingJacobian::gauss_newton, DampingJacobian::paper}) {
    ModelOptions options;
    options.damping_jacobian = jacobian;
    const ClothModel model = build_model(sheet.mesh, {&fabric, 1}, options);
    Elements elements(model);
    BlockMatrix<double> A(elements.pattern());
    set_mass(model, A);
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
      ClothState state{test::crumpled(sheet.x, 0.02, seed), {}};
      test::Random random(seed);
      for (std::size_t i = 0; i < sheet.x.size(); ++i) state.v.push_back(random.vector(5));
      elements.evaluate(model, state);
      elements.assemble(1.0 / 30, A);
      const Eigen::LLT<Eigen::MatrixXd> factor(A.to_dense());
      ASSERT_EQ(factor.info(), Eigen::Success) << "seed " << seed;
    }
  }
}

TEST(Elements, AnAffineDeformationLeavesInteriorParticlesWithoutForce) {
  const Sheet sheet = test::equilateral_sheet(0.1, 0.1, 0.02);
  Fabric fabric;
  const ClothModel model = build_model(sheet.mesh, {&fabric, 1});
  Mat3 F;
  F << 1.08, 0.02, 0.03, 0.01, 1, -0.02, 0.05, 0.01, 0.96;
  ClothState state;
  for (const Vec3& p : sheet.x) state.x.push_back(F * p);
  state.v.assign(state.x.size(), Vec3::Zero());
  Elements elements(model);
  elements.evaluate(model, state);
  Vec3s f(state.x.size());
  elements.forces(f);
  std::vector<bool> boundary(state.x.size(), false);
  for (const Edge& edge : model.topology.edges) {
    if (edge.triangle[1] < 0)
      boundary[static_cast<std::size_t>(edge.a)] = boundary[static_cast<std::size_t>(edge.b)] = true;
  }
  double interior = 0, edge = 0;
  for (std::size_t i = 0; i < f.size(); ++i)
    (boundary[i] ? edge : interior) = std::max(boundary[i] ? edge : interior, f[i].norm());
  EXPECT_GT(edge, 1e-2);
  EXPECT_LT(interior, 1e-11 * edge);
}

TEST(Elements, StiffnessTimesADisplacementAgreesWithTheMatrix) {
  const Cloth cloth = crumpled_cloth(0.006, 15);
  Elements elements(cloth.model);
  elements.evaluate(cloth.model, cloth.state);
  BlockMatrix<double> A(elements.pattern());
  const double h = 0.02;
  const auto n = static_cast<Eigen::Index>(3 * cloth.state.x.size());
  // (A(h) - A(2h)/2) / (h^2 - 2 h^2) = K, for A = h D + h^2 K
  elements.assemble(h, A);
  const Eigen::MatrixXd once = A.to_dense();
  elements.assemble(2 * h, A);
  const Eigen::MatrixXd K = (0.5 * A.to_dense() - once) / (h * h);
  Vec3s y(cloth.state.x.size()), f(y.size(), Vec3::Zero());
  test::Random random(3);
  Eigen::VectorXd dense(n);
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i] = random.vector(1);
    dense.segment<3>(3 * static_cast<Eigen::Index>(i)) = y[i];
  }
  elements.subtract_stiffness(y, f);
  const Eigen::VectorXd expected = -K * dense;
  for (std::size_t i = 0; i < y.size(); ++i) {
    EXPECT_LT((f[i] - expected.segment<3>(3 * static_cast<Eigen::Index>(i))).norm(), 1e-9 * expected.norm());
  }
}

TEST(Elements, TheForceOfDampingIsMinusDTimesTheVelocity) {
  const Cloth cloth = crumpled_cloth(0.006, 16, BendElement::hinge);
  Elements elements(cloth.model);
  elements.evaluate(cloth.model, cloth.state);
  BlockMatrix<double> A(elements.pattern());
  const double h = 0.02;
  // A = h D + h^2 K, so (4 A(h) - A(2h))/(2h) = D.
  elements.assemble(h, A);
  const Eigen::MatrixXd once = A.to_dense();
  elements.assemble(2 * h, A);
  const Eigen::MatrixXd D = (4 * once - A.to_dense()) / (2 * h);
  Vec3s moving(cloth.state.x.size()), still(moving.size());
  elements.forces(moving);
  ClothState state = cloth.state;
  for (Vec3& v : state.v) v.setZero();
  elements.evaluate(cloth.model, state);
  elements.forces(still);
  Eigen::VectorXd v(D.rows());
  for (std::size_t i = 0; i < moving.size(); ++i) v.segment<3>(3 * static_cast<Eigen::Index>(i)) = cloth.state.v[i];
  const Eigen::VectorXd expected = -D * v;
  EXPECT_GT(expected.norm(), 0);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const Vec3 force = moving[i] - still[i];
    EXPECT_LT((force - expected.segment<3>(3 * static_cast<Eigen::Index>(i))).norm(), 1e-9 * expected.norm()) << i;
  }
  // The same by subtract_stiffness, of what does not move and has a velocity.
  elements.evaluate(cloth.model, cloth.state);
  Vec3s f(moving.size(), Vec3::Zero());
  elements.subtract_stiffness(Vec3s(f.size(), Vec3::Zero()), cloth.state.v, f);
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_LT((f[i] - expected.segment<3>(3 * static_cast<Eigen::Index>(i))).norm(), 1e-9 * expected.norm()) << i;
}

TEST(BlockMatrix, KeepsATranslationExactInFloat) {
  const Cloth cloth = crumpled_cloth(0.006, 16);
  Elements elements(cloth.model);
  elements.evaluate(cloth.model, cloth.state);
  BlockMatrix<float> A(elements.pattern());
  for (Index i = 0; i < A.rows(); ++i)
    A.grounded(i) = cloth.model.mass_kg[static_cast<std::size_t>(i)] * Mat3::Identity();
  elements.assemble(1.0 / 30, A);
  const Vec3s x(cloth.state.x.size(), Vec3(0.1, -9.81, 3));
  Vec3s y(x.size());
  A.multiply(x, y);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(y[i], cloth.model.mass_kg[i] * x[i]);
}

TEST(BlockMatrix, BalancedProductsOfEveryPieceOfClothAddUpToWhatIsGrounded) {
  constexpr std::size_t first_piece = 4;  // rows 0 to 3, and 4 to 6
  const auto pattern = std::make_shared<const BlockPattern>(
      7, std::vector<std::pair<Index, Index>>{{0, 3}, {3, 1}, {1, 2}, {4, 6}, {6, 5}, {0, 1}});
  EXPECT_EQ(std::vector<Index>(pattern->piece_sizes().begin(), pattern->piece_sizes().end()),
            (std::vector<Index>{4, 3}));
  for (Index i = 0; i < 7; ++i) EXPECT_EQ(pattern->piece(i), i < 4 ? 0 : 1) << i;
  BlockMatrix<float> A(pattern);
  test::Random random(3);
  Vec3s x(7);
  for (Index i = 0; i < 7; ++i) {
    A.grounded(i) = random(1, 2) * Mat3::Identity();
    x[static_cast<std::size_t>(i)] = random.vector(1);
  }
  for (Slot s = 0; s < pattern->block_count(); ++s) {
    Mat3 L = random.vector(1e4) * random.vector(1).transpose();
    A.below(s) = Block<float>::from(L + L.transpose());  // symmetric: what each gives, the other takes
  }
  A.below(0).c0[1] += 1;  // but for this
  A.update_diagonal();
  Vec3s y(7), before;
  A.multiply(x, y);
  before = y;
  A.balance(x, y);
  Vec3 sums[2] = {Vec3::Zero(), Vec3::Zero()}, grounded[2] = {Vec3::Zero(), Vec3::Zero()};
  for (std::size_t i = 0; i < 7; ++i) {
    sums[i / first_piece] += y[i];
    grounded[i / first_piece] += A.grounded(static_cast<Index>(i)) * x[i];
    EXPECT_LT((y[i] - before[i]).norm(), 1) << i;
  }
  for (int piece = 0; piece < 2; ++piece) EXPECT_LT((sums[piece] - grounded[piece]).norm(), 1e-10) << piece;
  EXPECT_GT((y[0] - before[0]).norm(), 1e-3);
  EXPECT_LT((y[4] - before[4]).norm(), 1e-10);
}

TEST(BlockMatrix, ProductEqualsTheDenseOne) {
  const Cloth cloth = crumpled_cloth(0.006, 17);
  Elements elements(cloth.model);
  elements.evaluate(cloth.model, cloth.state);
  BlockMatrix<double> A(elements.pattern());
  BlockMatrix<float> B(elements.pattern());
  set_mass(cloth.model, A);
  for (Index i = 0; i < B.rows(); ++i) B.grounded(i) = A.grounded(i);
  elements.assemble(0.02, A);
  elements.assemble(0.02, B);
  test::Random random(5);
  Vec3s x(cloth.state.x.size()), y(x.size());
  std::vector<Lane<float>> x_float, y_float(x.size());
  Eigen::VectorXd dense(3 * static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = random.vector(1);
    x_float.push_back(to_lane<float>(x[i]));
    dense.segment<3>(3 * static_cast<Eigen::Index>(i)) = x[i];
  }
  A.multiply(x, y);
  B.multiply(x_float, y_float);
  const Eigen::VectorXd expected = A.to_dense() * dense;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 e = expected.segment<3>(3 * static_cast<Eigen::Index>(i));
    EXPECT_LT((y[i] - e).norm(), 1e-12 * expected.norm());
    EXPECT_LT((to_vec3(y_float[i]) - e).norm(), 1e-5 * expected.norm());
  }
}

TEST(ClothModel, MassIsDensityTimesArea) {
  const Sheet sheet = test::equilateral_sheet(0.4, 0.3, 0.05);
  Fabric fabric;
  fabric.density_kg_per_m2 = 0.2;
  const ClothModel model = build_model(sheet.mesh, {&fabric, 1});
  double mass = 0;
  for (const double m : model.mass_kg) mass += m;
  EXPECT_NEAR(mass, 0.2 * 0.4 * 0.3, 1e-12);
}

TEST(ClothModel, BucklesByTheMeanRigidityUnlessItsThreadsAreHeld) {
  Fabric fabric;
  fabric.bend_v_N_m = 3 * fabric.bend_u_N_m;
  const ClothMesh sheet = test::equilateral_sheet(0.1, 0.1, 0.02).mesh;
  ClothModel model = build_model(sheet, {&fabric, 1});
  EXPECT_DOUBLE_EQ(model.stiffness[0].bend, 2 * fabric.bend_u_N_m);
  set_panel_stiffness(model, 0, {.bend = 3});
  EXPECT_DOUBLE_EQ(model.stiffness[0].bend, 6 * fabric.bend_u_N_m);
  ModelOptions paper;
  paper.paper_scaling = true;
  EXPECT_EQ(build_model(sheet, {&fabric, 1}, paper).stiffness[0].bend, 0);
  ModelOptions held;
  held.threads_buckle = false;
  EXPECT_EQ(build_model(sheet, {&fabric, 1}, held).stiffness[0].bend, 0);
  EXPECT_EQ(build_model(sheet, {&fabric, 1}, held).stiffness[0].compression, fabric.compression_ratio);
  fabric.compression_ratio = 1;
  EXPECT_EQ(build_model(sheet, {&fabric, 1}).stiffness[0].bend, 0);
}

}  // namespace
}  // namespace toile::internal
