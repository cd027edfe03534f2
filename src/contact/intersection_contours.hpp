// contact/intersection_contours.hpp: the curves along which surfaces pass through each other, traced from single
// crossings.                                                                            [Baraff, Witkin & Kass 2003, 3]
//
//   crossing   an edge that passes through a triangle: one point of a curve
//   segment    the piece of a curve in one pair of triangles; its ends are the pair's two crossings, or one crossing
//              and a particle that the two triangles share
//   contour    segments joined at crossings: over the edge of one triangle into its neighbour, within the other.  It
//              has two sides, 0 and 1: the two surfaces (or two places of one surface) that meet along it.
//
//   closed     the curve returns to its first point
//   open       it ends where an edge of the boundary passes through the other surface, or at a shared particle
//
// Cloth and body are one mesh here: the body's particles and triangles follow the cloth's.  The crossings must be those
// of an exact finder (or of one with consistent ties): then a pair of triangles has two crossings, or one and a shared
// particle, and none is left over.  Where that fails a contour ends.
//
// Easily got wrong: in a surface that crosses itself both sides run over the same mesh, so the edges that the contour
// cuts are defined only per side.
#pragma once
#include "mesh/topology.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct SurfaceCrossing {
  std::array<Index, 2> edge;  // particles, smaller first
  Index triangle;             // shares no particle with the edge
  Vec3 position;              // m
};

struct ContourPoint {
  Index crossing;
  int edge_side;  // 0 or 1: the side of the edge; the triangle is the other side's
};

struct IntersectionContour {
  std::vector<ContourPoint> points;  // along the curve
  // [segment] its triangles of side 0 and of side 1.  Segment k joins points k and k+1; the last one of a closed
  // contour joins the last point and the first.
  std::vector<std::array<Index, 2>> triangles;
  bool closed = false;
  std::array<Index, 2> end_particle{-1, -1};  // open: the shared particle before the first and after the last point
  bool sides_joined = false;                  // closed, and side 0 continues as side 1: one curve, traversed twice
};

// Contours in the order of their first crossing, open ones first; every crossing belongs to exactly one.  The result
// depends on the order of `crossings` only.  Throws InputError for an edge that the mesh does not have.
std::vector<IntersectionContour> trace_contours(const Topology& topology, std::span<const Triangle> triangles,
                                                std::span<const SurfaceCrossing> crossings);

// Sum of the distances between neighbouring points and the particles at the ends, m.
double contour_length(const IntersectionContour& contour, std::span<const SurfaceCrossing> crossings,
                      std::span<const Vec3> x);

// The part of a surface that a contour cuts off: the reach of a flood fill from one bank that does not cross the curve.
struct CutRegion {
  bool separates = false;           // false: the fill reaches the other bank
  std::vector<Index> particles;     // of the smaller part, ascending; empty where the curve stays within one triangle
  double area_m2 = 0, rest_m2 = 0;  // of the smaller part and of the other
};

// Flood fills on one mesh; keeps its memory.
class SurfaceRegions {
 public:
  // `area_m2` per particle: its share of the triangles around it.
  SurfaceRegions(const Topology& topology, std::size_t particle_count, std::vector<double> area_m2);

  CutRegion cut_off(const IntersectionContour& contour, std::span<const SurfaceCrossing> crossings, int side);
  // Also marks all particles at most `rings` edges away from marked ones.
  void grow(std::vector<char>& marked, int rings) const;

 private:
  std::span<const std::pair<Index, Index>> around(Index particle) const {  // (neighbour, edge)
    const auto i = static_cast<std::size_t>(particle);
    return std::span(neighbours_).subspan(offsets_[i], offsets_[i + 1] - offsets_[i]);
  }

  const Topology* topology_;
  std::vector<double> area_m2_;
  std::vector<std::size_t> offsets_;
  std::vector<std::pair<Index, Index>> neighbours_;
  std::vector<char> cut_;          // [edge] cut an odd number of times
  std::vector<std::int8_t> bank_;  // [particle] -1: not reached, else 0 or 1
  std::vector<Index> queue_;
};

// The index of an edge in topology.edges; -1 when there is none.
Index find_edge(const Topology& topology, std::array<Index, 2> edge);

}  // namespace toile::internal
