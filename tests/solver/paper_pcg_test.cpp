// The listing of 1998 as it is printed: that it solves, what it keeps, and what its start and its stop rule get wrong.
#include "solver/paper_pcg.hpp"

#include "solver/crumpled_problem.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

using test::error_against_dense;
using test::Problem;

constexpr std::array readings = {PaperReading::inverse_everywhere, PaperReading::diagonal_of_A,
                                 PaperReading::as_printed};

PcgOptions options_of(double tolerance, int max_iterations) {
  PcgOptions options;
  options.preconditioner = Preconditioner::diagonal;
  options.tolerance = tolerance;
  options.max_iterations = max_iterations;
  return options;
}

TEST(PaperPcg, AgreesWithADenseSolve) {
  Problem<double> p;
  Vec3s dv(p.b.size());
  const PcgReport report = paper_pcg(p.system, p.b, options_of(1e-10, 5000), PaperReading::inverse_everywhere, dv);
  EXPECT_TRUE(report) << report.explain();
  EXPECT_LT(error_against_dense(p, dv), 1e-6);
}

TEST(PaperPcg, ConstraintsAreExactAtEveryIterationCount) {
  for (const PaperReading reading : readings) {
    for (const int limit : {0, 1, 5, 50}) {
      Problem<float> p;
      Vec3s dv(p.b.size());
      const PcgReport report = paper_pcg(p.system, p.b, options_of(1e-12, limit), reading, dv);
      EXPECT_EQ(report.status, PcgStatus::iteration_limit);
      EXPECT_EQ(report.iterations, limit);
      for (const Index i : p.constraints.constrained()) {
        const Mat3 held = Mat3::Identity() - p.constraints.S(i);
        EXPECT_LT((held * dv[static_cast<std::size_t>(i)] - p.constraints.z(i)).norm(), 1e-15)
            << limit << " iterations, particle " << i;
      }
    }
  }
}

