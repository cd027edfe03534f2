// rig/smoothing.hpp: curves in time without corners, of a number for every frame.
#pragma once
#include <span>
#include <vector>

namespace toile::internal {

// The mean over `seconds` about every frame, twice.
std::vector<double> smoothed(std::span<const double> values, double seconds, double rate_hz);

// The same of the largest within `seconds` before and after: nowhere less than given, and exactly 0 where that is 0 for twice as long before and
// after.  `loops`: the last is the first again.
std::vector<double> smoothed_above(std::span<const double> least, double seconds, double rate_hz, bool loops);

}  // namespace toile::internal
