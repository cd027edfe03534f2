#include "mesh/boundary_loops.hpp"

#include "mesh/half_edges.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

namespace toile::internal {
namespace {

// A side of a triangle; its number is 3 triangle + side.
constexpr Index none = -1;

// [side] the side of the other triangle on the same edge, or none.
std::vector<Index> opposite_sides(std::span<const Triangle> triangles) {
  std::vector<Index> opposite(3 * triangles.size(), none);
  const std::vector<HalfEdge> sides = sorted_half_edges(triangles);
  for (std::size_t first = 0; first < sides.size();) {
    const std::size_t end = edge_end(sides, first);
    if (end - first == 2) {
      const Index one = 3 * sides[first].triangle + sides[first].side;
      const Index two = 3 * sides[first + 1].triangle + sides[first + 1].side;
      opposite[at(one)] = two;
      opposite[at(two)] = one;
    }
    first = end;
  }
  return opposite;
}

Index next_in_triangle(Index side) { return side % 3 == 2 ? side - 2 : side + 1; }

// Splits a curve that comes to a vertex again there.
void add_simple(const std::vector<Index>& curve, std::vector<std::vector<Index>>& loops) {
  std::vector<Index> open;
  for (const Index v : curve) {
    const auto seen = std::find(open.begin(), open.end(), v);
    if (seen != open.end()) {
      if (open.end() - seen > 2) loops.emplace_back(seen, open.end());
      open.erase(seen, open.end());
    }
    open.push_back(v);
  }
  if (open.size() > 2) loops.push_back(std::move(open));
}

class EarClipping {
 public:
  EarClipping(std::span<const Index> loop, std::span<const Triangle> triangles, std::span<const Vec3> positions)
      : loop_(loop.rbegin(), loop.rend()) {  // the other side of the rim
    Vec3 normal = Vec3::Zero();
    const Vec3& origin = positions[at(loop_[0])];
    for (std::size_t i = 1; i + 1 < loop_.size(); ++i)
      normal += (positions[at(loop_[i])] - origin).cross(positions[at(loop_[i + 1])] - origin);
    const Vec3 u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
    for (const Index i : loop_) {
      x_.push_back(positions[at(i)]);
      flat_.emplace_back(u.dot(positions[at(i)] - origin), v.dot(positions[at(i)] - origin));
    }
    std::vector<Index> rim(loop_);
    std::sort(rim.begin(), rim.end());
    const auto on_rim = [&](Index i) { return std::binary_search(rim.begin(), rim.end(), i); };
    for (const Triangle& t : triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (on_rim(t[k]) && on_rim(t[(k + 1) % 3])) edges_.push_back(ends(t[k], t[(k + 1) % 3]));
    std::sort(edges_.begin(), edges_.end());
  }

  std::vector<Triangle> cut() {
    std::vector<Triangle> cap;
    for (std::size_t i = 0; i < loop_.size(); ++i) left_.push_back(i);
    while (left_.size() > 3) {
      const std::size_t ear = best_ear();
      const auto [a, b, c] = around(ear);
      cap.push_back({loop_[a], loop_[b], loop_[c]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    cap.push_back({loop_[left_[0]], loop_[left_[1]], loop_[left_[2]]});
    return cap;
  }

 private:
  static std::pair<Index, Index> ends(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

  std::array<std::size_t, 3> around(std::size_t k) const {
    const std::size_t n = left_.size();
    return {left_[(k + n - 1) % n], left_[k], left_[(k + 1) % n]};
  }
  double turn(std::size_t a, std::size_t b, std::size_t c) const {
    const Vec2 e = flat_[b] - flat_[a], f = flat_[c] - flat_[a];
    return e.x() * f.y() - e.y() * f.x();
  }
  bool is_ear(const std::array<std::size_t, 3>& corner) const {
    const std::size_t a = corner[0], b = corner[1], c = corner[2];  // no structured binding: the lambda captures them
    if (turn(a, b, c) <= 0) return false;
    return std::none_of(left_.begin(), left_.end(), [&](std::size_t p) {
      return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  }
  // The shortest cut of an ear; of any corner, if the rim crosses itself in the plane.
  std::size_t best_ear() const {
    std::array<std::size_t, 2> best{};
    std::array<double, 2> shortest;
    shortest.fill(std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < left_.size(); ++k) {
      const auto corner = around(k);
      if (std::binary_search(edges_.begin(), edges_.end(), ends(loop_[corner[0]], loop_[corner[2]]))) continue;
      const double length = (x_[corner[0]] - x_[corner[2]]).norm();
      for (const std::size_t kind : {std::size_t{0}, std::size_t{1}}) {
        if (length >= shortest[kind] || (kind == 0 && !is_ear(corner))) continue;
        shortest[kind] = length;
        best[kind] = k;
      }
    }
    return shortest[0] < std::numeric_limits<double>::infinity() ? best[0] : best[1];
  }

  std::vector<Index> loop_;
  std::vector<Vec3> x_;                         // of the loop
  std::vector<Vec2> flat_;                      // the same in the plane
  std::vector<std::pair<Index, Index>> edges_;  // of the triangles, between vertices of the loop
  std::vector<std::size_t> left_;               // indices of the loop that are not cut off yet
};

}  // namespace

std::vector<std::vector<Index>> boundary_loops(std::span<const Triangle> triangles) {
  const std::vector<Index> opposite = opposite_sides(triangles);
  std::vector<char> seen(opposite.size(), 0);
  std::vector<std::vector<Index>> loops;
  for (Index start = 0; at(start) < opposite.size(); ++start) {
    if (opposite[at(start)] != none || seen[at(start)] != 0) continue;
    std::vector<Index> curve;
    for (Index side = start; seen[at(side)] == 0;) {
      seen[at(side)] = 1;
      curve.push_back(triangles[at(side / 3)][at(side % 3)]);
      side = next_in_triangle(side);  // around its end, through all triangles there, to the next side without another
      while (opposite[at(side)] != none) side = next_in_triangle(opposite[at(side)]);
    }
    add_simple(curve, loops);
  }
  return loops;
}

std::vector<Triangle> cap(std::span<const Index> loop, std::span<const Triangle> triangles,
                          std::span<const Vec3> positions) {
  return EarClipping(loop, triangles, positions).cut();
}

}  // namespace toile::internal
