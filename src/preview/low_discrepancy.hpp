// preview/low_discrepancy.hpp: well-spread sample points, the same for a pixel every time.   [Burley 2020]
//
// The first two dimensions of Sobol's sequence, Owen-scrambled by hashing (B. Burley, Practical Hash-based Owen Scrambling,
// JCGT 9(4), 2020; the permutation is of Laine and Karras, 2011).  Each pair of dimensions has its own scramble and its own
// shuffle of the order, so that pairs do not correlate.
//
// Mind: the shuffle is masked to the next power of two above the sample count.  A nested shuffle keeps aligned blocks together,
// so any prefix stays well spread, and the loop over bits ends after log2(count) steps instead of 32.
#pragma once
#include "preview/vec3f.hpp"

#include <bit>
#include <cstdint>

namespace toile::internal {

inline std::uint32_t mix_bits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

inline std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}

// Owen scrambling of a number whose bits are reversed: every bit is flipped depending on the bits below it.
inline std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

// The points of one path: next() gives dimension pair after dimension pair, each in [0, 1)^2.
class PathSampler {
 public:
  PathSampler(std::uint32_t pixel_seed, std::uint32_t index, std::uint32_t count)
      : pixel_seed_(pixel_seed), index_reversed_(reverse_bits(index)), mask_(std::bit_ceil(count) - 1) {}

  Vec2f next() {
    const std::uint32_t seed = mix_bits(pixel_seed_ + 0x9e3779b9u * ++pair_);
    const std::uint32_t index = reverse_bits(scramble_reversed(index_reversed_, seed)) & mask_;
    // Dimension 0 is the index with its bits reversed, dimension 1 Pascal's triangle mod 2; both reversed once more to scramble.
    std::uint32_t second = 0;
    std::uint32_t direction = 0x80000000u;
    for (std::uint32_t bits = index; bits != 0; bits >>= 1, direction ^= direction >> 1) {
      if (bits & 1) second ^= direction;
    }
    return {to_unit(reverse_bits(scramble_reversed(index, mix_bits(seed ^ 0x68bc21ebu)))),
            to_unit(reverse_bits(scramble_reversed(reverse_bits(second), mix_bits(seed ^ 0x02e5be93u))))};
  }

 private:
  static float to_unit(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

  std::uint32_t pixel_seed_, index_reversed_, mask_, pair_ = 0;
};

// Turns (x, y, z) around so that z points along the unit vector n.  [Duff et al. 2017, Building an Orthonormal Basis, Revisited]
inline Vec3f along_normal(const Vec3f& n, float x, float y, float z) {
  const float sign = n.z() >= 0.0f ? 1.0f : -1.0f;
  const float a = -1.0f / (sign + n.z());
  const float b = n.x() * n.y() * a;
  const Vec3f tangent(1.0f + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
  const Vec3f bitangent(b, sign + n.y() * n.y() * a, -n.y());
  return x * tangent + y * bitangent + z * n;
}

// Direction about n with density cos / pi.
inline Vec3f cosine_direction(const Vec3f& n, const Vec2f& u) {
  const float radius = std::sqrt(u.x());
  const float angle = 6.28318531f * u.y();
  return along_normal(n, radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0f, 1.0f - u.x())));
}

}  // namespace toile::internal
