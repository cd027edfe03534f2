// contact/body_impacts.hpp: where cloth would pass through a moving body on a straight motion, and where it does already.   (L3)
//
// As contact/impacts.hpp: vertices of either against faces of the other, and edges against edges, all of them: a ridge between two
// cloth vertices that both keep their distance is met by an edge.  Vertex k of the body is "particle" cloth particles + k of an Impact.
//
// A limb and the sleeve around it move by several triangles in a step, and hardly against each other.  Their swept boxes say
// nothing then; pairs of triangles are first held against their motion relative to each other:
//
//   m = |u_a - u_b| + e_a + e_b + xi        u, e  mean displacement, and how far corners differ from it
//   |c_a - c_b| > R_a + R_b + m             can not meet;  c, R  centre and radius at the start
//   all corners of one farther than m from the plane of the other, on one side:  nor can they
//
// Easily got wrong: cloth that is through the body at the start would be kept there; it is to be exempted.
#pragma once
#include "contact/impacts.hpp"

namespace toile::internal {

struct BodyGuard {
  const BodySurface* body = nullptr;  // in motion from positions() to next_positions()
  double contact_m = 0;               // r, of every pair
  std::span<const char> exempt;       // [cloth particle] 1: pairs with it are not looked at
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

// All impacts, sorted by (kind, particles), so that their order does not depend on what else the body has.  Of `tree` only the hierarchy is
// used; its boxes become those of the motion.
// Returns false when there are too many, as find_impacts does: then not all are there.
[[nodiscard]] bool find_body_impacts(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> start,
                                     std::span<const Vec3> end, const BodyGuard& guard, BodyImpactWorkspace& workspace,
                                     std::vector<Impact>& impacts);

// Marks the particles of cloth edges and triangles that pass through the body as it is now.  Returns whether there are any.
// Decided in floating point: for what to guard, not for a judge.
bool mark_through_body(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> x, const BodySurface& body,
                       BodyImpactWorkspace& workspace, std::vector<char>& through);

}  // namespace toile::internal
