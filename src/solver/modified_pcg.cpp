#include "solver/modified_pcg.hpp"

#include "solver/paper_pcg.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace toile {
namespace {

// Of |b'|: what the rounding of A' leaves reachable.
template <class T>
constexpr double rounding_floor = sizeof(T) == sizeof(float) ? 1e-5 : 1e-13;

}  // namespace

std::string_view to_string(Preconditioner preconditioner) {
  switch (preconditioner) {
    case Preconditioner::diagonal:
      return "diagonal";
    case Preconditioner::block_jacobi:
      return "block_jacobi";
    case Preconditioner::block_ssor:
      return "block_ssor";
    case Preconditioner::block_ssor_coarse:
      return "block_ssor_coarse";
  }
  return "";
}

std::string PcgReport::explain() const {
  char text[256];
  switch (status) {
    case PcgStatus::converged:
      std::snprintf(text, sizeof text, "converged: residual %.3g <= %.3g after %d iterations", residual, target,
                    iterations);
      break;
    case PcgStatus::iteration_limit:
      std::snprintf(text, sizeof text, "stopped after %d iterations: residual %.3g, wanted %.3g (started at %.3g)",
                    iterations, residual, target, initial_residual);
      break;
    case PcgStatus::not_positive_definite:
      std::snprintf(text, sizeof text, "matrix not positive definite: c.A c = %.3g in iteration %d", curvature,
                    iterations);
      break;
    case PcgStatus::not_finite:
      std::snprintf(text, sizeof text, "a number was not finite in iteration %d (residual %.3g)", iterations, residual);
      break;
  }
  return text;
}

template <class T>
void ModifiedPcg<T>::prepare(const LinearSystem<T>& system, const PcgOptions& options) {
  const auto n = static_cast<std::size_t>(system.size());
  for (auto* vector : {&r_, &c_, &q_, &s_, &As_, &w_}) vector->resize(n);
  for (auto* vector : {&start_, &work_, &work2_}) vector->resize(n);
  if (options.procedure == PcgProcedure::paper_1998) return;
  if (options.preconditioner == Preconditioner::block_ssor_coarse) coarse_.factorise(system);
  if (options.preconditioner == Preconditioner::diagonal) {
    inverse_diagonal_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Mat3& D = system.diagonal(static_cast<Index>(i));
      inverse_diagonal_[i] = to_lane<T>(Vec3(1 / D(0, 0), 1 / D(1, 1), 1 / D(2, 2)));
    }
  }
}

// s <- M^-1 r in the range of S, and As <- A' s.
template <class T>
void ModifiedPcg<T>::precondition(const LinearSystem<T>& system, Preconditioner kind) {
  const std::size_t n = r_.size();
  if (kind == Preconditioner::diagonal) {
    for (std::size_t i = 0; i < n; ++i) s_[i] = inverse_diagonal_[i] * r_[i];
    for (const Index i : system.constraints().constrained()) {
      Lane<T>& s_i = s_[static_cast<std::size_t>(i)];
      s_i = to_lane<T>(system.constraints().S(i) * to_vec3(s_i));
    }
    system.multiply(s_, As_);
    return;
  }
  if (kind == Preconditioner::block_jacobi) {
    for (std::size_t i = 0; i < n; ++i) s_[i] = system.filtered_inverse_block(static_cast<Index>(i)).times(r_[i]);
    system.multiply(s_, As_);
    return;
  }
  sweep(system);
  if (kind == Preconditioner::block_ssor_coarse) coarse_.deflate(system, r_, s_, As_);
}

