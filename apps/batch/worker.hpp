// apps/batch/worker.hpp: this program as a child process that runs one job.
//
// The child is in a process group of its own: an interrupt from the keyboard is for the batch, which decides.  Should the batch die, the system
// kills the child: the next batch finds no run that still goes on, and its frames and last checkpoint are there.
//
// Easily got wrong: the system counts the death of the thread that started the child.  Start workers from the main thread.
#pragma once
#include "core/stopwatch.hpp"

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace toile::internal {

struct WorkerEnd {
  int exit_code = -1, signal = 0;  // either
  double seconds = 0, cpu_seconds = 0, memory_peak_mb = 0;
  std::string message;     // its last line on stderr, without "toile: "
  std::string stopped_by;  // reason code of the one who asked it to end; empty: nobody
};

class Worker {
 public:
  // `words` are the arguments behind the program's name.  Beyond `memory_limit_mb` of data (0: none) the child is refused memory.  Throws IoError.
  Worker(const std::vector<std::string>& words, double memory_limit_mb);
  // A child that lives is killed.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // The child's stderr, to be polled; -1 once it has closed it, shortly before its end.
  int messages() const { return messages_; }
  void read_messages();
  // Its end, once it has come.
  std::optional<WorkerEnd> ended();
  // In order first, with a checkpoint; by force when it still lives after `patience_s`.  To be called until it has ended.
  void stop(const std::string& reason, double patience_s);
  double seconds() const { return watch_.seconds(); }

 private:
  pid_t child_ = -1;
  int messages_ = -1;
  std::string text_, stopped_by_;
  Stopwatch watch_;
  double asked_at_s_ = -1;
};

}  // namespace toile::internal
