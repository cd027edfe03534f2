// The modified PCG against dense solves: solution, constraints, constraint forces, and every way in which it can end.
#include "solver/modified_pcg.hpp"

#include "core/parallel.hpp"
#include "solver/crumpled_problem.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

constexpr std::array preconditioners = {Preconditioner::diagonal, Preconditioner::block_jacobi,
                                        Preconditioner::block_ssor, Preconditioner::block_ssor_coarse};

using test::error_against_dense;
using test::Problem;

TEST(ModifiedPcg, AgreesWithADenseSolveForEveryPreconditioner) {
  for (const Preconditioner preconditioner : preconditioners) {
    Problem<double> p;
    ModifiedPcg<double> pcg(p.model.mesh);
    const PcgOptions options{preconditioner, 1e-11, 5000};
    pcg.prepare(p.system, options);
    Vec3s dv(p.b.size(), Vec3::Zero());
    const PcgReport report = pcg.solve(p.system, p.b, p.reference, options, dv);
    EXPECT_TRUE(report) << to_string(preconditioner) << ": " << report.explain();
    EXPECT_LT(error_against_dense(p, dv), 1e-7) << to_string(preconditioner);
  }
}

TEST(ModifiedPcg, FloatReachesWhatTheStopRuleAsks) {
  for (const Preconditioner preconditioner : preconditioners) {
    Problem<float> p;
    ModifiedPcg<float> pcg(p.model.mesh);
    const PcgOptions options{preconditioner, 1e-5, 5000};
    pcg.prepare(p.system, options);
    Vec3s dv(p.b.size(), Vec3::Zero());
    const PcgReport report = pcg.solve(p.system, p.b, p.reference, options, dv);
    EXPECT_TRUE(report) << to_string(preconditioner) << ": " << report.explain();
    EXPECT_LT(error_against_dense(p, dv), 1e-3) << to_string(preconditioner);
  }
}

TEST(ModifiedPcg, ConstraintsAreExactAtEveryIterationCount) {
  for (const Preconditioner preconditioner : preconditioners) {
    for (const int limit : {0, 1, 5, 50}) {
      Problem<float> p;
      ModifiedPcg<float> pcg(p.model.mesh);
      const PcgOptions options{preconditioner, 1e-12, limit};
      pcg.prepare(p.system, options);
      test::Random random(9);
      Vec3s dv(p.b.size());
      for (Vec3& dv_i : dv) dv_i = random.vector(1);  // a bad guess must not break them either
      const PcgReport report = pcg.solve(p.system, p.b, p.reference, options, dv);
      if (limit < 50) {
        EXPECT_EQ(report.status, PcgStatus::iteration_limit);
      }
      for (const Index i : p.constraints.constrained()) {
        const Mat3 held = Mat3::Identity() - p.constraints.S(i);
        EXPECT_LT((held * dv[static_cast<std::size_t>(i)] - p.constraints.z(i)).norm(), 1e-15)
            << limit << " iterations, particle " << i;
      }
    }
  }
}

TEST(ModifiedPcg, StopsWhereSinglePrecisionGetsNoFurther) {
  for (const Preconditioner preconditioner : preconditioners) {
    Problem<float> p;
    ModifiedPcg<float> pcg(p.model.mesh);
    const PcgOptions options{preconditioner, 1e-12, 5000};
    pcg.prepare(p.system, options);
    Vec3s dv(p.b.size(), Vec3::Zero());
    const PcgReport report = pcg.solve(p.system, p.b, p.reference, options, dv);
    EXPECT_TRUE(report) << report.explain();
    EXPECT_LT(error_against_dense(p, dv), 1e-3) << to_string(preconditioner);
  }
}

