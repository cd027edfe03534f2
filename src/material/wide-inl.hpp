// material/wide-inl.hpp: numbers and vectors of several elements at once, so that formulas read as they do for one.
//
// Included once for each instruction set that the compiler knows (Highway).  Every operation is a single one of IEEE
// 754 and every sum has one order, so each element gets the same bits whatever the width of a register.
#if defined(TOILE_MATERIAL_WIDE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOILE_MATERIAL_WIDE_INL_HPP
#undef TOILE_MATERIAL_WIDE_INL_HPP
#else
#define TOILE_MATERIAL_WIDE_INL_HPP
#endif

#include "material/batch.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace toile::internal::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using WideTag = hn::CappedTag<double, batch_size>;
constexpr std::size_t wide_lanes = hn::MaxLanes(WideTag());

struct Wide {
  hn::Vec<WideTag> v;
};
struct WideMask {
  hn::Mask<WideTag> m;
};

HWY_INLINE Wide wide(double a) { return {hn::Set(WideTag(), a)}; }
HWY_INLINE Wide operator+(Wide a, Wide b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE Wide operator-(Wide a, Wide b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE Wide operator*(Wide a, Wide b) { return {hn::Mul(a.v, b.v)}; }
HWY_INLINE Wide operator/(Wide a, Wide b) { return {hn::Div(a.v, b.v)}; }
HWY_INLINE Wide operator*(double a, Wide b) { return wide(a) * b; }
HWY_INLINE Wide square_root(Wide a) { return {hn::Sqrt(a.v)}; }
HWY_INLINE WideMask operator<(Wide a, Wide b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE WideMask operator>(Wide a, Wide b) { return {hn::Gt(a.v, b.v)}; }
HWY_INLINE Wide select(WideMask where, Wide yes, Wide no) { return {hn::IfThenElse(where.m, yes.v, no.v)}; }
HWY_INLINE Wide or_zero(WideMask where, Wide yes) { return {hn::IfThenElseZero(where.m, yes.v)}; }
// Like std::max(0.0, a) and std::min(a, b); a is no NaN.
HWY_INLINE Wide at_least_zero(Wide a) { return or_zero(wide(0) < a, a); }
HWY_INLINE Wide smaller(Wide a, Wide b) { return select(b < a, b, a); }

// Lanes [lane, lane + wide_lanes) of one number of a batch.
HWY_INLINE Wide load(const Batched& numbers, std::size_t lane) { return {hn::Load(WideTag(), numbers + lane)}; }
HWY_INLINE void store(Wide a, Batched& numbers, std::size_t lane) { hn::Store(a.v, WideTag(), numbers + lane); }

struct WideVec3 {
  Wide x, y, z;
};
HWY_INLINE WideVec3 operator+(const WideVec3& a, const WideVec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE WideVec3 operator-(const WideVec3& a, const WideVec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE WideVec3 operator*(Wide a, const WideVec3& b) { return {a * b.x, a * b.y, a * b.z}; }
HWY_INLINE WideVec3 operator/(const WideVec3& a, Wide b) { return {a.x / b, a.y / b, a.z / b}; }
HWY_INLINE Wide dot(const WideVec3& a, const WideVec3& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
HWY_INLINE Wide norm(const WideVec3& a) { return square_root(dot(a, a)); }
HWY_INLINE WideVec3 or_zero(WideMask where, const WideVec3& a) {
  return {or_zero(where, a.x), or_zero(where, a.y), or_zero(where, a.z)};
}
HWY_INLINE WideVec3 load(const Batched (&vector)[3], std::size_t lane) {
  return {load(vector[0], lane), load(vector[1], lane), load(vector[2], lane)};
}
HWY_INLINE void store(const WideVec3& a, Batched (&vector)[3], std::size_t lane) {
  store(a.x, vector[0], lane);
  store(a.y, vector[1], lane);
  store(a.z, vector[2], lane);
}

// By rows.
struct WideMat3 {
  WideVec3 row[3];
};
HWY_INLINE WideMat3 operator+(const WideMat3& a, const WideMat3& b) {
  return {{a.row[0] + b.row[0], a.row[1] + b.row[1], a.row[2] + b.row[2]}};
}
HWY_INLINE WideMat3 operator-(const WideMat3& a, const WideMat3& b) {
  return {{a.row[0] - b.row[0], a.row[1] - b.row[1], a.row[2] - b.row[2]}};
}
HWY_INLINE WideMat3 operator*(Wide a, const WideMat3& b) { return {{a * b.row[0], a * b.row[1], a * b.row[2]}}; }
HWY_INLINE WideVec3 operator*(const WideMat3& a, const WideVec3& b) {
  return {dot(a.row[0], b), dot(a.row[1], b), dot(a.row[2], b)};
}
HWY_INLINE WideMat3 outer(const WideVec3& a, const WideVec3& b) { return {{a.x * b, a.y * b, a.z * b}}; }
HWY_INLINE WideMat3 transpose(const WideMat3& a) {
  return {{{a.row[0].x, a.row[1].x, a.row[2].x},
           {a.row[0].y, a.row[1].y, a.row[2].y},
           {a.row[0].z, a.row[1].z, a.row[2].z}}};
}
HWY_INLINE void add_to_diagonal(Wide a, WideMat3& m) {
  m.row[0].x = m.row[0].x + a;
  m.row[1].y = m.row[1].y + a;
  m.row[2].z = m.row[2].z + a;
}

}  // namespace toile::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
