// body/solid_shapes.cpp: see the header.
#include "body/solid_shapes.hpp"

#include "core/elementary.hpp"
#include "core/error.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

namespace toile::internal {
namespace {

double signed_volume(const SolidMesh& solid) {
  double six = 0;
  for (const auto& [a, b, c] : solid.triangles)
    six += solid.positions[at(a)].dot(solid.positions[at(b)].cross(solid.positions[at(c)]));
  return six / 6;
}

// The number of pieces of at most edge_m for a side of the outline.
double pieces_of(const Vec2& from, const Vec2& to, double edge_m) {
  return std::max(1.0, std::ceil((to - from).norm() / edge_m - 1e-9));
}

// The outline cut into pieces of at most edge_m.
std::vector<Vec2> cut(std::span<const Vec2> profile, bool closed, double edge_m) {
  std::vector<Vec2> points;
  const std::size_t sides = closed ? profile.size() : profile.size() - 1;
  for (std::size_t k = 0; k < sides; ++k) {
    const Vec2 &from = profile[k], &to = profile[(k + 1) % profile.size()];
    const double pieces = pieces_of(from, to, edge_m);
    for (int i = 0; i < static_cast<int>(pieces); ++i) points.push_back(from + (i / pieces) * (to - from));
  }
  if (!closed) points.push_back(profile.back());
  return points;
}

void check_count(double triangles) {
  if (triangles > static_cast<double>(most_solid_triangles))
    throw InputError("", "edge_m", fmt::sprintf("at most %d triangles", static_cast<int>(most_solid_triangles)),
                     fmt::sprintf("at least %.0f", triangles));
}

[[noreturn]] void bad_profile(const char* expected, const std::string& got) {
  throw InputError("", "profile", expected, got);
}

// Whether the outline is a closed curve beside the axis.
bool check_profile(std::span<const Vec2> profile) {
  if (profile.size() < 3) bad_profile("at least three points", std::to_string(profile.size()));
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const std::string place = "point " + std::to_string(k);
    if (profile[k].x() < 0) bad_profile("distances from the axis, not below 0", place + " beyond it");
    if (profile[k] == profile[(k + 1) % profile.size()]) bad_profile("points that differ", place + " again");
    if (k > 0 && k + 1 < profile.size() && profile[k].x() == 0)
      bad_profile("points beside the axis between the ends", place + " on it");
  }
  const bool begins_on_axis = profile.front().x() == 0, ends_on_axis = profile.back().x() == 0;
  if (begins_on_axis != ends_on_axis) bad_profile("both ends on the axis, or none", "one of them");
  return !begins_on_axis;
}

}  // namespace

// 10 rings of 32 and two poles: 322 vertices; 64 triangles between neighbouring rings and 32 at each pole: 640.
SolidMesh rounded_cylinder(double radius_m, double height_m, const Vec3& top) {
  constexpr Index around = 32, rings = 10;
  const double rim = 0.15 * std::min(radius_m, 0.5 * height_m), bevel = rim * (1 - std::sqrt(0.5));
  // Distance from the axis and depth below the cap, down to the middle; the lower half mirrors it.
  const std::array<std::array<double, 2>, 5> upper = {{{0.5 * radius_m, 0},
                                                       {radius_m - rim, 0},
                                                       {radius_m - bevel, bevel},
                                                       {radius_m, rim},
                                                       {radius_m, rim + (height_m - 2 * rim) / 3}}};
  SolidMesh solid;
  for (Index ring = 0; ring < rings; ++ring) {
    const auto [r, depth] =
        ring < 5 ? upper[static_cast<std::size_t>(ring)] : upper[static_cast<std::size_t>(rings - 1 - ring)];
    const double y = ring < 5 ? -depth : depth - height_m;
    for (Index i = 0; i < around; ++i) {
      // Rings are staggered by half a piece, so that triangles are nearly isosceles.
      const double angle = 2 * 3.14159265358979323846 * (i + 0.5 * (ring % 2)) / around;
      solid.positions.push_back(top + Vec3(r * ieee_cos(angle), y, r * ieee_sin(angle)));
    }
  }
  const Index north = around * rings, south = north + 1;
  solid.positions.push_back(top);
  solid.positions.push_back(top - Vec3(0, height_m, 0));
  for (Index i = 0; i < around; ++i) {
    const Index next = (i + 1) % around;
    solid.triangles.push_back({north, next, i});
    for (Index ring = 0; ring + 1 < rings; ++ring) {
      const Index a = ring * around + i, b = ring * around + next, c = a + around, d = b + around;
      if (ring % 2 == 0) {
        solid.triangles.push_back({a, b, c});
        solid.triangles.push_back({b, d, c});
      } else {
        solid.triangles.push_back({a, b, d});
        solid.triangles.push_back({a, d, c});
      }
    }
    solid.triangles.push_back({south, (rings - 1) * around + i, (rings - 1) * around + next});
  }
  return solid;
}

