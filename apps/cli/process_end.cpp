#include "process_end.hpp"

#include "core/error.hpp"
#include "exit_code.hpp"

#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

namespace toile::internal {
namespace {

constexpr long unheard_us = 800'000;    // a second, with the time in which the system frees a large run
constexpr long orderly_us = 2'000'000;  // for the last files of a large run; `toile resume` writes the rest
constexpr long refused_us =
    2'000'000;  // exceptions unwind in milliseconds, unless a thread waits for one that has ended
constexpr std::size_t reserve = 1 << 20;  // bytes, for the exit: an exception and a message take some kilobytes

static_assert(std::atomic<int>::is_always_lock_free);  // signal handlers may use them
std::atomic<int> stop_asked{0}, heard{0}, deadline_for{0}, memory_refused{0};
bool says_json = false, on_terminal = false;
void* held_back = nullptr;  // freed when memory is refused

void write_all(int to, const char* text) {
  std::size_t left = std::strlen(text);
  while (left > 0) {
    const ssize_t written = ::write(to, text, left);
    if (written <= 0) return;
    text += written;
    left -= static_cast<std::size_t>(written);
  }
}

// Only calls async-signal-safe functions.
[[noreturn]] void leave(ExitCode code, const char* message) {
  static std::atomic<int> leaving{0};
  if (leaving.exchange(1) == 0) {
    if (on_terminal) write_all(STDERR_FILENO, "\r\033[K");  // the progress bar's line
    write_all(STDERR_FILENO, "toile: ");
    write_all(STDERR_FILENO, message);
    write_all(STDERR_FILENO, "\n");
    if (says_json) {
      write_all(STDOUT_FILENO, code == ExitCode::interrupted      ? "{\"exit_code\": 8, \"error\": \""
                               : code == ExitCode::resource_limit ? "{\"exit_code\": 7, \"error\": \""
                                                                  : "{\"exit_code\": 9, \"error\": \"");
      write_all(STDOUT_FILENO, message);
      write_all(STDOUT_FILENO, "\"}\n");
    }
  }
  ::_exit(static_cast<int>(code));
}

void leave_in(long us) {
  itimerval once{};
  once.it_value.tv_sec = us / 1'000'000;
  once.it_value.tv_usec = us % 1'000'000;
  ::setitimer(ITIMER_REAL, &once, nullptr);
}

// The first reason to end is the one reported.
bool set_deadline(ExitCode code, long us) {
  int none = 0;
  if (!deadline_for.compare_exchange_strong(none, static_cast<int>(code))) return false;
  leave_in(us);
  return true;
}

void on_signal(int signal) {
  // Closing a terminal may send SIGHUP twice, and the system sends SIGXCPU every second: neither shows impatience.
  const bool impatient = signal == SIGINT || signal == SIGTERM;
  if (stop_asked.exchange(1) != 0 && impatient) leave(ExitCode::interrupted, "interrupted at once");
  set_deadline(ExitCode::interrupted, unheard_us);
}

void on_deadline(int) {
  if (deadline_for == static_cast<int>(ExitCode::resource_limit)) leave(ExitCode::resource_limit, "out of memory");
  leave(ExitCode::interrupted, "interrupted");
}

void on_memory_refused() {
  if (memory_refused.exchange(1) == 0) {
    if (held_back != nullptr) ::munmap(held_back, reserve);
    set_deadline(ExitCode::resource_limit, refused_us);
  }
  throw std::bad_alloc();
}

// An uncaught exception, for example in a thread of a library.
[[noreturn]] void on_terminate() {
  if (memory_refused != 0) leave(ExitCode::resource_limit, "out of memory");
  if (const std::exception_ptr thrown = std::current_exception()) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      leave(ExitCode::resource_limit, "out of memory");
    } catch (const std::exception& error) {
      std::fprintf(stderr, "toile: %s\n", printable(error.what()).c_str());
    } catch (...) {
    }
  }
  leave(ExitCode::internal, "internal error");
}

void listen(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigfillset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

void prepare_for_the_end(bool json) {
  says_json = json;
  on_terminal = ::isatty(STDERR_FILENO) == 1;
  struct sigaction before {};
  const bool stays = ::sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler == SIG_IGN;  // nohup
  for (const int signal : {SIGINT, SIGTERM, SIGXCPU}) listen(signal, on_signal);
  if (!stays) listen(SIGHUP, on_signal);
  listen(SIGALRM, on_deadline);
  listen(SIGPIPE, SIG_IGN);
  listen(SIGXFSZ, SIG_IGN);
  sigset_t ours;  // the parent process may have blocked them
  sigemptyset(&ours);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGALRM}) sigaddset(&ours, signal);
  ::sigprocmask(SIG_UNBLOCK, &ours, nullptr);

  void* const pages = ::mmap(nullptr, reserve, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages != MAP_FAILED) held_back = pages;
  std::set_new_handler(on_memory_refused);
  std::set_terminate(on_terminate);
}

bool interrupted() {
  if (stop_asked == 0) return false;
  if (heard.exchange(1) == 0 && deadline_for == static_cast<int>(ExitCode::interrupted)) leave_in(orderly_us);
  return true;
}

}  // namespace toile::internal
