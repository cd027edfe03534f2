// verify/box_tree.hpp: which triangles could meet a box, and which is nearest to a point.  The judge's own tree.
//
// Four children to a node: its triangles are halved twice, at the median of their centres along the longest side of the centres'
// box.  Boxes are closed and rounded outward (core/lane_boxes.hpp): a triangle that touches the query is always visited, and so
// may be one that lies a rounding error beside it.
//
// Easily got wrong: the order of visits depends on the tree.  Callers sort what they collect.
#pragma once
#include "core/lane_boxes.hpp"
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
  OuterBox outer() const {
    OuterBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = OuterBox::below(low[static_cast<Eigen::Index>(k)]);
      box.high[k] = OuterBox::above(high[static_cast<Eigen::Index>(k)]);
    }
    return box;
  }
};

class BoxTree {
 public:
  // Indices must be in range and positions finite.
  BoxTree(std::span<const Triangle> triangles, std::span<const Vec3> x);

  // visit(triangle) for every triangle whose box meets `box`.
  template <class Visit>
  void visit_meeting(const ExactBox& box, Visit&& visit) const {
    const OuterBox query = box.outer();
    std::array<Index, most_waiting> stack;
    std::size_t waiting = 0;
    if (!nodes_.empty()) stack[waiting++] = 0;
    while (waiting > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(stack[--waiting])];
      for_lanes(node.boxes.overlapping(query), [&](std::size_t lane) {
        if (node.leaf)
          visit(node.child[lane]);
        else
          stack[waiting++] = node.child[lane];
      });
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
      double squared_distance;  // of its box, or less
    };
    Nearest best = start;
    ExactBox point;
    point.add(p);
    const OuterBox at = point.outer();
    std::array<Waiting, most_waiting> stack;
    std::size_t waiting = 0;
    if (!nodes_.empty()) stack[waiting++] = {0, 0};
    while (waiting > 0) {
      const Waiting next = stack[--waiting];
      if (next.squared_distance >= best.squared_distance) continue;
      const Node& node = nodes_[static_cast<std::size_t>(next.node)];
      const LaneBoxes::Lanes distance2 = node.boxes.distance2(at.low, at.high);
      std::array<Waiting, 4> near;  // ascending
      std::size_t count = 0;
      for (std::size_t lane = 0; lane < 4 && node.child[lane] >= 0; ++lane) {
        // A square beyond single precision says nothing but that it is one.
        const double distance = std::min<double>(distance2[lane], std::numeric_limits<float>::max());
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

  // The boxes of the same triangles elsewhere.  The halving stays: meant for a surface that moves.
  void refit(std::span<const Triangle> triangles, std::span<const Vec3> x);

 private:
  // Halving 2^31 triangles twice per level leaves at most 16 levels, each with three waiting siblings.
  static constexpr std::size_t most_waiting = 64;
  struct Node {
    LaneBoxes boxes;
    std::array<Index, 4> child{-1, -1, -1, -1};  // nodes, which follow their parent, or triangles; -1: none
    bool leaf = false;
  };
  Index build(std::span<Index> triangles, std::span<const Vec3> centres);

  std::vector<Node> nodes_;
};

}  // namespace toile
