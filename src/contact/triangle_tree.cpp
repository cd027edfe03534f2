#include "contact/triangle_tree.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile::internal {
namespace {

constexpr Index task_size = 512;    // a task's nodes hold at most this many triangles
constexpr Index refit_size = 1024;  // likewise, when boxes are made anew
constexpr std::size_t triangle_box_grain = 1024;

// Replaces every task with a node above task_size by its children, with `descend`.
template <class Big, class Split>
void cut_tasks(std::vector<TreeTask>& tasks, Big&& big, Split&& split) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {  // grows while it is read: breadth first
    const TreeTask task = tasks[i];
    if (big(task)) {
      split(task);
    } else {
      tasks[kept++] = task;
    }
  }
  tasks.resize(kept);
}

// Orders the triangles so that the first `n` lie before the others along the longest axis of their centroids; returns
// n, about half, a multiple of four so that leaves are full.
std::size_t split(std::span<const Vec3> centroids, std::span<Index> triangles) {
  const auto centroid = [&](Index t) -> const Vec3& { return centroids[static_cast<std::size_t>(t)]; };
  Vec3 low = centroid(triangles[0]), high = low;
  for (const Index t : triangles) {
    low = low.cwiseMin(centroid(t));
    high = high.cwiseMax(centroid(t));
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t left = (triangles.size() / 2 + 3) / 4 * 4;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(left), triangles.end(),
                   [&](Index s, Index t) {
                     const double a = centroid(s)[axis], b = centroid(t)[axis];
                     return a != b ? a < b : s < t;
                   });
  return left;
}

// Gathers the results of the tasks into one sorted list.
void sort_found(PairWorkspace& workspace, std::size_t first_count, std::vector<std::pair<Index, Index>>& pairs) {
  workspace.all.clear();
  for (std::size_t i = 0; i < workspace.tasks.size(); ++i) {
    workspace.all.insert(workspace.all.end(), workspace.found[i].begin(), workspace.found[i].end());
  }
  workspace.sorted.sort(workspace.all, first_count);
  const auto order = workspace.sorted.order();
  pairs.resize(workspace.all.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = workspace.all[static_cast<std::size_t>(order[i])];
  }
}

}  // namespace

TriangleTree::TriangleTree(std::span<const Vec3> positions, std::span<const Triangle> triangles)
    : triangles_(std::make_shared<const std::vector<Triangle>>(triangles.begin(), triangles.end())) {
  std::vector<Vec3> centroids(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Vec3 sum = Vec3::Zero();
    for (const Index i : triangles[t]) {
      TOILE_ASSERT(i >= 0 && static_cast<std::size_t>(i) < positions.size());
      sum += positions[static_cast<std::size_t>(i)];
    }
    // A NaN would break the order that the split relies on; such a triangle may sit anywhere in the tree.
    for (Eigen::Index k = 0; k < 3; ++k) centroids[t][k] = std::isfinite(sum[k]) ? sum[k] : 0.0;
  }
  std::vector<Index> order(triangles.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(triangles.size() / 2 + 1);
  if (!order.empty()) build(centroids, order);
  find_subtrees();
  triangle_boxes_.resize(triangles.size());
  refit(positions, positions, 0);
}

// The node of these triangles, after which all nodes below it follow.
Index TriangleTree::build(std::span<const Vec3> centroids, std::span<Index> triangles) {
  const auto self = static_cast<Index>(nodes_.size());
  nodes_.emplace_back();
  nodes_.back().count = static_cast<Index>(triangles.size());
  if (triangles.size() <= static_cast<std::size_t>(leaf_size)) {
    std::sort(triangles.begin(), triangles.end());
    std::copy(triangles.begin(), triangles.end(), nodes_.back().child.begin());
    return self;
  }
  std::array<std::span<Index>, 4> parts{triangles};
  std::size_t count = 1;
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = count; i-- > 0;) {
      const std::span<Index> part = parts[i];
      if (part.size() <= static_cast<std::size_t>(leaf_size)) continue;
      const std::size_t left = split(centroids, part);
      for (std::size_t j = count; j > i + 1; --j) parts[j] = parts[j - 1];
      parts[i] = part.first(left);
      parts[i + 1] = part.subspan(left);
      ++count;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Index child = build(centroids, parts[i]);  // moves nodes_
    nodes_[static_cast<std::size_t>(self)].child[i] = child;
  }
  return self;
}

void TriangleTree::refit(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m) {
  particle_boxes_.set(start, end, margin_m);
  refit_triangles();
}

void TriangleTree::refit(const ParticleBoxes& particles) {
  particle_boxes_ = particles;
  refit_triangles();
}

// The largest subtrees that are one task of a refit, and the nodes above them.
void TriangleTree::find_subtrees() {
  const auto end_of = [&](Index i) {  // of the nodes below
    while (!node(i).leaf()) i = *std::max_element(node(i).child.begin(), node(i).child.end());
    return i + 1;
  };
  for (Index i = 0; i < static_cast<Index>(nodes_.size());) {
    if (node(i).count > refit_size) {
      upper_nodes_.push_back(i++);
    } else {
      subtrees_.push_back({i, end_of(i)});
      i = subtrees_.back().end;
    }
  }
}

// work(node) for all, children before their parents, which stand before them.
template <class Work>
void TriangleTree::for_nodes_upwards(const Work& work) {
  parallel_for(subtrees_.size(), 1, [&](std::size_t subtree) {
    for (Index i = subtrees_[subtree].end; i-- > subtrees_[subtree].begin;) work(static_cast<std::size_t>(i));
  });
  for (std::size_t k = upper_nodes_.size(); k-- > 0;) work(static_cast<std::size_t>(upper_nodes_[k]));
}

