// The sweeps against the same sweeps block by block, and against themselves on every instruction set there is.
#include "solver/sweep_domains.hpp"

#include "solver/coarse_space.hpp"
#include "solver/crumpled_problem.hpp"
#include "support/every_target.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>

namespace toile::internal {
namespace {

using test::Problem;

template <class T>
using Lanes = std::vector<Lane<T>>;

// In the range of S, as every residual is, by places.
template <class T>
Lanes<T> some_residual(const Problem<T>& p) {
  test::Random random(4);
  Lanes<T> r(static_cast<std::size_t>(p.A.rows()));
  for (Index i = 0; i < p.A.rows(); ++i)
    r[static_cast<std::size_t>(p.A.pattern().place(i))] = to_lane<T>(p.constraints.S(i) * random.vector(1e-3));
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
    As = r;
    for (std::size_t epoch = 0; epoch < domains.epochs(); ++epoch)
      for (std::size_t d = domains.count(); d-- > 0;) domains.forward(this->system, d, epoch, s, As);
    for (std::size_t epoch = domains.epochs(); epoch-- > 0;)
      for (std::size_t d = 0; d < domains.count(); ++d) domains.backward(this->system, d, epoch, s, As);
    for (std::size_t d = 0; d < domains.count(); ++d) domains.finish(this->system, d, s, As);
  }
  // As threads may run: between two barriers the domains one after the other, beginning with `first`, each as far as it can go.  There is no
  // barrier where the way back begins.
  void sweep_ahead(std::size_t first) {
    As = r;
    const auto each = [&](auto&& work) {
      for (std::size_t k = 0; k < domains.count(); ++k) work((first + k) % domains.count());
    };
    const std::size_t last = domains.epochs() - 1;
    for (std::size_t epoch = 0; epoch < last; ++epoch)
      each([&](std::size_t d) { domains.forward(this->system, d, epoch, s, As); });
    each([&](std::size_t d) {
      domains.forward(this->system, d, last, s, As);
      domains.backward(this->system, d, last, s, As);
    });
    for (std::size_t epoch = last; epoch-- > 0;)
      each([&](std::size_t d) { domains.backward(this->system, d, epoch, s, As); });
    each([&](std::size_t d) { domains.finish(this->system, d, s, As); });
  }
  SweepDomains<T> domains;
  Lanes<T> r, s, As;
};

// Contacts of four particles, of two and of one, along one direction and along three, between all parts of the cloth.
template <class T>
void add_contacts(Swept<T>& p, int count) {
  test::Random random(11);
  const auto any = [&] {
    return std::min(p.A.rows() - 1, static_cast<Index>((0.5 + random.vector(0.5).x()) * p.A.rows()));
  };
  for (int k = 0; k < count; ++k) {
    ImplicitRow row{{any(), any(), any(), any()}, {1, -0.5, -0.25, -0.25}, Vec3(1, 0, 0), 0.05 * (1 + k % 3), 0};
    std::sort(row.particle.begin(), row.particle.end());
    if (std::adjacent_find(row.particle.begin(), row.particle.end()) != row.particle.end()) continue;
    if (k % 4 == 1) row = {{row.particle[0], row.particle[3], -1, -1}, {1, -1, 0, 0}, row.direction, row.a, 0};
    if (k % 4 == 2) row = {{row.particle[0], -1, -1, -1}, {1, 0, 0, 0}, row.direction, row.a, 0};
    p.rows.push_back(row);
    if (k % 2 == 0) continue;
    for (const Vec3& direction : {Vec3(0, 0.6, 0.8), Vec3(0, 0.8, -0.6)}) {
      p.rows.push_back(row);
      p.rows.back().direction = direction;
    }
  }
  p.system.update(p.rows, p.constraints);
  p.sweep();
}

// Row k of each of four strips of each domain, of which the first strips may have a row more, at the same time k.
struct Order {
  Order(Index n, Index domains, Index epochs) {
    for (Index d = 0; d < domains; ++d) {
      const Index rows = n * (d + 1) / domains - n * d / domains;
      for (Index strip = 0; strip < 4; ++strip)
        for (Index k = 0; k < rows / 4 + (strip < rows % 4 ? 1 : 0); ++k) {
          time.push_back(k);
          domain.push_back(d);
        }
    }
    const Index times = (n / domains + 1) / 4 + 1;
    for (const Index t : time) {
      Index e = 0;
      while (t >= times * (e + 1) / epochs) ++e;
      epoch.push_back(e);
    }
  }
  bool is_earlier(std::size_t p, std::size_t q) const {
    return domain[p] == domain[q] ? time[p] < time[q] : epoch[p] < epoch[q];
  }
  std::vector<Index> time, domain, epoch;
};

// The blocks of the rows of A + sum a g g^T off the diagonal, by places.
template <class T>
std::vector<std::map<std::size_t, Mat3>> blocks_of(const Swept<T>& p) {
  const BlockPattern& pattern = p.A.pattern();
  std::vector<std::map<std::size_t, Mat3>> blocks(static_cast<std::size_t>(p.A.rows()));
  const auto add = [&](Index i, Index j, const Mat3& block) {
    const auto q = static_cast<std::size_t>(pattern.place(j));
    auto& row = blocks[static_cast<std::size_t>(pattern.place(i))];
    row.try_emplace(q, Mat3::Zero()).first->second += block;
  };
  for (Index i = 0; i < p.A.rows(); ++i) {
    for (Slot slot = pattern.first_slot(i); slot < pattern.end_slot(i); ++slot) {
      add(pattern.column(slot), i, p.A.below(slot).to_mat3());
      add(i, pattern.column(slot), p.A.below(slot).to_mat3().transpose());
    }
  }
  for (const ImplicitRow& row : p.rows) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t l = 0; l < 4; ++l) {
        if (k == l || row.particle[k] < 0 || row.particle[l] < 0) continue;
        add(row.particle[k], row.particle[l],
            (row.a * row.weight[k] * row.weight[l]) * row.direction * row.direction.transpose());
      }
    }
  }
  return blocks;
}

