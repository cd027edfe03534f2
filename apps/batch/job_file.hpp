// apps/batch/job_file.hpp: the jobs of a batch, one JSON object per line.                                  docs/howto/batch.md
//
//   {"defaults": {"body": "woman", "resolution": 2, "no-preview": true}}        may stand in the first line
//   {"id": "skirt-1", "dress": "skirt.json", "fabric": "denim", "limit-seconds": 600}
//   {"id": "flag", "run": "flag.json", "body": null}                            null: as if the defaults did not say it
//
// Keys are the command's long options, so that the parser of the command line checks them; relative paths begin at the folder of the file.
#pragma once
#include "command_line.hpp"

#include <string>
#include <vector>

namespace toile::internal {

struct JobLimits {
  double seconds = 0, memory_mb = 0;  // 0: none
};

struct Job {
  std::string id;                  // the name of its folder
  int line = 0;                    // of the file, from 1
  std::vector<std::string> words;  // the command with its options, but for --out and --quiet
  CommandLine command;             // the same, parsed
  JobLimits limits;
};

struct JobFile {
  std::vector<Job> jobs;  // in the order of the file
  int lines = 0;
};

// `limits` are those of jobs that say nothing.  Every line is checked, but no file that a job names is read.  Throws IoError, and InputError with
// file and line.
JobFile read_job_file(const std::string& path, const JobLimits& limits);

}  // namespace toile::internal
