// Cost of the pieces of one solve, per call, on a square sheet of about 2.6k and 8.6k particles.
#include "assembly/elements.hpp"
#include "solver/modified_pcg.hpp"
#include "support/sheets.hpp"

#include <benchmark/benchmark.h>

namespace toile::internal {
namespace {

struct Sheet {
  explicit Sheet(double edge_m)
      : sheet(test::equilateral_sheet(1, 1, edge_m)),
        model(build_model(sheet.mesh, std::array{Fabric{}})),
        elements(model),
        A(elements.pattern()),
        system(A),
        constraints(model.particle_count()),
        state{test::crumpled(sheet.x, 0.0005, 1), Vec3s(sheet.x.size(), Vec3::Zero())},
        b(sheet.x.size()),
        reference(sheet.x.size()) {
    elements.evaluate(model, state);
    for (Index i = 0; i < A.rows(); ++i) A.grounded(i) = model.mass_kg[static_cast<std::size_t>(i)] * Mat3::Identity();
    elements.assemble(1.0 / 60, A);
    system.update({}, constraints);
    elements.forces(b);
    for (std::size_t i = 0; i < b.size(); ++i) {
      reference[i] = model.mass_kg[i] * Vec3(0, -9.81, 0) / 60;
      b[i] = b[i] / 60 + reference[i];
    }
  }
  test::Sheet sheet;
  ClothModel model;
  Elements elements;
  BlockMatrix<float> A;
  LinearSystem<float> system;
  ParticleConstraints constraints;
  ClothState state;
  Vec3s b, reference;
};

double edge_of(const benchmark::State& state) { return state.range(0) == 2600 ? 0.0218 : 0.0118; }

void evaluate_elements(benchmark::State& state) {
  Sheet s(edge_of(state));
  for (auto _ : state) s.elements.evaluate(s.model, s.state);
  state.counters["triangles"] = static_cast<double>(s.model.mesh.triangles.size());
}

void assemble(benchmark::State& state) {
  Sheet s(edge_of(state));
  for (auto _ : state) s.elements.assemble(1.0 / 60, s.A);
  state.counters["blocks"] = s.A.pattern().block_count();
}

void matrix_product(benchmark::State& state) {
  Sheet s(edge_of(state));
  std::vector<Lane<float>> x(s.b.size(), to_lane<float>(Vec3(1, 2, 3))), y(x.size());
  for (auto _ : state) {
    s.A.multiply(std::span<const Lane<float>>(x), std::span<Lane<float>>(y));
    benchmark::DoNotOptimize(y.data());
  }
}

// 50 iterations of each preconditioner; range(1) is its number.
void pcg_iterations(benchmark::State& state) {
  Sheet s(edge_of(state));
  ModifiedPcg<float> pcg(s.model.mesh);
  const PcgOptions options{static_cast<Preconditioner>(state.range(1)), 1e-12, 50};
  pcg.prepare(s.system, options);
  int iterations = 0;
  for (auto _ : state) {
    Vec3s dv(s.b.size(), Vec3::Zero());
    iterations += pcg.solve(s.system, s.b, s.reference, options, dv).iterations;
  }
  state.counters["us_per_iteration"] = benchmark::Counter(static_cast<double>(iterations) * 1e-6,
                                                          benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.SetLabel(std::string(to_string(options.preconditioner)));
}

// A' Z, E and its factor: once per pass of the active set.
void coarse_setup(benchmark::State& state) {
  Sheet s(edge_of(state));
  CoarseSpace<float> coarse(s.model.mesh);
  for (auto _ : state) coarse.factorise(s.system);
  state.counters["rows"] = coarse.dimension();
}

// A whole solve to 1e-3, setup included; range(1) is the preconditioner.
void solve(benchmark::State& state) {
  Sheet s(edge_of(state));
  ModifiedPcg<float> pcg(s.model.mesh);
  const PcgOptions options{static_cast<Preconditioner>(state.range(1)), 1e-3, 5000};
  int iterations = 0;
  for (auto _ : state) {
    Vec3s dv(s.b.size(), Vec3::Zero());
    pcg.prepare(s.system, options);
    iterations = pcg.solve(s.system, s.b, s.reference, options, dv).iterations;
  }
  state.counters["iterations"] = iterations;
  state.SetLabel(std::string(to_string(options.preconditioner)));
}

BENCHMARK(evaluate_elements)->Arg(2600)->Arg(8600)->Unit(benchmark::kMillisecond);
BENCHMARK(assemble)->Arg(2600)->Arg(8600)->Unit(benchmark::kMillisecond);
BENCHMARK(matrix_product)->Arg(2600)->Arg(8600)->Unit(benchmark::kMicrosecond);
BENCHMARK(pcg_iterations)->ArgsProduct({{2600, 8600}, {0, 1, 2, 3}})->Unit(benchmark::kMillisecond);
BENCHMARK(coarse_setup)->Arg(2600)->Arg(8600)->Unit(benchmark::kMillisecond);
BENCHMARK(solve)->ArgsProduct({{2600, 8600}, {0, 1, 2, 3}})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace toile::internal
