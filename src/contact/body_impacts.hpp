// contact/body_impacts.hpp: impacts of cloth with a moving body on a straight motion, and present crossings.   (L3)
//
// As contact/impacts.hpp: vertices of either against faces of the other, and all edges against edges: a ridge between
// two cloth vertices that both keep their distance hits an edge.  Vertex k of the body is "particle" cloth particles +
// k of an Impact.
//
// A limb and the sleeve around it move by several triangles in a step, but hardly against each other.  Their swept
// boxes then reject nothing, so pairs of triangles are first tested against their relative motion:
//
//   m = |u_a - u_b| + e_a + e_b + xi        u, e  mean displacement, and the largest deviation of a corner from it
//   |c_a - c_b| > R_a + R_b + m             cannot meet;  c, R  centre and radius at the start
//
// and then along three directions, the normals of both and the line between the centres: triangles of which one lies farther than 1.3 xi beyond the
// other before and after the motion are so all the way (contact/ccd.hpp), and none of their pairs is an impact.
//
// Easily got wrong: cloth that is through the body at the start would be kept there; the caller exempts it.
#pragma once
#include "contact/impacts.hpp"

namespace toile::internal {

struct BodyGuard {
  const BodySurface* body = nullptr;  // in motion from positions() to next_positions()
  double contact_m = 0;               // r, of every pair
  std::span<const char> exempt;       // [cloth particle] 1: pairs with it are skipped
};

struct BodyImpactWorkspace {
  struct Mover {
    Vec3 centre, displacement, normal;  // normal: unit, or zero
    double radius, differ;
  };
  std::vector<TreeTask> tasks;
  std::vector<std::vector<Impact>> found;  // by task
  std::vector<std::vector<Index>> through;
  std::vector<Mover> cloth, body;  // [triangle]
};

// All impacts, sorted by (kind, particles), so that their order does not depend on the rest of the body.  Of `tree`
// only the hierarchy is used; its boxes become those of the motion.  Returns false when there are too many, like
// find_impacts: then the list is incomplete.
[[nodiscard]] bool find_body_impacts(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> start,
                                     std::span<const Vec3> end, const BodyGuard& guard, BodyImpactWorkspace& workspace,
                                     std::vector<Impact>& impacts);

// Marks the particles of cloth edges and triangles that pass through the body at its present positions.  Returns
// whether there are any.  Decided in floating point: for choosing particles to guard, not for a verdict.
bool mark_through_body(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> x, const BodySurface& body,
                       BodyImpactWorkspace& workspace, std::vector<char>& through);

}  // namespace toile::internal
