// assembly/lane.hpp: three numbers in four lanes, so that a 3x3 block times a vector takes few vector instructions.
//
// Lane 3 is always zero.  Element-wise IEEE arithmetic in a fixed order: the same bits on every instruction set.
#pragma once
#include "core/types.hpp"

namespace toile::internal {

// Four doubles: for systems that need double precision, and for tests and references.
struct alignas(32) DoubleLane {
  double value[4];
  double operator[](std::size_t k) const { return value[k]; }
  DoubleLane& operator+=(const DoubleLane& o) { return *this = *this + o; }
  DoubleLane& operator-=(const DoubleLane& o) { return *this = *this - o; }
  friend DoubleLane operator+(const DoubleLane& a, const DoubleLane& b) {
    return {{a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]}};
  }
  friend DoubleLane operator-(const DoubleLane& a, const DoubleLane& b) {
    return {{a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]}};
  }
  friend DoubleLane operator*(const DoubleLane& a, const DoubleLane& b) {
    return {{a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]}};
  }
  friend DoubleLane operator*(const DoubleLane& a, double s) { return {{a[0] * s, a[1] * s, a[2] * s, a[3] * s}}; }
};

template <class T>
struct LaneType;
template <>
struct LaneType<float> {
  using type [[gnu::vector_size(16)]] = float;
};
template <>
struct LaneType<double> {
  using type = DoubleLane;
};
template <class T>
using Lane = typename LaneType<T>::type;

template <class T>
Lane<T> to_lane(const Vec3& a) {
  return Lane<T>{static_cast<T>(a.x()), static_cast<T>(a.y()), static_cast<T>(a.z()), T(0)};
}
template <class L>
Vec3 to_vec3(const L& a) {
  return {static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
}
template <class L>
double dot(const L& a, const L& b) {  // products and sum in double: a CG scalar must not lose digits
  return static_cast<double>(a[0]) * static_cast<double>(b[0]) + static_cast<double>(a[1]) * static_cast<double>(b[1]) +
         static_cast<double>(a[2]) * static_cast<double>(b[2]);
}

// Sum of many dot products, with products and sum in double as in dot().
template <class T>
class DotSum;
template <>
class DotSum<float> {
 public:
  void add(const Lane<float>& a, const Lane<float>& b) {
    low_ += low(a) * low(b);
    high_ += high(a) * high(b);
  }
  double value() const { return low_[0] + low_[1] + high_[0]; }

 private:
  using Two [[gnu::vector_size(16)]] = double;
  static Two low(const Lane<float>& a) { return __builtin_convertvector(__builtin_shufflevector(a, a, 0, 1), Two); }
  static Two high(const Lane<float>& a) { return __builtin_convertvector(__builtin_shufflevector(a, a, 2, 3), Two); }
  Two low_{0, 0}, high_{0, 0};
};
template <>
class DotSum<double> {
 public:
  void add(const DoubleLane& a, const DoubleLane& b) { sum_ += dot(a, b); }
  double value() const { return sum_; }

 private:
  double sum_ = 0;
};

// A 3x3 block, column by column.
template <class T>
struct Block {
  Lane<T> c0, c1, c2;

  static Block from(const Mat3& m) { return {to_lane<T>(m.col(0)), to_lane<T>(m.col(1)), to_lane<T>(m.col(2))}; }
  Mat3 to_mat3() const {
    Mat3 m;
    m << to_vec3(c0), to_vec3(c1), to_vec3(c2);
    return m;
  }
  Block transpose() const {
    return {Lane<T>{c0[0], c1[0], c2[0], 0}, Lane<T>{c0[1], c1[1], c2[1], 0}, Lane<T>{c0[2], c1[2], c2[2], 0}};
  }
  Lane<T> times(const Lane<T>& x) const { return c0 * x[0] + c1 * x[1] + c2 * x[2]; }
  Lane<T> transpose_times(const Lane<T>& x) const { return column_sums(c0 * x, c1 * x, c2 * x); }

  // (sum of r0, sum of r1, sum of r2): a 4x4 transpose and two additions.
  static Lane<float> column_sums(const Lane<float>& r0, const Lane<float>& r1, const Lane<float>& r2) {
    const Lane<float> zero{0, 0, 0, 0};
    const Lane<float> low = __builtin_shufflevector(r0, r1, 0, 4, 1, 5),
                      high = __builtin_shufflevector(r0, r1, 2, 6, 3, 7);
    const Lane<float> low2 = __builtin_shufflevector(r2, zero, 0, 4, 1, 5),
                      high2 = __builtin_shufflevector(r2, zero, 2, 6, 3, 7);
    return __builtin_shufflevector(low, low2, 0, 1, 4, 5) + __builtin_shufflevector(low, low2, 2, 3, 6, 7) +
           __builtin_shufflevector(high, high2, 0, 1, 4, 5);
  }
  static DoubleLane column_sums(const DoubleLane& r0, const DoubleLane& r1, const DoubleLane& r2) {
    return {{r0[0] + r0[1] + r0[2], r1[0] + r1[1] + r1[2], r2[0] + r2[1] + r2[2], 0}};
  }
};

}  // namespace toile::internal
