#include "mesh/topology.hpp"

#include "mesh/half_edges.hpp"

namespace toile::internal {
namespace {

// The corner opposite to side k (corners k, k+1) is corner k+2.
Index apex(std::span<const Triangle> triangles, const HalfEdge& side) {
  return triangles[static_cast<std::size_t>(side.triangle)][static_cast<std::size_t>(side.side + 2) % 3];
}

}  // namespace

Topology build_topology(Index particle_count, std::span<const Triangle> triangles) {
  check_corners("", particle_count, triangles);
  const std::vector<HalfEdge> half_edges = sorted_half_edges(triangles);
  check_edges("", half_edges);

  Topology topology;
  topology.triangle_edges.resize(triangles.size());
  std::size_t edges = 0, hinges = 0;
  for (std::size_t first = 0, end; first < half_edges.size(); first = end, ++edges) {
    end = edge_end(half_edges, first);
    if (end - first == 2) ++hinges;
  }
  topology.edges.reserve(edges);
  topology.hinges.reserve(hinges);
  for (std::size_t first = 0; first < half_edges.size();) {
    const std::size_t end = edge_end(half_edges, first);
    const auto edge = static_cast<Index>(topology.edges.size());
    for (std::size_t h = first; h < end; ++h) {
      const auto t = static_cast<std::size_t>(half_edges[h].triangle);
      topology.triangle_edges[t][static_cast<std::size_t>(half_edges[h].side)] = edge;
    }
    const HalfEdge& side_a = half_edges[first];  // sorted by triangle: the lower index comes first
    if (end - first == 2) {
      const HalfEdge& side_b = half_edges[first + 1];
      const Index x0 = side_a.forward ? side_a.a : side_a.b;
      const Index x1 = side_a.forward ? side_a.b : side_a.a;
      topology.edges.push_back({side_a.a, side_a.b, {side_a.triangle, side_b.triangle}});
      topology.hinges.push_back(
          {{x0, x1, apex(triangles, side_a), apex(triangles, side_b)}, {side_a.triangle, side_b.triangle}});
    } else {
      topology.edges.push_back({side_a.a, side_a.b, {side_a.triangle, -1}});
    }
    first = end;
  }
  return topology;
}

}  // namespace toile::internal
