// apps/cli/budget_text.hpp: what a run will take, in words.
#pragma once
#include "io/json_text.hpp"
#include "sim/budget.hpp"
#include "sim/scene.hpp"

#include <string>

namespace toile::internal {

// Throws when that is beyond the limits.
std::string describe_budget(const Scene& scene, const BudgetLimits& limits, JsonText& json);

}  // namespace toile::internal
