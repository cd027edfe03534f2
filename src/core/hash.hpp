// core/hash.hpp: a 64-bit fingerprint of bits, for `state_hash` and golden tests.  FNV-1a; not for security.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace toile {

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
  // With their number, so that what follows cannot be taken for a part of them.
  template <class T>
  void add_counted(std::span<const T> values) {
    const std::uint64_t size = values.size();
    add_bytes(&size, sizeof size);
    add(values);
  }
  void add_text(std::string_view text) { add_counted(std::span(text.data(), text.size())); }
  std::uint64_t value() const { return value_; }
  std::string hex() const {
    static constexpr char digits[] = "0123456789abcdef";
    std::string text(16, '0');
    for (int i = 0; i < 16; ++i) text[static_cast<std::size_t>(i)] = digits[(value_ >> (60 - 4 * i)) & 15];
    return text;
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace toile
