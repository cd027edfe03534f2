#include "garment/flares.hpp"

#include "core/elementary.hpp"
#include "garment/layering.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace toile::internal {
namespace {

constexpr double pi = std::numbers::pi;
// Rings of half a turn, 150 degrees and more, pass bent like this too, and take up to half as long again as flat ones.
constexpr double flared_rad = 200.0 / 180 * pi;
constexpr double spread_rad = 60.0 / 180 * pi;  // between the lines from the centre and the vertical, in the mean
constexpr int waves = 3;
constexpr double flat_m = 1e-3;       // panels that are folded or bent already are left alone,
constexpr double upright = 0.3;       // and so are those whose normal leans by more than 17 degrees
constexpr double round_within = 0.1;  // of the radius: how far the inner side may be from a circle
constexpr double like = 0.1;          // of their angles: rings that can be one cone
constexpr double arc_share =
    0.85;  // a notch turns by half of what its three points are apart about their centre, an arc of seven edges by 6/7
constexpr int arc_samples = 2000;  // of the line on the sphere: no edge gets longer by more than 1e-4

struct Ring {
  Index panel = -1;
  std::vector<Index> particles, inner;  // `inner`: along the side nearest to the centre
  Vec3 right, up, out;                  // of the plane, and away from the body
  Vec3 centre;
  double inner_m = 0, outer_m = 0;  // radii
  double middle_rad = 0, angle_rad = 0;
};

double turn(const Vec2& a, const Vec2& b) { return ieee_atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)); }

// Particles of the outline, counter-clockwise as seen from outside; empty if the panel has a hole.
std::vector<Index> outline_of(std::span<const Triangle> triangles, bool reversed) {
  std::map<std::pair<Index, Index>, int> sides;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
  std::map<Index, Index> next;
  for (const auto& [side, count] : sides)
    if (!sides.contains({side.second, side.first}))
      next[reversed ? side.second : side.first] = reversed ? side.first : side.second;
  std::vector<Index> outline;
  if (next.empty()) return outline;
  Index i = next.begin()->first;
  do {
    outline.push_back(i);
    i = next[i];
  } while (i != outline.front() && outline.size() <= next.size());
  if (outline.size() != next.size()) outline.clear();
  return outline;
}

// The run of particles along the outline over which it turns most to the outside, and the angle of that turn.
struct Hollow {
  std::size_t first = 0, count = 0;
  double turn_rad = 0;
};
Hollow deepest_hollow(std::span<const Vec2> outline) {
  const std::size_t n = outline.size();
  Hollow deepest, now;
  for (std::size_t k = 0; k < 2 * n; ++k) {
    const Vec2 &before = outline[(k + n - 1) % n], &here = outline[k % n], &after = outline[(k + 1) % n];
    const double t = -turn(here - before, after - here);
    if (now.turn_rad + t <= 0 || now.count >= n) {
      now = {(k + 1) % n, 0, 0};
      continue;
    }
    now.turn_rad += t;
    ++now.count;
    if (now.turn_rad > deepest.turn_rad) deepest = now;
  }
  return deepest;
}

// Least squares of |p|^2 = 2 c.p + const.
Vec2 centre_of(std::span<const Vec2> points) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  for (const Vec2& p : points) {
    const Vec3 row(2 * p.x(), 2 * p.y(), 1);
    a += row * row.transpose();
    b += p.squaredNorm() * row;
  }
  return Vec3(a.ldlt().solve(b)).head<2>();
}

