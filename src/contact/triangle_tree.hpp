// contact/triangle_tree.hpp: a bounding volume hierarchy over triangles, refitted every step.           (L0 of contact)
//
// Four children to a node, in one array in depth-first order, so that one vector instruction tests all four.  The tree
// is built by splitting near the median along the longest axis of the centroids of the positions given to build it.
// The topology of the mesh is fixed, so the tree is never rebuilt; only boxes change.  Queries visit nodes in a fixed
// order: the same input gives the same list at any thread count.
//
// Boxes are single precision, rounded outward (contact/lane_boxes.hpp).
//
// Easily got wrong: a copy of a tree shares the original's hierarchy (cheap to hold) but has boxes of its own.
#pragma once
#include "contact/lane_boxes.hpp"
#include "contact/particle_boxes.hpp"
#include "core/bucket_order.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace toile::internal {

struct Box {
  Vec3 low, high;
  bool overlaps(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

// A part of a query, for division among threads: node a against node b, or (within one tree, a = b) node a against
// itself.
struct TreeTask {
  Index a, b;
};

// Memory of self_pairs and cross_pairs, kept between calls.
struct PairWorkspace {
  std::vector<TreeTask> tasks;
  std::vector<std::vector<std::pair<Index, Index>>> found;  // by task
  std::vector<std::pair<Index, Index>> all;
  BucketOrder sorted;
};

class TriangleTree {
 public:
  TriangleTree() = default;
  TriangleTree(std::span<const Vec3> positions, std::span<const Triangle> triangles);

  // Boxes contain every triangle at `start` and at `end` (linear motion between), grown by `margin_m`.
  void refit(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m);
  // The same, where only particles with moved[i] != 0 have other boxes than at the last refit: the others are left
  // alone.
  void refit(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m,
             std::span<const std::uint8_t> moved);
  // Boxes contain those of the particles.
  void refit(const ParticleBoxes& particles);

  // Pairs (a, b) with a < b of this tree's triangles whose boxes overlap, sorted.  A pair that shares a particle is
  // kept: its other features may still be close.
  void self_pairs(std::vector<std::pair<Index, Index>>& pairs, PairWorkspace& workspace) const;
  void self_pairs(std::vector<std::pair<Index, Index>>& pairs) const;

  // Pairs (a of this tree, b of `other`) whose boxes overlap, sorted.
  void cross_pairs(const TriangleTree& other, std::vector<std::pair<Index, Index>>& pairs,
                   PairWorkspace& workspace) const;
  void cross_pairs(const TriangleTree& other, std::vector<std::pair<Index, Index>>& pairs) const;

  // Triangles whose box overlaps `box`, ascending; or unsorted, by visit(triangle).
  void overlapping(const Box& box, std::vector<Index>& triangles) const;
  template <class Visit>
  void visit_overlapping(const OuterBox& box, Visit&& visit) const;

  // Visits triangles whose box is nearer to p than the bound, nearest boxes first; visit(triangle, bound2) returns
  // the new bound (distance squared).  Returns the last bound.
  template <class Visit>
  double nearest(const Vec3& p, double bound2, Visit&& visit) const;

  // The traversals of self_pairs and cross_pairs in parts, unsorted, for callers that use each pair once and keep few:
  // visit(a, b) with a, b triangles.  Within one tree a != b, and each unordered pair comes once.  The number of tasks
  // depends on the mesh and the boxes only.
  void self_tasks(std::vector<TreeTask>& tasks) const;
  void cross_tasks(const TriangleTree& other, std::vector<TreeTask>& tasks) const;
  template <class Visit>
  void visit_self(TreeTask task, Visit&& visit) const;
  template <class Visit>
  void visit_cross(const TriangleTree& other, TreeTask task, Visit&& visit) const;

  Index triangle_count() const { return static_cast<Index>(triangles_ ? triangles_->size() : 0); }
  // The boxes of the last refit: of the motion, grown by the margin.
  const ParticleBoxes& particle_boxes() const { return particle_boxes_; }
  const OuterBox& particle_box(Index particle) const { return particle_boxes_[particle]; }
  const OuterBox& triangle_box(Index triangle) const { return triangle_boxes_[static_cast<std::size_t>(triangle)]; }
  OuterBox edge_box(Index a, Index b) const { return particle_boxes_.edge(a, b); }

 private:
  static constexpr Index leaf_size = 4;

  struct Node {
    LaneBoxes boxes;
    std::array<Index, 4> child{-1, -1, -1, -1};  // nodes, or in a leaf triangles; -1 in an empty lane
    Index count = 0;                             // triangles below
    bool leaf() const { return count <= leaf_size; }
  };

  const Node& node(Index i) const { return nodes_[static_cast<std::size_t>(i)]; }
  Index build(std::span<const Vec3> centroids, std::span<Index> triangles);
  void find_subtrees();
  template <class Work>
  void for_nodes_upwards(const Work& work);
  void refit_triangles();
  void set_lane(Node& at, int lane);
  template <class Visit, class Push>
  static void meet(const TriangleTree& first, const TriangleTree& second, TreeTask pair, Visit&& visit, Push&& push);
  template <class Visit, class Push>
  void meet_itself(Index a, Visit&& visit, Push&& push) const;

  struct Subtree {
    Index begin, end;  // nodes
  };

  std::vector<Node> nodes_;
  std::vector<Subtree> subtrees_;
  std::vector<Index> upper_nodes_;  // all other nodes, ascending
  std::shared_ptr<const std::vector<Triangle>> triangles_;
  std::vector<OuterBox> triangle_boxes_;
  std::vector<std::uint8_t> triangle_moved_, node_moved_;  // by refit
  ParticleBoxes particle_boxes_;
};

// ---------------------------------------------------------------------------------------------------------------------
// Traversals with an explicit stack.  A node with n triangles has children with at most n/4 + 8, so the depth is below
// 20 for any 31-bit count; a pair is replaced by at most 16, and the two sides may descend one after the other: 15 * 40
// + 1 entries.

namespace tree_walk {
inline constexpr std::size_t pair_stack = 640, node_stack = 96;
}  // namespace tree_walk

// One step of a traversal of pairs: passes pairs of triangles to `visit` and pairs of nodes to `push`.
template <class Visit, class Push>
void TriangleTree::meet(const TriangleTree& first, const TriangleTree& second, TreeTask pair, Visit&& visit,
                        Push&& push) {
  const Node &a = first.node(pair.a), &b = second.node(pair.b);
  unsigned any_a = 0, any_b = 0;
  for (int i = 0; i < 4; ++i) {
    const Index child = a.child[static_cast<std::size_t>(i)];
    if (child < 0) break;  // lanes are filled from the front
    const unsigned hits = b.boxes.overlapping(a.boxes.box(i));
    if (hits == 0) continue;
    any_b |= hits;
    any_a |= 1u << i;
    if (a.leaf() && b.leaf()) {
      for_lanes(hits, [&](std::size_t j) { visit(child, b.child[j]); });
    } else if (!a.leaf() && !b.leaf()) {
      for_lanes(hits, [&](std::size_t j) { push(TreeTask{child, b.child[j]}); });
    }
  }
  if (a.leaf() && !b.leaf()) for_lanes(any_b, [&](std::size_t j) { push(TreeTask{pair.a, b.child[j]}); });
  if (!a.leaf() && b.leaf()) for_lanes(any_a, [&](std::size_t i) { push(TreeTask{a.child[i], pair.b}); });
}

template <class Visit, class Push>
void TriangleTree::meet_itself(Index index, Visit&& visit, Push&& push) const {
  const Node& a = node(index);
  for (int i = 0; i < 4; ++i) {
    const Index child = a.child[static_cast<std::size_t>(i)];
    if (child < 0) break;
    if (!a.leaf()) push(TreeTask{child, child});
    const unsigned later = a.boxes.overlapping(a.boxes.box(i)) & ~((2u << i) - 1u);
    for_lanes(later, [&](std::size_t j) {
      if (a.leaf()) {
        visit(child, a.child[j]);
      } else {
        push(TreeTask{child, a.child[j]});
      }
    });
  }
}

template <class Visit>
void TriangleTree::visit_self(TreeTask task, Visit&& visit) const {
  std::array<TreeTask, tree_walk::pair_stack> stack;
  std::size_t top = 0;
  const auto push = [&](TreeTask pair) { stack[top++] = pair; };
  push(task);
  while (top > 0) {
    const TreeTask pair = stack[--top];
    if (pair.a == pair.b) {
      meet_itself(pair.a, visit, push);
    } else {
      meet(*this, *this, pair, visit, push);
    }
  }
}

template <class Visit>
void TriangleTree::visit_cross(const TriangleTree& other, TreeTask task, Visit&& visit) const {
  std::array<TreeTask, tree_walk::pair_stack> stack;
  std::size_t top = 0;
  const auto push = [&](TreeTask pair) { stack[top++] = pair; };
  push(task);
  while (top > 0) {
    const TreeTask pair = stack[--top];
    meet(*this, other, pair, visit, push);
  }
}

template <class Visit>
void TriangleTree::visit_overlapping(const OuterBox& box, Visit&& visit) const {
  if (nodes_.empty()) return;
  std::array<Index, tree_walk::node_stack> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& at = node(stack[--top]);
    for_lanes(at.boxes.overlapping(box), [&](std::size_t lane) {
      if (at.leaf()) {
        visit(at.child[lane]);
      } else {
        stack[top++] = at.child[lane];
      }
    });
  }
}

template <class Visit>
double TriangleTree::nearest(const Vec3& p, double bound2, Visit&& visit) const {
  if (nodes_.empty()) return bound2;
  std::array<float, 3> below, above;
  for (std::size_t k = 0; k < 3; ++k) {
    below[k] = OuterBox::below(p[static_cast<Eigen::Index>(k)]);
    above[k] = OuterBox::above(p[static_cast<Eigen::Index>(k)]);
  }
  struct Entry {
    Index child;
    float distance2;
  };
  std::array<Entry, tree_walk::node_stack> stack;
  std::size_t top = 0;
  stack[top++] = {0, 0};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (!(static_cast<double>(entry.distance2) < bound2)) continue;
    const Node& at = node(entry.child);
    const LaneBoxes::Lanes distance2 = at.boxes.distance2(below, above);
    // The children in reach, nearest first; equal ones in the order of their lanes.
    std::array<Entry, 4> near;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const float d = distance2[i];
      if (!(static_cast<double>(d) < bound2)) continue;
      std::size_t place = count++;
      for (; place > 0 && d < near[place - 1].distance2; --place) near[place] = near[place - 1];
      near[place] = {at.child[i], d};
    }
    if (at.leaf()) {
      for (std::size_t i = 0; i < count; ++i) {
        if (static_cast<double>(near[i].distance2) < bound2) bound2 = visit(near[i].child, bound2);
      }
    } else {
      while (count > 0) stack[top++] = near[--count];
    }
  }
  return bound2;
}

}  // namespace toile::internal
