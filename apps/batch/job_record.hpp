// apps/batch/job_record.hpp: how the process of a job ended, in the job's folder: job.json.
//
// Figures are the report's (report.json); here is what a report cannot say: what it was for, that there is none and why, time and memory of the
// process.
#pragma once
#include "worker.hpp"

#include <optional>
#include <string>
#include <vector>

namespace toile::internal {

struct JobRecord {
  std::string id, key;             // key: job_key.hpp
  std::vector<std::string> words;  // the command
  WorkerEnd end;
  bool reported = false;  // the process has written the finished report that is in the folder
};

void write_job_record(const std::string& folder, const JobRecord& record);
// Empty when there is none, or none that can be read.
std::optional<JobRecord> read_job_record(const std::string& folder);
// Before the job runs again.
void remove_job_record(const std::string& folder);

}  // namespace toile::internal
