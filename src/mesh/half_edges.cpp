#include "mesh/half_edges.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "core/error.hpp"

namespace toile::internal {

void check_corners(std::string_view where, Index particle_count, std::span<const Triangle> triangles) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [i, j, k] = triangles[t];
    for (const Index corner : triangles[t]) {
      if (corner < 0 || corner >= particle_count) {
        const std::string expected = particle_count > 0 ? "a corner in 0.." + std::to_string(particle_count - 1)
                                                        : std::string("no triangles, as there are no particles");
        throw InputError(where, "triangle " + std::to_string(t), expected, std::to_string(corner));
      }
    }
    if (i == j || j == k || k == i) {
      throw InputError(where, "triangle " + std::to_string(t), "three different corners",
                       std::to_string(i) + ", " + std::to_string(j) + ", " + std::to_string(k));
    }
  }
}

std::vector<HalfEdge> sorted_half_edges(std::span<const Triangle> triangles) {
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t side = 0; side < 3; ++side) {
      const Index from = triangles[t][side];
      const Index to = triangles[t][(side + 1) % 3];
      half_edges.push_back(
          {std::min(from, to), std::max(from, to), static_cast<Index>(t), static_cast<std::int8_t>(side), from < to});
    }
  }
  // A total order: with three different corners, no triangle has two sides on one edge.
  std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& l, const HalfEdge& r) {
    return std::tie(l.a, l.b, l.triangle) < std::tie(r.a, r.b, r.triangle);
  });
  return half_edges;
}

std::size_t edge_end(std::span<const HalfEdge> half_edges, std::size_t first) {
  std::size_t end = first + 1;
  while (end < half_edges.size() && half_edges[end].a == half_edges[first].a &&
         half_edges[end].b == half_edges[first].b) {
    ++end;
  }
  return end;
}

void check_edges(std::string_view where, std::span<const HalfEdge> half_edges) {
  for (std::size_t first = 0; first < half_edges.size();) {
    const std::size_t end = edge_end(half_edges, first);
    const HalfEdge& one = half_edges[first];
    const auto place = [&] { return "edge " + std::to_string(one.a) + "-" + std::to_string(one.b); };
    if (end - first > 2) {
      constexpr std::size_t named = 4;  // a message is one line
      std::string got = std::to_string(end - first) + ": triangles ";
      for (std::size_t h = first; h < std::min(end, first + named); ++h) {
        got += (h > first ? ", " : "") + std::to_string(half_edges[h].triangle);
      }
      if (end - first > named) got += ", ...";
      throw InputError(where, place(), "one or two triangles", got);
    }
    if (end - first == 2 && one.forward == half_edges[first + 1].forward) {
      throw InputError(where, place(), "two triangles that walk it in opposite directions",
                       "triangles " + std::to_string(one.triangle) + " and " +
                           std::to_string(half_edges[first + 1].triangle) +
                           " in the same direction (one of them is flipped)");
    }
    first = end;
  }
}

}  // namespace toile::internal
