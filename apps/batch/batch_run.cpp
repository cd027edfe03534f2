#include "batch_run.hpp"

#include "exit_code.hpp"
#include "io/run_folder.hpp"
#include "job_key.hpp"
#include "job_record.hpp"
#include "sim/progress.hpp"
#include "sim/report.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>
#include <utility>

namespace toile::internal {
namespace {

// The run in the folder is unfinished, and was asked for by the same words.
bool can_go_on(const std::string& folder, const std::vector<std::string>& words) {
  try {
    const std::optional<UnfinishedRun> run = read_unfinished_run(folder);
    return run && run->version == toile_version() && run->arguments == words;
  } catch (const Error&) {
    return false;
  }
}

// It ran out of a time that was another then: of all options that are not in the key, --time-limit alone changes a result.
bool had_another_time(const JobVerdict& verdict, const Job& job) {
  const auto is_time = [](const Reason& reason) { return reason.code == reason::time_limit; };
  return verdict.words != job.words && std::any_of(verdict.reasons.begin(), verdict.reasons.end(), is_time);
}

// The process of a batch that was killed may take a moment to follow it.
void wait_for_the_last_process(const std::string& folder) {
  constexpr int most = 200;
  constexpr std::chrono::milliseconds pause{10};
  for (int k = 0; k < most && std::filesystem::exists(folder) && is_written_to(folder); ++k)
    std::this_thread::sleep_for(pause);
}

bool ended_by_itself(const WorkerEnd& end) {
  return end.exit_code == static_cast<int>(ExitCode::ok) ||
         end.exit_code == static_cast<int>(ExitCode::simulation_failed);
}

}  // namespace

BatchRun::BatchRun(std::span<const Job> jobs, const BatchFolder& folder, BatchCalls calls)
    : jobs_(jobs), folder_(folder), calls_(std::move(calls)), progress_(jobs.size()) {}

std::vector<std::string> BatchRun::whole_words(const Job& job) const {
  std::vector<std::string> words = job.words;
  words.push_back("--out=" + folder_.run(job.id));
  words.emplace_back("--quiet");
  return words;
}

bool BatchRun::is_done(std::size_t job) {
  Progress& progress = progress_[job];
  progress.key = job_key(jobs_[job]);
  std::optional<JobVerdict> verdict = verdict_of_job(jobs_[job], progress.key, folder_.run(jobs_[job].id));
  if (!verdict || verdict->is_error() || progress.key.empty() || had_another_time(*verdict, jobs_[job])) return false;
  progress.verdict = std::move(verdict);
  ++done_before_;
  calls_.verdict(*progress.verdict, true);
  return true;
}

PoolTask BatchRun::task_of(std::size_t job, bool may_resume) {
  const std::string folder = folder_.run(jobs_[job].id);
  wait_for_the_last_process(folder);
  Progress& progress = progress_[job];
  progress.report_before = hash_of_finished_report(folder);
  remove_job_record(folder);
  PoolTask task{whole_words(jobs_[job]), jobs_[job].limits, job};
  progress.resuming = may_resume && can_go_on(folder, task.words);
  if (progress.resuming)
    task.words = {"resume", folder, "--threads=" + std::to_string(jobs_[job].command.threads), "--quiet"};
  return task;
}

std::optional<PoolTask> BatchRun::next() {
  while (next_ < jobs_.size() && !calls_.stop()) {
    const std::size_t job = next_++;
    if (!is_done(job)) return task_of(job, true);
    calls_.meanwhile();
  }
  return std::nullopt;
}

std::optional<PoolTask> BatchRun::worker_ended(const PoolTask& task, const WorkerEnd& end) {
  const Job& job = jobs_[task.tag];
  Progress& progress = progress_[task.tag];
  const std::string folder = folder_.run(job.id);
  worker_seconds_ += end.seconds;
  if (end.stopped_by == stopped_with_the_batch && !ended_by_itself(end)) return std::nullopt;  // it has yet to end
  // A state that cannot be taken up (damaged, or of other inputs) is no reason to fail.
  const auto code = static_cast<ExitCode>(end.exit_code);
  if (progress.resuming && (code == ExitCode::bad_input || code == ExitCode::io)) return task_of(task.tag, false);
  JobRecord record{job.id, progress.key, job.words, end, false};
  const std::string report = hash_of_finished_report(folder);
  record.reported = end.signal == 0 && !report.empty() && report != progress.report_before;
  write_job_record(folder, record);
  progress.verdict = verdict_of_job(job, progress.key, folder);
  ++ended_;
  if (progress.verdict) calls_.verdict(*progress.verdict, false);
  return std::nullopt;
}

void BatchRun::run(int processes) {
  run_pool(processes,
           {[&] { return next(); }, [&](const PoolTask& task, const WorkerEnd& end) { return worker_ended(task, end); },
            calls_.meanwhile, calls_.stop});
}

void BatchRun::collect() {
  for (std::size_t job = 0; job < jobs_.size() && !calls_.stop(); ++job) {
    Progress& progress = progress_[job];
    progress.key = job_key(jobs_[job]);
    progress.verdict = verdict_of_job(jobs_[job], progress.key, folder_.run(jobs_[job].id));
    if (progress.verdict) calls_.verdict(*progress.verdict, true);
    calls_.meanwhile();
  }
}

std::vector<JobVerdict> BatchRun::verdicts() const {
  std::vector<JobVerdict> verdicts;
  for (const Progress& progress : progress_)
    if (progress.verdict) verdicts.push_back(*progress.verdict);
  return verdicts;
}

}  // namespace toile::internal
