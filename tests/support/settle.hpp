// tests/support/settle.hpp: runs a cloth until it hardly moves.
#pragma once
#include "support/run_cloth.hpp"

namespace toile::internal::test {

// Runs at least `least` frames of `frame_s` until no particle is faster than `speed_m_per_s`.  Returns their number; fails the test where
// `most` are not enough or a step collapses.  Long frames are deliberate: backward Euler damps motion that it does not resolve,
// and a unique rest state does not depend on the path to it.
inline int settle(ClothRun& run, double frame_s, double speed_m_per_s, int least, int most) {
  run.adaptive.step_max_s = frame_s;
  if (run.stepper) run.stepper->options().step_max_s = frame_s;
  for (int f = 1; f <= most; ++f) {
    if (!run.frame(frame_s).ok) return f;
    if (f >= least && run.fastest() < speed_m_per_s) return f;
  }
  ADD_FAILURE() << "still moves at " << run.fastest() << " m/s after " << run.time_s << " s";
  return most;
}

}  // namespace toile::internal::test
