// verify/box_tree.cpp: see the header.
#include "verify/box_tree.hpp"

#include <numeric>

namespace toile {

BoxTree::BoxTree(std::span<const Triangle> triangles, std::span<const Vec3> x) {
  const std::size_t count = triangles.size();
  if (count == 0) return;
  std::vector<Vec3> centres(count);
  for (std::size_t t = 0; t < count; ++t) {
    ExactBox box;
    for (const Index i : triangles[t]) box.add(x[static_cast<std::size_t>(i)]);
    centres[t] = 0.5 * box.low + 0.5 * box.high;
  }
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(count);
  build(0, count, centres);
  leaf_boxes_.resize(count);
  refit(triangles, x);
}

// Recursion is as deep as the tree: at most 31.
void BoxTree::build(std::size_t first, std::size_t last, std::span<const Vec3> centres) {
  const std::size_t self = nodes_.size();
  nodes_.push_back({{}, static_cast<Index>(first), static_cast<Index>(last - first)});
  if (last - first <= leaf_size) return;
  ExactBox spread;
  for (std::size_t k = first; k < last; ++k) spread.add(centres[static_cast<std::size_t>(order_[k])]);
  int axis = 0;
  (spread.high - spread.low).maxCoeff(&axis);
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(first), at(middle), at(last), [&](Index s, Index t) {
    const double cs = centres[static_cast<std::size_t>(s)][axis], ct = centres[static_cast<std::size_t>(t)][axis];
    return cs < ct || (cs == ct && s < t);
  });
  build(first, middle, centres);
  nodes_[self].next = static_cast<Index>(nodes_.size());
  nodes_[self].count = 0;
  build(middle, last, centres);
}

void BoxTree::refit(std::span<const Triangle> triangles, std::span<const Vec3> x) {
  for (std::size_t k = 0; k < order_.size(); ++k) {
    leaf_boxes_[k] = ExactBox{};
    for (const Index i : triangles[static_cast<std::size_t>(order_[k])])
      leaf_boxes_[k].add(x[static_cast<std::size_t>(i)]);
  }
  // Children follow their parents.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    node.box = ExactBox{};
    if (node.count == 0) {
      node.box.add(nodes_[n + 1].box);
      node.box.add(nodes_[static_cast<std::size_t>(node.next)].box);
    }
    for (Index k = node.next; k < node.next + node.count; ++k) node.box.add(leaf_boxes_[static_cast<std::size_t>(k)]);
  }
}

}  // namespace toile
