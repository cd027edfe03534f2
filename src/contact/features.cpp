#include "contact/features.hpp"

#include "core/disjoint_sets.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

namespace toile::internal {
namespace {

// Rows from (row, value) pairs given by row_of(i), value_of(i), i ascending.
template <class RowOf, class ValueOf>
IndexRows make_rows(std::size_t row_count, std::size_t value_count, RowOf&& row_of, ValueOf&& value_of) {
  IndexRows rows;
  rows.offsets.assign(row_count + 1, 0);
  for (std::size_t i = 0; i < value_count; ++i) ++rows.offsets[static_cast<std::size_t>(row_of(i)) + 1];
  std::partial_sum(rows.offsets.begin(), rows.offsets.end(), rows.offsets.begin());
  std::vector<Index> next(rows.offsets.begin(), rows.offsets.end() - 1);
  rows.values.resize(value_count);
  for (std::size_t i = 0; i < value_count; ++i) {
    Index& at = next[static_cast<std::size_t>(row_of(i))];
    rows.values[static_cast<std::size_t>(at++)] = value_of(i);
  }
  return rows;
}

// The smallest particle of each class of `merged_particle`.
std::vector<Index> merge_classes(std::size_t particle_count, std::span<const Index> merged_particle) {
  DisjointSets sets(particle_count);
  if (merged_particle.empty()) return sets.representatives();
  if (merged_particle.size() != particle_count) {
    throw InputError("", "merged_particle", std::to_string(particle_count) + " entries",
                     std::to_string(merged_particle.size()));
  }
  for (std::size_t i = 0; i < particle_count; ++i) {
    const Index to = merged_particle[i];
    if (to < 0 || static_cast<std::size_t>(to) >= particle_count) {
      throw InputError("", "merged_particle " + std::to_string(i), "a particle below " + std::to_string(particle_count),
                       std::to_string(to));
    }
    sets.join(static_cast<Index>(i), to);
  }
  return sets.representatives();
}

}  // namespace

std::vector<std::uint8_t> assign_features(std::size_t particle_count, std::span<const Triangle> triangles,
                                          const Topology& topology) {
  std::vector<std::uint8_t> owned(triangles.size(), 0);
  std::vector<char> vertex_taken(particle_count, 0), edge_taken(topology.edges.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      char& vertex = vertex_taken[static_cast<std::size_t>(triangles[t][k])];
      char& edge = edge_taken[static_cast<std::size_t>(topology.triangle_edges[t][k])];
      if (!vertex) owned[t] = static_cast<std::uint8_t>(owned[t] | (1u << k));
      if (!edge) owned[t] = static_cast<std::uint8_t>(owned[t] | (8u << k));
      vertex = edge = 1;
    }
  }
  return owned;
}

IndexRows particle_corners(std::size_t particle_count, std::span<const Triangle> triangles) {
  return make_rows(
      particle_count, 3 * triangles.size(), [&](std::size_t i) { return triangles[i / 3][i % 3]; },
      [](std::size_t i) { return static_cast<Index>(i); });
}

ClothTopology::ClothTopology(std::size_t particle_count, std::span<const Triangle> triangles, const Topology& topology,
                             std::span<const Index> merged_particle)
    : triangles_(triangles), topology_(&topology), merged_(merge_classes(particle_count, merged_particle)) {
  owned_ = assign_features(particle_count, triangles, topology);
  merged_triangles_.assign(triangles.begin(), triangles.end());
  for (Triangle& corners : merged_triangles_) {
    for (Index& i : corners) i = merged(i);
  }
  corners_ = particle_corners(particle_count, merged_triangles_);

  // Edges with the same merged ends form a class; classes are numbered in the order of those ends.
  const std::size_t edges = topology.edges.size();
  const auto key = [&](std::size_t e) {
    const Index a = merged(topology.edges[e].a), b = merged(topology.edges[e].b);
    return std::make_tuple(std::min(a, b), std::max(a, b));
  };
  std::vector<std::size_t> order(edges);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t e, std::size_t f) { return std::make_pair(key(e), e) < std::make_pair(key(f), f); });
  edge_class_.resize(edges);
  Index classes = 0;
  for (std::size_t i = 0; i < edges; ++i) {
    if (i > 0 && key(order[i]) != key(order[i - 1])) ++classes;
    edge_class_[order[i]] = classes;
  }
  edge_rows_ = make_rows(
      edges == 0 ? 0 : static_cast<std::size_t>(classes) + 1, edges, [&](std::size_t e) { return edge_class_[e]; },
      [](std::size_t e) { return static_cast<Index>(e); });
}

}  // namespace toile::internal
