#include "body/step_speed.hpp"

#include "core/error.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <vector>

namespace toile::internal {
namespace {

constexpr double fastest_whole_m_s = 100;

}  // namespace

void check_step_speed(std::string_view file, const std::string& place, std::span<const Vec3> before,
                      std::span<const Vec3> x, const StepLimits& limits,
                      const std::function<std::size_t(std::size_t vertex)>& number) {
  if (x.empty()) return;
  Vec3 whole;  // single vertices do not change a median
  std::vector<double> moves(x.size());
  for (Eigen::Index k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < x.size(); ++i) moves[i] = x[i][k] - before[i][k];
    const auto middle = moves.begin() + static_cast<std::ptrdiff_t>(moves.size() / 2);
    std::nth_element(moves.begin(), middle, moves.end());
    whole[k] = *middle;
  }
  const double farthest_whole = fastest_whole_m_s / limits.rate_hz, farthest = limits.fastest_m_s / limits.rate_hz;
  if (whole.norm() > farthest_whole)
    throw InputError(
        file, place,
        fmt::sprintf("a body at most %.3g m from the frame before (%g m/s)", farthest_whole, fastest_whole_m_s),
        fmt::sprintf("%.3g m", whole.norm()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double moved = (x[i] - before[i] - whole).norm();
    if (moved <= farthest) continue;
    throw InputError(file, place + ", vertex " + std::to_string(number(i)),
                     "at most " + fmt::sprintf("%.3g m", farthest) + " from the frame before (" +
                         fmt::sprintf("%g m/s", limits.fastest_m_s) + ") beside what the whole body moves",
                     fmt::sprintf("%.3g m", moved));
  }
}

}  // namespace toile::internal
