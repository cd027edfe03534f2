#include "solver/vector_kernels.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <vector>

#include "support/every_target.hpp"
#include "support/sheets.hpp"

namespace toile::internal {
namespace {

template <class T>
struct Vectors {
  std::vector<Lane<T>> s, As, c, q, w, r;
  std::vector<Block<T>> G;
  Vec3s basis;                   // (1, u, v)
  std::vector<Index> aggregate;  // neighbours in runs of three, of four aggregates again and again
  std::array<double, 5> sums{};
  std::array<double, 36> moments{};

  Vectors(Index size, std::uint64_t seed) {
    test::Random random(seed);
    for (auto* of : {&s, &As, &c, &q, &w, &r}) {
      for (Index i = 0; i < size; ++i) {
        const Vec3 v = random.vector(1);
        of->push_back(to_lane<T>(v.cast<float>().cast<double>()));
      }
    }
    for (Index i = 0; i < size; ++i) {
      Mat3 m;
      m << random.vector(1), random.vector(1), random.vector(1);
      G.push_back(Block<T>::from(m.cast<float>().cast<double>()));
    }
    for (Index i = 0; i < size; ++i) {
      const Vec3 uv = random.vector(1);
      basis.emplace_back(1, uv.x(), uv.y());
      aggregate.push_back(i / 3 % 4);
    }
  }
  void iterate(Index begin, Index end) {
    add_moments(begin, end, r.data(), As.data(), basis.data(), aggregate.data(), moments.data());
    sums[0] = residual_norm2(begin, end, G.data(), r.data());
    sums[1] = dot_lanes(begin, end, r.data(), s.data());
    sums[2] = next_direction(begin, end, true, T(0.5), s.data(), As.data(), c.data(), q.data());
    sums[3] = next_direction(begin, end, false, T(0.5), s.data(), As.data(), c.data(), q.data());
    sums[4] = next_residual(begin, end, T(0.25), c.data(), q.data(), G.data(), w.data(), r.data());
  }
};

// All remainders of four, from the middle of vectors: what lies outside stays as it was.
TEST(VectorKernels, DoInFloatWhatTheReferenceDoesInDouble) {
  for (Index size = 0; size <= 9; ++size) {
    const Index begin = 3, end = begin + size, all = end + 4;
    Vectors<float> got(all, 1);
    Vectors<double> wanted(all, 1);
    got.iterate(begin, end);
    wanted.iterate(begin, end);
    for (std::size_t k = 0; k < got.sums.size(); ++k)
      EXPECT_NEAR(got.sums[k], wanted.sums[k], 2e-6 * (1 + size)) << size << ", sum " << k;
    for (std::size_t k = 0; k < got.moments.size(); ++k)
      EXPECT_NEAR(got.moments[k], wanted.moments[k], 1e-6) << size << ", moment " << k;
    const auto expect_near = [&](const std::vector<Lane<float>>& a, const std::vector<Lane<double>>& b) {
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT((to_vec3(a[i]) - to_vec3(b[i])).norm(), 1e-6) << size << i;
    };
    expect_near(got.c, wanted.c);
    expect_near(got.q, wanted.q);
    expect_near(got.w, wanted.w);
    expect_near(got.r, wanted.r);
  }
}

TEST(VectorKernels, GiveTheSameBitsOnEveryInstructionSet) {
  const Vectors<float> start(103, 2);
  Vectors<float> widest = start;
  widest.iterate(2, 101);
  const int targets = test::on_every_target([&](const char* name) {
    Vectors<float> v = start;
    v.iterate(2, 101);
    EXPECT_EQ(v.sums, widest.sums) << name;
    EXPECT_EQ(v.moments, widest.moments) << name;
    EXPECT_EQ(std::memcmp(v.r.data(), widest.r.data(), v.r.size() * sizeof v.r[0]), 0) << name;
    EXPECT_EQ(std::memcmp(v.w.data(), widest.w.data(), v.w.size() * sizeof v.w[0]), 0) << name;
  });
  EXPECT_GE(targets, 2);
}

}  // namespace
}  // namespace toile::internal
