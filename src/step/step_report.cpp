#include "step/step_report.hpp"

#include <fmt/printf.h>

namespace toile::internal {

std::string_view to_string(StepStatus status) {
  switch (status) {
    case StepStatus::accepted:
      return "accepted";
    case StepStatus::solver_failed:
      return "solver_failed";
    case StepStatus::stretched:
      return "stretched";
    case StepStatus::beyond_limit:
      return "beyond_limit";
    case StepStatus::passed_through:
      return "passed_through";
    case StepStatus::not_finite:
      return "not_finite";
  }
  return "";
}

std::string StepReport::explain() const {
  switch (status) {
    case StepStatus::accepted:
      return fmt::sprintf("accepted: h = %.3g ms, %d passes, %d CG iterations", 1e3 * h_s, passes, cg_iterations);
    case StepStatus::solver_failed:
      return "linear solver: " + pcg.explain();
    case StepStatus::stretched:
      return fmt::sprintf("h = %.3g ms: stretch of triangle %d changes by %.3g in one step", 1e3 * h_s, worst_triangle,
                          stretch_change);
    case StepStatus::beyond_limit:
      return fmt::sprintf(
          "h = %.3g ms: a thread of triangle %d would be stretched by %.3g %%, its limit is %.3g %%: what holds the "
          "cloth "
          "is farther apart than it may be long",
          1e3 * h_s, worst_triangle, 100 * strain, 100 * strain_limit);
    case StepStatus::passed_through:
      if (filter.hopeless)
        return fmt::sprintf(
            "h = %.3g ms: more than %d pairs of cloth, or cloth and body, would pass through each other", 1e3 * h_s,
            filter.left + filter.body_left);
      return fmt::sprintf("h = %.3g ms: %d pairs of cloth, and %d of cloth and body, would pass through each other",
                          1e3 * h_s, filter.left, filter.body_left);
    case StepStatus::not_finite:
      return fmt::sprintf("h = %.3g ms: position of particle %d is not finite", 1e3 * h_s, worst_particle);
  }
  return "";
}

}  // namespace toile::internal
