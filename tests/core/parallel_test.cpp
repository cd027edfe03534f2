#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace toile::internal {
namespace {

constexpr int thread_counts[] = {1, 2, 5};

TEST(ParallelFor, VisitsEveryIndexOnceWithAnyNumberOfThreads) {
  for (const int threads : thread_counts) {
    for (const std::size_t count :
         {std::size_t{1}, std::size_t{63}, std::size_t{64}, std::size_t{65}, std::size_t{10007}}) {
      std::vector<std::atomic<int>> visits(count);
      with_threads(threads, [&] { parallel_for(count, 64, [&](std::size_t i) { ++visits[i]; }); });
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(visits[i], 1) << "index " << i << ", threads " << threads;
    }
  }
}

TEST(ParallelBlocks, AreTheSameWithAnyNumberOfThreads) {
  std::set<std::pair<std::size_t, std::size_t>> expected;
  for (std::size_t begin = 0; begin < 1000; begin += 48)
    expected.emplace(begin, std::min<std::size_t>(1000, begin + 48));
  for (const int threads : thread_counts) {
    std::mutex mutex;
    std::set<std::pair<std::size_t, std::size_t>> blocks;
    with_threads(threads, [&] {
      parallel_blocks(1000, 48, [&](std::size_t begin, std::size_t end) {
        const std::lock_guard<std::mutex> lock(mutex);
        EXPECT_TRUE(blocks.emplace(begin, end).second);
      });
    });
    EXPECT_EQ(blocks, expected) << threads << " threads";
  }
}

TEST(ParallelBlocks, SumTheSameBitsWithAnyNumberOfThreads) {
  // A sum whose last bits depend on where it is cut.
  constexpr std::size_t count = 100003, grain = 256;
  const auto sum = [&] {
    std::vector<double> parts((count + grain - 1) / grain);
    parallel_blocks(count, grain, [&](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i) part += 1.0 / static_cast<double>(1 + i * i % 7919);
      parts[begin / grain] = part;
    });
    double total = 0;
    for (const double part : parts) total += part;
    return total;
  };
  std::vector<double> sums;
  for (const int threads : thread_counts) with_threads(threads, [&] { sums.push_back(sum()); });
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_EQ(sums[0], sums[2]);
}

TEST(ParallelBlocks, DoNothingForNothing) {
  parallel_blocks(0, 16, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelBlocks, TakeAGrainOfZeroForOne) {
  std::atomic<int> visits = 0;
  parallel_blocks(7, 0, [&](std::size_t begin, std::size_t end) { visits += static_cast<int>(end - begin); });
  EXPECT_EQ(visits, 7);
}

TEST(ParallelFor, HandsAnExceptionToTheCaller) {
  for (const int threads : thread_counts) {
    EXPECT_THROW(with_threads(threads,
                              [] {
                                parallel_for(1000, 8, [](std::size_t i) {
                                  if (i == 517) throw std::runtime_error("517");
                                });
                              }),
                 std::runtime_error);
  }
}

#ifdef TOILE_THREAD_SANITIZER
// Or what core/pool_order.hpp says of the pool would hide what it is there to show.
TEST(ThreadSanitizerDeathTest, SeesTwoBlocksThatWriteToOnePlace) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(with_threads(2,
                            [] {
                              long shared = 0;
                              parallel_blocks(1000, 1, [&](std::size_t begin, std::size_t) {
                                shared += static_cast<long>(begin);
                                std::this_thread::sleep_for(std::chrono::microseconds(10));
                              });
                              std::exit(shared == 0 ? 1 : 0);  // 66 where it has seen one
                            }),
               "data race");
}
#endif

TEST(WithThreads, LimitsTheLoopsInside) {
  for (const int threads : thread_counts) {
    int available = 0;
    with_threads(threads, [&] { available = available_threads(); });
    EXPECT_EQ(available, threads);
  }
}

TEST(WithThreads, TakesZeroForOnePerCore) {
  int available = 0;
  with_threads(0, [&] { available = available_threads(); });
  EXPECT_GE(available, 1);
}

}  // namespace
}  // namespace toile::internal
