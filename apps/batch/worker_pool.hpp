// apps/batch/worker_pool.hpp: a number of workers at a time.
#pragma once
#include "job_file.hpp"
#include "worker.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace toile::internal {

struct PoolTask {
  std::vector<std::string> words;
  JobLimits limits;
  std::size_t tag = 0;  // whose it is
};

struct PoolCalls {
  std::function<std::optional<PoolTask>()> next;  // asked when a process is free; empty: nothing is left
  // One has ended; what it returns is started in its place.
  std::function<std::optional<PoolTask>(const PoolTask&, const WorkerEnd&)> ended;
  std::function<void()> meanwhile;  // every tenth of a second or so
  std::function<bool()> stop;       // true: no task begins, and those that run are asked to end
};

// Returns when all have ended.
void run_pool(int processes, const PoolCalls& calls);

// Codes of tasks that were stopped, in docs/reason-codes.md.
inline constexpr const char* stopped_with_the_batch = "interrupted";
inline constexpr const char* stopped_by_its_limit = "limit_seconds";

}  // namespace toile::internal
