// apps/bench/read_stream.hpp: the bandwidth at which this machine reads a buffer of a given size repeatedly, with some threads.
//
// The limit of a piece that reads as many bytes.  The buffer is as large as the piece's working set, so that it is in the same caches,
// and every thread reads a part of its own, as in the piece.
#pragma once
#include "core/team.hpp"

#include <cstdint>
#include <vector>

namespace toile::internal {

class ReadStream {
 public:
  ReadStream(std::size_t bytes, int threads);

  // Measures once, over at least `bytes` of reading; the buffer is read once before, untimed.
  double seconds_per_byte(std::size_t bytes);

 private:
  struct alignas(64) CacheLine {
    std::uint64_t word[8];
  };
  void read_part(int member, std::size_t passes);

  Team team_;
  std::vector<CacheLine> buffer_;
  std::vector<CacheLine> sums_;  // [member] on its own cache line
};

}  // namespace toile::internal