TEST(ModifiedPcg, TheResidualIsTheConstraintForceOfTheDenseSolve) {
  Problem<double> p;
  ModifiedPcg<double> pcg(p.model.mesh);
  const PcgOptions options{Preconditioner::block_ssor_coarse, 1e-11, 5000};
  pcg.prepare(p.system, options);
  Vec3s dv(p.b.size(), Vec3::Zero()), e(p.b.size());
  ASSERT_TRUE(pcg.solve(p.system, p.b, p.reference, options, dv));
  p.system.multiply_unfiltered(dv, e);
  Eigen::VectorXd exact_dv, exact_e;
  p.dense(exact_dv, exact_e);
  ASSERT_GT(exact_e.norm(), 1e-4);
  for (std::size_t i = 0; i < e.size(); ++i) {
    EXPECT_LT((e[i] - p.b[i] - exact_e.segment<3>(3 * static_cast<Eigen::Index>(i))).norm(), 1e-6 * exact_e.norm())
        << "particle " << i;
  }
}

// With the constraints as rows N^T dv = c of a saddle point: [A N; N^T 0] [dv; lambda] = [b; c].  No S, no z.
TEST(ModifiedPcg, TheResidualIsMinusTheMultiplierOfADenseSaddlePoint) {
  Problem<double> p;
  const Eigen::MatrixXd A = p.system.to_dense();
  const Eigen::Index n = A.rows();
  struct Held {
    Index particle;
    Vec3 along;
    double c;
  };
  const std::array<Held, 6> held = {{{0, Vec3(1, 0, 0), 0.1},
                                     {0, Vec3(0, 1, 0), -0.2},
                                     {0, Vec3(0, 0, 1), 0.3},
                                     {5, Vec3(1, 2, 2) / 3, 0.25},
                                     {9, Vec3(0, 1, 0), -0.5},
                                     {9, Vec3(0.6, 0.8, 0), 0.125}}};
  const auto m = static_cast<Eigen::Index>(held.size());
  Eigen::MatrixXd saddle = Eigen::MatrixXd::Zero(n + m, n + m);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(n + m);
  saddle.topLeftCorner(n, n) = A;
  for (Eigen::Index k = 0; k < m; ++k) {
    const Held& row = held[static_cast<std::size_t>(k)];
    saddle.block<3, 1>(3 * row.particle, n + k) = row.along;
    saddle.block<1, 3>(n + k, 3 * row.particle) = row.along.transpose();
    rhs[n + k] = row.c;
  }
  for (std::size_t i = 0; i < p.b.size(); ++i) rhs.segment<3>(3 * static_cast<Eigen::Index>(i)) = p.b[i];
  const Eigen::VectorXd solution = saddle.partialPivLu().solve(rhs);
  const Eigen::VectorXd force = -saddle.topRightCorner(n, m) * solution.tail(m);

  ModifiedPcg<double> pcg(p.model.mesh);
  const PcgOptions options{Preconditioner::block_ssor_coarse, 1e-11, 5000};
  pcg.prepare(p.system, options);
  Vec3s dv(p.b.size(), Vec3::Zero()), e(p.b.size());
  ASSERT_TRUE(pcg.solve(p.system, p.b, p.reference, options, dv));
  p.system.multiply_unfiltered(dv, e);
  ASSERT_GT(force.norm(), 1e-4);
  for (std::size_t i = 0; i < e.size(); ++i) {
    const auto row = 3 * static_cast<Eigen::Index>(i);
    EXPECT_LT((dv[i] - solution.segment<3>(row)).norm(), 1e-7 * solution.head(n).norm()) << "particle " << i;
    EXPECT_LT((e[i] - p.b[i] - force.segment<3>(row)).norm(), 1e-6 * force.norm()) << "particle " << i;
  }
}

TEST(ModifiedPcg, AnExactGuessNeedsNoIteration) {
  Problem<double> p;
  ModifiedPcg<double> pcg(p.model.mesh);
  const PcgOptions options{Preconditioner::block_ssor, 1e-3, 1000};
  pcg.prepare(p.system, options);
  Eigen::VectorXd exact, e;
  p.dense(exact, e);
  Vec3s dv(p.b.size());
  for (std::size_t i = 0; i < dv.size(); ++i) dv[i] = exact.segment<3>(3 * static_cast<Eigen::Index>(i));
  EXPECT_EQ(pcg.solve(p.system, p.b, p.reference, options, dv).iterations, 0);
}

