// core/team.hpp: a few threads that work in step, for loops too short to be handed out as tasks.
//
// One iteration of the linear solver is some hundred microseconds with half a dozen places where all must have arrived; a
// scheduler's fork and join at each would cost as much as the work.  So its threads are taken once for a whole run, from the pool of
// core/parallel.hpp: threads of its own would share a core with the pool's, which look for work for a while after every loop.
// Members wait by spinning, and give their core away when the wait grows long: on a machine with other work a spinning member would
// keep the one it waits for from running.
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

  // work(member, present) on every member that is present at once; returns when all have returned.  Threads of the pool that do not come
  // soon have other work, and are left out: what is done must not depend on how many do it.  `work` must not throw, and all members
  // must pass the same barriers.
  void run(const std::function<void(int member, int present)>& work);

  // How often a member has waited so long that it gave its core away, since the last call.  Many: the machine has other work, and one
  // member alone would be faster.
  int take_long_waits() { return long_waits_.exchange(0, std::memory_order_relaxed); }

  // Inside run: waits until every member is here.  What each wrote before is seen by all after.
  void barrier();

 private:
  void join();
  void wait_until(const std::atomic<unsigned>& value, unsigned differs_from);

  int members_;
  const std::function<void(int, int)>* work_ = nullptr;
  std::unique_ptr<Tasks> tasks_;
  std::atomic<unsigned> came_{0};  // of the others, to this run; with a bit that says that it has begun
  int present_ = 1;                // in this run, with the caller
  std::atomic<int> arrived_{0};
  std::atomic<unsigned> passed_{0};  // barriers passed
  std::atomic<unsigned> begun_{0};   // runs
  std::atomic<int> long_waits_{0};
};

}  // namespace toile::internal
