// body/step_speed.hpp: how far a body may move from one pose to the next.
//
// What most of the body does carries it: it may ride in a car, at up to 100 m/s, but not jump across the room.  Beside that, the median of all
// vertices, no vertex is faster than the fastest hand: one that is has changed its place in a file, or a joint has flipped.
#pragma once
#include "core/types.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace toile::internal {

struct StepLimits {
  double rate_hz = 30, fastest_m_s = 20;
};

// Throws InputError, with `file` and `place` as its place; `number` of a vertex is the file's.
void check_step_speed(std::string_view file, const std::string& place, std::span<const Vec3> before,
                      std::span<const Vec3> x, const StepLimits& limits,
                      const std::function<std::size_t(std::size_t vertex)>& number);

}  // namespace toile::internal
