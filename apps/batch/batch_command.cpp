// apps/batch/batch_command.cpp: `toile batch`: many jobs, each in a process of its own.                       docs/howto/batch.md
#include "batch_files.hpp"
#include "batch_folder.hpp"
#include "batch_run.hpp"
#include "commands.hpp"
#include "core/parallel.hpp"
#include "io/json_text.hpp"
#include "terminal.hpp"

#include <fmt/printf.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace toile::internal {
namespace {

namespace fs = std::filesystem;

struct LineRange {
  int first = 1, last = 0;  // last 0: the end
};

// "7", "1-100"
LineRange line_range(const std::string& text) {
  LineRange range;
  const char *at = text.data(), *const end = at + text.size();
  auto read = std::from_chars(at, end, range.first);
  range.last = range.first;
  if (read.ec == std::errc{} && read.ptr != end && *read.ptr == '-')
    read = std::from_chars(read.ptr + 1, end, range.last);
  if (read.ec != std::errc{} || read.ptr != end || range.first < 1 || range.last < range.first)
    throw Error(ErrorKind::usage,
                "--lines: expected a line or two with - between them, 7 or 1-100, got \"" + printable(text) + '"');
  return range;
}

// The jobs of some lines.  A line may have none: it is blank, has the defaults, or is behind the end.
std::vector<Job> chosen(std::vector<Job> jobs, const std::string& lines) {
  if (lines.empty()) return jobs;
  const LineRange range = line_range(lines);
  std::erase_if(jobs, [&](const Job& job) { return job.line < range.first || job.line > range.last; });
  return jobs;
}

double own_cpu_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

// The batch's files are written while it works, for those who look; never for more than a fiftieth of the time, nor oftener than anyone looks.
class Files {
 public:
  Files(const BatchFolder& folder, std::string name, int jobs, bool wanted)
      : folder_(folder), name_(std::move(name)), jobs_(jobs), wanted_(wanted) {}

  void write(const BatchRun& run) {
    if (!wanted_) return;
    const Stopwatch took;
    write_batch_files(folder_.directory(), name_, run.verdicts(), jobs_);
    written_ = run.ended() + run.done_before();
    next_s_ = watch_.seconds() + std::max(least_pause_s, pause_per_second * took.seconds());
  }
  void write_now_and_then(const BatchRun& run) {
    if (watch_.seconds() > next_s_ && run.ended() + run.done_before() > written_) write(run);
  }

