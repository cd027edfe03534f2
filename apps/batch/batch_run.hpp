// apps/batch/batch_run.hpp: jobs from their lines to their verdicts.                                        docs/howto/batch.md
//
// A job with a finished run of the same inputs and settings is done.  One whose run was interrupted goes on from its checkpoint; any other begins
// anew.  Jobs start in the order of the file, and verdicts are in that order, whichever ended first.
#pragma once
#include "batch_folder.hpp"
#include "job_file.hpp"
#include "job_verdict.hpp"
#include "worker_pool.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

struct BatchCalls {
  std::function<void(const JobVerdict&, bool was_done)> verdict;  // of a job, as it ends
  std::function<void()> meanwhile;                                // every tenth of a second or so
  std::function<bool()> stop;
};

class BatchRun {
 public:
  BatchRun(std::span<const Job> jobs, const BatchFolder& folder, BatchCalls calls);

  // Runs what is not done; when `calls.stop` says so, as much as has ended by then.
  void run(int processes);
  // Runs nothing: the verdicts of what has ended.
  void collect();

  std::vector<JobVerdict> verdicts() const;  // of jobs that have ended
  int done_before() const { return done_before_; }
  int ended() const { return ended_; }
  double worker_seconds() const { return worker_seconds_; }  // wall time of all processes

 private:
  std::optional<PoolTask> next();
  std::optional<PoolTask> worker_ended(const PoolTask& task, const WorkerEnd& end);
  bool is_done(std::size_t job);
  PoolTask task_of(std::size_t job, bool may_resume);
  std::vector<std::string> whole_words(const Job& job) const;

  struct Progress {
    std::string key, report_before;
    bool resuming = false;
    std::optional<JobVerdict> verdict;
  };

  std::span<const Job> jobs_;
  const BatchFolder& folder_;
  BatchCalls calls_;
  std::vector<Progress> progress_;  // [job]
  std::size_t next_ = 0;
  int done_before_ = 0, ended_ = 0;
  double worker_seconds_ = 0;
};

}  // namespace toile::internal