std::optional<Ring> ring_of(const GarmentMesh& garment, Index panel, std::span<const Triangle> triangles,
                            const Vec3& middle) {
  if (triangles.empty()) return std::nullopt;
  Ring ring;
  ring.panel = panel;
  Vec3 area = Vec3::Zero();
  for (const Triangle& t : triangles) {
    area += (garment.x[at(t[1])] - garment.x[at(t[0])]).cross(garment.x[at(t[2])] - garment.x[at(t[0])]);
    ring.particles.insert(ring.particles.end(), t.begin(), t.end());
  }
  std::sort(ring.particles.begin(), ring.particles.end());
  ring.particles.erase(std::unique(ring.particles.begin(), ring.particles.end()), ring.particles.end());
  const Vec3 on = garment.x[at(ring.particles.front())];
  ring.out = area.normalized();
  const bool reversed = ring.out.dot(on - middle) < 0;
  if (reversed) ring.out = -ring.out;
  if (std::abs(ring.out.y()) > upright) return std::nullopt;
  for (const Index i : ring.particles)
    if (std::abs(ring.out.dot(garment.x[at(i)] - on)) > flat_m) return std::nullopt;
  ring.up = (Vec3::UnitY() - ring.out.y() * ring.out).normalized();
  ring.right = ring.up.cross(ring.out);

  const std::vector<Index> outline = outline_of(triangles, reversed);
  std::vector<Vec2> drawn;
  for (const Index i : outline)
    drawn.emplace_back(ring.right.dot(garment.x[at(i)] - on), ring.up.dot(garment.x[at(i)] - on));
  const Hollow hollow = deepest_hollow(drawn);
  if (hollow.turn_rad < 0.8 * flared_rad) return std::nullopt;  // it has a particle less at either end
  std::vector<Vec2> arc;
  const std::size_t n = outline.size();
  for (std::size_t k = 0; k < hollow.count + 2; ++k) {
    ring.inner.push_back(outline[(hollow.first + n - 1 + k) % n]);
    arc.push_back(drawn[(hollow.first + n - 1 + k) % n]);
  }
  const Vec2 centre = centre_of(arc);
  for (const Vec2& p : arc) ring.inner_m += (p - centre).norm() / static_cast<double>(arc.size());
  for (const Vec2& p : arc)
    if (std::abs((p - centre).norm() - ring.inner_m) > round_within * ring.inner_m) return std::nullopt;
  double along = 0;
  std::vector<double> angle{0};
  for (std::size_t k = 0; k + 1 < arc.size(); ++k) angle.push_back(along += turn(arc[k] - centre, arc[k + 1] - centre));
  if (-along < flared_rad || hollow.turn_rad < -arc_share * along) return std::nullopt;
  const Vec2 first = arc.front() - centre;
  ring.middle_rad = ieee_atan2(first.y(), first.x()) + 0.5 * along;
  if (ieee_sin(ring.middle_rad) > -0.5) return std::nullopt;  // open elsewhere than above
  ring.centre = on + centre.x() * ring.right + centre.y() * ring.up;
  const Vec2 down(ieee_cos(ring.middle_rad), ieee_sin(ring.middle_rad));
  for (std::size_t k = 0; k < outline.size(); ++k) {
    ring.outer_m = std::max(ring.outer_m, (drawn[k] - centre).norm());
    ring.angle_rad = std::max(ring.angle_rad, 2 * std::abs(turn(down, drawn[k] - centre)));
  }
  if (ring.angle_rad > (1 + like) * std::abs(along)) return std::nullopt;  // a panel with a round hollow
  return ring;
}

// The line on the unit sphere, half a turn about the vertical, as long as the ring's angle.
class Wave {
 public:
  explicit Wave(double angle_rad) {
    double low = 0, high = pi - spread_rad;
    for (int k = 0; k < 60; ++k) {
      height_rad_ = 0.5 * (low + high);
      measure();
      (length_.back() < angle_rad ? low : high) = height_rad_;
    }
  }
  double height_rad() const { return height_rad_; }

  // Directions at `s` from the middle of the line: to the right, up, out.
  Vec3 direction(double s) const {
    const double along = std::clamp(s + 0.5 * length_.back(), 0.0, length_.back());
    const auto after = std::upper_bound(length_.begin() + 1, length_.end() - 1, along);
    const auto k = static_cast<std::size_t>(after - length_.begin());
    const double part = (along - length_[k - 1]) / (length_[k] - length_[k - 1]);
    return point(psi(static_cast<double>(k - 1) + part));
  }

