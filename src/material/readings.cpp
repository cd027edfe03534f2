#include "material/readings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::internal {

double quadrature(double a, double b, double c) { return std::sqrt(a * a + b * b + c * c); }

double cube_root(double x) {
  if (!(x > 0)) return 0;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  while (exponent % 3 != 0) {
    mantissa *= 0.5;
    ++exponent;
  }
  double root = 0.8;  // mantissa is in [1/8, 1)
  for (int k = 0; k < 8; ++k) root -= (root * root * root - mantissa) / (3 * root * root);
  return std::ldexp(root, exponent / 3);
}

double student_factor(int freedom) {
  static constexpr std::array<double, 10> exact = {1.837, 1.321, 1.197, 1.142, 1.111,
                                                   1.091, 1.077, 1.067, 1.059, 1.053};
  const auto k = static_cast<std::size_t>(std::max(freedom, 1)) - 1;
  return k < exact.size() ? exact[k] : 1 + 0.52 / freedom;
}

Estimate estimate_of(std::span<const double> readings, double single, std::string from) {
  Estimate estimate;
  estimate.from = std::move(from);
  estimate.readings = static_cast<int>(readings.size());
  const auto n = static_cast<double>(readings.size());
  for (const double x : readings) estimate.value += x / n;
  estimate.relative = single;
  if (readings.size() < 2) return estimate;
  double variance = 0;
  for (const double x : readings) variance += (x - estimate.value) * (x - estimate.value) / (n - 1);
  const double u = std::sqrt(variance / n) * student_factor(estimate.readings - 1);
  estimate.relative = std::max(u / estimate.value, 0.1 * single);
  return estimate;
}

Combined combine(std::span<const Estimate> estimates) {
  Combined combined;
  combined.estimate = estimates.front();
  if (estimates.size() < 2) return combined;
  combined.estimate = {};
  double weights = 0;
  for (const Estimate& one : estimates) {
    const double weight = 1 / (one.relative * one.relative);
    weights += weight;
    combined.estimate.value += weight * one.value;
    combined.estimate.readings += one.readings;
    combined.estimate.from += (combined.estimate.from.empty() ? "" : ", ") + one.from;
  }
  combined.estimate.value /= weights;
  combined.estimate.relative = 1 / std::sqrt(weights);
  for (const Estimate& one : estimates) {
    const double off = (one.value / combined.estimate.value - 1) / one.relative;
    combined.chi_square += off * off;
  }
  combined.freedom = static_cast<int>(estimates.size()) - 1;
  static constexpr std::array<double, 4> one_in_twenty = {3.841, 5.991, 7.815, 9.488};
  combined.agree = combined.chi_square <= one_in_twenty.at(static_cast<std::size_t>(combined.freedom) - 1);
  if (!combined.agree) combined.widened = std::sqrt(combined.chi_square / combined.freedom);
  combined.estimate.relative *= combined.widened;
  return combined;
}

}  // namespace toile::internal
