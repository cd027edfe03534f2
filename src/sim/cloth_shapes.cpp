// sim/cloth_shapes.cpp: see the header.
#include "sim/cloth_shapes.hpp"

#include "core/elementary.hpp"
#include "core/error.hpp"
#include "dress/rigid_path.hpp"
#include "garment/triangulate.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace toile::internal {
namespace {

// A rectangle by its drawing: `where(x, y)` places a point, and `uv(x, y)` is its grain.
// `joined`: the side at the largest x is the one at x = 0.
struct Drawing {
  PlanarMesh sheet;
  std::vector<Index> particle;  // [point of the sheet]
  Index particles = 0;
};

Drawing draw(double width_m, double height_m, double edge_m, bool joined) {
  Drawing drawing{equilateral_sheet(width_m, height_m, edge_m), {}, 0};
  const std::vector<Vec2>& points = drawing.sheet.points;
  drawing.particle.assign(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!joined || points[i].x() != width_m) drawing.particle[i] = drawing.particles++;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (drawing.particle[i] >= 0) continue;
    // Both sides are cut into the same pieces: the nearest in height on the other side.
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double distance = std::abs(points[j].y() - points[i].y());
      if (points[j].x() != 0 || distance >= nearest) continue;
      nearest = distance;
      drawing.particle[i] = drawing.particle[j];
    }
  }
  return drawing;
}

// One number and a message for every way to ask for too much: the triangulation counts in 2^-20 m, with 25 bits.
void check_length(std::string_view key, std::string_view what, double length_m) {
  constexpr double longest_m = 32;
  if (length_m <= longest_m) return;
  throw InputError("", key, fmt::sprintf("at most %g m %s", longest_m, std::string(what)),
                   fmt::sprintf("%.4g m", length_m));
}

template <class Grain, class Where>
GarmentMesh mesh_of(const Drawing& drawing, const SceneCloth& cloth, const Grain& grain, const Where& where) {
  GarmentMesh garment;
  garment.name = cloth.name;
  garment.mesh.particle_count = drawing.particles;
  garment.mesh.panel.assign(drawing.sheet.triangles.size(), 0);
  garment.mesh.panel_names = {cloth.name};
  for (const auto& [a, b, c] : drawing.sheet.triangles) {
    garment.mesh.triangles.push_back({drawing.particle[at(a)], drawing.particle[at(b)], drawing.particle[at(c)]});
    const std::vector<Vec2>& points = drawing.sheet.points;
    garment.mesh.uv.push_back({grain(points[at(a)]), grain(points[at(b)]), grain(points[at(c)])});
  }
  const Mat3 turn = rotation_from_degrees(cloth.rotation_deg);
  for (std::size_t i = 0; i < drawing.sheet.points.size(); ++i) {
    if (drawing.particle[i] != static_cast<Index>(garment.x.size())) continue;  // of the joined side
    garment.x.push_back(turn * where(drawing.sheet.points[i]) + cloth.translation_m);
    garment.merged.push_back(static_cast<Index>(garment.merged.size()));
  }
  return garment;
}

// Grain up, as in panels.
Vec2 upright(const Vec2& p) { return {p.y(), -p.x()}; }

GarmentMesh make_grid(const SceneCloth& cloth) {
  const SceneGrid& grid = *cloth.grid;
  const Vec2 middle(0.5 * grid.width_m, 0.5 * grid.height_m);
  return mesh_of(draw(grid.width_m, grid.height_m, grid.edge_m, false), cloth, upright, [&](const Vec2& p) {
    const Vec2 q = p - middle;
    return Vec3(q.x(), q.y(), 0);
  });
}

GarmentMesh make_tube(const SceneCloth& cloth) {
  const SceneTube& tube = *cloth.tube;
  const double around_m = 2 * std::numbers::pi * tube.radius_m;
  check_length("radius_m", "around it", around_m);
  return mesh_of(draw(around_m, tube.length_m, tube.edge_m, true), cloth, upright, [&](const Vec2& p) {
    const double angle = p.x() / tube.radius_m;  // from z to x: seen from outside it runs to the right
    return Vec3(tube.radius_m * ieee_sin(angle), p.y() - 0.5 * tube.length_m, tube.radius_m * ieee_cos(angle));
  });
}

// A curve by points close to each other, with a direction across it at each.
struct Curve {
  Vec3s x, across;
  std::vector<double> s;  // length up to there

  template <class Of>
  auto at_length(double length, const Of& of) const {
    const auto after = std::upper_bound(s.begin() + 1, s.end() - 1, length);
    const auto k = static_cast<std::size_t>(after - s.begin());
    const double share = (length - s[k - 1]) / (s[k] - s[k - 1]);
    return Vec3((1 - share) * of[k - 1] + share * of[k]);
  }
};

// Between b and c, knots at the square roots of the distances.
Vec3 catmull_rom(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double share) {
  const double tb = std::sqrt((b - a).norm()), tc = tb + std::sqrt((c - b).norm()), td = tc + std::sqrt((d - c).norm()),
               t = tb + share * (tc - tb);
  const auto mix = [t](const Vec3& p, double from, const Vec3& q, double to) {
    return Vec3((to - t) / (to - from) * p + (t - from) / (to - from) * q);
  };
  const Vec3 ab = mix(a, 0, b, tb), bc = mix(b, tb, c, tc), cd = mix(c, tc, d, td);
  return mix(mix(ab, 0, bc, tc), tb, mix(bc, tb, cd, td), tc);
}

