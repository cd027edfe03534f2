// apps/batch/job_key.hpp: what the result of a job depends on, as one number.
//
// Like `input_hash` of a report, of all settings that change the result and of the bytes of all files, but found without meshing anything, and
// with the version of the program: a job with a finished run of this key need not run again.  Not in it: threads, pictures, limits.
#pragma once
#include "job_file.hpp"

#include <string>

namespace toile::internal {

// Empty when a file of the job is missing or wrong: its process will say so.  Relative paths refer to the present folder.
std::string job_key(const Job& job);

}  // namespace toile::internal
