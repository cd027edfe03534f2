// core/team.hpp: a few threads that work in step, for loops too short to be handed out as tasks.
//
// One iteration of the linear solver is some hundred microseconds with half a dozen places where all must have arrived; a
// scheduler's fork and join at each would cost as much as the work.  Members wait by spinning, and give their core away
// when the wait grows long: on a machine with other work a spinning member would keep the one it waits for from running.
#pragma once
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace toile {

class Team {
 public:
  explicit Team(int members);  // the caller is member 0; starts members - 1 threads, which sleep between runs
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int members() const { return members_; }

  // work(member) on every member at once; returns when all have returned.  `work` must not throw, and all members must pass
  // the same barriers.
  void run(const std::function<void(int member)>& work);

  // How often a member has waited so long that it gave its core away, since the last call.  Many: the machine has other work, and one
  // member alone would be faster.
  int take_long_waits() { return long_waits_.exchange(0, std::memory_order_relaxed); }

  // Inside run: waits until every member is here.  What each wrote before is seen by all after.
  void barrier();

 private:
  void serve(int member);

  int members_;
  const std::function<void(int)>* work_ = nullptr;
  std::atomic<unsigned> started_{0};  // runs begun; the members sleep on it
  std::atomic<int> arrived_{0};
  std::atomic<unsigned> passed_{0};  // barriers passed
  std::atomic<int> long_waits_{0};
  bool over_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace toile
