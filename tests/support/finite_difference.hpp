// support/finite_difference.hpp: the derivative of any function by central differences, to check a formula with.
//
//   df/dx_j ~ (f(x + h e_j) - f(x - h e_j)) / (2 h)         error O(h^2) + O(rounding / h)
//
// The step is swept over decades and chosen where two neighbouring steps agree best.  The formula under test has
// no part in the choice, so a wrong formula cannot influence it.
//
// A check against this must also assert that the derivative is not zero: two zeros agree perfectly.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <limits>

namespace toile::internal {

struct FiniteDifference {
  Eigen::MatrixXd derivative;                               // [component of f][component of x]
  double step = 0;                                          // the step chosen
  double spread = std::numeric_limits<double>::infinity();  // relative disagreement with the neighbouring step
};

// f: VectorXd -> VectorXd, smooth around x.  `length` is the size on which f changes, in the units of x.
template <class Function>
FiniteDifference finite_difference(const Function& f, const Eigen::VectorXd& x, double length) {
  constexpr int steps = 13;  // 1e-2 ... 1e-8 of `length`
  constexpr double ratio = 0.3162277660168379;
  FiniteDifference best;
  Eigen::MatrixXd previous, current;
  double h = 1e-2 * length;
  for (int k = 0; k < steps; ++k, h *= ratio) {
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      Eigen::VectorXd ahead = x, behind = x;
      ahead[j] += h;
      behind[j] -= h;
      const Eigen::VectorXd column = (f(ahead) - f(behind)) / (ahead[j] - behind[j]);  // the step as it was rounded
      if (j == 0) current.resize(column.size(), x.size());
      current.col(j) = column;
    }
    if (k > 0) {
      const double size = std::max(current.norm(), std::numeric_limits<double>::min());
      const double spread = (current - previous).norm() / size;
      if (spread < best.spread) best = {current, h, spread};
    }
    previous = current;
  }
  return best;
}

// |a - b| / |b| in the Frobenius norm; infinite when b = 0, so that a vanishing reference never passes.
template <class A, class B>
double relative_error(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  const double size = b.norm();
  return size > 0 ? (a - b).norm() / size : std::numeric_limits<double>::infinity();
}

}  // namespace toile::internal
