#include "material/monotone_curve.hpp"

#include <algorithm>
#include <utility>

namespace toile::internal {

MonotoneCurve::MonotoneCurve(std::vector<std::array<double, 2>> points) : points_(std::move(points)) {
  const auto chord = [&](std::size_t k) {
    return (points_[k + 1][1] - points_[k][1]) / (points_[k + 1][0] - points_[k][0]);
  };
  const std::size_t last = points_.size() - 1;
  slopes_.push_back(chord(0));
  for (std::size_t k = 1; k < last; ++k) {
    const double before = points_[k][0] - points_[k - 1][0], after = points_[k + 1][0] - points_[k][0];
    const double weight = (before + 2 * after) / (3 * (before + after));
    slopes_.push_back(1 / (weight / chord(k - 1) + (1 - weight) / chord(k)));
  }
  slopes_.push_back(chord(last - 1));
}

std::size_t MonotoneCurve::piece_of(double x) const {
  std::size_t k = 0;
  while (k + 2 < points_.size() && x >= points_[k + 1][0]) ++k;
  return k;
}

double MonotoneCurve::value(double x) const {
  x = std::clamp(x, points_.front()[0], points_.back()[0]);
  const std::size_t k = piece_of(x);
  const double width = points_[k + 1][0] - points_[k][0], t = (x - points_[k][0]) / width, s = 1 - t;
  return s * s * (1 + 2 * t) * points_[k][1] + t * t * (1 + 2 * s) * points_[k + 1][1] +
         width * s * t * (s * slopes_[k] - t * slopes_[k + 1]);
}

double MonotoneCurve::slope(double x) const {
  x = std::clamp(x, points_.front()[0], points_.back()[0]);
  const std::size_t k = piece_of(x);
  const double width = points_[k + 1][0] - points_[k][0], t = (x - points_[k][0]) / width, s = 1 - t;
  const double chord = (points_[k + 1][1] - points_[k][1]) / width;
  return 6 * s * t * chord + s * (1 - 3 * t) * slopes_[k] + t * (1 - 3 * s) * slopes_[k + 1];
}

double MonotoneCurve::inverse(double y) const {
  double low = points_.front()[0], high = points_.back()[0];
  if (y <= points_.front()[1]) return low;
  if (y >= points_.back()[1]) return high;
  for (int k = 0; k < 64; ++k) {
    const double middle = 0.5 * (low + high);
    (value(middle) < y ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace toile::internal