TEST(ModifiedPcg, BetterPreconditionersNeedFewerIterations) {
  const test::Sheet sheet = test::equilateral_sheet(0.8, 0.8, 0.02);
  std::array<int, 4> iterations{};
  for (std::size_t k = 0; k < preconditioners.size(); ++k) {
    Problem<float> p(sheet, 1.0 / 60, 0.001);
    ModifiedPcg<float> pcg(p.model.mesh);
    const PcgOptions options{preconditioners[k], 1e-3, 5000};
    pcg.prepare(p.system, options);
    Vec3s dv(p.b.size(), Vec3::Zero());
    const PcgReport report = pcg.solve(p.system, p.b, p.reference, options, dv);
    EXPECT_TRUE(report) << report.explain();
    iterations[k] = report.iterations;
  }
  EXPECT_LT(iterations[1], iterations[0]);
  EXPECT_LT(iterations[2], iterations[1]);
  EXPECT_LT(iterations[3], iterations[2]);
}

// The iteration never multiplies by A' where it sweeps: what it believes of its residual must be what it left.
TEST(ModifiedPcg, TheResidualItStopsAtIsTheTrueOne) {
  const test::Sheet sheet = test::equilateral_sheet(0.8, 0.8, 0.02);
  for (const bool with_rows : {true, false})
    for (const Preconditioner preconditioner : preconditioners) {
      Problem<float> p(sheet, 1.0 / 60, 0.001);
      for (Index i = 100; i < 400; i += 3) p.constraints.hold_along(i, Vec3(0, 0.6, 0.8), 0.1);
      if (!with_rows) p.rows.clear();
      p.system.update(p.rows, p.constraints);
      ModifiedPcg<float> pcg(p.model.mesh);
      const PcgOptions options{preconditioner, 1e-4, 5000};
      pcg.prepare(p.system, options);
      Vec3s dv(p.b.size(), Vec3::Zero()), r(p.b.size());
      const PcgReport report = pcg.solve(p.system, p.b, p.reference, options, dv);
      ASSERT_TRUE(report) << report.explain();
      ASSERT_GT(report.iterations, 10);
      p.system.multiply_unfiltered(dv, r);
      double sum = 0;
      for (std::size_t i = 0; i < r.size(); ++i) {
        r[i] -= p.b[i];
        sum += r[i].dot(p.system.filtered_inverse(static_cast<Index>(i)) * r[i]);
      }
      EXPECT_LT(std::sqrt(sum), 1.02 * report.target) << to_string(preconditioner) << (with_rows ? ", rows" : "");
    }
}

// Also where the coarse modes of several aggregates, rows and constraints meet.
TEST(ModifiedPcg, DeflationLeavesNoResidualInATranslationOfTheWholeSheet) {
  Problem<float> p(test::equilateral_sheet(0.8, 0.8, 0.02), 1.0 / 60, 0.001);
  p.constraints.clear();
  p.constraints.hold_along(9, Vec3(0, 1, 0), -0.5);
  p.system.update(p.rows, p.constraints);
  ModifiedPcg<float> pcg(p.model.mesh);
  const PcgOptions options{Preconditioner::block_ssor_coarse, 0.05, 5000};
  pcg.prepare(p.system, options);
  Vec3s dv(p.b.size(), Vec3::Zero()), r(p.b.size());
  ASSERT_TRUE(pcg.solve(p.system, p.b, p.reference, options, dv));
  p.system.multiply_unfiltered(dv, r);
  Vec3 sum = Vec3::Zero();
  double size = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    r[i] = p.constraints.S(static_cast<Index>(i)) * (p.b[i] - r[i]);
    sum += r[i];
    size += r[i].norm();
  }
  // The iteration is in float, the last correction in double.
  EXPECT_LT(sum.norm(), 1e-9 * size);
}

TEST(ModifiedPcg, LoosenMultipliesTheTargetWhateverTermOfTheStopRuleDecides) {
  for (const double tolerance : {1e-4, 0.5}) {  // decided by |b'|, and by gravity or a part of |b'|
    Problem<float> p;
    ModifiedPcg<float> pcg(p.model.mesh);
    PcgOptions options;
    options.tolerance = tolerance;
    pcg.prepare(p.system, options);
    Vec3s dv(p.b.size(), Vec3::Zero());
    const double target = pcg.solve(p.system, p.b, p.reference, options, dv).target;
    options.loosen = 10;
    dv.assign(dv.size(), Vec3::Zero());
    const PcgReport report = pcg.solve(p.system, p.b, p.reference, options, dv);
    EXPECT_DOUBLE_EQ(report.target, 10 * target);
    EXPECT_LE(report.residual, report.target);
  }
}

