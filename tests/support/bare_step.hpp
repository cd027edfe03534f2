// tests/support/bare_step.hpp: the step as the paper has it, for tests that look at one thing alone.  What a scene gets when it says
// nothing solves again where threads stretch too much and holds what the body pinches (StepOptions{}), and has air (AirOptions{}).
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
