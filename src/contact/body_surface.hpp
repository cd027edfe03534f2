// contact/body_surface.hpp: a moving closed body: nearest points, inside or outside, and the motion of its points.
//
// The side of p is the sign of (p - c) . N with c the nearest point and N the angle-weighted pseudonormal of the
// feature that contains c: a face's normal, the sum of an edge's two face normals, the sum of a vertex's face normals
// weighted by the angles there.                                                              [Baerentzen & Aanaes 2005]
//
// Easily got wrong: the mean of the face normals, or an area weight, gives the wrong side near sharp vertices.
#pragma once
#include "contact/features.hpp"
#include "contact/triangle_tree.hpp"
#include "mesh/topology.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::internal {

// The nearest point of a closed body to one point.
struct BodyPoint {
  Index triangle = -1;  // -1: nothing within reach
  Vec3 barycentric = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit, out of the body: along (p - point) outside, against it inside
  double gap_m = 0;            // signed distance: negative inside
  template <class Archive>
  void remember(Archive& archive) {
    archive(triangle, barycentric, normal, gap_m);
  }
};

// A closed, outward-wound triangle mesh.  Throws InputError (from build_topology) when an edge has three triangles or
// two that disagree.  An open mesh is accepted, but "inside" is undefined beyond its rim: check_closed first
// (mesh/check.hpp).
class BodySurface {
 public:
  BodySurface() = default;
  // The body may be the union of several colliders, which may overlap: `vertex_collider` [vertex] is the collider of
  // each vertex; empty: there is one.
  BodySurface(std::vector<Vec3> positions, std::vector<Triangle> triangles, std::vector<Index> vertex_collider = {});

  // Moves the body to `end` over the coming step, from `start`, its present positions.  Vertices that stand still, and
  // did so in the motion before, cost only a comparison: a room around a walking person.  Throws InputError when a
  // length is not the number of vertices.
  void set_motion(std::span<const Vec3> start, std::span<const Vec3> end);
  // A shorter step from the same start: changes the end alone.  The trees are left as they are; tree() still holds the
  // longer motion, as long as the shorter one is a part of it.
  void set_end(std::span<const Vec3> end);

  std::span<const Vec3> positions() const { return start_; }     // now
  std::span<const Vec3> next_positions() const { return end_; }  // at the end of the step
  std::span<const Triangle> triangles() const { return triangles_; }
  const Triangle& triangle(Index t) const { return triangles_[static_cast<std::size_t>(t)]; }
  Index collider(Index triangle) const { return collider_of_vertex(triangles_[at(triangle)][0]); }
  Index collider_of_vertex(Index vertex) const { return vertex_collider_.empty() ? 0 : vertex_collider_[at(vertex)]; }
  const Topology& topology() const { return topology_; }
  const TriangleTree& tree() const { return tree_; }          // boxes of the coming motion, without a margin
  const TriangleTree& tree_now() const { return tree_now_; }  // boxes of the present positions, without a margin

  // The nearest point of the body at its present positions, within `reach_m`.
  BodyPoint nearest(const Vec3& p, double reach_m) const;
  // The same among the faces whose normal is within 60 degrees of `direction`, even if others are nearer.  The normal
  // is the face's, and the gap the height over its plane: negative behind it.
  BodyPoint nearest_facing(const Vec3& p, const Vec3& direction, double reach_m) const;

  // The nearest face opposite p, along `normal` (unit): among the faces that look against it (n . normal < -1/2), at
  // points within 60 degrees of it.  The normal is the face's, as in nearest_facing.
  BodyPoint nearest_opposite(const Vec3& p, const Vec3& normal, double reach_m) const;

  // The number of the body's parts that contain p (less one for every room that does): 0 in the open.  In floating
  // point: for choosing an action, not for a verdict (verify/winding.hpp).
  int winding_number(const Vec3& p) const;

  // The material point (triangle, barycentric) now and at the end of the step; its mean velocity over a step of h
  // seconds is (next_position - position) / h.
  Vec3 position(Index triangle, const Vec3& barycentric) const { return point(start_, triangle, barycentric); }
  Vec3 next_position(Index triangle, const Vec3& barycentric) const { return point(end_, triangle, barycentric); }
  // next_position - position, without the cancellation of their difference.
  Vec3 travel(Index triangle, const Vec3& barycentric) const {
    const Triangle& c = triangles_[static_cast<std::size_t>(triangle)];
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) sum += barycentric[static_cast<Eigen::Index>(k)] * vertex_travel(c[k]);
    return sum;
  }
  Vec3 vertex_travel(Index vertex) const {
    return end_[static_cast<std::size_t>(vertex)] - start_[static_cast<std::size_t>(vertex)];
  }

  // An upper bound on the travel of the body's points that come within `reach_m` of p in the step; 0 when none does.  A
  // swinging hand does not count for a standing foot.
  double travel_near(const Vec3& p, double reach_m) const;

  // The normal at a triangle in the middle of the step, which may turn it: n + (N_end - N_now)/2, at unit length.
  Vec3 normal_midway(Index triangle, const Vec3& normal) const;

  // Unit pseudonormals of the body at its present positions.
  const Vec3& face_normal(Index triangle) const { return face_normals_[static_cast<std::size_t>(triangle)]; }
  const Vec3& vertex_normal(Index vertex) const { return vertex_normals_[static_cast<std::size_t>(vertex)]; }
  const Vec3& edge_normal(Index edge) const { return edge_normals_[static_cast<std::size_t>(edge)]; }

  // The convexity of an edge: the length of the difference of its face normals (2 sin of half the bend), or 0 where it
  // is flat to 1e-3 or hollow.
  double ridge_bend(Index edge) const { return ridge_bend_[static_cast<std::size_t>(edge)]; }

  // The features that this triangle represents (contact/features.hpp).
  std::uint8_t owned(Index triangle) const { return owned_[static_cast<std::size_t>(triangle)]; }
  // The same, with only the edges that have a ridge_bend.
  std::uint8_t owned_ridges(Index triangle) const { return owned_ridges_[static_cast<std::size_t>(triangle)]; }

 private:
  Vec3 point(const std::vector<Vec3>& x, Index triangle, const Vec3& barycentric) const {
    const Triangle& c = triangles_[static_cast<std::size_t>(triangle)];
    return barycentric[0] * x[static_cast<std::size_t>(c[0])] + barycentric[1] * x[static_cast<std::size_t>(c[1])] +
           barycentric[2] * x[static_cast<std::size_t>(c[2])];
  }
  // Updates the normals of faces with a vertex whose moved_ is not 0, and of their edges and vertices.
  void update_normals();

  std::vector<Vec3> start_, end_;
  std::vector<std::uint8_t> moved_, still_;  // [vertex] moved since the last motion or in this one; not in this one
  std::vector<std::uint8_t> face_moved_, edge_moved_;
  std::vector<Triangle> triangles_;
  std::vector<Index> vertex_collider_;
  Topology topology_;
  TriangleTree tree_, tree_now_;
  std::vector<std::uint8_t> owned_, owned_ridges_;
  IndexRows corners_;
  std::vector<Vec3> face_normals_, vertex_normals_, edge_normals_;
  std::vector<double> corner_angles_;  // [3 * triangle + corner], rad
  std::vector<double> ridge_bend_;     // [edge]
};

}  // namespace toile::internal
