// Additive CCD misses nothing: motions of every kind of ccd_queries.hpp against the exact oracle.
#include "contact/ccd_count.hpp"
#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace toile::internal {
namespace {

using namespace ccd_test;

constexpr std::int64_t block = 250;  // motions with one seed

Count counted(Features features, Kind kind, std::int64_t queries, std::uint64_t seed) {
  std::vector<Count> counts(static_cast<std::size_t>(queries / block));
  parallel_for(counts.size(), 1, [&](std::size_t i) {
    Random random(seed + 1000003 * i + 31 * static_cast<std::uint64_t>(kind) +
                  (features == Features::edge_edge ? 7 : 0));
    for (std::int64_t k = 0; k < block; ++k) {
      const Motion motion = motion_of(random, features, kind);
      counts[i].add(motion, touch_of(motion));
    }
  });
  Count sum;
  for (const Count& count : counts) sum.add(count);
  return sum;
}

// `queries` of each kind and each pair of features.
void expect_none_missed(std::int64_t queries, std::uint64_t seed) {
  Count all;
  for (const Features features : {Features::vertex_face, Features::edge_edge}) {
    for (std::size_t k = 0; k < kind_count; ++k) {
      const Count count = counted(features, static_cast<Kind>(k), queries, seed);
      const std::string name =
          std::string(features == Features::edge_edge ? "edge-edge " : "vertex-face ") + kind_name[k];
      std::cout << count.text(name.c_str()) << std::endl;
      EXPECT_EQ(count.false_negatives, 0) << name;
      EXPECT_EQ(count.late, 0) << name;
      EXPECT_GT(count.touches, count.queries / 100) << name << ": hardly any touch, the kind tests nothing";
      EXPECT_LT(count.touches, count.queries) << name << ": all touch, the kind tests nothing";
      all.add(count);
    }
  }
  std::cout << all.text("all") << '\n';
}

TEST(CcdFalseNegatives, ThereAreNoneInAHundredThousand) { expect_none_missed(3750, 1); }
TEST(CcdFalseNegativesLong, ThereAreNoneInTenMillion) { expect_none_missed(360'000, 2); }

}  // namespace
}  // namespace toile::internal
