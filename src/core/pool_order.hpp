// core/pool_order.hpp: tells ThreadSanitizer how the thread pool orders its work (happens-before).
//
// The pool's library is not instrumented, so the order that its atomics make is unknown to the sanitizer: the thread that hands out work
// seems to race with the workers.  In such builds the files that use the library are not instrumented either (src/CMakeLists.txt), and
// state the order here.  Two addresses, not one: tasks that are handed out together are not ordered, and their races must be found.
#pragma once

#ifdef TOILE_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace toile::internal {

class PoolOrder {
 public:
#ifdef TOILE_THREAD_SANITIZER
  void hand_out() { __tsan_release(&out_); }
  void take() { __tsan_acquire(&out_); }
  void give_back() { __tsan_release(&back_); }
  void all_done() { __tsan_acquire(&back_); }

 private:
  char out_ = 0, back_ = 0;
#else
  void hand_out() {}
  void take() {}
  void give_back() {}
  void all_done() {}
#endif
};

}  // namespace toile::internal