// (D + L) D^-1 (D + U) s = r with A' = L + D + U + (rows off the diagonal): the rows enter the sweeps through D only.
//   forward    y = (D + L)^-1 r        h = r - L y = D y
//   backward   D s + U s = h,          so that A' s = h + L s + rows: L s is pushed while the row of U is at hand, and no
//              product with A' is made at all                                                            [Eisenstat 1981]
template <class T>
void ModifiedPcg<T>::sweep(const LinearSystem<T>& system) {
  const BlockPattern& pattern = system.A().pattern();
  const std::size_t n = r_.size();
  std::copy(r_.begin(), r_.end(), As_.begin());
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<Index>(i);
    const Lane<T> y = system.filtered_inverse_block(row).times(As_[i]);
    s_[i] = y;
    for (Slot slot = pattern.first_slot(row), end = pattern.end_slot(row); slot < end; ++slot)
      As_[static_cast<std::size_t>(pattern.column(slot))] -= system.A().off_diagonal(slot).transpose_times(y);
  }
  for (std::size_t i = n; i-- > 0;) {
    const auto row = static_cast<Index>(i);
    Lane<T> sum{0, 0, 0, 0};
    const Slot begin = pattern.first_slot(row), end = pattern.end_slot(row);
    for (Slot slot = begin; slot < end; ++slot)
      sum += system.A().off_diagonal(slot).times(s_[static_cast<std::size_t>(pattern.column(slot))]);
    const Lane<T> s = s_[i] - system.filtered_inverse_block(row).times(sum);
    s_[i] = s;
    for (Slot slot = begin; slot < end; ++slot)
      As_[static_cast<std::size_t>(pattern.column(slot))] += system.A().off_diagonal(slot).transpose_times(s);
  }
  system.add_rows_off_diagonal(s_, As_);
  system.filter(As_);
}

// w += Q r,  r -= A' Q r: the residual of the coarse modes goes.
template <class T>
void ModifiedPcg<T>::correct_coarse_modes(const LinearSystem<T>& system) {
  std::fill(s_.begin(), s_.end(), Lane<T>{0, 0, 0, 0});
  std::fill(As_.begin(), As_.end(), Lane<T>{0, 0, 0, 0});
  coarse_.deflate(system, r_, s_, As_);
  for (std::size_t i = 0; i < r_.size(); ++i) {
    w_[i] += s_[i];
    r_[i] -= As_[i];
  }
}

template <class T>
double ModifiedPcg<T>::residual_norm2(const LinearSystem<T>& system) const {
  DotSum<T> sum;
  for (std::size_t i = 0; i < r_.size(); ++i)
    sum.add(r_[i], system.filtered_inverse_block(static_cast<Index>(i)).times(r_[i]));
  return sum.value();
}

// r = S (b - A (start + w)), with the product in double.
template <class T>
void ModifiedPcg<T>::true_residual(const LinearSystem<T>& system, std::span<const Vec3> b,
                                   std::span<const Vec3> start) {
  for (std::size_t i = 0; i < r_.size(); ++i) work_[i] = start[i] + to_vec3(w_[i]);
  system.multiply_unfiltered(work_, work2_);
  for (std::size_t i = 0; i < r_.size(); ++i) work2_[i] = b[i] - work2_[i];
  system.constraints().filter(work2_);
  for (std::size_t i = 0; i < r_.size(); ++i) r_[i] = to_lane<T>(work2_[i]);
}

