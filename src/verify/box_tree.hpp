// verify/box_tree.hpp: which triangles could meet a box, and which is nearest to a point.  The judge's own tree.
//
// Balanced binary tree: the triangles of a node are halved at the median of their centres along the longest side of the
// centres' box.  Boxes are closed and hold the coordinates as they are, without rounding: a triangle that touches the
// query is always visited.
//
// Easily got wrong: the order of visits depends on the tree.  Callers sort what they collect.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace toile {

struct ExactBox {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const ExactBox& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  bool meets(const ExactBox& other) const {
    return low.x() <= other.high.x() && other.low.x() <= high.x() && low.y() <= other.high.y() &&
           other.low.y() <= high.y() && low.z() <= other.high.z() && other.low.z() <= high.z();
  }
  double squared_distance(const Vec3& p) const { return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm(); }
};

class BoxTree {
 public:
  // Indices must be in range and positions finite.
  BoxTree(std::span<const Triangle> triangles, std::span<const Vec3> x);

  ExactBox bounds() const { return nodes_.empty() ? ExactBox{} : nodes_.front().box; }

  // visit(triangle) for every triangle whose box meets `box`.
  template <class Visit>
  void visit_meeting(const ExactBox& box, Visit&& visit) const {
    std::array<Index, max_depth> stack;
    std::size_t waiting = 0;
    if (!nodes_.empty()) stack[waiting++] = 0;
    while (waiting > 0) {
      const Index n = stack[--waiting];
      const Node& node = nodes_[static_cast<std::size_t>(n)];
      if (!node.box.meets(box)) continue;
      if (node.count == 0) {
        stack[waiting++] = node.next;
        stack[waiting++] = n + 1;
        continue;
      }
      for (Index k = node.next; k < node.next + node.count; ++k)
        if (leaf_boxes_[static_cast<std::size_t>(k)].meets(box)) visit(order_[static_cast<std::size_t>(k)]);
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
    Nearest best = start;
    std::array<Index, max_depth> stack;
    std::size_t waiting = 0;
    if (!nodes_.empty()) stack[waiting++] = 0;
    while (waiting > 0) {
      const Index n = stack[--waiting];
      const Node& node = nodes_[static_cast<std::size_t>(n)];
      if (node.box.squared_distance(p) >= best.squared_distance) continue;
      if (node.count == 0) {
        Index near = n + 1, far = node.next;
        if (nodes_[static_cast<std::size_t>(far)].box.squared_distance(p) <
            nodes_[static_cast<std::size_t>(near)].box.squared_distance(p))
          std::swap(near, far);
        stack[waiting++] = far;
        stack[waiting++] = near;
        continue;
      }
      for (Index k = node.next; k < node.next + node.count; ++k) {
        if (leaf_boxes_[static_cast<std::size_t>(k)].squared_distance(p) >= best.squared_distance) continue;
        const Index triangle = order_[static_cast<std::size_t>(k)];
        const double distance = squared_distance(triangle);
        if (distance < best.squared_distance) best = {triangle, distance};
      }
    }
    return best;
  }

  // The boxes of the same triangles elsewhere.  The halving stays: meant for a surface that moves.
  void refit(std::span<const Triangle> triangles, std::span<const Vec3> x);

 private:
  // Halving 2^31 triangles leaves at most 31 levels, each with one waiting sibling.
  static constexpr std::size_t max_depth = 64;
  static constexpr std::size_t leaf_size = 4;
  struct Node {
    ExactBox box;
    Index next;   // leaf: first entry of order_; inner: the second child (the first follows its parent)
    Index count;  // leaf: entries; inner: 0
  };
  void build(std::size_t first, std::size_t last, std::span<const Vec3> centres);

  std::vector<Node> nodes_;
  std::vector<Index> order_;
  std::vector<ExactBox> leaf_boxes_;  // as order_
};

}  // namespace toile
