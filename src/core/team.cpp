#include "core/team.hpp"

#include <algorithm>
#include <thread>

namespace toile::internal {
namespace {

constexpr int spins = 4000;  // some tens of microseconds
constexpr unsigned closed = 1u << 31;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

Team::Team(int members) : members_(std::max(members, 1)) {
  if (members_ > 1) tasks_ = std::make_unique<Tasks>();
}
Team::~Team() = default;

void Team::run(const std::function<void(int, int)>& work) {
  if (members_ == 1) {
    work(0, 1);
    return;
  }
  work_ = &work;
  came_.store(0, std::memory_order_release);
  for (int other = 1; other < members_; ++other)
    tasks_->run([](void* team) { static_cast<Team*>(team)->join(); }, this);
  for (int k = 0; k < spins && came_.load(std::memory_order_relaxed) + 1 < static_cast<unsigned>(members_); ++k)
    pause();
  present_ = static_cast<int>(came_.fetch_or(closed, std::memory_order_acq_rel)) + 1;
  begun_.fetch_add(1, std::memory_order_release);
  work(0, present_);
  barrier();       // all have returned
  tasks_->wait();  // tasks that came too late have ended as well
}

void Team::join() {
  const unsigned begun = begun_.load(std::memory_order_relaxed);
  const unsigned before = came_.fetch_add(1, std::memory_order_acq_rel);
  if ((before & closed) != 0) return;
  wait_until(begun_, begun);
  (*work_)(static_cast<int>(before) + 1, present_);
  barrier();
}

void Team::barrier() {
  if (present_ == 1) return;
  const unsigned now = passed_.load(std::memory_order_relaxed);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) == present_ - 1) {
    arrived_.store(0, std::memory_order_relaxed);
    passed_.store(now + 1, std::memory_order_release);
    return;
  }
  wait_until(passed_, now);
}

void Team::wait_until(const std::atomic<unsigned>& value, unsigned differs_from) {
  for (int k = 0; value.load(std::memory_order_acquire) == differs_from; ++k) {
    if (k < spins) {
      pause();
    } else {
      if (k == spins) long_waits_.fetch_add(1, std::memory_order_relaxed);
      std::this_thread::yield();
    }
  }
}

}  // namespace toile::internal