template <class T>
PcgReport ModifiedPcg<T>::solve(const LinearSystem<T>& system, std::span<const Vec3> b, std::span<const Vec3> reference,
                                const PcgOptions& options, std::span<Vec3> dv) {
  if (options.procedure == PcgProcedure::paper_1998)
    return paper_pcg(system, b, options, PaperReading::inverse_everywhere, dv);
  const std::size_t n = r_.size();
  const ParticleConstraints& constraints = system.constraints();
  const auto norm2 = [&](std::span<const Vec3> a) {  // |S a|^2 in D^-1
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += a[i].dot(system.filtered_inverse(static_cast<Index>(i)) * a[i]);
    return sum;
  };

  // The stop rule's two scales.
  for (std::size_t i = 0; i < n; ++i) start_[i] = constraints.z(static_cast<Index>(i));
  system.multiply_unfiltered(start_, work2_);
  for (std::size_t i = 0; i < n; ++i) work2_[i] = b[i] - work2_[i];
  const double scale = std::sqrt(norm2(work2_)), gravity = std::sqrt(norm2(reference));
  PcgReport report;
  report.target = std::max(std::min(options.tolerance * scale, 0.02 * gravity), 0.1 * options.tolerance * gravity);
  // Gravity that acts along held directions only, but for rounding (all of the cloth flat on the ground), says nothing.
  if (gravity <= 1e-9 * scale) report.target = options.tolerance * scale;
  report.target = std::max(report.target, rounding_floor<T> * scale);
  report.target *= options.loosen;

  // dv_0 = z + S w_0
  for (std::size_t i = 0; i < n; ++i) {
    const auto particle = static_cast<Index>(i);
    start_[i] = constraints.is_free(particle) ? dv[i] : Vec3(constraints.z(particle) + constraints.S(particle) * dv[i]);
    w_[i] = Lane<T>{0, 0, 0, 0};
  }
  true_residual(system, b, start_);
  double residual2 = residual_norm2(system);
  report.initial_residual = std::sqrt(residual2);

  const bool deflated =
      options.preconditioner == Preconditioner::block_ssor_coarse && report.initial_residual > report.target;
  if (deflated) {
    correct_coarse_modes(system);  // deflation begins without residual in the coarse modes
    residual2 = residual_norm2(system);
  }

  double delta = 0;
  while (true) {
    report.residual = std::sqrt(residual2);
    if (!std::isfinite(residual2)) {
      report.status = PcgStatus::not_finite;
      break;
    }
    if (report.residual <= report.target) break;
    if (report.iterations >= options.max_iterations) {
      report.status = PcgStatus::iteration_limit;
      break;
    }
    precondition(system, options.preconditioner);
    DotSum<T> rs;
    for (std::size_t i = 0; i < n; ++i) rs.add(r_[i], s_[i]);
    const double delta_new = rs.value();
    DotSum<T> cq;
    if (report.iterations == 0) {
      std::copy(s_.begin(), s_.end(), c_.begin());
      std::copy(As_.begin(), As_.end(), q_.begin());
      for (std::size_t i = 0; i < n; ++i) cq.add(c_[i], q_[i]);
    } else {
      const T beta = static_cast<T>(delta_new / delta);
      for (std::size_t i = 0; i < n; ++i) {
        c_[i] = s_[i] + c_[i] * beta;
        q_[i] = As_[i] + q_[i] * beta;
        cq.add(c_[i], q_[i]);
      }
    }
    delta = delta_new;
    const double curvature = cq.value();
    report.curvature = curvature;
    if (!(curvature > 0)) {
      report.status = std::isfinite(curvature) ? PcgStatus::not_positive_definite : PcgStatus::not_finite;
      break;
    }
    const T alpha = static_cast<T>(delta / curvature);
    DotSum<T> rr;
    for (std::size_t i = 0; i < n; ++i) {
      w_[i] += c_[i] * alpha;
      const Lane<T> r = r_[i] - q_[i] * alpha;
      r_[i] = r;
      rr.add(r, system.filtered_inverse_block(static_cast<Index>(i)).times(r));
    }
    residual2 = rr.value();
    ++report.iterations;
    if (report.iterations % 50 == 0) {  // rounding of the recurrence is thrown away
      true_residual(system, b, start_);
      residual2 = residual_norm2(system);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto particle = static_cast<Index>(i);
    const Vec3 w = to_vec3(w_[i]);
    dv[i] = start_[i] + (constraints.is_free(particle) ? w : Vec3(constraints.S(particle) * w));
  }
  if (deflated && report) {
    // What truncation left in the coarse modes goes, all in double: translations are among them, so that momentum is kept at
    // any tolerance.
    system.multiply_unfiltered(dv, work2_);
    for (std::size_t i = 0; i < n; ++i) work2_[i] = b[i] - work2_[i];
    constraints.filter(work2_);
    coarse_.correct(system, work2_, dv);
  }
  return report;
}

template class ModifiedPcg<float>;
template class ModifiedPcg<double>;

}  // namespace toile
