// apps/bench/read_stream.hpp: how fast this machine reads a buffer of a given size, again and again, with some threads.
//
// The limit of a piece that goes through as many bytes.  The buffer is as large as what the piece works on, so that it lies in the same
// caches, and every thread reads a part of its own, as it does there.
#pragma once
#include "core/team.hpp"

#include <cstdint>
#include <vector>

namespace toile::internal {

class ReadStream {
 public:
  ReadStream(std::size_t bytes, int threads);

  // Of one measurement over `bytes` of reading or more; the buffer is read once before, without the clock.
  double seconds_per_byte(std::size_t bytes);

 private:
  struct alignas(64) CacheLine {
    std::uint64_t word[8];
  };
  void read_part(int member, std::size_t passes);

  Team team_;
  std::vector<CacheLine> buffer_;
  std::vector<CacheLine> sums_;  // [member] on a line of its own
};

}  // namespace toile::internal
