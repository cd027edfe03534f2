// core/state_archive.hpp: serialises the state of a simulation between two frames.
//
// A class names its state once, for both directions, in the order in which it is stored:
//
//   template <class Archive>
//   void remember(Archive& archive) { archive(time_s_, memory_); archive.fixed(touch_); }
//
// so that writing and reading cannot differ.  Bits come back as they were, -0 and NaN too.
//
// Easily got wrong: a cache that does not change results has no place here, and everything that does must be here: the tests of
// sim/resume compare a run that goes on with one that was never interrupted, bit by bit.
#pragma once
#include "core/error.hpp"
#include "core/types.hpp"

#include <array>
#include <concepts>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace toile::internal {

template <class T>
concept RawState = std::is_arithmetic_v<T> || std::is_enum_v<T>;

class StateWriter {
 public:
  static constexpr bool reads = false;

  template <class... T>
  void operator()(T&... values) {
    (put(values), ...);
  }
  // A vector whose length follows from the scene: the reader refuses any other length.
  template <class T>
  void fixed(std::vector<T>& values) {
    put(values);
  }

  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  void raw(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  void count(std::size_t n) {
    const auto wide = static_cast<std::uint64_t>(n);
    raw(&wide, sizeof wide);
  }

  template <RawState T>
  void put(T& value) {
    raw(&value, sizeof value);
  }
  template <int N>
  void put(Eigen::Matrix<double, N, 1>& v) {
    raw(v.data(), sizeof(double) * N);
  }
  void put(std::string& text) {
    count(text.size());
    raw(text.data(), text.size());
  }
  template <class T, std::size_t N>
  void put(std::array<T, N>& values) {
    for (T& value : values) put(value);
  }
  template <class T>
  void put(std::vector<T>& values) {
    count(values.size());
    if constexpr (RawState<T>) {
      raw(values.data(), values.size() * sizeof(T));
    } else if constexpr (std::is_same_v<T, Vec3>) {
      static_assert(sizeof(Vec3) == 3 * sizeof(double));
      raw(values.data(), values.size() * sizeof(Vec3));
    } else {
      for (T& value : values) put(value);
    }
  }
  template <class T>
  void put(std::optional<T>& value) {
    bool there = value.has_value();
    put(there);
    if (there) put(*value);
  }
  template <class T>
  requires requires(T& value, StateWriter& archive) { value.remember(archive); }
  void put(T& value) { value.remember(*this); }

  std::string bytes_;
};

class StateReader {
 public:
  static constexpr bool reads = true;

  // `file` is named in messages.  The bytes must outlive the reader.
  StateReader(std::string_view bytes, std::string file) : bytes_(bytes), file_(std::move(file)) {}
  const std::string& file() const { return file_; }

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  template <class T>
  void fixed(std::vector<T>& values) {
    const std::size_t expected = values.size();
    get(values);
    if (values.size() != expected) fail(std::to_string(expected) + " entries", std::to_string(values.size()));
  }
  // Throws unless all bytes have been read.
  void end() const {
    if (at_ != bytes_.size()) fail("the end of the state", std::to_string(bytes_.size() - at_) + " bytes more");
  }

 private:
  [[noreturn]] void fail(const std::string& expected, const std::string& got) const {
    throw InputError(file_, "byte " + std::to_string(at_) + " of the state", expected, got);
  }
  void raw(void* data, std::size_t size) {
    if (size > bytes_.size() - at_) fail(std::to_string(size) + " bytes", std::to_string(bytes_.size() - at_));
    if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  // A count is accepted only if there are bytes for it.
  std::size_t count(std::size_t least_bytes_each) {
    std::uint64_t n = 0;
    raw(&n, sizeof n);
    if (n > (bytes_.size() - at_) / least_bytes_each)
      fail("at most " + std::to_string((bytes_.size() - at_) / least_bytes_each) + " entries", std::to_string(n));
    return static_cast<std::size_t>(n);
  }

  template <RawState T>
  void get(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      unsigned char byte = 0;
      raw(&byte, 1);
      if (byte > 1) fail("0 or 1", std::to_string(byte));
      value = byte != 0;
    } else {
      raw(&value, sizeof value);
    }
  }
  template <int N>
  void get(Eigen::Matrix<double, N, 1>& v) {
    raw(v.data(), sizeof(double) * N);
  }
  void get(std::string& text) {
    text.resize(count(1));
    raw(text.data(), text.size());
  }
  template <class T, std::size_t N>
  void get(std::array<T, N>& values) {
    for (T& value : values) get(value);
  }
  template <class T>
  void get(std::vector<T>& values) {
    if constexpr (RawState<T> || std::is_same_v<T, Vec3>) {
      values.resize(count(sizeof(T)));
      raw(values.data(), values.size() * sizeof(T));
    } else {
      const std::size_t n = count(1);
      values.clear();
      for (std::size_t i = 0; i < n; ++i) get(values.emplace_back());
    }
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool there = false;
    get(there);
    value.reset();
    if (there) get(value.emplace());
  }
  template <class T>
  requires requires(T& value, StateReader& archive) { value.remember(archive); }
  void get(T& value) { value.remember(*this); }

  std::string_view bytes_;
  std::string file_;
  std::size_t at_ = 0;
};

}  // namespace toile::internal
