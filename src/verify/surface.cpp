// verify/surface.cpp: see the header.
#include "verify/surface.hpp"

#include "core/error.hpp"

#include <string>

namespace toile::internal {

void check_surface(std::string_view name, std::span<const Triangle> triangles, std::span<const Vec3> x) {
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!x[i].allFinite())
      throw InputError(name, "vertex " + std::to_string(i), "a finite position", "infinity or NaN");
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    if (a == b || b == c || c == a)
      throw InputError(name, "triangle " + std::to_string(t), "three different corners", "one corner twice");
    for (const Index i : triangles[t])
      if (i < 0 || static_cast<std::size_t>(i) >= x.size())
        throw InputError(name, "triangle " + std::to_string(t), "an index below " + std::to_string(x.size()),
                         std::to_string(i));
  }
}

}  // namespace toile::internal