// y_i = G_i (r_i - sum A_ij y_j) over earlier j,  s_i = y_i - G_i sum A_ij s_j over later ones.
template <class T>
void expect_the_sweep_in_order(const Swept<T>& p, double tolerance) {
  const auto n = static_cast<std::size_t>(p.A.rows());
  const Order in(p.A.rows(), static_cast<Index>(p.domains.count()), static_cast<Index>(p.domains.epochs()));
  const auto particle = [&](std::size_t place) { return p.A.pattern().row_at(static_cast<Index>(place)); };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return in.time[a] < in.time[b]; });
  const auto blocks = blocks_of(p);
  Vec3s y(n), s(n), As(n);
  for (const std::size_t i : order) {
    Vec3 left = to_vec3(p.r[i]);
    for (const auto& [j, block] : blocks[i])
      if (in.is_earlier(j, i)) left -= block * y[j];
    y[i] = p.system.filtered_inverse(particle(i)) * left;
  }
  for (auto row = order.rbegin(); row != order.rend(); ++row) {
    Vec3 sum = Vec3::Zero();
    for (const auto& [j, block] : blocks[*row])
      if (in.is_earlier(*row, j)) sum += block * s[j];
    s[*row] = y[*row] - p.system.filtered_inverse(particle(*row)) * sum;
  }
  const std::vector<Mat3> diagonals = p.system.diagonals();
  double s_error = 0, As_error = 0, s2 = 0, As2 = 0;
  for (std::size_t i = 0; i < n; ++i) {
    As[i] = diagonals[static_cast<std::size_t>(particle(i))] * s[i];
    for (const auto& [j, block] : blocks[i]) As[i] += block * s[j];
    As[i] = p.constraints.S(particle(i)) * As[i];
    s_error += (to_vec3(p.s[i]) - s[i]).squaredNorm();
    As_error += (to_vec3(p.As[i]) - As[i]).squaredNorm();
    s2 += s[i].squaredNorm();
    As2 += As[i].squaredNorm();
  }
  EXPECT_LT(std::sqrt(s_error), tolerance * std::sqrt(s2));
  EXPECT_LT(std::sqrt(As_error), tolerance * std::sqrt(As2));
}

