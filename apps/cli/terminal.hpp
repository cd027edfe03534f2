// apps/cli/terminal.hpp: the progress bar and messages on a terminal.
#pragma once
#include "command_line.hpp"
#include "process_end.hpp"
#include "sim/simulate.hpp"

#include <string>
#include <string_view>

namespace toile::internal {

// One line on stderr that overwrites itself; nothing unless stderr is a terminal, or with --quiet.
class ProgressBar {
 public:
  explicit ProgressBar(const CommandLine& line);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  void show(const Progress& progress);
  void clear();

 private:
  bool on_;
  bool shown_ = false;
};

// To stdout; throws IoError when it is closed or full.
void print(std::string_view text);
// The first reason of a failed verdict, on stderr: "toile: DIR: stretch: p99 7 %, ...".
void tell_failure(const std::string& directory, const Verdict& verdict);

}  // namespace toile::internal
