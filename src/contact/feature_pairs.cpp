#include "contact/feature_pairs.hpp"

#include "core/parallel.hpp"

#include <cmath>

namespace toile::internal {
namespace {

constexpr float steps_ahead = 4;      // of motion as large as the recent one
constexpr float motion_fades = 0.7f;  // a particle that swings stands still twice in every period
constexpr double least_slack = 0.01;  // s_0, of the mean edge
constexpr double most_slack = 0.1;    // of the mean edge, in the mean: larger boxes cost more than they save
constexpr double most_crowd = 24;     // triangles near a particle: likewise
constexpr Index sampled = 32;         // every so many particles, to know beforehand
constexpr int steps_to_wait = 16;     // after they were more

// The number of triangle boxes that the box of a particle overlaps: the mean over a sample.
double crowd(const TriangleTree& tree) {
  const auto particles = static_cast<Index>(tree.particle_boxes().size());
  Index asked = 0, met = 0;
  for (Index i = 0; i < particles; i += sampled) {
    ++asked;
    tree.visit_overlapping(tree.particle_box(i), [&](Index) { ++met; });
  }
  return static_cast<double>(met) / std::max(asked, 1);
}

}  // namespace

bool FeaturePairs::seek(const ClothTopology& cloth, TriangleTree& tree, const ParticleBoxes& boxes) {
  follow(cloth, boxes);
  if (hold(boxes)) return true;
  made_ = false;
  if (wait_ > 0) --wait_;
  if (wait_ > 0 || steps_ahead * mean_motion_m_ > most_slack * mean_edge_m_) return false;
  const auto least_m = static_cast<float>(least_slack * mean_edge_m_);
  holds_ = boxes;
  holds_.grow([&](std::size_t i) { return least_m + steps_ahead * motion_m_[i]; });
  made_ = make(cloth, tree);
  if (!made_) wait_ = steps_to_wait;
  return made_;
}

void FeaturePairs::follow(const ClothTopology& cloth, const ParticleBoxes& boxes) {
  const bool known = last_.size() == boxes.size();
  if (!known) {
    made_ = false;
    last_.resize(boxes.size());
    motion_m_.assign(boxes.size(), 0);
    double sum = 0;
    for (const Edge& e : cloth.topology().edges) {
      double length2 = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto side = static_cast<double>(boxes[e.a].low[k] - boxes[e.b].low[k]);
        length2 += side * side;
      }
      sum += std::sqrt(length2);
    }
    mean_edge_m_ = sum / static_cast<double>(std::max<std::size_t>(cloth.topology().edges.size(), 1));
  }
  double sum = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const std::array<float, 3>& low = boxes[static_cast<Index>(i)].low;
    if (known) {
      float moved = motion_fades * motion_m_[i];
      for (std::size_t k = 0; k < 3; ++k) moved = std::max(moved, std::fabs(low[k] - last_[i][k]));
      motion_m_[i] = moved;
      sum += static_cast<double>(moved);
    }
    last_[i] = low;
  }
  mean_motion_m_ = sum / static_cast<double>(std::max<std::size_t>(boxes.size(), 1));
}

bool FeaturePairs::make(const ClothTopology& cloth, TriangleTree& tree) {
  tree.refit(holds_);
  if (crowd(tree) > most_crowd) return false;
  tree.self_tasks(tasks_);
  if (found_.size() < tasks_.size()) found_.resize(tasks_.size());
  parallel_for(tasks_.size(), 1, [&](std::size_t i) {
    Found& found = found_[i];
    found.vertices.clear();
    found.edges.clear();
    visit_feature_pairs(
        cloth, tree, tasks_[i], [&](Index v, Index t) { found.vertices.emplace_back(v, t); },
        [&](Index e, Index f) { found.edges.emplace_back(e, f); });
  });
  list(&Found::vertices, cloth.particle_count(), triangles_);
  list(&Found::edges, cloth.topology().edges.size(), edges_);
  return true;
}

// Sorts the keys of all tasks by their firsts.
void FeaturePairs::list(Keys Found::*keys, std::size_t rows, IndexRows& lists) const {
  // While filling, offsets[r + 1] runs from the start of row r to its end, which is the start of the next.
  std::vector<Index>&offsets = lists.offsets, &values = lists.values;
  offsets.assign(rows + 2, 0);
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      for (const auto& [first, second] : found_[i].*keys) visit(static_cast<std::size_t>(first), second);
    }
  };
  each([&](std::size_t first, Index) { ++offsets[first + 2]; });
  for (std::size_t r = 2; r < offsets.size(); ++r) offsets[r] += offsets[r - 1];
  const auto count = static_cast<std::size_t>(offsets.back());
  if (count > values.capacity()) values.reserve(2 * count);  // or it would grow by one pair each time
  values.resize(count);
  each([&](std::size_t first, Index second) { values[static_cast<std::size_t>(offsets[first + 1]++)] = second; });
}

}  // namespace toile::internal
