// tests/generated/child.hpp: work in a process of its own, so that a signal or a hang is a finding and not the end of the tests.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace toile::internal::generated {

struct Ended {
  int exit_code = -1;
  int signal = 0;
  bool hung = false;    // was still there at the limit, and was ended
  std::string message;  // what it wrote on stderr

  std::string text() const;
};

// The exit code is what `work` returns.  What it writes on stderr goes into `log`, a file.
Ended run_child(const std::string& log, int limit_s, const std::function<int()>& work);

// A program in the folder `directory`; `environment` has "NAME=value".
Ended run_program(const std::string& directory, const std::string& log, int limit_s, std::vector<std::string> words,
                  std::vector<std::string> environment = {});

}  // namespace toile::internal::generated
