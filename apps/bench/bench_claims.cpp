#include "bench_claims.hpp"

#include "bench_probe.hpp"
#include "step/explicit_reference.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <utility>

namespace toile::internal {
namespace {

constexpr int cg_particles = 6000;  // 18,000 variables
constexpr int explicit_particles = 2602;
constexpr int explicit_steps = 200;

BenchRow claim(std::string key, std::string what, std::string of_1998, double measured, std::string_view unit,
               int digits) {
  BenchRow row;
  row.add("what", "what", std::move(what));
  row.add("claim", "key", std::move(key));
  row.add("of_1998", "1998", std::move(of_1998));
  row.add("measured", "measured", measured, digits);
  row.add("unit", "unit", std::string(unit));
  return row;
}

Drape drape_to(BenchRuns& runs, int particles, std::string_view what) {
  runs.say(what, 0);
  Scene scene = embedded_scene("fig1-drape");
  SceneGrid& grid = std::get<SceneGrid>(scene.cloth.front().kind);
  grid.edge_m = edge_for(grid, particles);
  return Drape(scene);
}

void reach(Drape& drape, int frames) {
  if (!drape.advance(frames)) throw Error(ErrorKind::simulation_failed, "bench paper: the drape failed");
}

}  // namespace

void add_cg_claims(BenchRuns& runs, std::vector<BenchRow>& claims) {
  Drape drape = drape_to(runs, cg_particles, "18,000 var");
  reach(drape, std::min(state_frame, runs.line().bench_frames.value_or(state_frame)));
  StepSystem system(drape, 1.0 / 60);
  const std::string at = fmt::sprintf("CG iterations, %d variables, h = 1/60 s, ", 3 * system.model().particle_count());
  const auto solve = [&](std::string key, const std::string& how, std::string of_1998, const PcgOptions& options) {
    const PcgReport report = system.solve(options);
    claims.push_back(claim(std::move(key), at + how, std::move(of_1998), report.iterations,
                           report ? "iterations" : "iterations, not converged", 0));
  };
  PcgOptions options;
  options.max_iterations = most_iterations;
  options.preconditioner = Preconditioner::diagonal;
  options.procedure = PcgProcedure::paper_1998;
  for (const double eps : {1e-2, 1e-3}) {
    options.tolerance = eps;
    solve(fmt::sprintf("cg_paper_1998_eps_%g", eps), fmt::sprintf("as printed in 1998, eps = %g", eps), "50 - 100",
          options);
  }
  options.procedure = PcgProcedure::prefiltered;
  options.tolerance = 1e-3;  // of all three preconditioners
  for (const auto kind : {Preconditioner::diagonal, Preconditioner::block_jacobi, Preconditioner::block_ssor_coarse}) {
    options.preconditioner = kind;
    const std::string name(to_string(kind));
    solve("cg_" + name,
          fmt::sprintf("our stop rule, %s%s", name.c_str(), kind == PcgOptions{}.preconditioner ? " (ours)" : ""), "",
          options);
  }
}

void add_explicit_claims(BenchRuns& runs, std::vector<BenchRow>& claims) {
  Drape drape = drape_to(runs, explicit_particles, "explicit");
  reach(drape, std::min(state_frame, runs.line().bench_frames.value_or(state_frame)));
  // Released in the air, without contacts: they would only shorten the step.
  ExplicitReference reference(drape.model(), {});
  const ExplicitLimit limit = reference.limit(drape.state());
  const auto stands = [&](double h_s) {
    return reference.stands(drape.state(), h_s, explicit_steps, ExplicitScheme::symplectic_euler);
  };
  double below = 0.5 * limit.h_s, above = 2 * limit.h_s;
  for (int k = 0; k < 5 && !interrupted(); ++k) {
    const double middle = 0.5 * (below + above);
    (stands(middle) ? below : above) = middle;
  }
  const double ours_s = 1 / drape.scene().fps;
  claims.push_back(claim("explicit_step_that_stands",
                         "explicit step, largest that stands " + std::to_string(explicit_steps) + " steps", "",
                         1e3 * below, "ms", 5));
  claims.push_back(
      claim("explicit_step_limit", "explicit step, limit from the spectrum", "", 1e3 * limit.h_s, "ms", 5));
  claims.push_back(
      claim("explicit_step_limit_undamped", "  without damping", "", 1e3 * 2 / limit.omega_per_s, "ms", 5));
  claims.push_back(claim("implicit_step", "step of ours, row 1, longest", "33", 1e3 * ours_s, "ms", 1));
  claims.push_back(claim("implicit_over_explicit", "  times the explicit one", "", ours_s / below, "", 0));
  claims.push_back(claim("implicit_over_explicit_undamped", "  times the explicit one without damping", "",
                         ours_s * limit.omega_per_s / 2, "", 0));
}

}  // namespace toile::internal
