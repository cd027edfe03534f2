// solver/paper_pcg.hpp: the modified conjugate gradient method as it is printed, for comparison.             [BW98 5.3]
//
//   dv = z
//   delta_0 = filter(b)^T P filter(b)
//   r = filter(b - A dv),   c = filter(P^-1 r),   delta = r^T c
//   while delta > eps^2 delta_0:
//     q = filter(A c),   alpha = delta / (c^T q),   dv += alpha c,   r -= alpha q
//     s = P^-1 r,   delta_old = delta,   delta = r^T s,   c = filter(s + (delta / delta_old) c)
//
// P is said to be diagonal with P_ii = 1/A_ii, but P^-1 is applied to r.  Both cannot be meant; three readings:
//
//   inverse_everywhere   delta_0 with 1/A_ii (the text), r times 1/A_ii (a preconditioner)        surely the one run
//   diagonal_of_A        P = diag(A):  r times 1/A_ii, but delta_0 with A_ii: the sides of the test differ by A_ii^2
//   as_printed           P = 1/A_ii:   delta_0 with 1/A_ii, but r times A_ii: the opposite of a preconditioner
//
// The errors of the stop rule and of the start: docs/deviations.md#pcg.  Same precision and products as ModifiedPcg.
#pragma once
#include "solver/modified_pcg.hpp"

namespace toile::internal {

// eps is options.tolerance (times options.loosen), the cap options.max_iterations, the preconditioner the diagonal.
// dv: out only, the listing takes no guess.  In the report, residual, initial_residual and target are roots of delta,
// of its first value, and of eps^2 delta_0.
template <class T>
[[nodiscard]] PcgReport paper_pcg(const LinearSystem<T>& system, std::span<const Vec3> b, const PcgOptions& options,
                                  PaperReading reading, std::span<Vec3> dv);

extern template PcgReport paper_pcg(const LinearSystem<float>&, std::span<const Vec3>, const PcgOptions&, PaperReading,
                                    std::span<Vec3>);
extern template PcgReport paper_pcg(const LinearSystem<double>&, std::span<const Vec3>, const PcgOptions&, PaperReading,
                                    std::span<Vec3>);

}  // namespace toile::internal
