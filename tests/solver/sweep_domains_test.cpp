// The sweeps against a dense solve in the same order, and against themselves on every instruction set there is.
#include "solver/sweep_domains.hpp"

#include "solver/coarse_space.hpp"
#include "solver/crumpled_problem.hpp"
#include "support/every_target.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

namespace toile {
namespace {

using test::Problem;

template <class T>
using Lanes = std::vector<Lane<T>>;

// In the range of S, as every residual is.
template <class T>
Lanes<T> some_residual(const Problem<T>& p) {
  test::Random random(4);
  Lanes<T> r;
  for (Index i = 0; i < p.A.rows(); ++i) r.push_back(to_lane<T>(p.constraints.S(i) * random.vector(1e-3)));
  return r;
}

// Few particles in one domain, or 2,900 in two.
template <class T>
struct Swept : Problem<T> {
  explicit Swept(bool large) : Swept(large ? 1.0 : 0.16, large ? 1.0 : 0.16) {}
  Swept(double width_m, double height_m)
      : Problem<T>(test::equilateral_sheet(width_m, height_m, 0.02), 1.0 / 60, 0.002),
        r(some_residual<T>(*this)),
        s(r.size()),
        As(r.size()) {
    domains.cut(this->A.pattern());
    sweep();
  }
  void sweep() {
    domains.update(this->system);
    for (std::size_t d = 0; d < domains.count(); ++d) domains.sweep(this->system, d, r, s, As);
    for (std::size_t d = 0; d < domains.count(); ++d) {
      domains.add_between(d, s, As);
      domains.filter(this->system, d, As);
    }
  }
  SweepDomains<T> domains;
  Lanes<T> r, s, As;
};

template <class T>
void expect_the_dense_sweep(double width_m, double height_m, double tolerance) {
  Swept<T> p(width_m, height_m);
  p.rows.clear();
  p.system.update(p.rows, p.constraints);
  p.sweep();
  const Index n = p.A.rows();
  ASSERT_EQ(p.domains.count(), 1u);
  // Row k of each of four strips, of which the first may have a row more, at the same time k.
  const auto time = [n](Index i) {
    Index begin = 0;
    for (Index strip = 0;; ++strip) {
      const Index rows = n / 4 + (strip < n % 4 ? 1 : 0);
      if (i < begin + rows) return i - begin;
      begin += rows;
    }
  };
  std::vector<Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return time(i) < time(j); });
  const Eigen::MatrixXd dense = p.A.to_dense();
  Eigen::MatrixXd S = Eigen::MatrixXd::Identity(3 * n, 3 * n);
  for (Index i = 0; i < n; ++i) S.block<3, 3>(3 * i, 3 * i) = p.constraints.S(i);
  // y_i = G_i (r_i - sum A_ij y_j) over earlier j,  s_i = y_i - G_i sum A_ij s_j over later ones
  Eigen::VectorXd y(3 * n), s(3 * n), r(3 * n);
  for (const Index i : order) {
    r.segment<3>(3 * i) = to_vec3(p.r[static_cast<std::size_t>(i)]);
    Vec3 left = r.segment<3>(3 * i);
    for (Index j = 0; j < n; ++j)
      if (time(j) < time(i)) left -= dense.block<3, 3>(3 * i, 3 * j) * y.segment<3>(3 * j);
    y.segment<3>(3 * i) = p.system.filtered_inverse(i) * left;
  }
  for (auto row = order.rbegin(); row != order.rend(); ++row) {
    const Index i = *row;
    Vec3 sum = Vec3::Zero();
    for (Index j = 0; j < n; ++j)
      if (time(j) > time(i)) sum += dense.block<3, 3>(3 * i, 3 * j) * s.segment<3>(3 * j);
    s.segment<3>(3 * i) = y.segment<3>(3 * i) - p.system.filtered_inverse(i) * sum;
  }
  const Eigen::VectorXd As = S * (dense * s);
  double s_error = 0, As_error = 0;
  for (Index i = 0; i < n; ++i) {
    s_error += (to_vec3(p.s[static_cast<std::size_t>(i)]) - s.segment<3>(3 * i)).squaredNorm();
    As_error += (to_vec3(p.As[static_cast<std::size_t>(i)]) - As.segment<3>(3 * i)).squaredNorm();
  }
  EXPECT_LT(std::sqrt(s_error), tolerance * s.norm());
  EXPECT_LT(std::sqrt(As_error), tolerance * As.norm());
}

// A square, and bands of which four strips are shorter than the matrix is wide, so that blocks couple rows of one time.
TEST(SweepDomains, SweepsAsADenseMatrixWould) {
  for (const auto& [width_m, height_m] : {std::pair(0.16, 0.16), std::pair(0.5, 0.06), std::pair(0.06, 0.5)}) {
    SCOPED_TRACE(width_m);
    expect_the_dense_sweep<double>(width_m, height_m, 1e-12);
    expect_the_dense_sweep<float>(width_m, height_m, 1e-5);
  }
}

