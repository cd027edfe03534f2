// apps/bench/bench_limits.hpp: the table "limits" of `toile bench micro`: the solver's pieces beside the machine's read bandwidth.
//
//   share = time to read as many bytes / time of the piece        1: bound by memory traffic alone
//
// Bytes are counted once per loop over the particles, blocks as often as the method reads them: traffic_of_... in the .cpp have the
// sums.  They are read from a buffer as large as the data read since they were read last: at 100,000 particles the
// second sweep over a domain finds it in a cache, and the first does not.
#pragma once
#include "bench_runs.hpp"

namespace toile::internal {

// A row per piece, size of CommandLine::limit_sizes, and one and two threads, if there are two.
BenchTable measure_limits(BenchRuns& runs);

}  // namespace toile::internal
