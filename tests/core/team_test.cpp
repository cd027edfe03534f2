#include "core/team.hpp"

#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace toile::internal {
namespace {

TEST(Team, EveryMemberThatIsPresentWorksOnceInEachRun) {
  for (const int members : {1, 2, 5}) {
    with_threads(members, [&] {
      Team team(members);
      for (int run = 0; run < 50; ++run) {
        std::vector<int> visits(static_cast<std::size_t>(members), 0), told(visits);
        team.run([&](int member, int present) {
          ++visits[static_cast<std::size_t>(member)];
          told[static_cast<std::size_t>(member)] = present;
        });
        const int present = told[0];
        ASSERT_GE(present, 1);
        ASSERT_LE(present, members);
        for (int member = 0; member < members; ++member) {
          EXPECT_EQ(visits[static_cast<std::size_t>(member)], member < present ? 1 : 0) << members << " members";
          EXPECT_EQ(told[static_cast<std::size_t>(member)], member < present ? present : 0) << members << " members";
        }
      }
    });
  }
}

// As often as a thread of the pool has nothing else to do; were it never, a run would be on one thread for ever.
TEST(Team, ThreadsOfThePoolComeAndDoNotStandInTheWayOfItsLoops) {
  with_threads(2, [] {
    Team team(2);
    int together = 0;
    long sum = 0;
    for (int run = 0; run < 100000 && together < 10; ++run) {
      team.run([&](int member, int present) {
        if (member == 0 && present == 2) ++together;
        team.barrier();
      });
      std::vector<long> numbers(1000);
      parallel_for(numbers.size(), 10, [&](std::size_t i) { numbers[i] = 1; });
      sum += std::accumulate(numbers.begin(), numbers.end(), 0L) - 1000;
    }
    EXPECT_EQ(together, 10);
    EXPECT_EQ(sum, 0);
  });
}

// Where the pool has no thread to lend, the caller does it all.
TEST(Team, WhereNobodyComesTheCallerWorksAlone) {
  with_threads(1, [] {
    Team team(3);
    int runs = 0;
    for (int run = 0; run < 5; ++run) {
      team.run([&](int member, int present) {
        EXPECT_EQ(member, 0);
        EXPECT_EQ(present, 1);
        team.barrier();
        ++runs;
      });
    }
    EXPECT_EQ(runs, 5);
  });
}

TEST(Team, WhatWasWrittenBeforeABarrierIsSeenByAllAfterIt) {
  for (const int members : {1, 2, 5}) {
    with_threads(members, [&] {
      Team team(members);
      const auto n = static_cast<std::size_t>(members);
      std::vector<long> own(n, 0), sums(n, 0);
      constexpr long rounds = 200;
      int came = 0;
      team.run([&](int member, int present) {
        const auto me = static_cast<std::size_t>(member);
        if (member == 0) came = present;
        for (long round = 1; round <= rounds; ++round) {
          own[me] = round * (member + 1);
          team.barrier();
          sums[me] += std::accumulate(own.begin(), own.end(), 0L);
          team.barrier();
        }
      });
      const long expected = rounds * (rounds + 1) / 2 * came * (came + 1) / 2;
      for (int member = 0; member < came; ++member) EXPECT_EQ(sums[static_cast<std::size_t>(member)], expected);
    });
  }
}

}  // namespace
}  // namespace toile::internal
