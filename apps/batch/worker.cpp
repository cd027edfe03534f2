#include "worker.hpp"

#include "core/error.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

namespace toile::internal {
namespace {

constexpr const char* this_program = "/proc/self/exe";  // as it was started, whatever its file is by now
constexpr std::size_t kept_messages = 4096;             // bytes, from the end
constexpr int cannot_start = 127;

// In the child, between fork and exec: only what is safe in a signal handler.
[[noreturn]] void become_worker(char* const* arguments, int messages, pid_t batch, rlim_t memory_bytes) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != batch) ::_exit(cannot_start);  // it died before we asked to be told
  if (memory_bytes != RLIM_INFINITY) {
    const rlimit limit{memory_bytes, memory_bytes};
    ::setrlimit(RLIMIT_DATA, &limit);
  }
  const int nothing = ::open("/dev/null", O_RDWR);
  if (nothing < 0 || ::dup2(nothing, STDIN_FILENO) < 0 || ::dup2(nothing, STDOUT_FILENO) < 0 ||
      ::dup2(messages, STDERR_FILENO) < 0)
    ::_exit(cannot_start);
  if (nothing > STDERR_FILENO) ::close(nothing);
  ::execv(this_program, arguments);
  ::_exit(cannot_start);
}

std::string last_line(std::string_view text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
  const std::size_t start = text.find_last_of("\r\n");
  if (start != std::string_view::npos) text.remove_prefix(start + 1);
  constexpr std::string_view name = "toile: ";
  if (text.starts_with(name)) text.remove_prefix(name.size());
  return std::string(text);
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Worker::Worker(const std::vector<std::string>& words, double memory_limit_mb) {
  std::vector<std::string> owned{"toile"};
  owned.insert(owned.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (std::string& word : owned) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const rlim_t memory = memory_limit_mb > 0 ? static_cast<rlim_t>(memory_limit_mb * 1048576) : RLIM_INFINITY;
  std::array<int, 2> pipe{-1, -1};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
    throw IoError(this_program, std::string("cannot be started: ") + std::strerror(errno));
  const pid_t batch = ::getpid();
  child_ = ::fork();
  if (child_ == 0) become_worker(arguments.data(), pipe[1], batch, memory);
  const int error = errno;
  ::close(pipe[1]);
  messages_ = pipe[0];
  if (child_ < 0) {
    ::close(messages_);
    throw IoError(this_program, std::string("cannot be started: ") + std::strerror(error));
  }
  ::fcntl(messages_, F_SETFL, O_NONBLOCK);
}

Worker::~Worker() {
  if (messages_ >= 0) ::close(messages_);
  if (child_ <= 0) return;
  ::kill(child_, SIGKILL);
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void Worker::read_messages() {
  if (messages_ < 0) return;
  std::array<char, 1024> buffer;
  for (;;) {
    const ssize_t got = ::read(messages_, buffer.data(), buffer.size());
    if (got > 0) {
      text_.append(buffer.data(), static_cast<std::size_t>(got));
      if (text_.size() > 2 * kept_messages) text_.erase(0, text_.size() - kept_messages);
      continue;
    }
    if (got < 0 && errno == EINTR) continue;
    if (got == 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) {
      ::close(messages_);
      messages_ = -1;
    }
    return;
  }
}

std::optional<WorkerEnd> Worker::ended() {
  int status = 0;
  rusage used{};
  if (::wait4(child_, &status, WNOHANG, &used) != child_) return std::nullopt;
  child_ = -1;
  read_messages();
  WorkerEnd end;
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  end.seconds = watch_.seconds();
  end.cpu_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  end.memory_peak_mb = static_cast<double>(used.ru_maxrss) / 1024;
  end.message = last_line(text_);
  end.stopped_by = stopped_by_;
  return end;
}

void Worker::stop(const std::string& reason, double patience_s) {
  if (child_ <= 0) return;
  if (asked_at_s_ < 0) {
    asked_at_s_ = seconds();
    stopped_by_ = reason;
    ::kill(child_, SIGTERM);
  } else if (seconds() > asked_at_s_ + patience_s) {
    ::kill(child_, SIGKILL);
  }
}

}  // namespace toile::internal
