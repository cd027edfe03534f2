// core/available_memory.hpp: how much memory this process may still use.
#pragma once

namespace toile::internal {

// The least of the machine's free memory, the rest of a control group's limit (a container) and of this process's (ulimit -v, -d), in
// units of 2^20 bytes; infinite when the system reports none of them.
double available_memory_mb();

}  // namespace toile::internal
