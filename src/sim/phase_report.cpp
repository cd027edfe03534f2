#include "sim/phase_report.hpp"

#include <algorithm>

namespace toile::internal {

void add_frame(PhaseReport& phase, const FrameReport& frame) {
  ++phase.frames;
  phase.steps += frame.steps;
  phase.steps_rejected += frame.rejected;
  phase.passes += frame.passes;
  phase.cg_iterations += frame.cg_iterations;
  phase.cg_max = std::max(phase.cg_max, frame.cg_max);
  phase.met += frame.met;
  phase.refused += frame.refused;
  phase.corrected += frame.corrected;
  phase.truncated += frame.truncated;
  phase.pierced += frame.pierced;
  phase.pinched = std::max(phase.pinched, frame.pinched);
  phase.touching += frame.last.touching;
  phase.contact_rows += frame.last.rows;
  if (frame.steps == 0) return;
  phase.step_min_s = phase.step_min_s == 0 ? frame.step_min_s : std::min(phase.step_min_s, frame.step_min_s);
  phase.step_max_s = std::max(phase.step_max_s, frame.step_max_s);
}

void add_seconds(PhaseReport& phase, const PhaseSeconds& seconds) {
  phase.eval += seconds.eval;
  phase.cg += seconds.cg;
  phase.cloth_cloth += seconds.cloth_cloth;
  phase.filter += seconds.filter;
  phase.cloth_solid += seconds.cloth_solid;
}

void set_seconds(PhaseReport& phase, const PhaseSeconds& seconds, const PhaseSeconds& before) {
  phase.eval = seconds.eval - before.eval;
  phase.cg = seconds.cg - before.cg;
  phase.cloth_cloth = seconds.cloth_cloth - before.cloth_cloth;
  phase.filter = seconds.filter - before.filter;
  phase.cloth_solid = seconds.cloth_solid - before.cloth_solid;
  phase.body = seconds.body - before.body;
}

}  // namespace toile::internal
