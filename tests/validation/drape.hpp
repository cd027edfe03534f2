// tests/validation/drape.hpp: the drape test of Cusick (1965; BS 5058, ISO 9073-9).
//
//   a round specimen, radius 15 cm, is held level between two discs of radius 9 cm; its free ring sags into folds
//   DC = (A_shadow - A_disc) / (A_specimen - A_disc)          A_shadow: specimen and disc seen from above
//
// Stiff cloth stays out (DC near 1), limp cloth falls close to the disc (near 0).
#pragma once
#include "garment/triangulate.hpp"
#include "support/run_cloth.hpp"

#include <algorithm>

namespace toile::internal::test {

struct CusickSizes {
  double specimen_m = 0.15, disc_m = 0.09;  // radii
};

struct Disc {
  Sheet sheet;
  std::vector<Index> held;  // the ring of the clamp and what lies inside
  std::vector<Index> rim;   // counter-clockwise seen from above, from the warp's direction
};

// A round sheet about the origin with a ring of particles where it is clamped.  A row of particles that is held bends for the cell
// beyond it and for half a cell on this side: the ring lies half a row outside the disc's edge, so that the cloth is held to there.
inline Disc cusick_disc(double edge_m, const CusickSizes& sizes = {}) {
  constexpr double pi = 3.14159265358979323846;
  const double ring_m = sizes.disc_m + edge_m * std::sqrt(3.0) / 4;
  const auto circle = [&](double radius_m) {  // an even number of points
    const auto n = 2 * std::lround(pi * radius_m / edge_m);
    Vec2s points;
    for (long k = 0; k < n; ++k) {
      const double angle = 2 * pi * static_cast<double>(k) / static_cast<double>(n);
      points.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle));
    }
    return points;
  };
  const Vec2s ring = circle(ring_m), rim = circle(sizes.specimen_m);
  const auto cuts = std::max(1L, std::lround((sizes.specimen_m - ring_m) / edge_m));

  Disc disc;
  ClothMesh& mesh = disc.sheet.mesh;
  Vec2s uv;
  std::vector<Index> ring_index, rim_index;
  const auto add = [&](const Vec2& p) {
    uv.push_back(p);
    return static_cast<Index>(uv.size() - 1);
  };
  // `outline` is made of particles that are there already; the mesher's own points follow.
  const auto fill = [&](const std::vector<Index>& outline) {
    Vec2s points;
    for (const Index i : outline) points.push_back(uv[static_cast<std::size_t>(i)]);
    const PlanarMesh planar = triangulate(points, edge_m);
    std::vector<Index> number = outline;
    for (std::size_t k = outline.size(); k < planar.points.size(); ++k) number.push_back(add(planar.points[k]));
    for (const Triangle& t : planar.triangles) {
      Triangle global;
      for (std::size_t c = 0; c < 3; ++c) global[c] = number[static_cast<std::size_t>(t[c])];
      mesh.triangles.push_back(global);
    }
  };
  for (const Vec2& p : ring) ring_index.push_back(add(p));
  fill(ring_index);
  const auto held = static_cast<Index>(uv.size());
  for (Index i = 0; i < held; ++i) disc.held.push_back(i);
  for (const Vec2& p : rim) rim_index.push_back(add(p));
  std::array<std::vector<Index>, 2> cut;  // from ring to rim, at angles 0 and pi
  for (std::size_t side = 0; side < 2; ++side) {
    const Vec2 direction(side == 0 ? 1 : -1, 0);
    for (long k = 1; k < cuts; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(cuts);
      cut[side].push_back(add((ring_m + share * (sizes.specimen_m - ring_m)) * direction));
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {  // upper and lower half of the free ring
    std::vector<Index> outline;
    const std::size_t rim_half = rim.size() / 2, ring_half = ring.size() / 2;
    for (std::size_t k = 0; k <= rim_half; ++k) outline.push_back(rim_index[(side * rim_half + k) % rim.size()]);
    outline.insert(outline.end(), cut[1 - side].rbegin(), cut[1 - side].rend());
    for (std::size_t k = ring_half + 1; k-- > 0;) outline.push_back(ring_index[(side * ring_half + k) % ring.size()]);
    outline.insert(outline.end(), cut[side].begin(), cut[side].end());
    fill(outline);
  }
  disc.rim = rim_index;
  mesh.particle_count = static_cast<Index>(uv.size());
  for (const Triangle& t : mesh.triangles) {
    mesh.uv.push_back(
        {uv[static_cast<std::size_t>(t[0])], uv[static_cast<std::size_t>(t[1])], uv[static_cast<std::size_t>(t[2])]});
    mesh.panel.push_back(0);
  }
  mesh.panel_names = {"specimen"};
  for (const Vec2& p : uv) disc.sheet.x.emplace_back(p.x(), 0, -p.y());
  return disc;
}

// The area that triangles and a disc about the y axis cover together, seen from above, m^2: per scan line, the length of the union of
// the intervals that they cut out, exact along the line and a midpoint rule across it.
inline double shadow_m2(std::span<const Triangle> triangles, std::span<const Vec3> x, double disc_m, int lines = 2000) {
  double low = -disc_m, high = disc_m;
  for (const Vec3& p : x) low = std::min(low, p.z()), high = std::max(high, p.z());
  const double dz = (high - low) / lines;
  std::vector<std::vector<std::pair<double, double>>> covered(static_cast<std::size_t>(lines));
  const auto z_of = [&](int line) { return low + (line + 0.5) * dz; };
  for (const Triangle& t : triangles) {
    const std::array<Vec3, 3> p = {x[static_cast<std::size_t>(t[0])], x[static_cast<std::size_t>(t[1])],
                                   x[static_cast<std::size_t>(t[2])]};
    const double z0 = std::min({p[0].z(), p[1].z(), p[2].z()}), z1 = std::max({p[0].z(), p[1].z(), p[2].z()});
    const int first = std::max(0, static_cast<int>(std::ceil((z0 - low) / dz - 0.5)));
    for (int line = first; line < lines && z_of(line) < z1; ++line) {
      double left = 1e9, right = -1e9;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = p[k], &b = p[(k + 1) % 3];
        if ((a.z() <= z_of(line)) == (b.z() <= z_of(line))) continue;
        const double at = a.x() + (b.x() - a.x()) * (z_of(line) - a.z()) / (b.z() - a.z());
        left = std::min(left, at), right = std::max(right, at);
      }
      if (left < right) covered[static_cast<std::size_t>(line)].emplace_back(left, right);
    }
  }
  double area = 0;
  for (int line = 0; line < lines; ++line) {
    auto& intervals = covered[static_cast<std::size_t>(line)];
    const double half2 = disc_m * disc_m - z_of(line) * z_of(line);
    if (half2 > 0) intervals.emplace_back(-std::sqrt(half2), std::sqrt(half2));
    std::sort(intervals.begin(), intervals.end());
    double end = -1e9;
    for (const auto& [left, right] : intervals) {
      area += dz * std::max(0.0, right - std::max(end, left));
      end = std::max(end, right);
    }
  }
  return area;
}