SolidMesh ball(double radius_m, double edge_m) {
  SolidMesh solid;
  solid.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  solid.triangles = {{2, 4, 0}, {2, 0, 5}, {2, 5, 1}, {2, 1, 4}, {3, 0, 4}, {3, 5, 0}, {3, 1, 5}, {3, 4, 1}};
  for (;;) {
    double longest = 0;
    for (const Triangle& t : solid.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest, (solid.positions[at(t[k])] - solid.positions[at(t[(k + 1) % 3])]).norm());
    if (radius_m * longest <= edge_m) break;
    check_count(4.0 * static_cast<double>(solid.triangles.size()));
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [place, added] = middles.try_emplace(std::minmax(a, b), static_cast<Index>(solid.positions.size()));
      if (added) solid.positions.push_back((solid.positions[at(a)] + solid.positions[at(b)]).normalized());
      return place->second;
    };
    std::vector<Triangle> halved;
    for (const auto& [a, b, c] : solid.triangles) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      halved.insert(halved.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    solid.triangles = std::move(halved);
  }
  for (Vec3& p : solid.positions) p *= radius_m;
  return solid;
}

SolidMesh block(const Vec3& size_m) {
  SolidMesh solid;
  for (int corner = 0; corner < 8; ++corner)
    solid.positions.push_back(0.5 * Vec3((corner & 1) != 0 ? size_m.x() : -size_m.x(),
                                         (corner & 2) != 0 ? size_m.y() : -size_m.y(),
                                         (corner & 4) != 0 ? size_m.z() : -size_m.z()));
  for (const auto& [a, b, c, d] :
       {std::array<Index, 4>{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
    solid.triangles.push_back({a, b, c});
    solid.triangles.push_back({a, c, d});
  }
  return solid;
}

SolidMesh revolved(std::span<const Vec2> profile_m, double edge_m) {
  const bool closed = check_profile(profile_m);
  double widest = 0, along = 0;
  for (std::size_t k = 0; k < profile_m.size(); ++k) {
    widest = std::max(widest, profile_m[k].x());
    if (closed || k > 0) along += pieces_of(profile_m[k], profile_m[k == 0 ? profile_m.size() - 1 : k - 1], edge_m);
  }
  const double pieces_around = std::max(6.0, std::ceil(2 * std::numbers::pi * widest / edge_m));
  check_count(2 * (along - (closed ? 0 : 1)) * pieces_around);
  const auto around = static_cast<Index>(pieces_around);
  const std::vector<Vec2> outline = cut(profile_m, closed, edge_m);
  SolidMesh solid;
  std::vector<Index> first;  // [point of the outline] its vertex at angle 0
  for (const Vec2& p : outline) {
    first.push_back(static_cast<Index>(solid.positions.size()));
    const Index copies = p.x() == 0 ? 1 : around;
    for (Index i = 0; i < copies; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      solid.positions.push_back(Vec3(p.x() * ieee_cos(angle), p.y(), p.x() * ieee_sin(angle)));
    }
  }
  const std::size_t rings = outline.size();
  for (std::size_t ring = 0; ring + (closed ? 0 : 1) < rings; ++ring) {
    const std::size_t next = (ring + 1) % rings;
    for (Index i = 0; i < around; ++i) {
      const Index j = (i + 1) % around, a = first[ring], b = first[next];
      if (outline[ring].x() == 0) {
        solid.triangles.push_back({a, b + i, b + j});
      } else if (outline[next].x() == 0) {
        solid.triangles.push_back({a + i, b, a + j});
      } else {
        solid.triangles.push_back({a + i, b + i, b + j});
        solid.triangles.push_back({a + i, b + j, a + j});
      }
    }
  }
  if (signed_volume(solid) < 0) turn_inside_out(solid);
  return solid;
}

SolidMesh whole_of(const SurfaceMesh& mesh, std::span<const Triangle> triangles) {
  std::vector<Index> place(mesh.positions.size(), -1);
  for (const Triangle& t : triangles)
    for (const Index v : t) place[at(v)] = 0;
  SolidMesh solid;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] < 0) continue;
    place[i] = static_cast<Index>(solid.positions.size());
    solid.positions.push_back(mesh.positions[i]);
  }
  for (const auto& [a, b, c] : triangles) solid.triangles.push_back({place[at(a)], place[at(b)], place[at(c)]});
  return solid;
}

void turn_inside_out(SolidMesh& solid) {
  for (Triangle& t : solid.triangles) std::swap(t[1], t[2]);
}

}  // namespace toile::internal
