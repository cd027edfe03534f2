// core/elementary.hpp: sin, cos, asin, atan2 from + - * / and sqrt only, so that a run has the same bits on every machine.
//
// IEEE 754 fixes the result of + - * / sqrt and of remainder, round; it leaves sin and its kin to the C library, which
// may even choose by processor.  Everything that reaches a position uses these; tools/check_elementary.py checks it.
//
// Errors, in units in the last place (ulp) of the exact result:  atan2 <= 2,  sin, cos <= 2 for |x| <= 1e6,  asin <= 3.
// Measured worst on a million arguments: 1.7, 1.1, 0.8, 1.9.
//
// sin and cos of |x| > 1e6 are NaN: no angle in a garment is that large, and reducing one needs more digits of pi.
#pragma once

namespace toile::internal {

// Angle of the point (x, y) from the x axis, in [-pi, pi].  Signed zeros and infinities as in IEEE 754: (-0, -1) is -pi.
double ieee_atan2(double y, double x);

double ieee_sin(double x);
double ieee_cos(double x);

// NaN outside [-1, 1].
double ieee_asin(double x);

}  // namespace toile::internal
