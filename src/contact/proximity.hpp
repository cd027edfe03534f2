// contact/proximity.hpp: near pairs of features.  Positions in, records out; no forces here.   (L0 and L2 of contact)
//
// A contact is a weighted sum of particles:  sum_i weight_i x_i [- body point] = gap * normal,  so the gap's rate is
// normal . (sum_i weight_i v_i [- body velocity]).
//
// Feature ownership: every vertex-face, vertex-edge, vertex-vertex and edge-edge pair appears once, whichever triangles
// reported it.  Edge-edge records have both parameters interior.  Of the remaining records, two kinds are dropped:
//
//   not a least distance   A vertex-edge or vertex-vertex record where the vertex also has a record with a face around
//                          that edge or vertex, or (vertex-vertex) with an edge at that vertex: the point is nearer
//                          there.
//   the region test        Let u be the unit vector from the feature's point to the other side.  The record counts only
//                          if u . t <= region_tolerance for every direction t that leads from the feature into the
//                          cloth around it: across the edge into each of its triangles, along each edge that leaves the
//                          vertex.  For edge-edge both edges must pass.  Without it a vertex over a face also gets rows
//                          of the edges nearby, with sideways normals that interlock two sheets like gears.
//                                                             [the cones of offset geometric contact, Chen et al. 2025]
//
// A vertex-vertex record must pass as seen from both of its vertices.
//
// Two edges that are both flat (flat_edge_sine), and not listed in ProximityOptions::bent, are not reported: between
// two planes the rows of their vertices already keep the gap, and parallel sheets would otherwise carry three rows of
// edges for each of vertices.
//
// Easily got wrong: for vertex-edge the region test is about the edge only.  Whether the direction leans into the cloth
// around the vertex is not tested, so a vertex of a lower sheet just outside the hem of an upper one has a slanting row
// with that hem.
#pragma once
#include "contact/body_surface.hpp"
#include "contact/distance.hpp"
#include "contact/feature_pairs.hpp"
#include "contact/features.hpp"
#include "contact/triangle_tree.hpp"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace toile::internal {

// Cosine of the angle to a direction within the cloth above which a record leans into the feature's own surroundings.
inline constexpr double region_tolerance = 0.1;

// Two faces of the cloth that meet at an edge are flat there when the sine of their bend is below this: an edge of
// length l then hides at most l/40 of the gap that its vertices show.
inline constexpr double flat_edge_sine = 0.1;

// Below this cosine between a body record's direction and the body's pseudonormal (84 degrees) its sign is doubtful.
inline constexpr double doubtful_cosine = 0.1;

// A ridge of the body counts for a cloth edge if the edge, supported at its ends only, would sink into it by more than
// this share of the range.
inline constexpr double ridge_dip_share = 0.1;

enum class ContactKind : std::uint8_t { vertex_face, vertex_edge, vertex_vertex, edge_edge };

// Cloth against cloth.
//   vertex_face    (vertex, corners of the triangle)          weights (1, -b0, -b1, -b2)
//   vertex_edge    (vertex, edge a < b, -1)                   weights (1, -(1-t), -t, 0)
//   vertex_vertex  (smaller, larger, -1, -1)                  weights (1, -1, 0, 0)
//   edge_edge      (edge a < b, edge a < b; smaller first)    weights (1-s, s, -(1-t), -t)
struct ClothContact {
  ContactKind kind;
  std::array<Index, 4> particle;  // unused entries are -1 with weight 0
  std::array<double, 4> weight;   // sums to 0
  Vec3 normal;                    // unit, from the second feature to the first
  double gap_m;                   // distance, >= 0; at 0 the normal is the surface's, with an arbitrary sign
};

// A body feature against a cloth face or edge (for vertices of the cloth: constraints, L1).
struct BodyContact {
  ContactKind kind;                  // vertex_face: body vertex, cloth face;  edge_edge: cloth edge, body edge
  std::array<Index, 3> particle;     // of the cloth; unused entries are -1 with weight 0
  std::array<double, 3> weight;      // sums to 1
  std::array<Index, 2> body_vertex;  // one (then -1) or the two ends of the body's edge
  double body_parameter;             // point on the body's edge: (1-t) first + t second; 0 for a vertex
  Vec3 normal;                       // unit, out of the body
  double gap_m;                      // signed: negative when the body pokes through
};

struct ProximityOptions {
  double range_m = 5e-3;   // report pairs nearer than this
  double depth_m = 10e-3;  // body: and penetrating less than this
  // 0.1 excludes every row that leans into its own cloth; 0.5 keeps contacts in sharp creases, where sewing squeezes
  // folds together.  Sheets slide with either: the stiffness of slanting rows used to interlock them
  // (step/contact_rows.hpp).
  double region_tolerance = toile::internal::region_tolerance;
  // Edges (a < b) of the cloth that count as bent, whatever their faces: edges that lie flat because their rows act.
  std::span<const std::array<Index, 2>> bent = {};
};

// Memory of the two queries, kept between calls so that a steady simulation allocates nothing.  One per caller.
class ProximityWorkspace {
 public:
  ProximityWorkspace();
  ~ProximityWorkspace();
  ProximityWorkspace(ProximityWorkspace&&) noexcept;
  ProximityWorkspace& operator=(ProximityWorkspace&&) noexcept;

  struct Memory;
  Memory& memory() { return *memory_; }

 private:
  std::unique_ptr<Memory> memory_;
};

// All contacts of the cloth with itself within range at positions x.  Features that touch (share a merged particle) are
// skipped.  Of `tree` only the hierarchy is used; its boxes become those of the query.  The list is sorted by (kind,
// particles) and is the same for any number of threads.  `pairs`: lists of this cloth, kept where that pays, for the
// caller's next queries as well; the contacts are the same without.
void find_cloth_contacts(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> x,
                         const ProximityOptions& options, ProximityWorkspace& workspace,
                         std::vector<ClothContact>& contacts, FeaturePairs* pairs = nullptr);

// Body vertices near cloth faces and body ridges near cloth edges, at x and the body's present positions; sorted by
// kind, then the body's vertex or edge, then the cloth's triangle or edge.  `cloth_tree`: as above.
//
// The sign of the gap comes from the body's pseudonormal, so a body feature that has passed through the cloth pushes it
// back out.  A penetrating record must be confirmed: its point of the cloth has to be inside the body, with its nearest
// way out on the same side.  Otherwise the far side of a finger or an ear would pull cloth through it.  Two kinds are
// left to edge rows and L1, because the cloth's vertices keep the gap there: a body vertex whose nearest
// cloth feature is not the face's interior, and body edges that are hollow or nearly flat (ridge_dip_share).
void find_body_contacts(const ClothTopology& cloth, TriangleTree& cloth_tree, std::span<const Vec3> x,
                        const BodySurface& body, const ProximityOptions& options, ProximityWorkspace& workspace,
                        std::vector<BodyContact>& contacts);

}  // namespace toile::internal
