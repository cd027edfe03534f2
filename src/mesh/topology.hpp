// mesh/topology.hpp: edges and hinges of a triangle mesh, in a fixed order.
//
//            x2                  hinge: the edge x0 -> x1 as triangle A = (x0, x1, x2) walks it;
//           /  \                 triangle B walks it backwards, B = (x1, x0, x3).
//          / A  \                A is the triangle with the lower index, so x0 may be the larger particle.
//        x0 ---- x1
//          \ B  /                e = x1 - x0,  N_A = e x (x2 - x0),  N_B = (x3 - x0) x e
//           \  /                 theta = atan2((N_A x N_B) . e / |e|,  N_A . N_B)
//            x3
//
// theta = 0 when flat.  theta > 0 when the two triangles bend away from the side that their normals point to: a ridge
// seen from the right side, as every edge of a convex body has, with x3 behind the plane of A.  theta < 0 in a valley.
//
// Edges are sorted by (smaller, larger) particle; hinges by their edge.  Neither order depends on the triangles' order.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct Edge {
  Index a, b;                     // a < b
  std::array<Index, 2> triangle;  // in increasing order; the second is -1 on a boundary
};

struct Hinge {
  std::array<Index, 4> particle;  // x0, x1, x2, x3 as drawn
  std::array<Index, 2> triangle;  // A, B with A < B
};

struct Topology {
  std::vector<Edge> edges;
  std::vector<std::array<Index, 3>> triangle_edges;  // edge k of a triangle joins corners k and k+1
  std::vector<Hinge> hinges;
};

// Throws InputError, naming the edge and its triangles, when an edge has three or more triangles or two that
// walk it in the same direction (one of them is flipped); naming the triangle when a corner
// is out of range or used twice.
Topology build_topology(Index particle_count, std::span<const Triangle> triangles);

}  // namespace toile::internal
