#include "budget_text.hpp"

#include "sim/scene.hpp"

#include <fmt/printf.h>

namespace toile::internal {

std::string describe_budget(const Scene& scene, const BudgetLimits& limits, JsonText& json) {
  const Budget budget = estimate_budget(scene, read_text_file);
  check_budget(budget, limits);
  json.key("budget");
  json.begin_object();
  json.member("memory_mb", budget.memory_mb);
  json.member("frames", budget.frames);
  json.member("unwritten_frames", budget.unwritten_frames);
  json.member("seconds", budget.seconds);
  json.end_object();
  return fmt::sprintf("about %.0f MB, up to %.0f frames%s, up to %s\n", budget.memory_mb, budget.frames,
                      budget.unwritten_frames > 0 ? fmt::sprintf(" and %.0f before them", budget.unwritten_frames) : "",
                      budget.seconds < 120    ? fmt::sprintf("%.0f s", budget.seconds)
                      : budget.seconds < 7200 ? fmt::sprintf("%.0f min", budget.seconds / 60)
                                              : fmt::sprintf("%.1f hours", budget.seconds / 3600));
}

}  // namespace toile::internal
