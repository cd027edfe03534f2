#include "mesh/check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "core/error.hpp"
#include "mesh/half_edges.hpp"

namespace toile::internal {
namespace {

// Below these fractions of the area or volume of a well-shaped element of that size, a value is rounding noise.
constexpr double zero_area = 1e-10;   // of the longest side squared
constexpr double zero_volume = 1e-9;  // of the surface's area to the power 3/2 (a ball has 0.094)

// Six digits, in every locale.
std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr};
}

std::string element(std::string_view kind, std::size_t index) {
  return std::string(kind) + " " + std::to_string(index);
}

void check_finite(std::string_view where, std::span<const Vec3> positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3& x = positions[i];
    if (!x.allFinite()) {
      throw InputError(where, element("particle", i), "a finite position",
                       "(" + number(x.x()) + ", " + number(x.y()) + ", " + number(x.z()) + ")");
    }
  }
}

// The same three particles twice, in whatever order: reported at the smallest index that repeats an earlier triangle.
void check_duplicates(std::string_view where, std::span<const Triangle> triangles) {
  struct Named {
    Triangle corners;  // sorted
    Index triangle;
  };
  std::vector<Named> named(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    named[t] = {triangles[t], static_cast<Index>(t)};
    std::sort(named[t].corners.begin(), named[t].corners.end());
  }
  std::sort(named.begin(), named.end(), [](const Named& l, const Named& r) {
    return std::tie(l.corners, l.triangle) < std::tie(r.corners, r.triangle);
  });
  Index repeat = std::numeric_limits<Index>::max();
  Index original = -1;
  for (std::size_t n = 1; n < named.size(); ++n) {
    if (named[n].corners == named[n - 1].corners && named[n].triangle < repeat) {
      repeat = named[n].triangle;
      original = named[n - 1].triangle;
    }
  }
  if (original < 0) return;
  const auto [i, j, k] = triangles[static_cast<std::size_t>(repeat)];
  throw InputError(where, element("triangle", static_cast<std::size_t>(repeat)),
                   "three corners that no other triangle joins",
                   std::to_string(i) + ", " + std::to_string(j) + ", " + std::to_string(k) + " again, as in triangle " +
                       std::to_string(original));
}

void check_isolated(std::string_view where, std::size_t particle_count, std::span<const Triangle> triangles) {
  std::vector<char> used(particle_count, 0);
  for (const Triangle& triangle : triangles) {
    for (const Index corner : triangle) used[static_cast<std::size_t>(corner)] = 1;
  }
  const auto isolated = std::find(used.begin(), used.end(), char{0});
  if (isolated != used.end()) {
    throw InputError(where, element("particle", static_cast<std::size_t>(isolated - used.begin())),
                     "a particle that some triangle uses", "one in no triangle");
  }
}

// Returns the half edges, for checks that build on this one.
std::vector<HalfEdge> check_surface(std::string_view where, std::span<const Vec3> positions,
                                    std::span<const Triangle> triangles) {
  if (triangles.empty()) throw InputError(where, "mesh", "at least one triangle", "none");
  check_corners(where, static_cast<Index>(positions.size()), triangles);
  check_finite(where, positions);
  check_duplicates(where, triangles);
  std::vector<HalfEdge> half_edges = sorted_half_edges(triangles);
  check_edges(where, half_edges);
  check_isolated(where, positions.size(), triangles);
  return half_edges;
}

// `what` has one entry per triangle.
void check_count(std::string_view where, std::string_view what, std::size_t expected, std::size_t got) {
  if (expected != got) {
    throw InputError(where, what, std::to_string(expected) + " entries", std::to_string(got));
  }
}

}  // namespace

void check_triangles(std::string_view where, std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  check_surface(where, positions, triangles);
}

void check_cloth(std::string_view where, const ClothMesh& mesh, std::span<const Vec3> positions) {
  check_count(where, "positions", static_cast<std::size_t>(std::max<Index>(mesh.particle_count, 0)), positions.size());
  check_count(where, "uv", mesh.triangles.size(), mesh.uv.size());
  check_count(where, "panel", mesh.triangles.size(), mesh.panel.size());
  check_surface(where, positions, mesh.triangles);

  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Index panel = mesh.panel[t];
    if (panel < 0 || static_cast<std::size_t>(panel) >= mesh.panel_names.size()) {
      throw InputError(where, element("triangle", t),
                       "one of the " + std::to_string(mesh.panel_names.size()) + " panels",
                       "panel " + std::to_string(panel));
    }
    const std::string place =
        element("triangle", t) + " of panel \"" + printable(mesh.panel_names[static_cast<std::size_t>(panel)]) + "\"";
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec2& uv = mesh.uv[t][corner];
      if (!uv.allFinite()) {
        throw InputError(where, place, "finite pattern coordinates",
                         "(" + number(uv.x()) + ", " + number(uv.y()) + ") at corner " + std::to_string(corner));
      }
    }
    const Vec2 side0 = mesh.uv[t][1] - mesh.uv[t][0];
    const Vec2 side1 = mesh.uv[t][2] - mesh.uv[t][1];
    const Vec2 side2 = mesh.uv[t][0] - mesh.uv[t][2];
    const double longest2 = std::max({side0.squaredNorm(), side1.squaredNorm(), side2.squaredNorm()});
    const double twice_area = side2.x() * side0.y() - side0.x() * side2.y();
    if (!(twice_area > zero_area * longest2) || !std::isfinite(twice_area)) {
      const bool flipped = twice_area < -zero_area * longest2;
      throw InputError(
          where, place, "a positive area in the pattern",
          number(0.5 * twice_area) + " m^2" + (flipped ? " (clockwise: flipped)" : " (its corners lie on one line)"));
    }
  }
}

void check_closed(std::string_view where, std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  const std::vector<HalfEdge> half_edges = check_surface(where, positions, triangles);
  for (std::size_t first = 0; first < half_edges.size();) {
    const std::size_t end = edge_end(half_edges, first);
    if (end - first == 1) {
      const HalfEdge& side = half_edges[first];
      throw InputError(where, "edge " + std::to_string(side.a) + "-" + std::to_string(side.b), "two triangles",
                       "only triangle " + std::to_string(side.triangle) + " (the surface has a hole)");
    }
    first = end;
  }

  // Divergence theorem: one tetrahedron per triangle, from a point near the surface so that a body far from the origin
  // does not lose its volume to cancellation.
  const Vec3& origin = positions[static_cast<std::size_t>(triangles[0][0])];
  double volume = 0;
  double area = 0;
  for (const Triangle& triangle : triangles) {
    const Vec3 x0 = positions[static_cast<std::size_t>(triangle[0])] - origin;
    const Vec3 x1 = positions[static_cast<std::size_t>(triangle[1])] - origin;
    const Vec3 x2 = positions[static_cast<std::size_t>(triangle[2])] - origin;
    volume += x0.dot(x1.cross(x2)) / 6;
    area += (x1 - x0).cross(x2 - x0).norm() / 2;
  }
  const double noise = zero_volume * area * std::sqrt(area);
  if (!(volume > noise)) {
    throw InputError(where, "mesh", "triangles that face outwards around a positive volume",
                     number(volume) + (volume < -noise ? " (turned inside out)" : " (flat)"));
  }
}

}  // namespace toile::internal