inline double drape_coefficient(const Disc& disc, std::span<const Vec3> x, const CusickSizes& sizes = {}) {
  constexpr double pi = 3.14159265358979323846;
  const double inner = pi * sizes.disc_m * sizes.disc_m, outer = pi * sizes.specimen_m * sizes.specimen_m;
  return (shadow_m2(disc.sheet.mesh.triangles, x, sizes.disc_m) - inner) / (outer - inner);
}

// Folds: how often the rim rises and falls by more than a tenth of its whole rise on the way round.
inline int fold_count(const Disc& disc, std::span<const Vec3> x) {
  double low = 1e9, high = -1e9;
  for (const Index i : disc.rim) {
    low = std::min(low, x[static_cast<std::size_t>(i)].y());
    high = std::max(high, x[static_cast<std::size_t>(i)].y());
  }
  const double least = 0.1 * (high - low);
  if (high - low < 1e-3) return 0;  // a bowl
  // Turning points with hysteresis, from the highest point once round.
  std::size_t start = 0;
  for (std::size_t k = 0; k < disc.rim.size(); ++k) {
    if (x[static_cast<std::size_t>(disc.rim[k])].y() == high) start = k;
  }
  int folds = 0;
  bool falling = true;
  double extreme = high;
  for (std::size_t k = 1; k <= disc.rim.size(); ++k) {
    const double y = x[static_cast<std::size_t>(disc.rim[(start + k) % disc.rim.size()])].y();
    if (falling ? y > extreme + least : y < extreme - least) {
      folds += falling ? 1 : 0;
      falling = !falling;
      extreme = y;
    }
    extreme = falling ? std::min(extreme, y) : std::max(extreme, y);
  }
  return folds;
}

}  // namespace toile::internal::test
