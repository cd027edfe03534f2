// Cost of additive CCD per query, on motions like those of cloth (Kind::cloth of tests/contact/ccd_queries.hpp).
#include "contact/ccd.hpp"
#include "contact/ccd_count.hpp"

#include <benchmark/benchmark.h>

namespace toile::internal {
namespace {

// One iteration is one query.
void ccd_query(benchmark::State& state, exact::Features features) {
  struct Query {
    std::array<Vec3, 4> x, u;
    double separation_m;
  };
  exact::Random random(1);
  std::vector<Query> queries;
  for (int i = 0; i < 4096; ++i) {
    const exact::Motion motion = ccd_test::motion_of(random, features, ccd_test::Kind::cloth);
    Query query{motion.start, motion.end, std::min(1e-4, 0.5 * ccd_test::distance_m(features, motion.start))};
    for (std::size_t k = 0; k < 4; ++k) query.u[k] -= query.x[k];
    queries.push_back(query);
  }
  std::size_t next = 0;
  for (auto _ : state) {
    const Query& q = queries[next++ % queries.size()];
    benchmark::DoNotOptimize(features == exact::Features::vertex_face ? vertex_face_impact(q.x, q.u, q.separation_m)
                                                                      : edge_edge_impact(q.x, q.u, q.separation_m));
  }
}

// A sleeve on a limb that is moved by some cm in a step: cloth 0.3 to 3 mm above a face, or an edge, slides along it by 1 to 30 mm and turns a
// little.  Nothing meets.
void ccd_slide(benchmark::State& state, exact::Features features) {
  constexpr double separation_m = 1.5e-4;
  exact::Random random(2);
  const auto between = [&](double low, double high) { return random.real(low, high); };
  std::vector<std::array<std::array<Vec3, 4>, 2>> queries;
  for (int i = 0; i < 4096; ++i) {
    const double height = between(3e-4, 3e-3), slide = between(1e-3, 3e-2), lift = between(0, 5e-4);
    std::array<Vec3, 4> x{Vec3(-0.01, height, 0), Vec3(0.01, height + lift, 0), Vec3(0, 0, -0.01), Vec3(0, 0, 0.01)};
    if (features == exact::Features::vertex_face)
      x = {Vec3(0, height, 0), Vec3(-0.01, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0, 0.01)};
    std::array<Vec3, 4> u;
    for (Vec3& v : u) v = Vec3(0.02, 0.01, 0);
    for (std::size_t k = 0; k < (features == exact::Features::vertex_face ? 1u : 2u); ++k)
      u[k] += Vec3(slide * between(0.8, 1.2), between(0, 1e-4), slide * between(-0.2, 0.2));
    queries.push_back({x, u});
  }
  std::size_t next = 0;
  for (auto _ : state) {
    const auto& [x, u] = queries[next++ % queries.size()];
    benchmark::DoNotOptimize(features == exact::Features::vertex_face ? vertex_face_impact(x, u, separation_m)
                                                                      : edge_edge_impact(x, u, separation_m));
  }
}

BENCHMARK_CAPTURE(ccd_slide, vertex_face, exact::Features::vertex_face)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ccd_slide, edge_edge, exact::Features::edge_edge)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ccd_query, vertex_face, exact::Features::vertex_face)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ccd_query, edge_edge, exact::Features::edge_edge)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace toile::internal
