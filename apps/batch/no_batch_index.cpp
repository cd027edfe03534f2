// apps/batch/no_batch_index.cpp: in place of batch_index.cpp where Toile is built without SQLite (TOILE_SQLITE).
#include "batch_files.hpp"

namespace toile::internal {

bool can_index() { return false; }

std::string index_of(std::span<const JobVerdict>) { return {}; }

}  // namespace toile::internal
