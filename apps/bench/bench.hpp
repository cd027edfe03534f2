// apps/bench/bench.hpp: the five benchmarks of `toile bench`.                                            docs/benchmarks.md
//
// Each fills tables and facts; bench_command.cpp adds the machine and prints.  An interrupt ends one after the current row.
#pragma once
#include "bench_runs.hpp"

namespace toile::internal {

BenchResult bench_scaling(BenchRuns& runs);
BenchResult bench_stiffness(BenchRuns& runs);
BenchResult bench_paper(BenchRuns& runs);
BenchResult bench_micro(BenchRuns& runs);
BenchResult bench_torture(BenchRuns& runs);

}  // namespace toile::internal
