#include "verify/gauge.hpp"

#include "body/measure.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

namespace toile::internal {
namespace {

using Cell = std::tuple<Index, long, long>;  // panel, column, row

// The plane's intersections with two edges of a triangle, as shares from the smaller particle to the larger.
struct Cut {
  struct End {
    std::pair<Index, Index> edge;
    Vec3 worn;
    Vec2 drawn;
  };
  std::array<End, 2> ends;
};

class Walk {
 public:
  Walk(const ClothMesh& mesh, std::span<const Vec3> x, Index triangle, const Vec3& normal)
      : mesh_(mesh), x_(x), normal_(normal), first_(triangle) {
    Vec3 middle = Vec3::Zero();
    for (const Index i : mesh.triangles[at(triangle)]) middle += x[at(i)] / 3;
    origin_ = middle;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& corners = mesh.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = corners[k], b = corners[(k + 1) % 3];
        if (above(a) != above(b)) beside_[std::minmax(a, b)].push_back(static_cast<Index>(t));
      }
    }
  }

  ClothRing ring() {
    ClothRing ring;
    const Cut start = cut(first_);
    add(start, ring);
    ring.closed = follow(start.ends[1].edge, ring);
    if (!ring.closed) follow(start.ends[0].edge, ring);
    if (ring.worn_m > 0) ring.middle_m /= ring.worn_m;
    ring.normal = normal_;
    return ring;
  }

 private:
  double height(Index i) const { return (x_[at(i)] - origin_).dot(normal_); }
  bool above(Index i) const { return height(i) >= 0; }

  Cut cut(Index t) const {
    Cut cut;
    std::size_t count = 0;
    const Triangle& corners = mesh_.triangles[at(t)];
    for (std::size_t k = 0; k < 3 && count < 2; ++k) {
      const std::size_t next = (k + 1) % 3;
      const Index a = corners[k], b = corners[next];
      if (above(a) == above(b)) continue;
      const double s = height(a) / (height(a) - height(b));
      cut.ends[count++] = {std::minmax(a, b), (1 - s) * x_[at(a)] + s * x_[at(b)],
                           (1 - s) * mesh_.uv[at(t)][k] + s * mesh_.uv[at(t)][next]};
    }
    return cut;
  }

  static void add(const Cut& cut, ClothRing& ring) {
    const double worn_m = (cut.ends[1].worn - cut.ends[0].worn).norm();
    ring.worn_m += worn_m;
    ring.middle_m += 0.5 * worn_m * (cut.ends[0].worn + cut.ends[1].worn);
    ring.cut_m += (cut.ends[1].drawn - cut.ends[0].drawn).norm();
  }

  // True: it returned to the first triangle.
  bool follow(std::pair<Index, Index> edge, ClothRing& ring) const {
    Index from = first_;
    for (std::size_t steps = 0; steps < mesh_.triangles.size(); ++steps) {
      const std::vector<Index>& beside = beside_.at(edge);
      const auto next = std::find_if(beside.begin(), beside.end(), [&](Index t) { return t != from; });
      if (next == beside.end()) return false;
      if (*next == first_) return true;
      const Cut step = cut(*next);
      add(step, ring);
      edge = step.ends[0].edge == edge ? step.ends[1].edge : step.ends[0].edge;
      from = *next;
    }
    return false;
  }

  const ClothMesh& mesh_;
  std::span<const Vec3> x_;
  Vec3 normal_, origin_;
  Index first_;
  std::map<std::pair<Index, Index>, std::vector<Index>> beside_;
};

}  // namespace

std::vector<double> gauge_stretch(const ClothMesh& mesh, std::span<const double> stretch,
                                  std::span<const char> left_out) {
  const double reach = gauge_m / 2;
  std::vector<Vec2> middle(mesh.triangles.size());
  std::vector<double> area(mesh.triangles.size());
  std::map<Cell, std::vector<Index>> cells;
  const auto cell_of = [&](std::size_t t, long right, long up) {
    return Cell{mesh.panel.empty() ? 0 : mesh.panel[t], std::lround(std::floor(middle[t].x() / reach)) + right,
                std::lround(std::floor(middle[t].y() / reach)) + up};
  };
  for (std::size_t t = 0; t < middle.size(); ++t) {
    const auto& uv = mesh.uv[t];
    middle[t] = (uv[0] + uv[1] + uv[2]) / 3;
    const Vec2 e = uv[1] - uv[0], f = uv[2] - uv[0];
    area[t] = 0.5 * std::abs(e.x() * f.y() - e.y() * f.x());
    if (left_out.empty() || left_out[t] == 0) cells[cell_of(t, 0, 0)].push_back(static_cast<Index>(t));
  }
  std::vector<double> gauge(middle.size(), 0);
  for (const auto& [cell, triangles] : cells) {
    for (const Index t : triangles) {
      double sum = 0, weights = 0;
      for (long right = -1; right <= 1; ++right)
        for (long up = -1; up <= 1; ++up) {
          const auto beside = cells.find(cell_of(at(t), right, up));
          if (beside == cells.end()) continue;
          for (const Index other : beside->second) {
            const double share = (middle[at(other)] - middle[at(t)]).squaredNorm() / (reach * reach);
            if (share >= 1) continue;
            const double weight = area[at(other)] * (1 - share) * (1 - share);
            sum += weight * std::max(0.0, stretch[at(other)]);
            weights += weight;
          }
        }
      gauge[at(t)] = weights > 0 ? sum / weights : 0;
    }
  }
  return gauge;
}

ClothRing cloth_ring(const ClothMesh& mesh, std::span<const Vec3> x, Index triangle, const Vec3& normal) {
  if (!(normal.norm() > 0)) return {};
  return Walk(mesh, x, triangle, normal).ring();
}

double girth_within_m(const ClothRing& ring, std::span<const Vec3> body_x, std::span<const Triangle> body) {
  if (!ring.closed) return 0;
  const double radius_m = ring.worn_m / (2 * std::numbers::pi);
  std::vector<Vec3> within;
  for (const std::vector<Vec3>& curve : section(body_x, body, ring.middle_m, ring.normal)) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : curve) middle += p / static_cast<double>(curve.size());
    // The plane of a sleeve also cuts the trunk beside the arm.
    if ((middle - ring.middle_m).norm() < radius_m) within.insert(within.end(), curve.begin(), curve.end());
  }
  return within.empty() ? 0 : girth_m(within, ring.normal);
}

}  // namespace toile::internal
