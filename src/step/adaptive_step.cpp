#include "step/adaptive_step.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

constexpr int longest_wait = 40;  // accepted steps before a failed increase is tried again [BW98 7]

}  // namespace

FrameReport AdaptiveStep::advance(ClothState& state, double t_s, double frame_s) {
  FrameReport report;
  steps_s_.clear();
  steps_s_.reserve(64);  // once: few frames take more
  const long base_steps = std::max(1L, std::lround(std::ceil(frame_s / options_.step_max_s - 1e-9)));
  const double base_s = frame_s / static_cast<double>(base_steps);
  // Time is counted in the smallest step, so that it is exact.
  const long ticks_per_base = 1L << options_.most_halvings, ticks = base_steps * ticks_per_base;
  const double tick_s = base_s / static_cast<double>(ticks_per_base);

  for (long now = 0; now < ticks;) {
    if (options_.stop && options_.stop()) {
      report.interrupted = true;
      return report;
    }
    const double start_s = t_s + static_cast<double>(now) * tick_s;
    integrator_.prepare(state, start_s, base_s / static_cast<double>(1L << halvings_), base_s);
    while (true) {
      const long step_ticks = ticks_per_base >> halvings_;
      const double h = base_s / static_cast<double>(1L << halvings_);
      StepLimits limits{options_.stretch_limit, halvings_ >= options_.truncation_floor};
      using Pierce = StepLimits::Pierce;
      limits.pierce = halvings_ >= options_.piercing_floor         ? Pierce::all
                      : halvings_ >= options_.pinch_piercing_floor ? Pierce::pinched
                                                                   : Pierce::nothing;
      if (halvings_ >= options_.stretch_floor) limits.stretch = std::numeric_limits<double>::infinity();
      report.last = integrator_.attempt(state, start_s, h, limits, candidate_);
      report.passes += report.last.passes;
      report.cg_iterations += report.last.cg_iterations;
      if (report.last) {
        integrator_.accept(candidate_, h);
        std::swap(state, candidate_);
        now += step_ticks;
        ++report.steps;
        steps_s_.push_back(h);
        report.met += report.last.filter.impacts > 0 ? 1 : 0;
        report.corrected += report.last.filter.corrected;
        report.truncated += report.last.filter.truncated;
        report.pierced += report.last.filter.body_left;
        report.pinched = std::max(report.pinched, report.last.pinched);
        report.step_min_s = report.steps == 1 ? h : std::min(report.step_min_s, h);
        report.step_max_s = std::max(report.step_max_s, h);
        report.cg_max = std::max(report.cg_max, report.last.cg_iterations);
        if (growing_) patience_ = wait_ = 2;  // the increase held: the next may follow after two
        growing_ = false;
        ++successes_;
        break;
      }
      ++report.rejected;
      report.refused += report.last.status == StepStatus::passed_through ? 1 : 0;
      if (halvings_ >= options_.most_halvings) {
        report.ok = false;
        report.diagnosis = diagnose(state, report.last);
        report.offenders = offenders(state, report.last);
        return report;
      }
      if (growing_) patience_ = std::min(2 * patience_, longest_wait);
      growing_ = false;
      wait_ = patience_;
      successes_ = 0;
      ++halvings_;
    }
    const long doubled = ticks_per_base >> (halvings_ - 1 < 0 ? 0 : halvings_ - 1);
    if (halvings_ > 0 && successes_ >= wait_ && now % doubled == 0) {
      --halvings_;
      successes_ = 0;
      growing_ = true;
    }
  }
  return report;
}

Index AdaptiveStep::most_strained(const ClothState& state) const {
  std::vector<Vec2> w(integrator_.model().mesh.triangles.size());
  integrator_.elements().stretch(state.x, w);
  double worst = 0;
  Index triangle = -1;
  for (std::size_t t = 0; t < w.size(); ++t) {
    const double strain = (w[t] - Vec2::Ones()).cwiseAbs().maxCoeff();
    if (strain > worst) {
      worst = strain;
      triangle = static_cast<Index>(t);
    }
  }
  return triangle;
}

// The offending triangle, or all triangles around the offending particles.
std::vector<Index> AdaptiveStep::offenders(const ClothState& state, const StepReport& report) const {
  const std::vector<Triangle>& triangles = integrator_.model().mesh.triangles;
  std::vector<char> marked(state.x.size(), 0);
  const auto mark = [&](Index particle) {  // the body's particles follow the cloth's
    if (particle >= 0 && static_cast<std::size_t>(particle) < marked.size())
      marked[static_cast<std::size_t>(particle)] = 1;
  };
  mark(report.worst_particle);
  if (report.status == StepStatus::passed_through) {
    for (const auto impacts : {integrator_.filter().left(), integrator_.filter().left_with_body()})
      for (const Impact& impact : impacts)
        for (const Index particle : impact.particle) mark(particle);
  }
  const Index strained = report.status == StepStatus::solver_failed ? most_strained(state) : report.worst_triangle;
  std::vector<Index> found;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const bool any = std::any_of(triangles[t].begin(), triangles[t].end(),
                                 [&](Index i) { return marked[static_cast<std::size_t>(i)] != 0; });
    if (any || static_cast<Index>(t) == strained) found.push_back(static_cast<Index>(t));
  }
  return found;
}

std::string AdaptiveStep::diagnose(const ClothState& state, const StepReport& report) const {
  std::string words = "the step collapsed below " + std::to_string(report.h_s) + " s: " + report.explain();
  const ClothModel& model = integrator_.model();
  Index triangle = report.worst_triangle;
  if (triangle < 0 && report.status == StepStatus::solver_failed) triangle = most_strained(state);
  if (triangle >= 0) {
    const Triangle& corners = model.mesh.triangles[static_cast<std::size_t>(triangle)];
    const Vec3& x = state.x[static_cast<std::size_t>(corners[0])];
    words += fmt::sprintf("; triangle %d (particles %d, %d, %d) at (%.3f, %.3f, %.3f) m", triangle, corners[0],
                          corners[1], corners[2], x.x(), x.y(), x.z());
  }
  if (report.worst_particle >= 0) {
    const Vec3& x = state.x[static_cast<std::size_t>(report.worst_particle)];
    words += fmt::sprintf("; particle %d at (%.3f, %.3f, %.3f) m", report.worst_particle, x.x(), x.y(), x.z());
  }
  return words;
}

}  // namespace toile::internal
