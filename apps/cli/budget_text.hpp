// apps/cli/budget_text.hpp: the budget of a run, in words.
#pragma once
#include "io/json_text.hpp"
#include "sim/budget.hpp"
#include "sim/scene.hpp"

#include <string>

namespace toile::internal {

// Throws when the budget is beyond the limits.
std::string describe_budget(const Scene& scene, const BudgetLimits& limits, JsonText& json);

}  // namespace toile::internal
