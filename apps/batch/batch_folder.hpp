// apps/batch/batch_folder.hpp: the folder of a batch and its lock.
//
//   batch.json                                  says that the others are Toile's, and which job file they are of
//   verdicts.jsonl, index.sqlite, index.html    of all jobs
//   runs/ID                                     the run of a job, with job.json (job_record.hpp)
//
// A batch has the folder for itself; processes that run some lines of one job file (--lines) share it with each other.
#pragma once
#include <string>

namespace toile::internal {

class BatchFolder {
 public:
  enum class Use { alone, shared };
  // Makes the folder.  Throws IoError when another batch is at work there, and when files there have names of ours and are not.
  BatchFolder(std::string directory, const std::string& job_file, Use use);
  ~BatchFolder();
  BatchFolder(const BatchFolder&) = delete;
  BatchFolder& operator=(const BatchFolder&) = delete;

  const std::string& directory() const { return directory_; }
  std::string run(const std::string& id) const { return directory_ + "/runs/" + id; }

 private:
  void lock(Use use);

  std::string directory_;
  int lock_ = -1;
};

}  // namespace toile::internal
