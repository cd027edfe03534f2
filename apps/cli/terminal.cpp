#include "terminal.hpp"

#include "core/error.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace toile::internal {

ProgressBar::ProgressBar(const CommandLine& line) : on_(!line.quiet && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::show(const Progress& progress) {
  if (!on_) return;
  constexpr int width = 30;
  const int done = std::clamp(static_cast<int>(progress.share * width), 0, width);
  std::string left;
  if (progress.seconds_left >= 0) left = std::to_string(static_cast<long>(progress.seconds_left + 0.5)) + " s left";
  std::fprintf(stderr, "\r%-10.10s [%s%s] %3d %% %-16s", std::string(progress.phase).c_str(),
               std::string(static_cast<std::size_t>(done), '#').c_str(),
               std::string(static_cast<std::size_t>(width - done), '.').c_str(), static_cast<int>(100 * progress.share),
               left.c_str());
  std::fflush(stderr);
  shown_ = true;
}

void ProgressBar::clear() {
  if (!shown_) return;
  std::fprintf(stderr, "\r%-72s\r", "");
  std::fflush(stderr);
  shown_ = false;
}

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw IoError("standard output", std::strerror(errno));
}

void tell_failure(const std::string& directory, const Verdict& verdict) {
  if (verdict.pass) return;
  const Reason& reason = verdict.reasons.front();
  std::fprintf(stderr, "toile: %s: %s: %s\n", printable(directory).c_str(), printable(reason.code).c_str(),
               reason.detail.c_str());
}

}  // namespace toile::internal
