// contact/features.hpp: representative triangles of vertices and edges, and the surroundings of features. [Curtis 2008]
//
// If every pair of triangles tested its corners, a vertex with six triangles over a face with six neighbours would be
// tested 36 times.  Each vertex and each edge is therefore owned by one representative triangle, and only that one
// tests it.
//
// Easily got wrong: two particles that a seam will weld are one vertex for the question "do these features touch?", yet
// each has its own owner, because until the weld they are at two places.
#pragma once
#include "core/types.hpp"
#include "mesh/topology.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::internal {

// [triangle] bit k: owns corner k;  bit 3 + k: owns edge k (corners k, k+1).  Every particle with a triangle and every
// edge has exactly one owner, the first triangle that has it.
std::vector<std::uint8_t> assign_features(std::size_t particle_count, std::span<const Triangle> triangles,
                                          const Topology& topology);

// A list of lists: row i is values[offsets[i]] .. values[offsets[i + 1]].
struct IndexRows {
  std::vector<Index> offsets, values;
  std::span<const Index> row(Index i) const {
    const auto r = static_cast<std::size_t>(i);
    return std::span(values).subspan(static_cast<std::size_t>(offsets[r]),
                                     static_cast<std::size_t>(offsets[r + 1] - offsets[r]));
  }
};

// [particle] every 3 * triangle + corner with this particle, ascending.
IndexRows particle_corners(std::size_t particle_count, std::span<const Triangle> triangles);

// The topology of a cloth mesh for contact, which only a weld changes.  Holds references: `triangles` and `topology`
// must outlive it.
//
// merged_particle[i] is the particle that i will be welded to (or i); chains and mutual pairs are understood.
// Empty: nothing is merged.  Throws InputError when its length is not the number of particles or an entry is out of
// range.
class ClothTopology {
 public:
  ClothTopology(std::size_t particle_count, std::span<const Triangle> triangles, const Topology& topology,
                std::span<const Index> merged_particle = {});
  // Deleted: it would keep a pointer to a temporary.
  ClothTopology(std::size_t, std::span<const Triangle>, Topology&&, std::span<const Index> = {}) = delete;

  std::size_t particle_count() const { return merged_.size(); }
  std::span<const Triangle> triangles() const { return triangles_; }
  const Topology& topology() const { return *topology_; }
  const Triangle& triangle(Index t) const { return triangles_[static_cast<std::size_t>(t)]; }
  const Edge& edge(Index e) const { return topology_->edges[static_cast<std::size_t>(e)]; }
  const std::array<Index, 3>& triangle_edges(Index t) const {
    return topology_->triangle_edges[static_cast<std::size_t>(t)];
  }

  std::uint8_t owned(Index triangle) const { return owned_[static_cast<std::size_t>(triangle)]; }
  // The smallest of the particles that will be welded to `particle`.
  Index merged(Index particle) const { return merged_[static_cast<std::size_t>(particle)]; }
  const Triangle& merged_triangle(Index t) const { return merged_triangles_[static_cast<std::size_t>(t)]; }

  // 3 * triangle + corner at every particle merged with this one, itself included.
  std::span<const Index> corners_around(Index particle) const { return corners_.row(merged(particle)); }
  // Edges whose ends are merged with those of this edge, itself included.
  std::span<const Index> merged_edges(Index edge) const {
    return edge_rows_.row(edge_class_[static_cast<std::size_t>(edge)]);
  }

 private:
  std::span<const Triangle> triangles_;
  const Topology* topology_;
  std::vector<std::uint8_t> owned_;
  std::vector<Index> merged_;
  std::vector<Triangle> merged_triangles_;
  IndexRows corners_, edge_rows_;
  std::vector<Index> edge_class_;
};

}  // namespace toile::internal
