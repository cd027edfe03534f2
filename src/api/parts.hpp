// api/parts.hpp: conversions between the library's types (include/toile/) and the engine's.
#pragma once
#include "core/error.hpp"
#include "sim/scene.hpp"
#include "toile/body.hpp"
#include "toile/cloth.hpp"
#include "toile/error.hpp"
#include "toile/fabric.hpp"

#include <exception>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace toile {

struct Cloth::Parts {
  internal::SceneCloth cloth;
};

struct Body::Parts {
  internal::SceneCollider body;
};

// Translates exceptions of `work` into errors of toile/error.hpp.
[[noreturn]] void throw_translated();
template <class Work>
decltype(auto) translated(Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (...) {
    throw_translated();
  }
}

// Check an argument; throw internal::InputError naming it.
void require_finite(const char* what, const Point& p);
void require_above_zero(const char* what, double value);     // and finite
void require_at_least_zero(const char* what, double value);  // likewise
void require_pressure(const char* what, double Pa);          // as in a scene

internal::Fabric engine_fabric(const Fabric& fabric);

inline internal::Vec3 engine_vector(const Point& p) { return {p[0], p[1], p[2]}; }
inline Point point_of(const internal::Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline std::vector<internal::Vec3> engine_vectors(std::span<const Point> points) {
  std::vector<internal::Vec3> vectors;
  vectors.reserve(points.size());
  for (const Point& p : points) vectors.push_back(engine_vector(p));
  return vectors;
}

// The same memory: an engine's vector is three doubles.
static_assert(sizeof(internal::Vec3) == sizeof(Point) && alignof(internal::Vec3) == alignof(Point));
inline std::span<const Point> view(std::span<const internal::Vec3> vectors) {
  return {reinterpret_cast<const Point*>(vectors.data()), vectors.size()};
}
static_assert(std::is_same_v<Face, internal::Triangle>);
static_assert(sizeof(std::array<internal::Vec2, 3>) == sizeof(CornerUvs));
inline std::span<const CornerUvs> view(std::span<const std::array<internal::Vec2, 3>> uv) {
  return {reinterpret_cast<const CornerUvs*>(uv.data()), uv.size()};
}

}  // namespace toile
