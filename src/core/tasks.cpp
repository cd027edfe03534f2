#include "core/tasks.hpp"

#include <tbb/task_group.h>

namespace toile::internal {

struct Tasks::Group {
  tbb::task_group tasks;
};

Tasks::Tasks() : group_(std::make_unique<Group>()) {}
Tasks::~Tasks() = default;

void Tasks::run(void (*work)(void*), void* of) {
  order_.hand_out();
  group_->tasks.run([this, work, of] {
    order_.take();
    work(of);
    order_.give_back();
  });
}

void Tasks::wait() {
  group_->tasks.wait();
  order_.all_done();
}

}  // namespace toile::internal
