// verify/crossings.hpp: every edge that passes through a triangle, found exactly.
//
// Two triangles in general position intersect exactly when an edge of one passes through the other.  So cloth and body
// are free of each other when no cloth edge passes through a body triangle and no body edge through a cloth triangle (a
// finger tip inside one large cloth triangle shows only in the second).
//
// Pairs that share a particle are not tested, and no crossing is missed: an edge and a triangle with a common end meet
// there and, in general position, nowhere else; two triangles that share one particle and cross do so through the edge
// opposite to it, which shares nothing with the other triangle; two that share an edge cannot cross.
//
// Degenerate positions are resolved as in predicates.hpp, a particle's rank being its index (the body's follow the
// cloth's): passing exactly through an edge or a vertex of the surface is one crossing; merely touching may or may not
// be one.
#pragma once
#include "core/types.hpp"
#include "verify/box_tree.hpp"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace toile::internal {

struct Crossing {
  std::array<Index, 2> edge;  // particles, smaller first
  Index triangle;
  Vec3 position;              // approximately, m
  bool edge_of_body = false;  // the edge is the body's and the triangle the cloth's
};

// Cloth edges through body triangles, then body edges through cloth triangles; each sorted by (edge, triangle).
// Throws InputError when an index is out of range, a triangle has a corner twice, or a position is not finite.
std::vector<Crossing> find_body_crossings(std::span<const Triangle> cloth, std::span<const Vec3> x,
                                          std::span<const Triangle> body, std::span<const Vec3> body_x);

// Edges of a surface through triangles of the same surface that share no particle with them, sorted by (edge,
// triangle). Throws as find_body_crossings.
std::vector<Crossing> find_cloth_crossings(std::span<const Triangle> cloth, std::span<const Vec3> x);

// Both for surfaces that move, frame by frame: edges are found once, and the trees follow the surfaces.
class CrossingSearch {
 public:
  CrossingSearch(std::vector<Triangle> cloth, std::vector<Triangle> body);

  struct Found {
    std::vector<Crossing> of_body, of_cloth;  // as find_body_crossings and find_cloth_crossings
  };
  // Throws as find_body_crossings.
  Found find(std::span<const Vec3> x, std::span<const Vec3> body_x);

 private:
  struct Moving {
    std::vector<Triangle> triangles;
    std::vector<std::array<Index, 2>> edges;
    std::optional<BoxTree> tree;
  };
  Moving cloth_, body_;
  int frames_ = 0;
};

// The number of different edges in a list sorted as above: the count in report.json.
int count_edges(std::span<const Crossing> crossings);

}  // namespace toile::internal
