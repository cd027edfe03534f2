// material/readings.hpp: what repeated readings say of a quantity, and several methods of one quantity.     docs/howto/fit-fabric.md
//
//   mean of n readings      u = s t / sqrt(n)           s: their standard deviation
//   a single reading        u = what the method is known to scatter by
//   several methods         x = sum(x_i / r_i^2) / sum(1 / r_i^2),  r_i = u_i / x_i
//
// u is one standard uncertainty: the quantity lies within it in 68 of 100 cases.  t is Student's factor for 68.27 %: three readings
// know their own scatter badly.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

using Readings = std::vector<double>;  // in SI

struct Estimate {
  double value = 0, relative = 0;  // relative: one standard uncertainty over the value
  int readings = 0;
  std::string from;  // "cantilever"
  double uncertainty() const { return value * relative; }
};

// `single`: relative scatter of the method.  Readings that agree better than a tenth of it were rounded to agree: u is not below that tenth.
// At least one reading, all above zero.
Estimate estimate_of(std::span<const double> readings, double single, std::string from);

double student_factor(int freedom);  // at least 1

struct Combined {
  Estimate estimate;
  double chi_square = 0;  // sum of ((x_i - x) / (r_i x))^2, with one degree of freedom less than there are methods
  int freedom = 0;
  bool agree = true;   // chi_square is below what chance exceeds once in twenty
  double widened = 1;  // of methods that disagree: by how much u was made larger, sqrt(chi_square / freedom)
};

// Weights are relative to the common value: with u_i itself, of two methods that scatter by the same share the lower would count more.
// At least one estimate.
Combined combine(std::span<const Estimate> estimates);

// sqrt of the sum of squares
double quadrature(double a, double b, double c = 0);

// x >= 0.  With + * / only, so that it has the same bits everywhere.
double cube_root(double x);

}  // namespace toile::internal
