// core/hash.hpp: 64-bit fingerprints of bits; not for security.
//
//   Hash       FNV-1a: `state_hash`, `input_hash`, golden tests
//   Checksum   of a frame or a file: whether it is as it was written.  Eight bytes at a time, as every step is one-to-one in the state
//              and in the word: two texts of one length that differ in one word never have the same.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace toile::internal {

inline std::string hex_of(std::uint64_t value) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text(16, '0');
  for (int i = 0; i < 16; ++i) text[static_cast<std::size_t>(i)] = digits[(value >> (60 - 4 * i)) & 15];
  return text;
}

// May be called with pieces; all but the last must have a length that is a multiple of eight.
class Checksum {
 public:
  explicit Checksum(std::uint64_t size_bytes) : value_(0x9e3779b97f4a7c15ULL ^ size_bytes) {}
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (; size >= 8; bytes += 8, size -= 8) {
      std::uint64_t word;
      std::memcpy(&word, bytes, 8);
      value_ = after(word);
    }
    if (size > 0) std::memcpy(&rest_, bytes, size);  // an empty range may have a null pointer
  }
  std::uint64_t value() const { return after(rest_); }

 private:
  std::uint64_t after(std::uint64_t word) const {
    const std::uint64_t value = (value_ ^ word) * 0xff51afd7ed558ccdULL;
    return value ^ (value >> 32);
  }

  std::uint64_t value_, rest_ = 0;
};

inline std::uint64_t checksum(const void* data, std::size_t size) {
  Checksum sum(size);
  sum.add(data, size);
  return sum.value();
}

class Hash {
 public:
  void add_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3ULL;
  }
  // Numbers are hashed by their bits: -0.0 and 0.0 differ, as they would in a replay.
  template <class T>
  void add(std::span<const T> values) {
    add_bytes(values.data(), values.size_bytes());
  }
  // With their number, so that the next item cannot be taken for a part of them.
  template <class T>
  void add_counted(std::span<const T> values) {
    const std::uint64_t size = values.size();
    add_bytes(&size, sizeof size);
    add(values);
  }
  void add_text(std::string_view text) { add_counted(std::span(text.data(), text.size())); }
  std::uint64_t value() const { return value_; }
  std::string hex() const { return hex_of(value_); }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

inline std::uint64_t hash_of_text(std::string_view text) {
  Hash hash;
  hash.add_text(text);
  return hash.value();
}

// Combines several hashes; their order counts.
inline std::uint64_t combined(std::initializer_list<std::uint64_t> hashes) {
  Hash hash;
  hash.add_counted(std::span(hashes.begin(), hashes.size()));
  return hash.value();
}

}  // namespace toile::internal
