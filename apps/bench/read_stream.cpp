#include "read_stream.hpp"

#include "core/stopwatch.hpp"

#include <algorithm>

// The widest registers available: narrower ones do not saturate the second cache.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "read_stream.cpp"
#include <hwy/foreach_target.h>
// Has to follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace toile::internal::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Four independent sums.
std::uint64_t sum_words(const std::uint64_t* words, std::size_t count) {
  const hn::CappedTag<std::uint64_t, 8> wide;
  const std::size_t lanes = hn::Lanes(wide);
  auto a = hn::Zero(wide), b = a, c = a, d = a;
  std::size_t k = 0;
  for (; k + 4 * lanes <= count; k += 4 * lanes) {
    a = hn::Add(a, hn::Load(wide, words + k));
    b = hn::Add(b, hn::Load(wide, words + k + lanes));
    c = hn::Add(c, hn::Load(wide, words + k + 2 * lanes));
    d = hn::Add(d, hn::Load(wide, words + k + 3 * lanes));
  }
  std::uint64_t sum = hn::GetLane(hn::SumOfLanes(wide, hn::Add(hn::Add(a, b), hn::Add(c, d))));
  for (; k < count; ++k) sum += words[k];
  return sum;
}

}  // namespace
}  // namespace toile::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace toile::internal {
namespace {
HWY_EXPORT(sum_words);
}  // namespace

ReadStream::ReadStream(std::size_t bytes, int threads)
    : team_(threads),
      buffer_((bytes + sizeof(CacheLine) - 1) / sizeof(CacheLine), CacheLine{}),
      sums_(static_cast<std::size_t>(threads), CacheLine{}) {}

void ReadStream::read_part(int member, std::size_t passes) {
  const auto part = static_cast<std::size_t>(member), parts = sums_.size();
  const std::size_t begin = buffer_.size() * part / parts, end = buffer_.size() * (part + 1) / parts;
  for (std::size_t pass = 0; pass < passes; ++pass)
    sums_[part].word[0] += HWY_DYNAMIC_DISPATCH(sum_words)(buffer_[begin].word, (end - begin) * 8);
}

double ReadStream::seconds_per_byte(std::size_t bytes) {
  const std::size_t size = buffer_.size() * sizeof(CacheLine), passes = std::max<std::size_t>(1, bytes / size);
  double seconds = 0;
  bool all_read = false;
  const auto read = [&](int member, int present) {
    if (present < team_.members()) return;  // fewer readers would measure another limit
    read_part(member, 1);
    team_.barrier();  // all threads are awake
    const Stopwatch watch;
    read_part(member, passes);
    team_.barrier();
    if (member != 0) return;
    seconds = watch.seconds();
    all_read = true;
  };
  while (!all_read) team_.run(read);
  return seconds / static_cast<double>(passes * size);
}

}  // namespace toile::internal
#endif
