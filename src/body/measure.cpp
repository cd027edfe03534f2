// body/measure.cpp: sections of a closed mesh by following triangles, and hulls by Andrew's monotone chain.
#include "body/measure.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

namespace toile::internal {

namespace {

double cross2(const Vec2& o, const Vec2& a, const Vec2& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

}  // namespace

std::vector<std::vector<Vec3>> section(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                       const Vec3& origin, const Vec3& normal) {
  std::vector<double> height(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) height[i] = (positions[i] - origin).dot(normal);
  // Every crossed triangle is entered over one edge and left over another; walking it as wound, the edge that goes down
  // is followed by the edge that goes up.  A closed mesh makes this a set of cycles.
  using EdgeKey = std::pair<Index, Index>;  // (smaller, larger)
  std::map<EdgeKey, EdgeKey> next;
  for (const Triangle& t : triangles) {
    EdgeKey down, up;
    bool crossed = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      const bool above_a = height[at(a)] >= 0, above_b = height[at(b)] >= 0;
      if (above_a == above_b) continue;
      crossed = true;
      (above_a ? down : up) = std::minmax(a, b);
    }
    if (crossed) next.emplace(down, up);
  }
  std::vector<std::vector<Vec3>> curves;
  while (!next.empty()) {
    std::vector<Vec3> curve;
    for (auto entry = next.begin(); entry != next.end();) {
      const auto [a, b] = entry->first;
      const double t = height[at(a)] / (height[at(a)] - height[at(b)]);
      curve.push_back(positions[at(a)] + t * (positions[at(b)] - positions[at(a)]));
      const EdgeKey following = entry->second;
      next.erase(entry);
      entry = next.find(following);
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

double girth_m(std::span<const Vec3> curve, const Vec3& normal) {
  // Any two axes across the normal.
  const Vec3 aside = std::abs(normal.x()) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 u = normal.cross(aside).normalized(), v = normal.cross(u);
  std::vector<Vec2> points;
  for (const Vec3& p : curve) points.emplace_back(p.dot(u), p.dot(v));
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Vec2> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 && cross2(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // the other chain starts with it
    std::reverse(points.begin(), points.end());
  }
  double length = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) length += (hull[(i + 1) % hull.size()] - hull[i]).norm();
  return length;
}

double girth_at_m(std::span<const Vec3> positions, std::span<const Triangle> triangles, const Vec3& origin,
                  const Vec3& normal) {
  double nearest2 = 0, girth = 0;
  bool found = false;
  for (const auto& curve : section(positions, triangles, origin, normal)) {
    Vec3 centroid = Vec3::Zero();
    for (const Vec3& p : curve) centroid += p;
    centroid /= static_cast<double>(curve.size());
    const double distance2 = (centroid - origin).squaredNorm();
    if (found && distance2 >= nearest2) continue;
    found = true;
    nearest2 = distance2;
    girth = girth_m(curve, normal);
  }
  return girth;
}

namespace {

// The section of least, or greatest, girth among those at whole percents of the height from `first` to `last`.
Level extreme_girth(std::span<const Vec3> positions, std::span<const Triangle> triangles, int first, int last,
                    bool least) {
  if (positions.empty()) return {};
  Vec3 low = positions[0], high = positions[0];
  for (const Vec3& p : positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Vec3 origin = 0.5 * (low + high);
  Level found;
  for (int percent = first; percent <= last; ++percent) {
    origin.y() = low.y() + 0.01 * percent * (high.y() - low.y());
    const double girth = girth_at_m(positions, triangles, origin, Vec3::UnitY());
    if (girth <= 0) continue;
    if (found.girth_m > 0 && (least ? girth >= found.girth_m : girth <= found.girth_m)) continue;
    found = {origin.y(), girth};
  }
  return found;
}

constexpr int hips_from = 45, waist_from = 55, waist_to = 70;  // percent of the height

}  // namespace

double waist_height_m(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  return extreme_girth(positions, triangles, waist_from, waist_to, true).height_m;
}

Level hips(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  return extreme_girth(positions, triangles, hips_from, waist_from, false);
}

}  // namespace toile::internal
