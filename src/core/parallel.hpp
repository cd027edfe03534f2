// core/parallel.hpp: parallel loops whose result does not depend on the number of threads.
//
// Work is cut into blocks of a fixed size, never into "as many parts as threads".  A body that writes
// only to its own indices, and reductions that add the blocks in order, give the same bits on 1 or 64 threads.
#pragma once
#include <cstddef>
#include <functional>

namespace toile::internal {

// Calls body(begin, end) for consecutive blocks of `grain` indices that cover [0, count).
void parallel_blocks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

// body(i) for every i in [0, count), in blocks of `grain`.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, Body&& body) {
  parallel_blocks(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

// Runs `work` with at most `threads` threads (0: one per core) for the parallel loops inside it.
void with_threads(int threads, const std::function<void()>& work);

// The number of threads that the caller's loops may use.
int available_threads();

// Cores that the system lets this process use.
int usable_cores();

// Starts that many threads (0: one per core) for later loops, or as many as the system gives, and returns their number, the caller included.
// Without it they start when they are first needed, and a thread that is refused then ends the program.
int start_threads(int threads);

}  // namespace toile::internal
