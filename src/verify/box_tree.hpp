// verify/box_tree.hpp: a bounding volume hierarchy of the judge's own: triangles near a box, and the nearest to a point.
//
// Four children to a node: its triangles are halved twice, at the median of their centres along the longest side of the centres'
// box.  Boxes are closed and hold the coordinates as they are, without rounding: a triangle that touches the query is always
// visited.  Nothing of this is shared with the tree of src/contact: an error there must not hide itself.
//
// Easily got wrong: the order of visits depends on the tree.  Callers sort their results.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace toile::internal {

struct ExactBox {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

// Four boxes side by side, in pairs for the narrowest registers.  A box that was never set meets nothing and is infinitely far.
class FourBoxes {
 public:
  FourBoxes() { low_.fill({all(none), all(none)}), high_.fill({all(-none), all(-none)}); }

  void set(std::size_t lane, const ExactBox& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      low_[k][lane / 2][lane % 2] = box.low[static_cast<Eigen::Index>(k)];
      high_[k][lane / 2][lane % 2] = box.high[static_cast<Eigen::Index>(k)];
    }
  }
  ExactBox whole() const {
    ExactBox sum;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        sum.low[axis] = std::min(sum.low[axis], double{low_[k][lane / 2][lane % 2]});
        sum.high[axis] = std::max(sum.high[axis], double{high_[k][lane / 2][lane % 2]});
      }
    }
    return sum;
  }
  // Bit `lane` is set where that box meets the other.
  unsigned meeting(const ExactBox& other) const {
    unsigned bits = 0;
    for (std::size_t pair = 0; pair < 2; ++pair) {
      PairMask hit{-1, -1};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        hit &= (low_[k][pair] <= all(other.high[axis])) & (all(other.low[axis]) <= high_[k][pair]);
      }
      bits |= static_cast<unsigned>((hit[0] & 1) | (hit[1] & 2)) << 2 * pair;
    }
    return bits;
  }
  std::array<double, 4> squared_distances(const Vec3& p) const {
    std::array<double, 4> squared{};
    for (std::size_t pair = 0; pair < 2; ++pair) {
      Pair sum = all(0);
      for (std::size_t k = 0; k < 3; ++k) {
        const Pair at = all(p[static_cast<Eigen::Index>(k)]);
        const Pair out = larger(larger(low_[k][pair] - at, at - high_[k][pair]), all(0));
        sum += out * out;
      }
      squared[2 * pair] = sum[0];
      squared[2 * pair + 1] = sum[1];
    }
    return squared;
  }

 private:
  using Pair = double __attribute__((vector_size(16)));
  using PairMask = std::int64_t __attribute__((vector_size(16)));
  static constexpr double none = std::numeric_limits<double>::infinity();
  static Pair all(double x) { return Pair{x, x}; }
  static Pair larger(Pair a, Pair b) { return a > b ? a : b; }

  std::array<std::array<Pair, 2>, 3> low_, high_;
};

class BoxTree {
 public:
  // Indices must be in range and positions finite.
  BoxTree(std::span<const Triangle> triangles, std::span<const Vec3> x);

  // visit(triangle) for every triangle whose box meets `box`.
  template <class Visit>
  void visit_meeting(const ExactBox& box, Visit&& visit) const {
    std::array<Index, most_waiting> stack;
    std::size_t waiting = 0;
    if (!nodes_.empty()) stack[waiting++] = 0;
    while (waiting > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(stack[--waiting])];
      for (unsigned bits = node.boxes.meeting(box); bits != 0; bits &= bits - 1) {
        const Index child = node.child[static_cast<std::size_t>(std::countr_zero(bits))];
        if (node.leaf)
          visit(child);
        else
          stack[waiting++] = child;
      }
    }
  }

  struct Nearest {
    Index triangle = -1;
    double squared_distance = std::numeric_limits<double>::infinity();
  };

  // The triangle with the least squared_distance(triangle) below that of `start`, or `start` itself: give -1 and a
  // squared reach to look no farther, or a good guess and its distance to look quickly.  squared_distance must be that
  // of the triangle to p.  Of triangles that are equally near it may be any one, but always the same.
  template <class SquaredDistance>
  Nearest nearest(const Vec3& p, Nearest start, SquaredDistance&& squared_distance) const {
    struct Waiting {
      Index node;
      double squared_distance;  // of its box
    };
    Nearest best = start;
    std::array<Waiting, most_waiting> stack;
    std::size_t waiting = 0;
    if (!nodes_.empty()) stack[waiting++] = {0, 0};
    while (waiting > 0) {
      const Waiting next = stack[--waiting];
      if (next.squared_distance >= best.squared_distance) continue;
      const Node& node = nodes_[static_cast<std::size_t>(next.node)];
      const std::array<double, 4> distances = node.boxes.squared_distances(p);
      std::array<Waiting, 4> near;  // ascending
      std::size_t count = 0;
      for (std::size_t lane = 0; lane < 4 && node.child[lane] >= 0; ++lane) {
        const double distance = distances[lane];
        if (distance >= best.squared_distance) continue;
        std::size_t place = count++;
        for (; place > 0 && distance < near[place - 1].squared_distance; --place) near[place] = near[place - 1];
        near[place] = {node.child[lane], distance};
      }
      if (!node.leaf) {
        while (count > 0) stack[waiting++] = near[--count];
        continue;
      }
      for (std::size_t k = 0; k < count && near[k].squared_distance < best.squared_distance; ++k) {
        const double distance = squared_distance(near[k].node);
        if (distance < best.squared_distance) best = {near[k].node, distance};
      }
    }
    return best;
  }

  // Refits the boxes to new positions of the same triangles; the tree stays.  For a surface that moves.
  void refit(std::span<const Triangle> triangles, std::span<const Vec3> x);

 private:
  // Halving 2^31 triangles twice per level leaves at most 16 levels, each with three waiting siblings.
  static constexpr std::size_t most_waiting = 64;
  struct Node {
    FourBoxes boxes;
    std::array<Index, 4> child{-1, -1, -1, -1};  // nodes, which follow their parent, or triangles; -1: none
    bool leaf = false;
  };
  Index build(std::span<Index> triangles, std::span<const Vec3> centres);

  std::vector<Node> nodes_;
};

}  // namespace toile::internal
