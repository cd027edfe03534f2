#include "core/parallel.hpp"

#include "core/pool_order.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

namespace toile::internal {

void parallel_blocks(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t blocks = (count + grain - 1) / grain;
  if (blocks == 1 || tbb::this_task_arena::max_concurrency() == 1) {
    for (std::size_t b = 0; b < blocks; ++b) body(b * grain, std::min(count, (b + 1) * grain));
    return;
  }
  PoolOrder order;
  order.hand_out();
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, blocks, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        order.take();
        for (std::size_t b = range.begin(); b != range.end(); ++b) {
          body(b * grain, std::min(count, (b + 1) * grain));
        }
        order.give_back();
      },
      tbb::simple_partitioner());
  order.all_done();
}

void with_threads(int threads, const std::function<void()>& work) {
  if (threads <= 0) threads = tbb::info::default_concurrency();
  // Only for more than one per core: it holds for the whole process, and another thread of the caller's may have asked for fewer.
  std::optional<tbb::global_control> limit;
  if (threads > tbb::info::default_concurrency())
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  PoolOrder order;
  order.hand_out();
  arena.execute([&] {  // on a thread of the pool, where the caller's is not one of the arena's
    order.take();
    work();
    order.give_back();
  });
  order.all_done();
}

int available_threads() { return tbb::this_task_arena::max_concurrency(); }

int usable_cores() { return tbb::info::default_concurrency(); }

namespace {

// The largest number of threads at once, the caller included.
int threads_given(int wanted) {
  std::mutex mutex;
  std::condition_variable counted;
  bool done = false;
  std::vector<std::thread> others;
  others.reserve(static_cast<std::size_t>(wanted));
  try {
    while (static_cast<int>(others.size()) + 1 < wanted)
      others.emplace_back([&] {
        std::unique_lock lock(mutex);
        counted.wait(lock, [&] { return done; });
      });
  } catch (const std::system_error&) {  // refused: use the threads that there are
  }
  {
    const std::lock_guard lock(mutex);
    done = true;
  }
  counted.notify_all();
  for (std::thread& other : others) other.join();
  return static_cast<int>(others.size()) + 1;
}

}  // namespace

int start_threads(int threads) {
  if (threads <= 0) threads = usable_cores();
  threads = threads_given(threads);
  with_threads(threads, [&] {
    // All take part in one loop, or have had a tenth of a second to come.
    constexpr std::chrono::milliseconds most_wait(100);
    const auto end = std::chrono::steady_clock::now() + most_wait;
    std::atomic<int> here{0};
    parallel_for(static_cast<std::size_t>(threads), 1, [&](std::size_t) {
      ++here;
      while (here < threads && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    });
  });
  return threads;
}

}  // namespace toile::internal
