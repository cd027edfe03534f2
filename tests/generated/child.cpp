#include "generated/child.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

namespace toile::internal::generated {

std::string Ended::text() const {
  if (hung) return "still running at the time limit";
  if (signal != 0) return "signal " + std::to_string(signal) + (message.empty() ? "" : ": " + message);
  return "exit code " + std::to_string(exit_code) + (message.empty() ? "" : ": " + message);
}

Ended run_child(const std::string& log, int limit_s, const std::function<int()>& work) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const int to = open(log.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
    if (to < 0 || dup2(to, 1) < 0 || dup2(to, 2) < 0) _exit(126);
    const int code = work();
    std::fflush(nullptr);
    _exit(code);
  }
  Ended ended;
  int status = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(limit_s);
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) {
      ended.hung = true;
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
  std::ifstream file(log, std::ios::binary);
  ended.message.assign(std::istreambuf_iterator<char>(file), {});
  while (!ended.message.empty() && ended.message.back() == '\n') ended.message.pop_back();
  return ended;
}

Ended run_program(const std::string& directory, const std::string& log, int limit_s, std::vector<std::string> words,
                  std::vector<std::string> environment) {
  return run_child(log, limit_s, [&] {
    if (chdir(directory.c_str()) != 0) return 126;
    for (std::string& variable : environment) putenv(variable.data());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execvp(argv.front(), argv.data());
    return 127;
  });
}

}  // namespace toile::internal::generated
