// step/body_at.hpp: where a body's vertices are at any time, m.
//
// The function gets room for all vertices and writes where they are.  The room comes filled with where the body stands: what the
// function leaves alone stands still, and never is what the memory held before.  In builds with assertions it comes filled with
// NaN, and a function that left any of it is a bug of ours.
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

  BodyAt() = default;  // nothing that moves
  template <class F>
  requires(!std::same_as<std::remove_cvref_t<F>, BodyAt> && std::invocable<F&, double, std::span<Vec3>>)
      BodyAt(F&& function)
      : function_(std::forward<F>(function)) {}

  explicit operator bool() const { return static_cast<bool>(function_); }

  // Where the body is at t_s into `x`, which may be `standing` itself.
  void operator()(double t_s, std::span<const Vec3> standing, Vec3s& x) const {
    if (x.data() != standing.data()) x.assign(standing.begin(), standing.end());
#ifndef NDEBUG
    std::fill(x.begin(), x.end(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
#endif
    function_(t_s, x);
    TOILE_ASSERT(std::all_of(x.begin(), x.end(), [](const Vec3& p) { return !p.hasNaN(); }));
  }

  // Within the function of another one, whose room it shares.
  const Function& function() const { return function_; }

 private:
  Function function_;
};

}  // namespace toile::internal
