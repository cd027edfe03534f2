#include "worker_pool.hpp"

#include <poll.h>

#include <memory>
#include <utility>

namespace toile::internal {
namespace {

// A run ends within a second (process_end.hpp).  The batch itself has two in all when it is interrupted.
constexpr double patience_with_a_limit_s = 5, patience_when_interrupted_s = 1.2;
constexpr int wait_ms = 100;       // until limits and interrupts are looked at again
constexpr int wait_at_end_ms = 2;  // between the last message of a process and its end

struct Running {
  PoolTask task;
  std::unique_ptr<Worker> worker;
};

void start(PoolTask task, std::vector<Running>& running) {
  auto worker = std::make_unique<Worker>(task.words, task.limits.memory_mb);
  running.push_back({std::move(task), std::move(worker)});
}

void wait_for_messages(std::vector<Running>& running) {
  std::vector<pollfd> ready;
  int patience_ms = wait_ms;
  for (const Running& one : running) {
    if (one.worker->messages() < 0) patience_ms = wait_at_end_ms;
    ready.push_back({one.worker->messages(), POLLIN, 0});  // negative descriptors are passed over
  }
  ::poll(ready.data(), ready.size(), patience_ms);
  for (Running& one : running) one.worker->read_messages();
}

void stop_late_ones(std::vector<Running>& running, bool all) {
  for (Running& one : running) {
    const double limit_s = one.task.limits.seconds;
    if (all)
      one.worker->stop(stopped_with_the_batch, patience_when_interrupted_s);
    else if (limit_s > 0 && one.worker->seconds() > limit_s)
      one.worker->stop(stopped_by_its_limit, patience_with_a_limit_s);
  }
}

}  // namespace

void run_pool(int processes, const PoolCalls& calls) {
  std::vector<Running> running;
  bool more = true;
  for (;;) {
    const bool stop = calls.stop();
    while (!stop && more && running.size() < static_cast<std::size_t>(processes)) {
      std::optional<PoolTask> task = calls.next();
      more = task.has_value();
      if (more) start(std::move(*task), running);
    }
    if (running.empty()) return;
    wait_for_messages(running);
    stop_late_ones(running, calls.stop());
    for (std::size_t k = 0; k < running.size();) {
      const std::optional<WorkerEnd> end = running[k].worker->ended();
      if (!end) {
        ++k;
        continue;
      }
      const PoolTask task = std::move(running[k].task);
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(k));
      std::optional<PoolTask> again = calls.ended(task, *end);
      if (again && !calls.stop()) start(std::move(*again), running);
    }
    calls.meanwhile();
  }
}

}  // namespace toile::internal
