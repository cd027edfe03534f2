// support/every_target.hpp: the same work on each of the machine's instruction sets.
#pragma once
#include <hwy/targets.h>

#include <cstdint>

namespace toile::test {

// Calls work(name of the set) on each in turn, the plainest last, and returns how many there are.
template <class Work>
int on_every_target(const Work& work) {
  int count = 0;
  const auto supported = static_cast<std::uint64_t>(hwy::SupportedTargets());
  for (std::uint64_t left = supported; left != 0; left &= left - 1, ++count) {
    const auto target = static_cast<std::int64_t>(left & (~left + 1));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    work(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return count;
}

}  // namespace toile::test
