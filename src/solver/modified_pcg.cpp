#include "solver/modified_pcg.hpp"

#include "core/denormals.hpp"
#include "core/parallel.hpp"
#include "solver/paper_pcg.hpp"
#include "solver/vector_kernels.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace toile::internal {
namespace {

// Of |b'|: the residual that the rounding of A' allows.
template <class T>
constexpr double rounding_floor = sizeof(T) == sizeof(float) ? 1e-5 : 1e-13;

// The stop rule (docs/theory/solver.md):  target = max( min( tol |b'|, max( 0.02 |g|, 0.2 tol |b'| ) ),  min( 0.1 tol, 1e-4 ) |g| )
constexpr double share_of_gravity = 0.02;  // the residual must be negligible beside the weight,
constexpr double violent_share = 0.2;      // but in violent motion not finer than this part of tol |b'|
constexpr double resting_share = 0.1;      // of tol |g|: a finer solve changes nothing,
constexpr double resting_most = 1e-4;      // of |g|: but cloth at rest must not creep

constexpr int usual_long_waits =
    4;  // of a solve on a quiet machine, besides one per iteration: residuals in double, made by one
constexpr int solves_until_next_try = 100;

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
  switch (status) {
    case PcgStatus::converged:
      return fmt::sprintf("converged: residual %.3g <= %.3g after %d iterations", residual, target, iterations);
    case PcgStatus::iteration_limit:
      return fmt::sprintf("stopped after %d iterations: residual %.3g, wanted %.3g (started at %.3g)", iterations,
                          residual, target, initial_residual);
    case PcgStatus::not_positive_definite:
      return fmt::sprintf("matrix not positive definite: c.A c = %.3g in iteration %d", curvature, iterations);
    case PcgStatus::not_finite:
      return fmt::sprintf("a number was not finite in iteration %d (residual %.3g)", iterations, residual);
  }
  return "";
}

template <class T>
void ModifiedPcg<T>::prepare(const LinearSystem<T>& system, const PcgOptions& options) {
  const auto n = static_cast<std::size_t>(system.size());
  for (auto* vector : {&r_, &c_, &q_, &s_, &As_, &w_, &Zy_}) vector->resize(n);
  for (auto* vector : {&start_, &work_, &work2_}) vector->resize(n);
  if (options.procedure == PcgProcedure::paper_1998) return;
  domains_.cut(system.A().pattern());
  domains_.update(system);
  parts_.resize(domains_.count());
  coarse_parts_.resize(domains_.count());
  for (auto& part : coarse_parts_) part.resize(static_cast<std::size_t>(coarse_.dimension()));
  solutions_.resize(domains_.count());  // as many members at most
  if (options.preconditioner == Preconditioner::block_ssor_coarse) coarse_.factorise(system);
  if (options.preconditioner == Preconditioner::diagonal) {
    inverse_diagonal_.clear();
    const std::vector<Mat3> diagonals = system.diagonals();
    for (Index place = 0; place < system.size(); ++place) {
      const Mat3& D = diagonals[static_cast<std::size_t>(system.A().pattern().row_at(place))];
      inverse_diagonal_.push_back(to_lane<T>(Vec3(1 / D(0, 0), 1 / D(1, 1), 1 / D(2, 2))));
    }
  }
}

// work(domain) for the domains of one member.
template <class T>
template <class Work>
void ModifiedPcg<T>::for_own_domains(const Share& share, const Work& work) const {
  for (auto d = static_cast<std::size_t>(share.member); d < domains_.count();
       d += static_cast<std::size_t>(share.members))
    work(d);
}

// work(particle, place) for the particles of one member.
template <class T>
template <class Work>
void ModifiedPcg<T>::for_own_particles(const Share& share, const Work& work) const {
  for_own_domains(share, [&](std::size_t d) {
    for (Index place = domains_.begin(d); place < domains_.end(d); ++place)
      work(static_cast<std::size_t>(domains_.particle_at(place)), static_cast<std::size_t>(place));
  });
}

