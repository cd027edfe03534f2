// tests/support/bare_step.hpp: the paper's step without additions, for tests of a single feature.  The defaults of a scene solve
// again where threads stretch too much and hold pinched particles (StepOptions{}), and have air (AirOptions{}).
#pragma once
#include "step/implicit_euler.hpp"

namespace toile::internal::test {

inline StepOptions bare_step() {
  StepOptions options;
  options.pcg.tolerance = 1e-3;
  options.relinearisations = 0;
  options.flypaper = false;
  options.body.friction = 0.4;
  return options;
}

}  // namespace toile::internal::test