 private:
  static double psi(double k) { return -0.5 * pi + pi * k / arc_samples; }
  Vec3 point(double psi) const {
    const double theta = spread_rad - height_rad_ * ieee_cos(2 * waves * (psi + 0.5 * pi));
    const double s = ieee_sin(theta);
    return {s * ieee_sin(psi), -ieee_cos(theta), s * ieee_cos(psi)};
  }
  void measure() {
    length_.assign(1, 0);
    for (int k = 1; k <= arc_samples; ++k)
      length_.push_back(length_.back() + (point(psi(k)) - point(psi(k - 1))).norm());
  }

  double height_rad_ = 0;
  std::vector<double> length_;  // [sample] from one end
};

// For each ring the ring to whose outside it is sewn; -1: none.
std::vector<int> above(const GarmentMesh& garment, const std::vector<Ring>& rings) {
  std::vector<int> ring_at(garment.mesh.panel_names.size(), -1), up(rings.size(), -1);
  for (std::size_t r = 0; r < rings.size(); ++r) ring_at[at(rings[r].panel)] = static_cast<int>(r);
  const std::vector<Index> panel_of = garment.panel_of_particle();
  for (std::size_t r = 0; r < rings.size(); ++r) {
    std::map<int, int> sewn;
    for (const SeamPair& pair : garment.pairs)
      for (const auto& [mine, other] : {std::pair(pair.a, pair.b), std::pair(pair.b, pair.a)})
        if (std::find(rings[r].inner.begin(), rings[r].inner.end(), mine) != rings[r].inner.end())
          ++sewn[ring_at[at(panel_of[at(other)])]];
    for (const auto& [q, count] : sewn)
      if (q >= 0 && q != static_cast<int>(r) && 2 * count > static_cast<int>(rings[r].inner.size()) &&
          rings[static_cast<std::size_t>(q)].inner_m < rings[r].inner_m &&
          rings[static_cast<std::size_t>(q)].out.dot(rings[r].out) > 0)
        up[r] = q;
  }
  return up;
}

}  // namespace

int hang_flares(GarmentMesh& garment, const Vec3& middle) {
  std::vector<std::vector<Triangle>> triangles(garment.mesh.panel_names.size());
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t)
    triangles[at(garment.mesh.panel[t])].push_back(garment.mesh.triangles[t]);
  std::vector<Ring> rings;
  for (std::size_t p = 0; p < triangles.size(); ++p)
    if (std::optional<Ring> ring = ring_of(garment, static_cast<Index>(p), triangles[p], middle))
      rings.push_back(std::move(*ring));
  std::stable_sort(rings.begin(), rings.end(), [](const Ring& a, const Ring& b) { return a.inner_m < b.inner_m; });
  const std::vector<int> over = above(garment, rings);
  std::vector<Vec3> centre;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const Ring& ring = rings[r];
    const Wave wave(ring.angle_rad);
    centre.push_back(ring.centre);
    if (over[r] >= 0) {
      const Ring& upper = rings[static_cast<std::size_t>(over[r])];
      double drop_m = std::max(0.0, upper.outer_m + layer_gap_m - ring.inner_m) / ieee_cos(spread_rad);
      if (std::abs(ring.angle_rad - upper.angle_rad) > like * ring.angle_rad) {
        const double lowest_m = upper.outer_m * ieee_cos(spread_rad - Wave(upper.angle_rad).height_rad());
        drop_m = lowest_m + layer_gap_m - ring.inner_m * ieee_cos(spread_rad + wave.height_rad());
      }
      centre.back() = centre[static_cast<std::size_t>(over[r])] - drop_m * ring.up;
    }
    const Vec2 down(ieee_cos(ring.middle_rad), ieee_sin(ring.middle_rad));
    for (const Index i : ring.particles) {
      const Vec3 from = garment.x[at(i)] - ring.centre;
      const Vec2 drawn(ring.right.dot(from), ring.up.dot(from));
      const Vec3 d = wave.direction(turn(down, drawn));
      garment.x[at(i)] = centre.back() + drawn.norm() * (d.x() * ring.right + d.y() * ring.up + d.z() * ring.out);
    }
  }
  return static_cast<int>(rings.size());
}

}  // namespace toile::internal
