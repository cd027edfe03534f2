#include "solver/paper_pcg.hpp"

#include <cmath>

namespace toile::internal {
namespace {

// a_k / D_kk or a_k D_kk
Vec3 scaled(const Mat3& D, const Vec3& a, bool divide) {
  return divide ? Vec3(a.cwiseQuotient(D.diagonal())) : Vec3(a.cwiseProduct(D.diagonal()));
}

}  // namespace

template <class T>
PcgReport paper_pcg(const LinearSystem<T>& system, std::span<const Vec3> b, const PcgOptions& options,
                    PaperReading reading, std::span<Vec3> dv) {
  const ParticleConstraints& constraints = system.constraints();
  const std::size_t n = b.size();
  const double eps = options.tolerance * options.loosen;
  const bool divide_r = reading != PaperReading::as_printed, divide_b = reading != PaperReading::diagonal_of_A;
  PcgReport report;

  const std::vector<Mat3> diagonals = system.diagonals();
  Vec3s filtered(b.begin(), b.end());
  constraints.filter(filtered);
  double delta_0 = 0;
  for (std::size_t i = 0; i < n; ++i) delta_0 += filtered[i].dot(scaled(diagonals[i], filtered[i], divide_b));

  Vec3s z(n), residual(n);
  for (std::size_t i = 0; i < n; ++i) z[i] = constraints.z(static_cast<Index>(i));
  system.multiply_unfiltered(z, residual);
  for (std::size_t i = 0; i < n; ++i) residual[i] = b[i] - residual[i];
  constraints.filter(residual);

  std::vector<Lane<T>> r(n), c(n), q(n), s(n), sum(n, Lane<T>{0, 0, 0, 0}), P_inverse(n);
  for (std::size_t i = 0; i < n; ++i) {
    r[i] = to_lane<T>(residual[i]);
    P_inverse[i] = to_lane<T>(scaled(diagonals[i], Vec3::Ones(), divide_r));
    c[i] = P_inverse[i] * r[i];
  }
  system.filter(c);
  DotSum<T> rc;
  for (std::size_t i = 0; i < n; ++i) rc.add(r[i], c[i]);
  double delta = rc.value();

  report.initial_residual = std::sqrt(delta);
  report.target = eps * std::sqrt(delta_0);
  while (delta > eps * eps * delta_0) {
    if (report.iterations >= options.max_iterations) {
      report.status = PcgStatus::iteration_limit;
      break;
    }
    system.multiply(c, q);  // filtered
    DotSum<T> cq;
    for (std::size_t i = 0; i < n; ++i) cq.add(c[i], q[i]);
    report.curvature = cq.value();
    if (!(report.curvature > 0)) {
      report.status = std::isfinite(report.curvature) ? PcgStatus::not_positive_definite : PcgStatus::not_finite;
      break;
    }
    const T alpha = static_cast<T>(delta / report.curvature);
    DotSum<T> rs;
    for (std::size_t i = 0; i < n; ++i) {
      sum[i] += c[i] * alpha;
      r[i] -= q[i] * alpha;
      s[i] = P_inverse[i] * r[i];
      rs.add(r[i], s[i]);
    }
    const T beta = static_cast<T>(rs.value() / delta);
    delta = rs.value();
    for (std::size_t i = 0; i < n; ++i) c[i] = s[i] + c[i] * beta;
    system.filter(c);
    ++report.iterations;
  }
  if (delta < 0) report.status = PcgStatus::not_positive_definite;  // the listing would call this converged
  if (!std::isfinite(delta)) report.status = PcgStatus::not_finite;
  report.residual = std::sqrt(delta);
  // z + sum of alpha c; the sum is filtered once more, in double, so that its rounding cannot move along constrained directions.
  for (std::size_t i = 0; i < n; ++i) dv[i] = z[i] + constraints.S(static_cast<Index>(i)) * to_vec3(sum[i]);
  return report;
}

template PcgReport paper_pcg(const LinearSystem<float>&, std::span<const Vec3>, const PcgOptions&, PaperReading,
                             std::span<Vec3>);
template PcgReport paper_pcg(const LinearSystem<double>&, std::span<const Vec3>, const PcgOptions&, PaperReading,
                             std::span<Vec3>);

}  // namespace toile::internal
