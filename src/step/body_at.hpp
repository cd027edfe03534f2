// step/body_at.hpp: the positions of a body's vertices as a function of time, m.
//
// The function writes into a vector for all vertices.  The vector comes filled with the standing positions, so vertices
// that the function leaves alone stand still.  In builds with assertions it comes filled with NaN, and a vertex left
// unwritten is a bug of ours.
#pragma once
#include "core/error.hpp"
#include "core/types.hpp"

#include <algorithm>
#include <concepts>
#include <functional>
#include <limits>
#include <span>
#include <utility>

namespace toile::internal {

class BodyAt {
 public:
  using Function = std::function<void(double t_s, std::span<Vec3> x)>;

  BodyAt() = default;  // no motion
  template <class F>
  requires(!std::same_as<std::remove_cvref_t<F>, BodyAt> && std::invocable<F&, double, std::span<Vec3>>)
      BodyAt(F&& function)
      : function_(std::forward<F>(function)) {}

  explicit operator bool() const { return static_cast<bool>(function_); }

  // Writes the positions at t_s into `x`, which may be `standing` itself.
  void operator()(double t_s, std::span<const Vec3> standing, Vec3s& x) const {
    if (x.data() != standing.data()) x.assign(standing.begin(), standing.end());
#ifndef NDEBUG
    std::fill(x.begin(), x.end(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
#endif
    function_(t_s, x);
    TOILE_ASSERT(std::all_of(x.begin(), x.end(), [](const Vec3& p) { return !p.hasNaN(); }));
  }

  // For use within another function, whose vector it shares.
  const Function& function() const { return function_; }

 private:
  Function function_;
};

}  // namespace toile::internal
