// apps/batch/job_verdict.hpp: the verdict of a job and its key figures, from the files of its folder.            docs/howto/batch.md
#pragma once
#include "job_file.hpp"
#include "verify/verdict.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace toile::internal {

// A member of verdicts.jsonl and a column of the index; absent where there is no report, or it has none.
struct JobFigure {
  std::string_view name;
  bool is_number;
  std::variant<std::monostate, double, std::string> value;
};

struct JobVerdict {
  std::string id;
  int line = 0;         // of the job file
  std::string verdict;  // "pass" and "fail" are the report's; "error": there is no verdict, and the reason says why
  std::vector<Reason> reasons, qualifications;
  std::vector<JobFigure> figures;  // of every job the same, in one order
  std::string message;             // the last line of its process; empty where a report says everything
  std::vector<std::string> words;  // the command that was run
  std::string key;                 // job_key.hpp

  bool passed() const { return verdict == "pass"; }
  bool is_error() const { return verdict == "error"; }
};

// The report_hash of the run in the folder; empty when none has come to its end there.
std::string hash_of_finished_report(const std::string& folder);

// Empty while the job has not ended, and when what is there is of another key.
std::optional<JobVerdict> verdict_of_job(const Job& job, const std::string& key, const std::string& folder);

}  // namespace toile::internal
