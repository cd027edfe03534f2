// garment/garment_mesh.hpp: a pattern as cloth: meshed panels, placed flat around the body, and the seams between them.
//
// Seam samples are shared: both edges of a stitch get the point count of the longer one, so that sewing pairs particle with
// particle and nothing is inserted later.  An eased seam keeps its two lengths, the surplus spread evenly by arc length.
//
// Coordinates: the grain runs up the panel, so the warp is u = y of the drawing and the weft v = -x.  A panel that is drawn
// clockwise faces the other way (a back panel): it is mirrored, v = x, so that every triangle is counter-clockwise in (u, v) and
// seen from its right side.  A panel sewn "right to wrong" is turned over so that the right sides agree along every seam.
//
// A fold cuts its panel into pieces that are meshed one by one and share the points on the line: mesh edges follow it.
#pragma once
#include "garment/pattern.hpp"
#include "mesh/cloth_mesh.hpp"

#include <span>
#include <string>
#include <vector>

namespace toile::internal {

struct SeamPair {  // two particles that will become one
  Index a = 0, b = 0;
  double share_m = 0;  // how much of the seam's length this pair carries
  Index seam = 0;
};

struct Seam {
  std::string name;  // "front.2 - back.4": panel and edge number of both sides
  double length_a_m = 0, length_b_m = 0;
};

struct LabelledEdge {  // an edge that belongs at a place of the body: "lower_interface", "strapless_top" ...
  std::string label;
  std::vector<Index> particles;
};

struct GarmentMesh {
  std::string name;
  ClothMesh mesh;               // panels unwelded
  Vec3s x;                      // placed, m
  std::vector<Seam> seams;      // one per stitch
  std::vector<SeamPair> pairs;  // a dart's apex, sewn to itself, is not among them
  std::vector<LabelledEdge> labels;
  std::vector<std::string> panel_labels;  // [panel] "body", "arm", "leg" ... or empty
  std::vector<Index> merged;        // [particle] smallest particle of the class it will be welded into (itself if none)
  std::vector<bool> on_panel_edge;  // [particle]
  bool legacy_frame = false;
  bool pleated = false;  // panels with pleats begin folded, and stay so while they are sewn

  // Removes these `pairs` (indices, ascending): the weld leaves them open.
  void leave_open(std::span<const Index> open_pairs);
  std::vector<Index> panel_of_particle() const;  // -1: a particle without a triangle
};

struct MeshQuality {  // for reports
  double min_angle_deg = 0, p1_angle_deg = 0, mean_edge_m = 0, min_edge_m = 0, max_edge_m = 0;
};
MeshQuality mesh_quality(const ClothMesh& mesh);

// Throws InputError naming the seam when its two sides cannot be joined: twisted (the other way round, the placed edges are much
// nearer) or closing into a one-sided surface.
GarmentMesh mesh_garment(const Pattern& pattern, double resolution_m);

// The same with the edge length that gives the welded garment `particles` particles, within 1 %.  Whole rows of
// triangles make the count jump with the edge length; at a jump the first panels are meshed on its one side and the others
// on the other.  Throws InputError naming the nearest count when that is not enough (or for particles outside
// 20 ... 2,000,000).
struct CountedGarment {
  GarmentMesh garment;
  double resolution_m = 0;  // edge length of the outlines
};
CountedGarment mesh_garment_to_count(const Pattern& pattern, int particles);

// Particles of the welded garment.
int welded_count(const GarmentMesh& garment);

// The welded cloth: classes of `merged` become one particle each, numbered so that neighbours have near numbers, for cache locality
// (assembly/block_pattern.hpp).  Connected components follow each other in the order of their first particles: in an outfit the garments
// already worn come before the new one.
struct WeldedMesh {
  ClothMesh mesh;
  std::vector<Index> particle_of;  // [unwelded particle] welded particle
};
WeldedMesh weld(const GarmentMesh& garment);

}  // namespace toile::internal
