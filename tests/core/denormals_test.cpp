#include "core/denormals.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cfenv>
#include <cstdint>

namespace toile::internal {
namespace {

// Of 10^-20 with itself, 10^-40, and of 10^-40 with 10^20.  Volatile: by the processor, not the compiler.  Bits: a comparison would take
// the one for zero as well.
std::uint32_t tiny_product() {
  volatile float a = 1e-20f;
  volatile float product = a * a;
  return std::bit_cast<std::uint32_t>(static_cast<float>(product));
}
std::uint32_t product_of_tiny() {
  volatile float a = 1e-40f, b = 1e20f;
  volatile float product = a * b;
  return std::bit_cast<std::uint32_t>(static_cast<float>(product));
}

#if defined(__SSE__)
TEST(DenormalsAreZero, WhileItLives) {
  EXPECT_GT(tiny_product(), 0u);
  EXPECT_GT(product_of_tiny(), 0u);
  {
    const DenormalsAreZero outer;
    EXPECT_EQ(tiny_product(), 0u);
    EXPECT_EQ(product_of_tiny(), 0u);
    { const DenormalsAreZero inner; }
    EXPECT_EQ(tiny_product(), 0u) << "as the host had set it";
    EXPECT_EQ(product_of_tiny(), 0u);
  }
  EXPECT_GT(tiny_product(), 0u);
  EXPECT_GT(product_of_tiny(), 0u);
}

TEST(DenormalsAreZero, KeepsTheFlagsThatWereRaisedMeanwhile) {
  std::feclearexcept(FE_ALL_EXCEPT);
  {
    const DenormalsAreZero here;
    volatile float zero = 0;
    volatile float none = zero / zero;
    (void)none;
  }
  EXPECT_NE(std::fetestexcept(FE_INVALID), 0);
  std::feclearexcept(FE_ALL_EXCEPT);
}
#endif

TEST(DenormalsAreZero, LeavesAllOtherNumbersAlone) {
  volatile float a = 1.1e-19f;
  volatile float before = a * a;  // the least normal float is 1.18e-38
  const DenormalsAreZero here;
  volatile float within = a * a;
  EXPECT_EQ(before, within);
}

}  // namespace
}  // namespace toile::internal