// A square, bands of which four strips are shorter than the matrix is wide, so that blocks couple rows of one time, and two domains of two
// epochs; each with few contacts and with many.
TEST(SweepDomains, SweepEveryBlockInItsTime) {
  for (const auto& [width_m, height_m] :
       {std::pair(0.16, 0.16), std::pair(0.5, 0.06), std::pair(0.06, 0.5), std::pair(1.0, 1.0)}) {
    SCOPED_TRACE(width_m);
    Swept<double> fine(width_m, height_m);
    Swept<float> coarse(width_m, height_m);
    EXPECT_EQ(fine.domains.count(), width_m == 1.0 ? 2u : 1u);
    EXPECT_EQ(fine.domains.epochs(), fine.domains.count());
    expect_the_sweep_in_order(fine, 1e-12);
    expect_the_sweep_in_order(coarse, 1e-5);
    add_contacts(fine, 200);
    add_contacts(coarse, 200);
    expect_the_sweep_in_order(fine, 1e-12);
    expect_the_sweep_in_order(coarse, 1e-5);
  }
}

// Couplings that are applied in groups stay within the epoch of their rows; with other lengths of an epoch, groups end elsewhere in it.
TEST(SweepDomains, DoNotDependOnWhichDomainIsAhead) {
  for (const double width_m : {0.9, 0.94, 0.98, 1.0, 1.02, 1.06}) {
    SCOPED_TRACE(width_m);
    Swept<float> p(width_m, 1.0);
    add_contacts(p, 4000);
    ASSERT_EQ(p.domains.count(), 2u);
    const Lanes<float> s = p.s, As = p.As;
    for (std::size_t first = 0; first < p.domains.count(); ++first) {
      p.sweep_ahead(first);
      EXPECT_EQ(std::memcmp(p.s.data(), s.data(), s.size() * sizeof s[0]), 0) << first;
      EXPECT_EQ(std::memcmp(p.As.data(), As.data(), As.size() * sizeof As[0]), 0) << first;
    }
  }
}

// Which of two rows is first does not matter to the sum of their blocks' work, but M has to be symmetric: a.M^-1 b = b.M^-1 a.
TEST(SweepDomains, AreSymmetric) {
  Swept<double> p(true);
  add_contacts(p, 100);
  const Lanes<double> a = p.r, Ma = p.s;
  std::reverse(p.r.begin(), p.r.end());
  for (std::size_t i = 0; i < p.r.size(); ++i)
    p.r[i] = to_lane<double>(p.constraints.S(p.A.pattern().row_at(static_cast<Index>(i))) * to_vec3(p.r[i]));
  p.sweep();
  double ab = 0, ba = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += dot(a[i], p.s[i]);
    ba += dot(p.r[i], Ma[i]);
  }
  EXPECT_NEAR(ab, ba, 1e-12 * std::abs(ab));
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
          const Index i = A.pattern().row_at(strips.first[strip] + k), j = A.pattern().row_at(to[strip] / 4);
          EXPECT_EQ(std::count(std::begin(to), std::end(to), to[strip]), 1) << n << ": " << i << ", " << j;
          if (i == j) continue;  // none
          EXPECT_LT(k, rows.time(to[strip] / 4));
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
        if (const Index j = A.pattern().column(slot);
            rows.time(A.pattern().place(i)) != rows.time(A.pattern().place(j)))
          wanted.emplace_back(i, j);
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
}  // namespace toile::internal
