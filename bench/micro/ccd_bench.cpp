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

BENCHMARK_CAPTURE(ccd_query, vertex_face, exact::Features::vertex_face)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ccd_query, edge_edge, exact::Features::edge_edge)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace toile::internal
