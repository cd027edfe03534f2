#include "core/parallel.hpp"

#include "core/pool_order.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace toile {

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
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
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

}  // namespace toile
