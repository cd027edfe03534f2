// preview/ffmpeg_process.cpp: starting, feeding and ending the encoder.
#include "preview/ffmpeg_process.hpp"

#include "core/error.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

extern char** environ;

namespace toile::internal {
namespace {

constexpr int film_descriptor = 3;           // of the child
constexpr std::size_t kept_messages = 4096;  // bytes of ffmpeg's messages, from the end

void close_if_open(int& descriptor) {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

// The last line that is not blank, fit for a log.
std::string last_line(std::string_view text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
  const std::size_t start = text.find_last_of("\r\n");
  return printable(start == std::string_view::npos ? text : text.substr(start + 1));
}

// Frees the attributes of posix_spawn, however the constructor ends.
struct SpawnPlan {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  SpawnPlan() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
};

}  // namespace

std::string find_ffmpeg() {
  const char* variable = std::getenv("PATH");
  std::string_view folders = variable ? variable : "";
  while (!folders.empty()) {
    const std::size_t colon = folders.find(':');
    const std::string_view folder = folders.substr(0, colon);
    folders = colon == std::string_view::npos ? std::string_view() : folders.substr(colon + 1);
    if (folder.empty()) continue;  // by POSIX the current folder: a program there is not run
    std::string program = std::string(folder) + "/ffmpeg";
    struct stat status {};
    if (::stat(program.c_str(), &status) == 0 && S_ISREG(status.st_mode) && ::access(program.c_str(), X_OK) == 0) {
      return program;
    }
  }
  throw IoError("ffmpeg",
                "the program is not in PATH and films need it; install it (Debian, Ubuntu: apt-get install ffmpeg; "
                "Fedora: dnf install ffmpeg-free; macOS: brew install ffmpeg)");
}

FfmpegProcess::FfmpegProcess(const std::string& program, const std::string& film, int output, int width, int height,
                             double fps)
    : film_(film) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  // H.264 players expect 4:2:0, hence even sizes, and Rec. 709 colours, said explicitly.  A fixed number of threads and no
  // version stamps: the same pictures give the same file.
  std::vector<std::string> words{
      program,
      "-hide_banner",
      "-loglevel",
      "error",
      "-nostats",
      "-y",
      "-f",
      "rawvideo",
      "-pixel_format",
      "rgb24",
      "-video_size",
      size,
      "-framerate",
      shortest(fps),
      "-i",
      "pipe:0",
      "-an",
      "-vf",
      "crop=trunc(iw/2)*2:trunc(ih/2)*2:0:0,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
      "-c:v",
      "libx264",
      "-preset",
      "medium",
      "-crf",
      "17",
      "-threads",
      "2",
      "-color_primaries",
      "bt709",
      "-color_trc",
      "bt709",
      "-colorspace",
      "bt709",
      "-color_range",
      "tv",
      "-fflags",
      "+bitexact",
      "-flags:v",
      "+bitexact",
      "-map_metadata",
      "-1",
      "-movflags",
      "+faststart",
      "-f",
      "mp4",
      "file:/proc/self/fd/" + std::to_string(film_descriptor)};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  std::array<int, 2> pictures{-1, -1}, messages{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pictures.data()) != 0 ||
      ::pipe2(messages.data(), O_CLOEXEC) != 0) {
    const int error = errno;
    for (int d : pictures) close_if_open(d);
    throw IoError(film_, std::string("cannot connect to ffmpeg: ") + std::strerror(error));
  }
  SpawnPlan plan;
  posix_spawn_file_actions_adddup2(&plan.actions, pictures[1], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&plan.actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&plan.actions, messages[1], STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&plan.actions, output, film_descriptor);
  // Its own process group: an interrupt from the keyboard is for us; we decide whether the film is finished.
  sigset_t none, defaults;
  sigemptyset(&none);
  sigemptyset(&defaults);
  // SIGXFSZ stays ignored, if it is: a film that grows too large is then an error with its reason.
  for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGALRM}) sigaddset(&defaults, signal);
  posix_spawnattr_setsigmask(&plan.attributes, &none);
  posix_spawnattr_setsigdefault(&plan.attributes, &defaults);
  posix_spawnattr_setpgroup(&plan.attributes, 0);
  posix_spawnattr_setflags(&plan.attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  pid_t child = -1;
  const int error = posix_spawn(&child, program.c_str(), &plan.actions, &plan.attributes, arguments.data(), environ);
  ::close(pictures[1]);
  ::close(messages[1]);
  input_ = pictures[0];
  errors_ = messages[0];
  if (error != 0) {
    close_if_open(input_);
    close_if_open(errors_);
    throw IoError(film_, "cannot start " + printable(program) + ": " + std::strerror(error));
  }
  child_ = child;
  ::fcntl(errors_, F_SETFL, O_NONBLOCK);
}

FfmpegProcess::~FfmpegProcess() {
  close_if_open(input_);
  close_if_open(errors_);
  if (child_ > 0) {
    ::kill(child_, SIGKILL);
    wait();
  }
}

// True until the child closes its end.
bool FfmpegProcess::read_messages() {
  std::array<char, 1024> buffer;
  for (;;) {
    const ssize_t got = ::read(errors_, buffer.data(), buffer.size());
    if (got > 0) {
      messages_.append(buffer.data(), static_cast<std::size_t>(got));
      if (messages_.size() > 2 * kept_messages) messages_.erase(0, messages_.size() - kept_messages);
    } else if (got == 0) {
      return false;
    } else if (errno != EINTR) {
      return errno == EAGAIN || errno == EWOULDBLOCK;
    }
  }
}

int FfmpegProcess::wait() {
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0) {
    if (errno != EINTR) {
      status = -1;  // already reaped (SIGCHLD ignored): its exit status is unknown
      break;
    }
  }
  child_ = -1;
  return status;
}

void FfmpegProcess::fail(const std::string& what) {
  const std::string line = last_line(messages_);
  throw IoError(film_, "ffmpeg " + what + (line.empty() ? "" : ": " + line));
}

void FfmpegProcess::write(std::span<const unsigned char> bytes) {
  while (!bytes.empty()) {
    // Its messages are read while it is fed: a child that waits for room for messages would not take pictures.
    std::array<pollfd, 2> ready{{{input_, POLLOUT, 0}, {errors_, POLLIN, 0}}};
    if (::poll(ready.data(), ready.size(), -1) < 0) {
      if (errno == EINTR) continue;
      fail(std::string("cannot be waited for (") + std::strerror(errno) + ")");
    }
    if (ready[1].revents != 0 && errors_ >= 0 && !read_messages()) close_if_open(errors_);
    if (ready[0].revents == 0) continue;
    const ssize_t sent = ::send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    } else if (sent < 0 && errno != EINTR && errno != EAGAIN && errno != EWOULDBLOCK) {
      finish();  // throws with the reason that the child gave, unless it claims success
      fail("ended before the film did");
    }
  }
}

void FfmpegProcess::finish(const std::function<bool()>& stop) {
  constexpr int ask_every_ms = 100;
  close_if_open(input_);
  while (errors_ >= 0) {
    if (stop && stop()) throw Error(ErrorKind::interrupted, "interrupted while the film was finished");
    pollfd ready{errors_, POLLIN, 0};
    if (::poll(&ready, 1, stop ? ask_every_ms : -1) < 0 && errno != EINTR) break;
    if (!read_messages()) close_if_open(errors_);
  }
  const int status = wait();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  fail(WIFSIGNALED(status) ? "was ended by signal " + std::to_string(WTERMSIG(status)) : "failed");
}

}  // namespace toile::internal
