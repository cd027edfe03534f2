// material/monotone_curve.hpp: a smooth curve through points that ascend in both coordinates, and which ascends between them.
//
// Cubic pieces whose slopes at the points are weighted harmonic means of those of the chords beside them (Fritsch & Butland, "A method for
// constructing local monotone piecewise cubic interpolants", 1984).
#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace toile::internal {

class MonotoneCurve {
 public:
  // At least two, ascending strictly in x and y.
  explicit MonotoneCurve(std::vector<std::array<double, 2>> points);

  // Between the first point and the last; beyond them the value is theirs.
  double value(double x) const;
  double slope(double x) const;
  double inverse(double y) const;  // the x at which value(x) = y

  const std::array<double, 2>& first() const { return points_.front(); }
  const std::array<double, 2>& last() const { return points_.back(); }

 private:
  std::size_t piece_of(double x) const;
  std::vector<std::array<double, 2>> points_;
  std::vector<double> slopes_;  // [point]
};

}  // namespace toile::internal
