#include "core/team.hpp"

#include <algorithm>

namespace toile {
namespace {

constexpr int spins = 4000;  // some tens of microseconds

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

Team::Team(int members) : members_(std::max(members, 1)) {
  for (int member = 1; member < members_; ++member) threads_.emplace_back([this, member] { serve(member); });
}

Team::~Team() {
  over_ = true;
  started_.fetch_add(1, std::memory_order_release);
  started_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Team::serve(int member) {
  for (unsigned run = 0;; ++run) {
    started_.wait(run, std::memory_order_acquire);
    if (over_) return;
    (*work_)(member);
    barrier();
  }
}

void Team::run(const std::function<void(int)>& work) {
  if (members_ == 1) {
    work(0);
    return;
  }
  work_ = &work;
  started_.fetch_add(1, std::memory_order_release);
  started_.notify_all();
  work(0);
  barrier();  // all have returned
}

void Team::barrier() {
  if (members_ == 1) return;
  const unsigned now = passed_.load(std::memory_order_relaxed);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) == members_ - 1) {
    arrived_.store(0, std::memory_order_relaxed);
    passed_.store(now + 1, std::memory_order_release);
    return;
  }
  for (int k = 0; passed_.load(std::memory_order_acquire) == now; ++k) {
    if (k < spins) {
      pause();
    } else {
      if (k == spins) long_waits_.fetch_add(1, std::memory_order_relaxed);
      std::this_thread::yield();
    }
  }
}

}  // namespace toile