// Scaling the reference moves |g| against |b'| through all four terms; |b'| stays.
TEST(ModifiedPcg, StopsAtAPartOfGravityUnlessTheLoadDwarfsItOrIsNothingBesideIt) {
  Problem<float> p;
  ModifiedPcg<float> pcg(p.model.mesh);
  PcgOptions options;
  options.tolerance = 1e-2;
  pcg.prepare(p.system, options);
  const auto target = [&](double gravity_over_load) {
    double load2 = 0, gravity2 = 0;
    Vec3s start(p.b.size()), Az(p.b.size());
    for (std::size_t i = 0; i < p.b.size(); ++i) start[i] = p.constraints.z(static_cast<Index>(i));
    p.system.multiply_unfiltered(start, Az);
    for (std::size_t i = 0; i < p.b.size(); ++i) {
      const Mat3& G = p.system.filtered_inverse(static_cast<Index>(i));
      const Vec3 load = p.b[i] - Az[i];
      load2 += load.dot(G * load);
      gravity2 += p.reference[i].dot(G * p.reference[i]);
    }
    Vec3s reference = p.reference, dv(p.b.size(), Vec3::Zero());
    const double scale = gravity_over_load * std::sqrt(load2 / gravity2);
    for (Vec3& g : reference) g *= scale;
    const PcgReport report = pcg.solve(p.system, p.b, reference, options, dv);
    EXPECT_TRUE(report) << report.explain();
    return report.target / std::sqrt(load2);
  };
  EXPECT_NEAR(target(1e-3), 2e-3, 1e-8);  // 0.2 tol |b'|
  EXPECT_NEAR(target(0.2), 4e-3, 1e-8);   // 0.02 |g|
  EXPECT_NEAR(target(2), 1e-2, 1e-8);     // tol |b'|
  EXPECT_NEAR(target(200), 2e-2, 1e-8);   // 1e-4 |g|
  options.tolerance = 1e-4;
  EXPECT_NEAR(target(200), 2e-3, 1e-8);  // 0.1 tol |g|
}

// 2,900 particles are swept in two domains, and rows and held particles lie in both.
template <class T>
struct TwoDomains : Problem<T> {
  TwoDomains() : Problem<T>(test::equilateral_sheet(1, 1, 0.02), 1.0 / 60, 0.002) {
    this->rows.push_back({{100, 2500, 2501, 2560}, {1, -0.5, -0.25, -0.25}, Vec3(0, 1, 0), 0.02, 0});
    this->rows.push_back({{2000, -1, -1, -1}, {1, 0, 0, 0}, Vec3(0.6, 0, 0.8), 0.1, 0});
    this->constraints.hold_along(2600, Vec3(0, 0, 1), 0.3);
    this->constraints.hold(2700, Vec3(0, 0.1, 0));
    this->system.update(this->rows, this->constraints);
  }
};

TEST(ModifiedPcg, TwoDomainsReachTheSolutionToo) {
  for (const Preconditioner preconditioner : {Preconditioner::block_ssor, Preconditioner::block_ssor_coarse}) {
    TwoDomains<double> p;
    SweepDomains<double> domains;
    domains.cut(p.A.pattern());
    ASSERT_EQ(domains.count(), 2u);
    ModifiedPcg<double> pcg(p.model.mesh);
    const PcgOptions options{preconditioner, 1e-9, 5000};
    pcg.prepare(p.system, options);
    const std::size_t n = p.b.size();
    Vec3s dv(n, Vec3::Zero()), r(n);
    const PcgReport report = pcg.solve(p.system, p.b, p.reference, options, dv);
    EXPECT_TRUE(report) << to_string(preconditioner) << ": " << report.explain();
    p.system.multiply_unfiltered(dv, r);
    for (std::size_t i = 0; i < n; ++i) r[i] = p.b[i] - r[i];
    p.constraints.filter(r);
    double left = 0;  // the true residual, which no recurrence, cut or thread has touched
    for (std::size_t i = 0; i < n; ++i) left += r[i].dot(p.system.filtered_inverse(static_cast<Index>(i)) * r[i]);
    EXPECT_LT(std::sqrt(left), 1.01 * report.target) << to_string(preconditioner);
    EXPECT_LT(report.target, 1e-6 * report.initial_residual);
  }
}