void TriangleTree::refit_triangles() {
  parallel_for(triangle_boxes_.size(), triangle_box_grain,
               [&](std::size_t t) { triangle_boxes_[t] = particle_boxes_.triangle((*triangles_)[t]); });
  for_nodes_upwards([&](std::size_t i) {
    Node& at = nodes_[i];
    for (int lane = 0; lane < 4; ++lane) {
      if (at.child[static_cast<std::size_t>(lane)] >= 0) set_lane(at, lane);
    }
  });
}

void TriangleTree::refit(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m,
                         std::span<const std::uint8_t> moved) {
  particle_boxes_.set(start, end, margin_m, moved);
  triangle_moved_.resize(triangle_boxes_.size());
  parallel_for(triangle_boxes_.size(), triangle_box_grain, [&](std::size_t t) {
    const Triangle& corners = (*triangles_)[t];
    std::uint8_t any = 0;
    for (const Index i : corners) any |= moved[static_cast<std::size_t>(i)];
    triangle_moved_[t] = any;
    if (any != 0) triangle_boxes_[t] = particle_boxes_.triangle(corners);
  });
  node_moved_.resize(nodes_.size());
  for_nodes_upwards([&](std::size_t i) {
    Node& at = nodes_[i];
    const std::vector<std::uint8_t>& below = at.leaf() ? triangle_moved_ : node_moved_;
    std::uint8_t any = 0;
    for (int lane = 0; lane < 4; ++lane) {
      const Index child = at.child[static_cast<std::size_t>(lane)];
      if (child < 0 || below[static_cast<std::size_t>(child)] == 0) continue;
      set_lane(at, lane);
      any = 1;
    }
    node_moved_[i] = any;
  });
}

void TriangleTree::set_lane(Node& at, int lane) {
  const Index child = at.child[static_cast<std::size_t>(lane)];
  at.boxes.set(lane, at.leaf() ? triangle_box(child) : node(child).boxes.whole());
}

void TriangleTree::self_tasks(std::vector<TreeTask>& tasks) const {
  tasks.clear();
  if (nodes_.empty()) return;
  tasks.push_back({0, 0});
  const auto push = [&](TreeTask task) { tasks.push_back(task); };
  const auto never = [](Index, Index) {};  // a node above task_size is no leaf
  cut_tasks(
      tasks, [&](TreeTask t) { return std::max(node(t.a).count, node(t.b).count) > task_size; },
      [&](TreeTask t) { t.a == t.b ? meet_itself(t.a, never, push) : meet(*this, *this, t, never, push); });
}

void TriangleTree::cross_tasks(const TriangleTree& other, std::vector<TreeTask>& tasks) const {
  tasks.clear();
  if (nodes_.empty() || other.nodes_.empty()) return;
  tasks.push_back({0, 0});
  const auto push = [&](TreeTask task) { tasks.push_back(task); };
  const auto never = [](Index, Index) {};
  cut_tasks(
      tasks, [&](TreeTask t) { return std::max(node(t.a).count, other.node(t.b).count) > task_size; },
      [&](TreeTask t) { meet(*this, other, t, never, push); });
}

void TriangleTree::self_pairs(std::vector<std::pair<Index, Index>>& pairs, PairWorkspace& workspace) const {
  self_tasks(workspace.tasks);
  if (workspace.found.size() < workspace.tasks.size()) workspace.found.resize(workspace.tasks.size());
  parallel_for(workspace.tasks.size(), 1, [&](std::size_t i) {
    auto& found = workspace.found[i];
    found.clear();
    visit_self(workspace.tasks[i], [&](Index a, Index b) { found.emplace_back(std::min(a, b), std::max(a, b)); });
  });
  sort_found(workspace, static_cast<std::size_t>(triangle_count()), pairs);
}

void TriangleTree::self_pairs(std::vector<std::pair<Index, Index>>& pairs) const {
  PairWorkspace workspace;
  self_pairs(pairs, workspace);
}

void TriangleTree::cross_pairs(const TriangleTree& other, std::vector<std::pair<Index, Index>>& pairs,
                               PairWorkspace& workspace) const {
  cross_tasks(other, workspace.tasks);
  if (workspace.found.size() < workspace.tasks.size()) workspace.found.resize(workspace.tasks.size());
  parallel_for(workspace.tasks.size(), 1, [&](std::size_t i) {
    auto& found = workspace.found[i];
    found.clear();
    visit_cross(other, workspace.tasks[i], [&](Index a, Index b) { found.emplace_back(a, b); });
  });
  sort_found(workspace, static_cast<std::size_t>(triangle_count()), pairs);
}

void TriangleTree::cross_pairs(const TriangleTree& other, std::vector<std::pair<Index, Index>>& pairs) const {
  PairWorkspace workspace;
  cross_pairs(other, pairs, workspace);
}

void TriangleTree::overlapping(const Box& box, std::vector<Index>& triangles) const {
  triangles.clear();
  OuterBox query;
  for (std::size_t k = 0; k < 3; ++k) {
    query.low[k] = OuterBox::below(box.low[static_cast<Eigen::Index>(k)]);
    query.high[k] = OuterBox::above(box.high[static_cast<Eigen::Index>(k)]);
  }
  visit_overlapping(query, [&](Index t) { triangles.push_back(t); });
  std::sort(triangles.begin(), triangles.end());
}

}  // namespace toile::internal