int iterations_to(double error, PaperReading reading, int cap) {  // by bisection: an iteration count is all it takes
  int low = 0, high = cap;
  while (low < high) {
    const int middle = (low + high) / 2;
    Problem<double> p;
    Vec3s dv(p.b.size());
    (void)paper_pcg(p.system, p.b, options_of(1e-12, middle), reading, dv);
    if (error_against_dense(p, dv) < error)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

TEST(PaperPcg, ReadAsPrintedItsPreconditionerMakesThingsWorse) {
  const int inverse = iterations_to(1e-3, PaperReading::inverse_everywhere, 3000),
            diagonal = iterations_to(1e-3, PaperReading::diagonal_of_A, 3000),
            printed = iterations_to(1e-3, PaperReading::as_printed, 3000);
  std::printf("iterations to 1e-3: 1/A_ii everywhere %d, P = diag(A) %d, as printed %d\n", inverse, diagonal, printed);
  EXPECT_EQ(diagonal, inverse);  // the same iteration; only its stop differs
  EXPECT_GT(printed, 2 * inverse);
}

TEST(PaperPcg, WithPReadAsTheDiagonalItsStopRuleHasOtherUnits) {
  // In grams instead of kilograms A and b are a thousand times larger, and so is nothing else.
  std::array<int, 2> inverse{}, diagonal{};
  for (std::size_t k = 0; k < 2; ++k) {
    const double unit = k == 0 ? 1 : 1000;
    Problem<double> p;
    for (Slot slot = 0; slot < p.A.pattern().block_count(); ++slot)
      p.A.below(slot) = Block<double>::from(unit * p.A.below(slot).to_mat3());
    for (Index i = 0; i < p.A.rows(); ++i) p.A.grounded(i) *= unit;
    p.A.update_diagonal();
    for (Vec3& b : p.b) b *= unit;
    for (ImplicitRow& row : p.rows) row.a *= unit;
    p.system.update(p.rows, p.constraints);
    Vec3s dv(p.b.size());
    inverse[k] = paper_pcg(p.system, p.b, options_of(1e-3, 5000), PaperReading::inverse_everywhere, dv).iterations;
    diagonal[k] = paper_pcg(p.system, p.b, options_of(1e-3, 5000), PaperReading::diagonal_of_A, dv).iterations;
  }
  std::printf("kg: %d and %d, g: %d and %d\n", inverse[0], diagonal[0], inverse[1], diagonal[1]);
  EXPECT_EQ(inverse[0], inverse[1]);
  EXPECT_GT(diagonal[0], diagonal[1] + 20);
}

// delta_0 is built from b.  What must be solved is b' = S (b - A z): where constraints move, the two have nothing to do with each other.
TEST(PaperPcg, ItsStopRuleNeverEndsWhenAHandMovesUnloadedCloth) {
  Problem<double> p;
  p.b.assign(p.b.size(), Vec3::Zero());  // at rest, weightless: only z drives it
  p.reference = p.b;
  Vec3s dv(p.b.size());
  const PcgReport paper = paper_pcg(p.system, p.b, options_of(1e-3, 400), PaperReading::inverse_everywhere, dv);
  EXPECT_EQ(paper.status, PcgStatus::iteration_limit);
  EXPECT_EQ(paper.target, 0);
  ModifiedPcg<double> pcg(p.model.mesh);
  pcg.prepare(p.system, options_of(1e-3, 400));
  dv.assign(dv.size(), Vec3::Zero());
  const PcgReport ours = pcg.solve(p.system, p.b, p.reference, options_of(1e-3, 400), dv);
  EXPECT_TRUE(ours) << ours.explain();
}

TEST(PaperPcg, ItsStopRuleEndsTooSoonWhereConstraintsBalanceTheLoad) {
  // b = A z + a hundredth of it on the free: dv = z is already close to b, and yet none of the remaining motion is solved for.
  Problem<double> p;
  Vec3s z(p.b.size()), Az(p.b.size());
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = p.constraints.z(static_cast<Index>(i));
  p.system.multiply_unfiltered(z, Az);
  double size = 0, load = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    size += Az[i].squaredNorm();
    load += p.b[i].squaredNorm();
  }
  for (std::size_t i = 0; i < z.size(); ++i) p.b[i] = Az[i] + (1e-4 * std::sqrt(size / load)) * p.b[i];
  Vec3s dv(p.b.size());
  const PcgReport paper = paper_pcg(p.system, p.b, options_of(1e-2, 5000), PaperReading::inverse_everywhere, dv);
  EXPECT_TRUE(paper);
  EXPECT_EQ(paper.iterations, 0);
  ModifiedPcg<double> pcg(p.model.mesh);
  pcg.prepare(p.system, options_of(1e-2, 5000));
  dv.assign(dv.size(), Vec3::Zero());
  p.reference.assign(p.b.size(), Vec3::Zero());
  EXPECT_GT(pcg.solve(p.system, p.b, p.reference, options_of(1e-2, 5000), dv).iterations, 10);
}

TEST(PaperPcg, ALoadOnAHeldParticleChangesNothing) {
  Problem<double> p;
  Vec3s dv(p.b.size());
  const auto iterations = [&] {
    return paper_pcg(p.system, p.b, options_of(1e-3, 5000), PaperReading::inverse_everywhere, dv).iterations;
  };
  const int before = iterations();
  p.b[0] += Vec3(100, 0, 0);
  EXPECT_EQ(iterations(), before);
}

TEST(PaperPcg, ItsStartThrowsAGoodGuessAway) {
  Problem<double> p;
  Eigen::VectorXd exact, e;
  p.dense(exact, e);
  Vec3s guess(p.b.size());
  for (std::size_t i = 0; i < guess.size(); ++i) guess[i] = exact.segment<3>(3 * static_cast<Eigen::Index>(i));
  Vec3s dv = guess;
  EXPECT_GT(paper_pcg(p.system, p.b, options_of(1e-3, 5000), PaperReading::inverse_everywhere, dv).iterations, 20);
  dv = guess;
  ModifiedPcg<double> pcg(p.model.mesh);
  pcg.prepare(p.system, options_of(1e-3, 5000));
  EXPECT_EQ(pcg.solve(p.system, p.b, p.reference, options_of(1e-3, 5000), dv).iterations, 0);
}

TEST(PaperPcg, ModifiedPcgRunsItWhenAskedTo) {
  Problem<float> p;
  PcgOptions options = options_of(1e-3, 5000);
  options.procedure = PcgProcedure::paper_1998;
  Vec3s expected(p.b.size()), dv(p.b.size(), Vec3(1, 2, 3));
  const PcgReport direct = paper_pcg(p.system, p.b, options, PaperReading::inverse_everywhere, expected);
  ModifiedPcg<float> pcg(p.model.mesh);
  pcg.prepare(p.system, options);
  const PcgReport asked = pcg.solve(p.system, p.b, p.reference, options, dv);
  EXPECT_EQ(dv, expected);
  EXPECT_EQ(asked.iterations, direct.iterations);
  EXPECT_GT(asked.iterations, 0);
}

TEST(PaperPcg, SaysWhenItCannotGoOn) {
  Problem<float> p;
  Vec3s dv(p.b.size());
  p.b[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(paper_pcg(p.system, p.b, options_of(1e-3, 100), PaperReading::inverse_everywhere, dv).status,
            PcgStatus::not_finite);
  Problem<double> q;
  q.rows.push_back({{70, 71, -1, -1}, {1, -1, 0, 0}, Vec3(0, 1, 0), -5000, 0});
  q.system.update(q.rows, q.constraints);
  EXPECT_EQ(paper_pcg(q.system, q.b, options_of(1e-9, 1000), PaperReading::inverse_everywhere, dv).status,
            PcgStatus::not_positive_definite);
}

}  // namespace
}  // namespace toile::internal
