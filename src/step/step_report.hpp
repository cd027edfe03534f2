// step/step_report.hpp: what an attempted step came to, in numbers a log can plot.
#pragma once
#include "solver/modified_pcg.hpp"
#include "step/safe_filter.hpp"

#include <string>
#include <string_view>

namespace toile::internal {

// Time per phase, for reports; s.
struct PhaseSeconds {
  double eval = 0, cg = 0, cloth_cloth = 0, cloth_solid = 0;
  double filter = 0;  // of cloth_cloth: the safe filter at the end of the step
  double body = 0;    // where the body is, its tree and its normals
  template <class Archive>
  void remember(Archive& archive) {
    archive(eval, cg, cloth_cloth, cloth_solid, filter, body);
  }
};

enum class StepStatus { accepted, solver_failed, stretched, beyond_limit, passed_through, too_fast, not_finite };
std::string_view to_string(StepStatus status);

struct StepReport {  // what happened, in numbers a log can plot
  StepStatus status = StepStatus::accepted;
  double h_s = 0;
  int passes = 0, cg_iterations = 0;
  int relinearised = 0;                 // solves about an end found before
  FilterReport filter;                  // of the end of the step
  int touching = 0, rows = 0;           // body constraints and contact rows of the last pass
  int pinched = 0;                      // particles held between parts of the body (step/flypaper.hpp)
  double stretch_change = 0;            // max over triangles of | |w|' - |w| | away from rest
  double strain = 0, strain_limit = 0;  // beyond_limit: of a thread of the worst triangle, and what it may be
  Index worst_triangle = -1, worst_particle = -1;
  PcgReport pcg;  // of the last pass
  explicit operator bool() const { return status == StepStatus::accepted; }
  std::string explain() const;  // one sentence for a person
};

}  // namespace toile::internal
