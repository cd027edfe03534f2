#include "core/team.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace toile {
namespace {

TEST(Team, EveryMemberWorksOnceInEachRun) {
  for (const int members : {1, 2, 5}) {
    Team team(members);
    std::vector<int> visits(static_cast<std::size_t>(members), 0);
    for (int run = 0; run < 50; ++run) team.run([&](int member) { ++visits[static_cast<std::size_t>(member)]; });
    for (const int count : visits) EXPECT_EQ(count, 50) << members << " members";
  }
}

TEST(Team, WhatWasWrittenBeforeABarrierIsSeenByAllAfterIt) {
  for (const int members : {1, 2, 5}) {
    Team team(members);
    const auto n = static_cast<std::size_t>(members);
    std::vector<long> own(n, 0), sums(n, 0);
    constexpr long rounds = 200;
    team.run([&](int member) {
      const auto me = static_cast<std::size_t>(member);
      for (long round = 1; round <= rounds; ++round) {
        own[me] = round * (member + 1);
        team.barrier();
        sums[me] += std::accumulate(own.begin(), own.end(), 0L);
        team.barrier();
      }
    });
    const long expected = rounds * (rounds + 1) / 2 * members * (members + 1) / 2;
    for (const long sum : sums) EXPECT_EQ(sum, expected) << members << " members";
  }
}

}  // namespace
}  // namespace toile
