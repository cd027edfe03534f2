// body/lead_in.hpp: from the pose in which the body stands into a motion that begins in another.
//
//   x(t) = d + s(t / L) (p(tau(t)) - d),   s(u) = u^3 (10 - 15u + 6u^2)
// tau(t) is max(0, t - L) with its corner rounded over 2 e, e = min(L / 2, 0.15 s), tau' being 3w^2 - 2w^3 there: the
// body starts at rest, is C2 to the end of the lead-in, and meets the motion's time u at L + u whenever u >= e.
#pragma once
#include "body/movements.hpp"

#include <algorithm>

namespace toile::internal {

inline constexpr double same_pose_m = 1e-5;  // between the body and a motion's first pose: nothing to be led into

struct LeadIn {
  double seconds = 0;

  double share(double t) const { return seconds > 0 ? least_jerk(t / seconds) : 1.0; }

  double clock(double t) const {
    const double e = std::min(0.5 * seconds, rounding_s);
    if (t >= seconds + e) return t - seconds;
    if (t <= seconds - e) return 0;
    const double w = (t - seconds + e) / (2 * e);
    return 2 * e * (w * w * w - 0.5 * w * w * w * w);
  }

  static constexpr double rounding_s = 0.15;  // half the time over which the motion's clock starts
};

}  // namespace toile::internal
