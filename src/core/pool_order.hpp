// core/pool_order.hpp: what the thread pool orders, told to ThreadSanitizer.
//
// The pool's library is not instrumented, so what it orders by its own atomics looks like a race of whoever hands out work with whoever does
// it.  In builds with ThreadSanitizer the files that use the library are not instrumented either (src/CMakeLists.txt), and say it here.
// Two addresses, not one: work that is handed out together is not ordered among itself, and races within it are what is looked for.
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