// Of patterns without any order, from a single row on: each block of two times once, at the earlier of its rows, and none twice at once.
TEST(StripRows, HoldEveryBlockOnceAndNeverAddToAParticleTwiceAtATime) {
  test::Random random(7);
  for (Index n = 1; n <= 45; ++n) {
    std::vector<std::pair<Index, Index>> links;
    const auto any = [&] { return std::min(n - 1, static_cast<Index>((0.5 + random.vector(0.5).x()) * n)); };
    for (Index k = 0; k < 4 * n; ++k) {
      const Index i = any(), j = any();
      if (i != j) links.emplace_back(i, j);
    }
    BlockMatrix<float> A(std::make_shared<const BlockPattern>(n, links));
    for (Slot slot = 0; slot < A.pattern().block_count(); ++slot) {
      Mat3 block;
      block << random.vector(1), random.vector(1), random.vector(1);
      A.below(slot) = Block<float>::from(block);
    }
    std::array<Index, strips_at_once + 1> begin{};
    for (Index strip = 0; strip < 4; ++strip)
      begin[static_cast<std::size_t>(strip) + 1] =
          begin[static_cast<std::size_t>(strip)] + n / 4 + (strip < n % 4 ? 1 : 0);
    StripRows rows;
    rows.arrange(A.pattern(), begin);
    rows.copy(A);
    const Strips strips = rows.strips();
    std::vector<std::pair<Index, Index>> held;
    for (Index k = 0; k < strips.rows; ++k) {
      for (std::int32_t at = strips.begin[k]; at < strips.begin[k + 1]; ++at) {
        const auto& to = strips.column[at].offset;
        for (std::size_t strip = 0; strip < strips_at_once; ++strip) {
          const Index i = strips.first[strip] + k, j = to[strip] / 4;
          EXPECT_EQ(std::count(std::begin(to), std::end(to), to[strip]), 1) << n << ": " << i << ", " << j;
          if (i == j) continue;  // none
          EXPECT_LT(k, rows.time(j));
          held.emplace_back(std::min(i, j), std::max(i, j));
          const Block<float>& below = A.below(A.pattern().slot(std::min(i, j), std::max(i, j)));
          const Block<float> wanted = i < j ? below : below.transpose();
          const Lane<float> columns[3] = {wanted.c0, wanted.c1, wanted.c2};
          for (std::size_t r = 0; r < 3; ++r)
            EXPECT_EQ(to_vec3(strips.block[at].row[r][strip]), to_vec3(columns[r])) << n << ": " << i << ", " << j;
        }
      }
    }
    std::vector<std::pair<Index, Index>> wanted;
    for (Index i = 0; i < n; ++i) {
      for (Slot slot = A.pattern().first_slot(i); slot < A.pattern().end_slot(i); ++slot)
        if (rows.time(i) != rows.time(A.pattern().column(slot))) wanted.emplace_back(i, A.pattern().column(slot));
    }
    std::sort(held.begin(), held.end());
    EXPECT_EQ(held, wanted) << n;
  }
}

TEST(SweepDomains, ReadTheBlocksAgainWhenTheyHaveChanged) {
  Swept<float> p(false);
  const Lanes<float> before = p.s;
  for (Slot slot = 0; slot < p.A.pattern().block_count(); ++slot)
    p.A.below(slot) = Block<float>::from(0.5 * p.A.below(slot).to_mat3());
  p.A.update_diagonal();
  p.system.update(p.rows, p.constraints);
  p.sweep();
  Swept<float> fresh(false);
  fresh.A = p.A;
  fresh.system.update(fresh.rows, fresh.constraints);
  fresh.domains = {};
  fresh.domains.cut(fresh.A.pattern());
  fresh.sweep();
  EXPECT_NE(std::memcmp(before.data(), p.s.data(), p.s.size() * sizeof p.s[0]), 0);
  EXPECT_EQ(std::memcmp(fresh.s.data(), p.s.data(), p.s.size() * sizeof p.s[0]), 0);
}

TEST(SweepDomains, GiveTheSameBitsOnEveryInstructionSet) {
  for (const bool large : {false, true}) {
    Swept<float> p(large);
    CoarseSpace<float> coarse(p.model.mesh);
    coarse.factorise(p.system);
    const Lanes<float> s = p.s, As = p.As;
    std::vector<std::vector<double>> part(1, std::vector<double>(static_cast<std::size_t>(coarse.dimension())));
    coarse.restrict(0, p.A.rows(), p.r, As, part[0]);
    CoarseSpace<float>::Solution solution;
    coarse.solve(part, solution);
    Lanes<float> t = s, At = As, Zy(s.size());
    coarse.prolong(solution, 0, p.A.rows(), Zy);
    coarse.add(solution, 0, p.A.rows(), Zy, t, At);
    const auto same = [](const Lanes<float>& a, const Lanes<float>& b) {
      return std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
    };
    const int targets = test::on_every_target([&](const char* name) {
      p.s.assign(p.s.size(), Lane<float>{});
      p.As = p.s;
      p.sweep();
      EXPECT_TRUE(same(p.s, s)) << name;
      EXPECT_TRUE(same(p.As, As)) << name;
      std::vector<std::vector<double>> again(1, std::vector<double>(part[0].size()));
      coarse.restrict(0, p.A.rows(), p.r, p.As, again[0]);
      EXPECT_EQ(again, part) << name;
      coarse.solve(again, solution);
      coarse.prolong(solution, 0, p.A.rows(), Zy);
      coarse.add(solution, 0, p.A.rows(), Zy, p.s, p.As);
      EXPECT_TRUE(same(p.s, t)) << name;
      EXPECT_TRUE(same(p.As, At)) << name;
    });
    EXPECT_GE(targets, 1);
  }
}

}  // namespace
}  // namespace toile
