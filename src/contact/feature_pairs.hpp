// contact/feature_pairs.hpp: pairs of features of a cloth that may meet: vertices and triangles, edges and edges.  (L0)
//
// The pairs come from a traversal of the tree, or from lists that are kept while they are valid. [Verlet 1967]
// Lists are made with boxes enlarged on every side by
//
//   s_i = s_0 + 4 d_i            d_i  recent motion of particle i in a step, relative to the mean of the cloth
//
// and are valid for every query whose boxes lie within these.  A list contains the pairs that a traversal finds and
// more; the caller tests the boxes of the query against each other, and gets the same pairs from both.  Results do not
// depend on whether there are lists.
//
// Lists pay where cloth comes to rest.  Cloth that moves by more than a few hundredths of its edges in a step leaves
// its boxes at once, or needs such large ones that they contain most of its surroundings: then there are none.
// Measured: bench/notes.md.
#pragma once
#include "contact/features.hpp"
#include "contact/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace toile::internal {

// Pairs of features that do not touch (share a merged particle) and whose boxes overlap, of one task of the tree's
// traversal against itself: on_vertex(particle, triangle) and on_edges(lesser edge, greater edge), each pair once.
template <class OnVertex, class OnEdges>
void visit_feature_pairs(const ClothTopology& cloth, const TriangleTree& tree, TreeTask task, OnVertex&& on_vertex,
                         OnEdges&& on_edges) {
  const auto meet_vertices = [&](Index a, unsigned owned, Index b) {
    const Triangle& merged = cloth.merged_triangle(b);
    const OuterBox& box = tree.triangle_box(b);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(owned >> k & 1u)) continue;
      const Index v = cloth.triangle(a)[k], m = cloth.merged_triangle(a)[k];
      if (m == merged[0] || m == merged[1] || m == merged[2]) continue;
      if (tree.particle_box(v).overlaps(box)) on_vertex(v, b);
    }
  };
  const auto meet_edges = [&](Index a, unsigned edges_a, Index b, unsigned edges_b) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(edges_a >> k & 1u)) continue;
      const Index first = cloth.triangle_edges(a)[k];
      const Edge& e = cloth.edge(first);
      const OuterBox box = tree.edge_box(e.a, e.b);
      const Index ea = cloth.merged(e.a), eb = cloth.merged(e.b);
      for (std::size_t l = 0; l < 3; ++l) {
        if (!(edges_b >> l & 1u)) continue;
        const Index second = cloth.triangle_edges(b)[l];
        const Edge& f = cloth.edge(second);
        const Index fa = cloth.merged(f.a), fb = cloth.merged(f.b);
        if (ea == fa || ea == fb || eb == fa || eb == fb) continue;
        if (box.overlaps(tree.edge_box(f.a, f.b))) on_edges(std::min(first, second), std::max(first, second));
      }
    }
  };
  tree.visit_self(task, [&](Index a, Index b) {
    const unsigned owned_a = cloth.owned(a), owned_b = cloth.owned(b);
    if (owned_a & 7u) meet_vertices(a, owned_a, b);
    if (owned_b & 7u) meet_vertices(b, owned_b, a);
    if (owned_a >> 3 != 0 && owned_b >> 3 != 0) meet_edges(a, owned_a >> 3, b, owned_b >> 3);
  });
}

// The lists of one cloth.  All boxes are relative to the mean motion (contact/particle_boxes.hpp).
class FeaturePairs {
 public:
  // For the proximity query, once a step: are the lists valid for these boxes?  Rebuilds them where that pays; then the
  // boxes of `tree` are theirs.
  bool seek(const ClothTopology& cloth, TriangleTree& tree, const ParticleBoxes& boxes);
  // For any other query: are they valid?
  bool hold(const ParticleBoxes& boxes) const { return made_ && boxes.within(holds_); }

  // While they are valid: the triangles that the vertex may meet, and the edges of a greater index that the edge may.
  std::span<const Index> triangles_near(Index vertex) const { return triangles_.row(vertex); }
  std::span<const Index> edges_near(Index edge) const { return edges_.row(edge); }

 private:
  using Keys = std::vector<std::pair<Index, Index>>;
  struct Found {
    Keys vertices, edges;
  };

  void follow(const ClothTopology& cloth, const ParticleBoxes& boxes);
  bool make(const ClothTopology& cloth, TriangleTree& tree);
  void list(Keys Found::*keys, std::size_t rows, IndexRows& lists) const;

  bool made_ = false;
  int wait_ = 0;  // steps until the next attempt
  ParticleBoxes holds_;
  IndexRows triangles_, edges_;
  std::vector<std::array<float, 3>> last_;  // corners of the boxes last given to seek; empty: never
  std::vector<float> motion_m_;             // d_i
  double mean_edge_m_ = 0, mean_motion_m_ = 0;
  std::vector<TreeTask> tasks_;
  std::vector<Found> found_;  // by task
};

}  // namespace toile::internal
