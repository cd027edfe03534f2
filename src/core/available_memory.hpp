// core/available_memory.hpp: how much memory this process may still use.
#pragma once

namespace toile::internal {

// The least of what the machine has free, what a control group (a container) leaves, and the limits of this process (ulimit -v, -d), in
// units of 2^20 bytes; infinite when the system says none of them.
double available_memory_mb();

}  // namespace toile::internal
