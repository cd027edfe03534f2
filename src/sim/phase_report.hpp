// sim/phase_report.hpp: the sums over frames and their steps in a report.
#pragma once
#include "sim/report.hpp"
#include "step/adaptive_step.hpp"

namespace toile::internal {

void add_frame(PhaseReport& phase, const FrameReport& frame);
void add_seconds(PhaseReport& phase, const PhaseSeconds& seconds);
// The sums since `before`.
void set_seconds(PhaseReport& phase, const PhaseSeconds& seconds, const PhaseSeconds& before = {});

}  // namespace toile::internal
