// tests/cli/program.hpp: runs the program `toile` and keeps what it said.
#pragma once
#include "io/scratch.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

namespace toile::internal::test {

struct Ended {
  int exit_code = -1, signal = 0;
  std::string out, err;
  auto err_lines() const { return std::count(err.begin(), err.end(), '\n'); }
};

// Runs in the scratch directory, so that nothing is left elsewhere.  `while_running` gets the process id.
template <class During>
Ended run_program(const Scratch& scratch, const std::string& program, std::vector<std::string> words,
                  During&& while_running) {
  const std::string out = scratch / "stdout.txt", err = scratch / "stderr.txt", directory = scratch.directory();
  words.insert(words.begin(), program);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const int to_out = open(out.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644),
              to_err = open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
    if (dup2(to_out, 1) < 0 || dup2(to_err, 2) < 0 || chdir(directory.c_str()) != 0) _exit(126);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  while_running(child);
  int status = 0;
  waitpid(child, &status, 0);
  Ended ended;
  if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
  ended.out = scratch.get("stdout.txt");
  ended.err = scratch.get("stderr.txt");
  return ended;
}

template <class During>
Ended run_toile(const Scratch& scratch, std::vector<std::string> words, During&& while_running) {
  return run_program(scratch, TOILE_PROGRAM, std::move(words), while_running);
}

inline Ended run_toile(const Scratch& scratch, std::vector<std::string> words) {
  return run_toile(scratch, std::move(words), [](pid_t) {});
}

}  // namespace toile::internal::test