// The sum over all domains of part(begin, end) of their particles, the same for every member.
template <class T>
template <class Part>
double ModifiedPcg<T>::sum_over_domains(Share& share, const Part& part) {
  share.odd = !share.odd;  // the last sum's parts may still be read
  const std::size_t which = share.odd ? 1 : 0;
  for_own_domains(share, [&](std::size_t d) { parts_[d][which] = part(domains_.begin(d), domains_.end(d)); });
  team_->barrier();
  double sum = 0;
  for (std::size_t d = 0; d < domains_.count(); ++d) sum += parts_[d][which];
  return sum;
}

// s <- M^-1 r in the range of S, and As <- A' s.
template <class T>
void ModifiedPcg<T>::precondition(const LinearSystem<T>& system, Preconditioner kind, Share& share) {
  const std::size_t n = r_.size();
  switch (kind) {
    case Preconditioner::diagonal:  // by one member, like the next
      for (std::size_t p = 0; p < n; ++p) s_[p] = inverse_diagonal_[p] * r_[p];
      for (std::size_t d = 0; d < domains_.count(); ++d) domains_.filter(system, d, s_);
      return multiply(system, s_, As_);
    case Preconditioner::block_jacobi:
      for (std::size_t p = 0; p < n; ++p) s_[p] = system.filtered_inverses_by_place()[p].times(r_[p]);
      return multiply(system, s_, As_);
    case Preconditioner::block_ssor:
      return sweep(system, share);
    case Preconditioner::block_ssor_coarse:
      sweep(system, share);
      return deflate(system, share);
  }
}

// y = A' x in the order of places.
template <class T>
void ModifiedPcg<T>::multiply(const LinearSystem<T>& system, std::span<const Lane<T>> x, std::span<Lane<T>> y) {
  of_particles_.resize(x.size());
  product_.resize(x.size());
  const BlockPattern& pattern = system.A().pattern();
  const auto place = [&](std::size_t i) { return static_cast<std::size_t>(pattern.place(static_cast<Index>(i))); };
  for (std::size_t i = 0; i < x.size(); ++i) of_particles_[i] = x[place(i)];
  system.multiply(of_particles_, product_);
  for (std::size_t i = 0; i < x.size(); ++i) y[place(i)] = product_[i];
}

template <class T>
void ModifiedPcg<T>::sweep(const LinearSystem<T>& system, Share& share) {
  const std::size_t last = domains_.epochs() - 1;
  for_own_domains(share, [&](std::size_t d) {
    std::copy(r_.begin() + domains_.begin(d), r_.begin() + domains_.end(d), As_.begin() + domains_.begin(d));
  });
  for (std::size_t epoch = 0;; ++epoch) {
    for_own_domains(share, [&](std::size_t d) { domains_.forward(system, d, epoch, s_, As_); });
    if (epoch == last) break;
    team_->barrier();
  }
  for (std::size_t epoch = last;; --epoch) {
    for_own_domains(share, [&](std::size_t d) { domains_.backward(system, d, epoch, s_, As_); });
    team_->barrier();
    if (epoch == 0) break;
  }
  for_own_domains(share, [&](std::size_t d) { domains_.finish(system, d, s_, As_); });
}

// s += Q (r - As),  As += A' Q (r - As): no residual is left in the coarse modes.
template <class T>
void ModifiedPcg<T>::deflate(const LinearSystem<T>& system, Share& share) {
  for_own_domains(
      share, [&](std::size_t d) { coarse_.restrict(domains_.begin(d), domains_.end(d), r_, As_, coarse_parts_[d]); });
  team_->barrier();
  auto& solution = solutions_[static_cast<std::size_t>(share.member)];
  coarse_.solve(coarse_parts_, solution);
  for_own_domains(share, [&](std::size_t d) {
    coarse_.prolong(solution, domains_.begin(d), domains_.end(d), Zy_);
    domains_.filter(system, d, Zy_);
    coarse_.add(solution, domains_.begin(d), domains_.end(d), Zy_, s_, As_);
  });
  team_->barrier();  // the parts may be written again, and Zy is complete
  if (system.rows().empty()) return;
  for_own_domains(share, [&](std::size_t d) {
    domains_.add_rows(system, d, Zy_, As_);
    domains_.filter(system, d, As_);
  });
}