TEST(ModifiedPcg, GivesTheSameBitsOnEveryNumberOfThreads) {
  TwoDomains<float> p;
  Vec3s expected;
  for (const int threads : {1, 2, 5}) {
    ModifiedPcg<float> pcg(p.model.mesh);
    Vec3s dv(p.b.size(), Vec3::Zero());
    with_threads(threads, [&] {
      const PcgOptions options;
      pcg.prepare(p.system, options);
      EXPECT_TRUE(pcg.solve(p.system, p.b, p.reference, options, dv));
    });
    if (threads == 1) expected = dv;
    for (std::size_t i = 0; i < dv.size(); ++i) ASSERT_EQ(dv[i], expected[i]) << threads << " threads, particle " << i;
  }
}

TEST(ModifiedPcg, SaysWhenTheMatrixIsNotPositiveDefinite) {
  Problem<double> p;
  p.rows.push_back({{70, 71, -1, -1}, {1, -1, 0, 0}, Vec3(0, 1, 0), -50, 0});
  p.system.update(p.rows, p.constraints);
  ModifiedPcg<double> pcg(p.model.mesh);
  const PcgOptions options{Preconditioner::block_jacobi, 1e-9, 1000};
  pcg.prepare(p.system, options);
  Vec3s dv(p.b.size(), Vec3::Zero());
  const PcgReport report = pcg.solve(p.system, p.b, p.reference, options, dv);
  EXPECT_EQ(report.status, PcgStatus::not_positive_definite) << report.explain();
  EXPECT_NE(report.explain().find("not positive definite"), std::string::npos);
}

TEST(ModifiedPcg, SaysWhenANumberIsNotFinite) {
  Problem<float> p;
  p.b[3].x() = std::numeric_limits<double>::quiet_NaN();
  ModifiedPcg<float> pcg(p.model.mesh);
  const PcgOptions options;
  pcg.prepare(p.system, options);
  Vec3s dv(p.b.size(), Vec3::Zero());
  EXPECT_EQ(pcg.solve(p.system, p.b, p.reference, options, dv).status, PcgStatus::not_finite);
}

TEST(ModifiedPcg, AFullyHeldClothIsSolvedByItsConstraintsAlone) {
  Problem<float> p;
  for (Index i = 0; i < p.A.rows(); ++i) p.constraints.hold(i, Vec3(0.5, 0, -1));
  p.system.update(p.rows, p.constraints);
  ModifiedPcg<float> pcg(p.model.mesh);
  const PcgOptions options;
  pcg.prepare(p.system, options);
  Vec3s dv(p.b.size(), Vec3::Zero());
  const PcgReport report = pcg.solve(p.system, p.b, p.reference, options, dv);
  EXPECT_TRUE(report) << report.explain();
  for (const Vec3& dv_i : dv) EXPECT_EQ(dv_i, Vec3(0.5, 0, -1));
}

// Residuals that single precision only has as denormals, of which each would cost a hundred cycles.
TEST(ModifiedPcg, TakesForNothingWhatSinglePrecisionCannotHold) {
  TwoDomains<float> p;
  p.constraints.clear();
  p.system.update({}, p.constraints);
  for (Vec3& b_i : p.b) b_i *= 1e-37;  // of some 1e-5 kg m/s
  const Vec3s weightless(p.b.size(), Vec3::Zero());
  for (const int threads : {1, 2}) {
    Vec3s dv(p.b.size(), Vec3::Zero());
    PcgReport report;
    with_threads(threads, [&] {
      ModifiedPcg<float> pcg(p.model.mesh);
      const PcgOptions options;
      pcg.prepare(p.system, options);
      report = pcg.solve(p.system, p.b, weightless, options, dv);
    });
    EXPECT_TRUE(report) << report.explain();
#if defined(__SSE__)
    EXPECT_EQ(report.iterations, 0) << threads << " threads";
    for (const Vec3& dv_i : dv) ASSERT_EQ(dv_i, Vec3(0, 0, 0)) << threads << " threads";
#endif
  }
  volatile float tiny = 1e-20f;
  EXPECT_GT(tiny * tiny, 0) << "the caller's own arithmetic";
}

