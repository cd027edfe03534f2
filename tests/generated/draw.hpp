// tests/generated/draw.hpp: numbers by chance that depend on a seed and on their name alone.
#pragma once
#include <cstdint>
#include <string_view>

namespace toile::internal::generated {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}

  std::uint64_t bits(std::string_view name) const {
    std::uint64_t h = mix(seed_ + 0x9e3779b97f4a7c15u);
    for (const char c : name) h = mix(h ^ static_cast<unsigned char>(c));
    return h;
  }
  double between(std::string_view name, double low, double high) const {
    return low + (high - low) * (static_cast<double>(bits(name) >> 11) * 0x1p-53);
  }
  int whole(std::string_view name, int low, int high) const {
    return low + static_cast<int>(bits(name) % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {  // the finaliser of splitmix64
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t seed_;
};

}  // namespace toile::internal::generated
