#include "solver/block_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <vector>

#include "support/every_target.hpp"
#include "support/sheets.hpp"

namespace toile::internal {
namespace {

constexpr Eigen::Index side = BlockCholesky::side;
using Couples = std::vector<std::pair<Index, Index>>;

// A strip of aggregates, each beside the next, and one contact from end to end, named twice.
Couples strip_with_a_contact(Index blocks) {
  Couples couples;
  for (Index p = 0; p + 1 < blocks; ++p) couples.emplace_back(p, p + 1);
  couples.emplace_back(1, blocks - 2);
  couples.emplace_back(1, blocks - 2);
  return couples;
}

// sum of G_c G_c^T over couples, each on the eighteen directions of its two, + a multiple of one.  Those of `still` are empty.
Eigen::MatrixXd couple(BlockCholesky& E, Index blocks, const Couples& couples, const std::vector<Index>& still = {}) {
  test::Random random(5);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(side * blocks, side * blocks);
  dense.diagonal().setConstant(0.1);
  for (const auto& [p, q] : couples) {
    Eigen::MatrixXd G(side * blocks, 6);
    G.setZero();
    for (Eigen::Index r = 0; r < side; ++r) {
      for (Eigen::Index c = 0; c < 6; ++c) {
        G(side * p + r, c) = random.vector(1).x();
        G(side * q + r, c) = random.vector(1).y();
      }
    }
    dense += G * G.transpose();
  }
  for (const Index k : still) {
    dense.row(k).setZero();
    dense.col(k).setZero();
  }
  E.begin(blocks, couples);
  const auto set = [&](Index p, Index q) {
    for (Eigen::Index r = 0; r < side; ++r) {
      for (Eigen::Index c = 0; c < side; ++c) E.block(p, q)[side * r + c] = dense(side * p + r, side * q + c);
    }
  };
  for (Index p = 0; p < blocks; ++p) set(p, p);
  for (const auto& [p, q] : couples) set(p, q);
  return dense;
}

Eigen::VectorXd any(Eigen::Index size) {
  test::Random random(6);
  Eigen::VectorXd b(size);
  for (double& element : b) element = random.vector(1).z();
  return b;
}

std::vector<double> solve(const BlockCholesky& E, const Eigen::VectorXd& b) {
  std::vector<double> x(b.begin(), b.end());
  E.solve(x);
  return x;
}

TEST(BlockCholesky, SolvesAsADenseOneWould) {
  BlockCholesky E;
  for (const Index blocks : {Index(4), Index(9), Index(40)}) {
    const Couples couples = strip_with_a_contact(blocks);
    const Eigen::MatrixXd dense = couple(E, blocks, couples);
    const Eigen::VectorXd b = any(dense.rows()), wanted = dense.llt().solve(b);
    E.factorise();
    const std::vector<double> x = solve(E, b);
    for (Eigen::Index k = 0; k < b.size(); ++k) EXPECT_NEAR(x[static_cast<std::size_t>(k)], wanted[k], 1e-9) << k;
  }
}

// Rows so wide that their products are shared out; then other couples, on the same object.
TEST(BlockCholesky, SolvesWhereAllAreCoupledAndWhenFewerAreAgain) {
  BlockCholesky E;
  const Index blocks = 30;
  Couples all;
  for (Index p = 0; p < blocks; ++p) {
    for (Index q = p + 1; q < blocks; ++q) all.emplace_back(p, q);
  }
  for (const Couples& couples : {all, strip_with_a_contact(blocks), all}) {
    const Eigen::MatrixXd dense = couple(E, blocks, couples);
    const Eigen::VectorXd b = any(dense.rows());
    E.factorise();
    const std::vector<double> x = solve(E, b);
    const Eigen::VectorXd left = dense * Eigen::Map<const Eigen::VectorXd>(x.data(), b.size()) - b;
    EXPECT_LT(left.norm(), 1e-9 * b.norm());
  }
}

// Of n aggregates in a row each couples with the next: no block fills up, but those that the contact brings, one per row between.
TEST(BlockCholesky, StoresWhatFillsUpAndNoMore) {
  BlockCholesky E;
  const Index blocks = 50;
  Couples couples = strip_with_a_contact(blocks);
  E.begin(blocks, couples);
  EXPECT_EQ(E.stored_blocks(), static_cast<std::size_t>(blocks + (blocks - 1) + (blocks - 4)));
  couples.resize(static_cast<std::size_t>(blocks - 1));
  E.begin(blocks, couples);
  EXPECT_EQ(E.stored_blocks(), static_cast<std::size_t>(blocks + (blocks - 1)));
}

TEST(BlockCholesky, LeavesOutDirectionsInWhichNothingMoves) {
  BlockCholesky E;
  const std::vector<Index> still{0, 13, 14, 35};
  const Eigen::MatrixXd dense = couple(E, 4, strip_with_a_contact(4), still);
  Eigen::VectorXd b = any(dense.rows());
  E.factorise();
  const std::vector<double> x = solve(E, b);
  for (const Index k : still) {
    EXPECT_EQ(x[static_cast<std::size_t>(k)], 0) << k;
    b[k] = 0;
  }
  EXPECT_LT((dense * Eigen::Map<const Eigen::VectorXd>(x.data(), b.size()) - b).norm(), 1e-9 * b.norm());
}

TEST(BlockCholesky, GivesTheSameBitsOnEveryInstructionSet) {
  BlockCholesky E;
  const auto solved = [&] {
    const Eigen::MatrixXd dense = couple(E, 16, strip_with_a_contact(16), {20});
    E.factorise();
    return solve(E, any(dense.rows()));
  };
  const std::vector<double> widest = solved();
  EXPECT_GE(test::on_every_target([&](const char* name) { EXPECT_EQ(solved(), widest) << name; }), 2);
}

}  // namespace
}  // namespace toile::internal
