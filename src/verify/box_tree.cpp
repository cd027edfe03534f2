// verify/box_tree.cpp: see the header.
#include "verify/box_tree.hpp"

#include <numeric>
#include <utility>

namespace toile::internal {
namespace {

// About the median of the centres along the longest side of their box: the first is a multiple of four, so that leaves are full.
std::pair<std::span<Index>, std::span<Index>> halves(std::span<Index> triangles, std::span<const Vec3> centres) {
  ExactBox spread;
  for (const Index t : triangles) spread.add(centres[static_cast<std::size_t>(t)]);
  int axis = 0;
  (spread.high - spread.low).maxCoeff(&axis);
  const std::size_t middle = std::min((triangles.size() / 2 + 3) / 4 * 4, triangles.size());
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(middle), triangles.end(),
                   [&](Index s, Index t) {
                     const double cs = centres[static_cast<std::size_t>(s)][axis],
                                  ct = centres[static_cast<std::size_t>(t)][axis];
                     return cs < ct || (cs == ct && s < t);
                   });
  return {triangles.first(middle), triangles.subspan(middle)};
}

}  // namespace

BoxTree::BoxTree(std::span<const Triangle> triangles, std::span<const Vec3> x) {
  const std::size_t count = triangles.size();
  if (count == 0) return;
  std::vector<Vec3> centres(count);
  for (std::size_t t = 0; t < count; ++t) {
    ExactBox box;
    for (const Index i : triangles[t]) box.add(x[static_cast<std::size_t>(i)]);
    centres[t] = 0.5 * box.low + 0.5 * box.high;
  }
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(count / 2 + 1);
  build(order, centres);
  nodes_.shrink_to_fit();
  refit(triangles, x);
}

// The node of these triangles, after which all nodes below it follow.  Recursion is as deep as the tree: at most 16.
Index BoxTree::build(std::span<Index> triangles, std::span<const Vec3> centres) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  if (triangles.size() <= 4) {
    nodes_[self].leaf = true;
    std::copy(triangles.begin(), triangles.end(), nodes_[self].child.begin());
    return static_cast<Index>(self);
  }
  const auto [left, right] = halves(triangles, centres);
  std::size_t lane = 0;
  for (const std::span<Index> half : {left, right}) {
    const auto [first, second] = halves(half, centres);
    for (const std::span<Index> part : {first, second}) {
      if (part.empty()) continue;
      const Index child = build(part, centres);  // moves nodes_
      nodes_[self].child[lane++] = child;
    }
  }
  return static_cast<Index>(self);
}

void BoxTree::refit(std::span<const Triangle> triangles, std::span<const Vec3> x) {
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children follow their parents
    Node& node = nodes_[n];
    for (std::size_t lane = 0; lane < 4 && node.child[lane] >= 0; ++lane) {
      const auto child = static_cast<std::size_t>(node.child[lane]);
      if (!node.leaf) {
        node.boxes.set(lane, nodes_[child].boxes.whole());
        continue;
      }
      ExactBox box;
      for (const Index i : triangles[child]) box.add(x[static_cast<std::size_t>(i)]);
      node.boxes.set(lane, box);
    }
  }
}

}  // namespace toile::internal