// w += Q r,  r -= A' Q r: the residual of the coarse modes goes.
template <class T>
void ModifiedPcg<T>::correct_coarse_modes(const LinearSystem<T>& system, Share& share) {
  for_own_particles(share, [&](std::size_t, std::size_t p) { s_[p] = As_[p] = Lane<T>{0, 0, 0, 0}; });
  deflate(system, share);
  for_own_particles(share, [&](std::size_t, std::size_t p) {
    w_[p] += s_[p];
    r_[p] -= As_[p];
  });
}

template <class T>
double ModifiedPcg<T>::residual_norm2(const LinearSystem<T>& system, Share& share) {
  return sum_over_domains(share, [&](Index begin, Index end) {
    return toile::internal::residual_norm2(begin, end, system.filtered_inverses_by_place().data(), r_.data());
  });
}

// r = S (b - A (start + w)), with the product in double.
template <class T>
void ModifiedPcg<T>::true_residual(const LinearSystem<T>& system, std::span<const Vec3> b, const Share& share) {
  for_own_particles(share, [&](std::size_t i, std::size_t p) { work_[i] = start_[i] + to_vec3(w_[p]); });
  team_->barrier();
  const auto part = [&](int member) {  // as the matrix is stored
    return static_cast<Index>(static_cast<std::int64_t>(system.size()) * member / share.members);
  };
  system.A().multiply_rows(part(share.member), part(share.member + 1), work_, work2_);
  team_->barrier();
  for_own_domains(share, [&](std::size_t d) { domains_.add_rows(system, d, work_, work2_); });
  const ParticleConstraints& constraints = system.constraints();
  for_own_particles(share, [&](std::size_t i, std::size_t p) {
    const auto particle = static_cast<Index>(i);
    const Vec3 residual = b[i] - work2_[i];
    r_[p] = to_lane<T>(constraints.is_free(particle) ? residual : Vec3(constraints.S(particle) * residual));
  });
}

// Runs on every member.
template <class T>
void ModifiedPcg<T>::iterate(const LinearSystem<T>& system, std::span<const Vec3> b, const PcgOptions& options,
                             Share& share, PcgReport& report) {
  true_residual(system, b, share);
  double residual2 = residual_norm2(system, share);
  report.initial_residual = std::sqrt(residual2);
  if (options.preconditioner == Preconditioner::block_ssor_coarse && report.initial_residual > report.target) {
    correct_coarse_modes(system, share);  // deflation begins without residual in the coarse modes
    residual2 = residual_norm2(system, share);
  }
  double delta = 0;
  while (true) {
    report.residual = std::sqrt(residual2);
    if (!std::isfinite(residual2)) {
      report.status = PcgStatus::not_finite;
      return;
    }
    if (report.residual <= report.target) return;
    if (report.iterations >= options.max_iterations) {
      report.status = PcgStatus::iteration_limit;
      return;
    }
    precondition(system, options.preconditioner, share);
    const double delta_new =
        sum_over_domains(share, [&](Index begin, Index end) { return dot_lanes(begin, end, r_.data(), s_.data()); });
    const T beta = report.iterations == 0 ? T(0) : static_cast<T>(delta_new / delta);
    const bool first = report.iterations == 0;
    const double curvature = sum_over_domains(share, [&](Index begin, Index end) {
      return next_direction(begin, end, first, beta, s_.data(), As_.data(), c_.data(), q_.data());
    });
    delta = delta_new;
    report.curvature = curvature;
    if (!(curvature > 0)) {
      report.status = std::isfinite(curvature) ? PcgStatus::not_positive_definite : PcgStatus::not_finite;
      return;
    }
    const T alpha = static_cast<T>(delta / curvature);
    residual2 = sum_over_domains(share, [&](Index begin, Index end) {
      return next_residual(begin, end, alpha, c_.data(), q_.data(), system.filtered_inverses_by_place().data(),
                           w_.data(), r_.data());
    });
    ++report.iterations;
    if (report.iterations % 50 == 0) {  // the residual is recomputed, without the rounding of the recurrence
      true_residual(system, b, share);
      residual2 = residual_norm2(system, share);
    }
  }
}

template <class T>
Team& ModifiedPcg<T>::team_for(const PcgOptions& options) {
  const bool swept = options.preconditioner == Preconditioner::block_ssor ||
                     options.preconditioner == Preconditioner::block_ssor_coarse;
  const int members = swept ? std::min(available_threads(), static_cast<int>(domains_.count())) : 1;
  if (solves_alone_ > 0) --solves_alone_;
  if (members == 1 || solves_alone_ > 0) return *alone_;
  if (!all_ || all_->members() != members) all_ = std::make_unique<Team>(members);
  return *all_;
}

