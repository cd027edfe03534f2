// core/tasks.hpp: tasks of the pool of core/parallel.hpp that run beside their caller; for core/team.hpp.
#pragma once
#include "core/pool_order.hpp"

#include <memory>

namespace toile::internal {

class Tasks {
 public:
  Tasks();
  ~Tasks();  // after wait()
  Tasks(const Tasks&) = delete;
  Tasks& operator=(const Tasks&) = delete;

  // Runs work(of) at some time before wait() returns.  Allocates nothing.
  void run(void (*work)(void*), void* of);
  void wait();

 private:
  struct Group;
  std::unique_ptr<Group> group_;
  PoolOrder order_;
};

}  // namespace toile::internal