 private:
  static constexpr double least_pause_s = 10, pause_per_second = 50;
  const BatchFolder& folder_;
  std::string name_;
  int jobs_;
  bool wanted_;
  Stopwatch watch_;
  double next_s_ = least_pause_s;
  int written_ = 0;
};

void tell(const JobVerdict& verdict) {
  const Reason& reason = verdict.reasons.front();
  std::fprintf(stderr, "toile: %s: %s: %s%s%s\n", verdict.id.c_str(), verdict.verdict.c_str(),
               printable(reason.code).c_str(), reason.detail.empty() ? "" : ": ", printable(reason.detail).c_str());
}

ExitCode code_of(const BatchCounts& counts, bool stopped, bool collects) {
  if (counts.missing() > 0 && stopped) return ExitCode::interrupted;
  if (counts.missing() > 0 && collects) return ExitCode::simulation_failed;
  return counts.passed == counts.jobs ? ExitCode::ok : ExitCode::simulation_failed;
}

struct BatchResult {
  BatchCounts counts;
  ExitCode code = ExitCode::ok;
  std::string directory;
  int processes = 1, done_before = 0;
  double seconds = 0, worker_seconds = 0;
};

std::string as_text(const BatchResult& result) {
  const BatchCounts& counts = result.counts;
  std::string text = fmt::sprintf("%s: %d of %d pass", result.directory, counts.passed, counts.jobs);
  if (counts.jobs > 0) text += fmt::sprintf(" (%.1f %%)", 100.0 * counts.passed / counts.jobs);
  if (counts.failed > 0) text += fmt::sprintf(", %d fail", counts.failed);
  if (counts.errors > 0) text += fmt::sprintf(", %d without a verdict", counts.errors);
  if (counts.missing() > 0) text += fmt::sprintf(", %d not run yet", counts.missing());
  if (result.done_before > 0) text += fmt::sprintf("; %d were done before", result.done_before);
  text += '\n';
  for (const auto& [code, number] : counts.reasons) text += fmt::sprintf("  %6d  %s\n", number, code);
  text += fmt::sprintf("  %.1f s, %d at a time; jobs %.1f s, the batch itself %.2f s of processor\n", result.seconds,
                       result.processes, result.worker_seconds, own_cpu_seconds());
  return text;
}

std::string as_json(const BatchResult& result) {
  JsonText json;
  json.begin_object();
  json.member("out", result.directory);
  json.member("jobs", result.counts.jobs);
  json.member("passed", result.counts.passed);
  json.member("failed", result.counts.failed);
  json.member("errors", result.counts.errors);
  json.member("missing", result.counts.missing());
  json.member("done_before", result.done_before);
  json.key("reasons");
  json.begin_object();
  for (const auto& [code, number] : result.counts.reasons) json.member(code, number);
  json.end_object();
  json.member("processes", result.processes);
  json.member("seconds", result.seconds);
  json.member("job_seconds", result.worker_seconds);
  json.member("own_cpu_seconds", own_cpu_seconds());
  json.member("exit_code", static_cast<int>(result.code));
  json.end_object();
  return json.str() + '\n';
}

// Absolute: the batch works in the folder of the job file, where relative paths of jobs begin.
std::string absolute(const std::string& path) { return fs::absolute(path).lexically_normal().string(); }

std::string folder_for(const CommandLine& line) {
  std::string folder = line.out.empty() ? "out/" + fs::path(line.inputs.front()).stem().string() : line.out;
  folder = absolute(folder);
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  return folder;
}

void go_to(const std::string& folder) {
  std::error_code error;
  fs::current_path(folder, error);
  if (error) throw IoError(printable(folder), "cannot go there: " + error.message());
}

BatchResult run_batch(const CommandLine& line, const std::vector<Job>& jobs, const BatchFolder& folder) {
  const Stopwatch watch;
  const auto total = static_cast<int>(jobs.size());
  ProgressBar bar(line);
  Files files(folder, fs::path(line.inputs.front()).stem().string(), total, line.lines.empty());
  BatchRun* running = nullptr;
  const auto verdict = [&](const JobVerdict& one, bool was_done) {
    if (was_done || one.passed()) return;
    bar.clear();
    tell(one);
  };
  const auto meanwhile = [&] {
    const int ended = running->ended() + running->done_before();
    const double left = running->ended() > 0 ? watch.seconds() * (total - ended) / running->ended() : -1;
    bar.show({"batch", total > 0 ? static_cast<double>(ended) / total : 1, left});
    files.write_now_and_then(*running);
  };
  BatchRun run(jobs, folder, {verdict, meanwhile, interrupted});
  running = &run;
  BatchResult result;
  result.processes = std::max(1, std::min(line.processes > 0 ? line.processes : usable_cores(), total));
  line.collect ? run.collect() : run.run(result.processes);
  bar.clear();
  files.write(run);
  result.counts = count(run.verdicts(), total);
  result.code = code_of(result.counts, interrupted(), line.collect);
  result.directory = folder.directory();
  result.done_before = run.done_before();
  result.seconds = watch.seconds();
  result.worker_seconds = run.worker_seconds();
  return result;
}

}  // namespace

ExitCode batch_command(const CommandLine& line) {
  std::signal(SIGCHLD, SIG_DFL);  // a parent that ignored it would leave us without the ends of our processes
  const std::string& file = line.inputs.front();
  const std::vector<Job> jobs = chosen(read_job_file(file, {line.limit_seconds, line.limit_mb}).jobs, line.lines);
  const BatchFolder folder(folder_for(line), absolute(file),
                           line.lines.empty() ? BatchFolder::Use::alone : BatchFolder::Use::shared);
  if (line.lines.empty() && !can_index() && !line.quiet)
    std::fprintf(stderr, "toile: built without SQLite: there will be no index.sqlite\n");
  go_to(line.paths_from.empty() ? fs::path(absolute(file)).parent_path().string() : line.paths_from);
  const BatchResult result = run_batch(line, jobs, folder);
  if (line.json) {
    print(as_json(result));
  } else if (!line.quiet) {
    print(as_text(result));
  }
  if (result.code == ExitCode::interrupted)
    std::fprintf(stderr, "toile: interrupted: %d of %d jobs are left; the same command goes on with them\n",
                 result.counts.missing(), result.counts.jobs);
  return result.code;
}

}  // namespace toile::internal
