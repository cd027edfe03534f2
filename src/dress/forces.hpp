// dress/forces.hpp: the external forces of a run besides gravity, one line each.                    docs/howto/add-a-force.md
#pragma once
#include "assembly/force.hpp"
#include "dress/outfit_run.hpp"

#include <memory>
#include <vector>

namespace toile::internal {

// In the order in which they are added.  They read the run in every step: it must outlive them.
std::vector<std::unique_ptr<Force>> forces_of(const OutfitRun& run);

// Whether any of them may carry cloth upwards.
bool may_lift(const OutfitRun& run);

}  // namespace toile::internal