Vec3s smooth_path(const std::vector<Vec3>& path, bool closed, double piece_m) {
  const std::size_t n = path.size(), spans = closed ? n : n - 1;
  const auto point = [&](std::ptrdiff_t k) -> Vec3 {
    const auto size = static_cast<std::ptrdiff_t>(n);
    if (closed) return path[static_cast<std::size_t>((k + size) % size)];
    if (k < 0) return 2 * path[0] - path[1];
    if (k >= size) return 2 * path[n - 1] - path[n - 2];
    return path[static_cast<std::size_t>(k)];
  };
  Vec3s x;
  for (std::size_t span = 0; span < spans; ++span) {
    const auto k = static_cast<std::ptrdiff_t>(span);
    const Vec3 a = point(k - 1), b = point(k), c = point(k + 1), d = point(k + 2);
    const int pieces = std::max(1, static_cast<int>(std::ceil((c - b).norm() / piece_m)));
    for (int i = 0; i < pieces; ++i) x.push_back(catmull_rom(a, b, c, d, static_cast<double>(i) / pieces));
  }
  x.push_back(point(static_cast<std::ptrdiff_t>(spans)));
  return x;
}

Vec3 tangent(const Vec3s& x, std::size_t k, bool closed) {
  const std::size_t last = x.size() - 1;
  const Vec3& before = k > 0 ? x[k - 1] : closed ? x[last - 1] : x[0];
  const Vec3& after = k < last ? x[k + 1] : closed ? x[1] : x[last];
  return (after - before).normalized();
}

Curve curve_of(const SceneRibbon& ribbon) {
  Curve curve;
  curve.x = smooth_path(ribbon.path_m, ribbon.closed, 0.25 * ribbon.edge_m);
  const std::size_t count = curve.x.size();
  curve.s.assign(1, 0);
  for (std::size_t k = 1; k < count; ++k) curve.s.push_back(curve.s.back() + (curve.x[k] - curve.x[k - 1]).norm());

  Vec3 t = tangent(curve.x, 0, ribbon.closed);
  Vec3 across = ribbon.across - ribbon.across.dot(t) * t;
  if (!(across.norm() > 1e-6 * ribbon.across.norm())) across = t.unitOrthogonal();
  across.normalize();
  curve.across.assign(1, across);
  for (std::size_t k = 1; k < count; ++k) {  // double reflection [Wang 2008, table I]
    const Vec3 v1 = curve.x[k] - curve.x[k - 1];
    const double c1 = v1.squaredNorm();
    const Vec3 across_left = across - 2 / c1 * v1.dot(across) * v1, t_left = t - 2 / c1 * v1.dot(t) * v1;
    t = tangent(curve.x, k, ribbon.closed);
    const Vec3 v2 = t - t_left;
    const double c2 = v2.squaredNorm();
    across = c2 > 0 ? Vec3(across_left - 2 / c2 * v2.dot(across_left) * v2) : across_left;
    curve.across.push_back(across);
  }
  if (!ribbon.closed) return curve;
  const Vec3 end = curve.across.back(), start = curve.across.front();
  const double gap = ieee_atan2(t.dot(end.cross(start)), end.dot(start));
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = gap * curve.s[k] / curve.s.back();
    const Vec3 axis = tangent(curve.x, k, true), a = curve.across[k];
    curve.across[k] = ieee_cos(angle) * a + ieee_sin(angle) * axis.cross(a);
  }
  return curve;
}

// A ribbon lies beside its middle line: where that turns back, or bends in its plane more narrowly than half its width, it would
// lie on itself.  `!(... > 0)` holds for what is not a number, too.
void check_bends(const Curve& curve, double width_m) {
  const auto fail = [&](std::size_t k, const char* expected, const char* got) {
    const Vec3& x = curve.x[k];
    throw InputError("", "path_m", expected, fmt::sprintf("%s near (%.3g, %.3g, %.3g) m", got, x.x(), x.y(), x.z()));
  };
  for (std::size_t k = 1; k < curve.x.size(); ++k) {
    const Vec3 piece = curve.x[k] - curve.x[k - 1];
    if (k > 1 && !(piece.dot(curve.x[k - 1] - curve.x[k - 2]) > 0))
      fail(k - 1, "a line that goes on within a quarter of edge_m", "one that turns back");
    for (const double side : {-0.5 * width_m, 0.5 * width_m})
      if (!((piece + side * (curve.across[k] - curve.across[k - 1])).dot(piece) > 0))
        fail(k - 1, "bends wider than half of width_m", "a ribbon that folds onto itself");
  }
}

GarmentMesh make_ribbon(const SceneCloth& cloth) {
  const SceneRibbon& ribbon = *cloth.ribbon;
  const Curve curve = curve_of(ribbon);
  check_length("path_m", "along it", curve.s.back());
  check_bends(curve, ribbon.width_m);
  const auto along = [](const Vec2& p) { return p; };
  return mesh_of(draw(curve.s.back(), ribbon.width_m, ribbon.edge_m, ribbon.closed), cloth, along, [&](const Vec2& p) {
    return Vec3(curve.at_length(p.x(), curve.x) +
                (p.y() - 0.5 * ribbon.width_m) * curve.at_length(p.x(), curve.across));
  });
}

}  // namespace

GarmentMesh shaped_cloth(const SceneCloth& cloth) {
  if (cloth.tube) return make_tube(cloth);
  if (cloth.ribbon) return make_ribbon(cloth);
  return make_grid(cloth);
}

}  // namespace toile::internal
