// core/denormals.hpp: denormal numbers as zero, for a while.
//
// A float product below 10^-38 costs some x86 processors a hundred cycles or more, and the blocks of cloth have many: normals that are
// nearly along an axis, 10^-20 times 10^-20, and corrections that fade over hundreds of rows of a sweep.  The sums that they enter are
// 10^30 times as large, so results have the same bits with them and without.
#pragma once
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace toile::internal {

// During its lifetime its thread reads and writes denormals as zero, in float and in double.  Afterwards the host's mode is restored.
// Only on x86; elsewhere nothing happens.
class DenormalsAreZero {
 public:
#if defined(__SSE__)
  DenormalsAreZero() : before_(_mm_getcsr() & zeros) { _mm_setcsr(_mm_getcsr() | zeros); }
  ~DenormalsAreZero() {
    _mm_setcsr((_mm_getcsr() & ~zeros) | before_);
  }  // flags that were raised meanwhile stay raised
#else
  DenormalsAreZero() = default;
  ~DenormalsAreZero() {}
#endif
  DenormalsAreZero(const DenormalsAreZero&) = delete;
  DenormalsAreZero& operator=(const DenormalsAreZero&) = delete;

#if defined(__SSE__)
 private:
  static constexpr unsigned zeros = 0x8040;  // of MXCSR: results flush to zero, operands are zero
  unsigned before_;
#endif
};

}  // namespace toile::internal
