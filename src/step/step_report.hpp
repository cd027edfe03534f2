// step/step_report.hpp: the outcome of an attempted step, in numbers that a log can plot.
#pragma once
#include "solver/modified_pcg.hpp"
#include "step/safe_filter.hpp"

#include <string>
#include <string_view>

namespace toile::internal {

// Time per phase, s.
struct PhaseSeconds {
  double eval = 0, cg = 0, cloth_cloth = 0, cloth_solid = 0;
  double filter = 0;  // the part of cloth_cloth in the safe filter
  double body = 0;    // positions of the body, its tree and its normals
  template <class Archive>
  void remember(Archive& archive) {
    archive(eval, cg, cloth_cloth, cloth_solid, filter, body);
  }
};
inline PhaseSeconds operator+(const PhaseSeconds& a, const PhaseSeconds& b) {
  return {a.eval + b.eval,     a.cg + b.cg,    a.cloth_cloth + b.cloth_cloth, a.cloth_solid + b.cloth_solid,
          a.filter + b.filter, a.body + b.body};
}
inline PhaseSeconds operator-(const PhaseSeconds& a, const PhaseSeconds& b) {
  return {a.eval - b.eval,     a.cg - b.cg,    a.cloth_cloth - b.cloth_cloth, a.cloth_solid - b.cloth_solid,
          a.filter - b.filter, a.body - b.body};
}

enum class StepStatus { accepted, solver_failed, stretched, beyond_limit, passed_through, not_finite };
std::string_view to_string(StepStatus status);

struct StepReport {  // of one attempt
  StepStatus status = StepStatus::accepted;
  double h_s = 0;
  int passes = 0, cg_iterations = 0;
  int relinearised = 0;                 // solves about the end of an earlier one
  FilterReport filter;                  // of the safe filter
  int touching = 0, rows = 0;           // body constraints and contact rows of the last pass
  int pinched = 0;                      // pinched particles (step/flypaper.hpp)
  double stretch_change = 0;            // max over triangles of | |w|' - |w| | away from rest
  double strain = 0, strain_limit = 0;  // beyond_limit: strain of a thread of the worst triangle, and its limit
  Index worst_triangle = -1, worst_particle = -1;
  PcgReport pcg;  // of the last pass
  explicit operator bool() const { return status == StepStatus::accepted; }
  std::string explain() const;  // one sentence for a person
};

}  // namespace toile::internal
