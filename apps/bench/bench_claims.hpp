// apps/bench/bench_claims.hpp: two figures from the paper's text, measured on our cloth.                        [BW98 1, 8]
//
//   cg         iterations at 18,000 variables: the paper's diagonal preconditioner in the literal procedure of 1998, and ours
//   explicit   the longest step of an explicit integrator on row 1's cloth, beside our step
#pragma once
#include "bench_runs.hpp"

namespace toile::internal {

void add_cg_claims(BenchRuns& runs, std::vector<BenchRow>& claims);
void add_explicit_claims(BenchRuns& runs, std::vector<BenchRow>& claims);

}  // namespace toile::internal
