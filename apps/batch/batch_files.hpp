// apps/batch/batch_files.hpp: the files of a batch beside its runs: verdicts.jsonl, index.sqlite and index.html.    docs/howto/batch.md
//
// All three are made of the verdicts, each time as a whole, and appear when they are complete: they can be made anew at any time.
#pragma once
#include "job_verdict.hpp"

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace toile::internal {

struct BatchCounts {
  int jobs = 0, passed = 0, failed = 0, errors = 0;
  int missing() const { return jobs - passed - failed - errors; }
  std::vector<std::pair<std::string, int>> reasons;  // first reasons of what did not pass, the most frequent first
};
BatchCounts count(std::span<const JobVerdict> verdicts, int jobs);

// One line of verdicts.jsonl, without its end.
std::string verdict_line(const JobVerdict& verdict);

// `verdicts` are in the order of the file; `jobs` is how many it has.  Throws IoError.
void write_batch_files(const std::string& directory, const std::string& name, std::span<const JobVerdict> verdicts,
                       int jobs);

// The bytes of index.sqlite; empty in a build without SQLite.
std::string index_of(std::span<const JobVerdict> verdicts);
bool can_index();

// The text of index.html.
std::string page_of(const std::string& directory, const std::string& name, std::span<const JobVerdict> verdicts,
                    int jobs);

}  // namespace toile::internal