// What it keeps between the passes of a step must not show.
TEST(ModifiedPcg, ASecondPrepareGivesTheBitsOfAFirst) {
  Problem<float> p;
  PcgOptions options;
  options.tolerance = 1e-5;
  ModifiedPcg<float> kept(p.model.mesh);
  const auto solve = [&](ModifiedPcg<float>& pcg) {
    pcg.prepare(p.system, options);
    Vec3s dv(p.b.size(), Vec3::Zero());
    EXPECT_TRUE(pcg.solve(p.system, p.b, p.reference, options, dv));
    return dv;
  };
  const auto expect_the_same = [&](const char* after) {
    p.system.update(p.rows, p.constraints);
    ModifiedPcg<float> fresh(p.model.mesh);
    EXPECT_EQ(solve(kept), solve(fresh)) << after;
  };
  expect_the_same("nothing");
  p.constraints.hold_along(33, Vec3(0, 0, 1), 0.1);
  expect_the_same("another particle is held");
  p.constraints.hold_along(33, Vec3(1, 0, 0), 0.1);
  expect_the_same("it loses a second direction");
  p.constraints.clear();
  expect_the_same("all are free");
  p.rows.pop_back();
  expect_the_same("a row less");
  p.constraints.hold_along(5, Vec3(1, 2, 2) / 3, 0.25);
  p.elements.assemble(1.0 / 30, p.A);
  expect_the_same("other blocks");
}

TEST(LinearSystem, ProductsOfHeldParticlesAreThoseOfTheDenseMatrix) {
  Problem<double> p;
  const auto n = static_cast<Eigen::Index>(p.b.size());
  test::Random random(4);
  Vec3s x(p.b.size()), Az(x.size(), Vec3::Ones()), e(x.size(), Vec3::Ones());
  Eigen::VectorXd z(3 * n), x_dense(3 * n), b(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto particle = static_cast<std::size_t>(i);
    x[particle] = random.vector(1);
    x_dense.segment<3>(3 * i) = x[particle];
    b.segment<3>(3 * i) = p.b[particle];
    z.segment<3>(3 * i) = p.constraints.z(static_cast<Index>(i));
  }
  const Eigen::MatrixXd M = p.system.to_dense();
  const Eigen::VectorXd Az_dense = M * z, e_dense = M * x_dense - b;
  p.system.multiply_prescribed(Az);
  p.system.held_residual(x, p.b, e);
  EXPECT_GT(Az_dense.norm(), 0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto particle = static_cast<std::size_t>(i);
    EXPECT_LT((Az[particle] - Az_dense.segment<3>(3 * i)).norm(), 1e-12 * Az_dense.norm()) << i;
    if (p.constraints.is_free(static_cast<Index>(i))) {
      EXPECT_EQ(e[particle], Vec3(Vec3::Zero())) << i;
    } else {
      EXPECT_LT((e[particle] - e_dense.segment<3>(3 * i)).norm(), 1e-12 * e_dense.norm()) << i;
    }
  }
}

TEST(LinearSystem, ItsDiagonalBlocksAreThoseOfTheDenseMatrixRowsIncluded) {
  const Problem<double> problem;
  const Eigen::MatrixXd dense = problem.system.to_dense();
  const std::vector<Mat3> diagonals = problem.system.diagonals();
  for (Index i = 0; i < problem.A.rows(); ++i) {
    const Mat3 block = dense.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(i));
    EXPECT_LT((diagonals[static_cast<std::size_t>(i)] - block).norm(), 1e-12 * block.norm()) << i;
  }
}

}  // namespace
}  // namespace toile::internal
