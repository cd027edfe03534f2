// core/team.hpp: a team of threads with barriers, for loops too short for a fork and join each.
//
// One iteration of the linear solver takes some hundred microseconds and has half a dozen barriers; a scheduler's fork and join at
// each would cost as much as the work.  So its threads are taken once for a whole run, from the pool of core/parallel.hpp: threads
// of its own would share a core with the pool's, which spin for a while after every loop.
// Members wait by spinning, and yield their core when the wait grows long: on a busy machine a spinning member would keep the
// member that it waits for from running.
#pragma once
#include "core/tasks.hpp"

#include <atomic>
#include <functional>
#include <memory>

namespace toile::internal {

class Team {
 public:
  explicit Team(int members);  // at most; the caller is member 0
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int members() const { return members_; }

  // Runs work(member, present) on every member that is present at the same time; returns when all have returned.  Threads of the pool
  // that do not come soon are busy, and are left out: the result must not depend on the number present.  `work` must not throw, and all
  // members must pass the same barriers.
  void run(const std::function<void(int member, int present)>& work);

  // How often a member has waited so long that it yielded its core, since the last call.  Many: the machine is busy, and one member
  // alone would be faster.
  int take_long_waits() { return long_waits_.exchange(0, std::memory_order_relaxed); }

  // Inside run: waits until every member is here.  Writes before it are visible to all members after it.
  void barrier();

 private:
  void join();
  void wait_until(const std::atomic<unsigned>& value, unsigned differs_from);

  int members_;
  const std::function<void(int, int)>* work_ = nullptr;
  std::unique_ptr<Tasks> tasks_;
  std::atomic<unsigned> came_{0};  // the other members that have come to this run, and a bit: it has begun
  int present_ = 1;                // in this run, with the caller
  std::atomic<int> arrived_{0};
  std::atomic<unsigned> passed_{0};  // barriers passed
  std::atomic<unsigned> begun_{0};   // runs
  std::atomic<int> long_waits_{0};
};

}  // namespace toile::internal