// The target of the stop rule, from its two scales; work2 = A z.
template <class T>
double ModifiedPcg<T>::find_target(const LinearSystem<T>& system, std::span<const Vec3> b,
                                   std::span<const Vec3> reference, const PcgOptions& options, const Share& share) {
  for_own_domains(share, [&](std::size_t d) {
    parts_[d] = {0, 0};
    for (Index place = domains_.begin(d); place < domains_.end(d); ++place) {
      const auto i = static_cast<std::size_t>(domains_.particle_at(place));
      const Mat3& G = system.filtered_inverse(static_cast<Index>(i));  // |S a|^2 in D^-1
      const Vec3 a = b[i] - work2_[i];
      parts_[d][0] += a.dot(G * a);
      parts_[d][1] += reference[i].dot(G * reference[i]);
    }
  });
  team_->barrier();
  double scale2 = 0, gravity2 = 0;
  for (std::size_t d = 0; d < domains_.count(); ++d) {
    scale2 += parts_[d][0];
    gravity2 += parts_[d][1];
  }
  const double scale = std::sqrt(scale2), gravity = std::sqrt(gravity2);
  const double relative = options.tolerance * scale;
  const double felt = std::max(share_of_gravity * gravity, violent_share * relative);
  const double resting = std::min(resting_share * options.tolerance, resting_most) * gravity;
  double target = std::max(std::min(relative, felt), resting);
  // Gravity along constrained directions only, up to rounding (all of the cloth flat on the ground), is no scale.
  if (gravity <= 1e-9 * scale) target = options.tolerance * scale;
  return options.loosen * std::max(target, rounding_floor<T> * scale);
}

template <class T>
PcgReport ModifiedPcg<T>::solve(const LinearSystem<T>& system, std::span<const Vec3> b, std::span<const Vec3> reference,
                                const PcgOptions& options, std::span<Vec3> dv) {
  if (options.procedure == PcgProcedure::paper_1998) {
    const DenormalsAreZero here;
    return paper_pcg(system, b, options, PaperReading::inverse_everywhere, dv);
  }
  const ParticleConstraints& constraints = system.constraints();
  PcgReport report;
  system.multiply_prescribed(work2_);
  team_ = &team_for(options);
  const auto work = [&](int member, int present) {
    const DenormalsAreZero on_this_thread;
    Share share{member, present};
    PcgReport own;
    own.target = find_target(system, b, reference, options, share);
    for_own_particles(share, [&](std::size_t i, std::size_t p) {  // dv_0 = z + S w_0
      const auto particle = static_cast<Index>(i);
      start_[i] =
          constraints.is_free(particle) ? dv[i] : Vec3(constraints.z(particle) + constraints.S(particle) * dv[i]);
      w_[p] = Lane<T>{0, 0, 0, 0};
    });
    iterate(system, b, options, share, own);
    for_own_particles(share, [&](std::size_t i, std::size_t p) {
      const auto particle = static_cast<Index>(i);
      const Vec3 w = to_vec3(w_[p]);
      dv[i] = start_[i] + (constraints.is_free(particle) ? w : Vec3(constraints.S(particle) * w));
    });
    if (member == 0) report = own;
  };
  team_->run(std::cref(work));  // by reference: no copy of the lambda on the heap
  if (team_->take_long_waits() > usual_long_waits + report.iterations) solves_alone_ = solves_until_next_try;

  if (options.preconditioner == Preconditioner::block_ssor_coarse && report.initial_residual > report.target &&
      report) {
    // Removes the residual left in the coarse modes, in double: translations are among them, so that momentum is kept at
    // any tolerance.
    system.multiply_unfiltered(dv, work2_);
    for (std::size_t i = 0; i < work2_.size(); ++i) work2_[i] = b[i] - work2_[i];
    constraints.filter(work2_);
    coarse_.correct(system, work2_, dv);
  }
  return report;
}

template class ModifiedPcg<float>;
template class ModifiedPcg<double>;

}  // namespace toile::internal
