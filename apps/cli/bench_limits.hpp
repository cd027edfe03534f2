// apps/cli/bench_limits.hpp: the table "limits" of `toile bench micro`: the solver's pieces beside what the machine can read.
//
//   share = time to read as many bytes / time of the piece        1: nothing but moving its data takes time
//
// Bytes are counted once per loop over the particles, blocks as often as the method reads them: traffic_of() in the .cpp has the sums.
#pragma once
#include "bench_runs.hpp"

namespace toile {

// A row per piece, size of CommandLine::limit_sizes, and one and two threads, as far as there are two.
BenchTable measure_limits(BenchRuns& runs);

}  // namespace toile
