// support/every_target.hpp: runs a test on each of the machine's instruction sets.
//
// TOILE_TEST_TARGETS names those to test, "SSSE3" or "SSSE3,AVX2"; unset: all that the machine has.
#pragma once
#include <gtest/gtest.h>
#include <hwy/detect_targets.h>
#include <hwy/targets.h>

#include <cstdint>
#include <cstdlib>
#include <string>

namespace toile::internal::test {

inline bool is_asked_for(const std::string& target) {
  const char* const only = std::getenv("TOILE_TEST_TARGETS");
  return only == nullptr || (',' + std::string(only) + ',').find(',' + target + ',') != std::string::npos;
}

// Calls work(name of the set) on each in turn, the most basic last, and returns the number that the machine has.
template <class Work>
int on_every_target(const Work& work) {
  int count = 0;
  bool any = false;
  std::string names;
  const auto supported = static_cast<std::uint64_t>(hwy::SupportedTargets() & HWY_TARGETS);  // with compiled code
  for (std::uint64_t left = supported; left != 0; left &= left - 1, ++count) {
    const auto target = static_cast<std::int64_t>(left & (~left + 1));
    names += std::string(" ") + hwy::TargetName(target);
    if (!is_asked_for(hwy::TargetName(target))) continue;
    any = true;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    work(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_TRUE(any) << "TOILE_TEST_TARGETS names none of those of this machine:" << names;
  return count;
}

}  // namespace toile::internal::test
