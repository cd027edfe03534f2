// body/middle_line.hpp: moves a person without a skeleton into a posture by bending the middle line.          docs/motions.md
//
// Bends and twists of space along an axis [Barr, Global and Local Deformations of Solid Primitives, SIGGRAPH 1984]: level slices of the
// body stay as they are, and are carried by the line.  Of a point p whose slice is at the height u,
//
//   x = c(u) + Rz(tau(u)) Ry(phi(u)) (p - m(u)),     c'(u) = (-sin a(u), cos a(u), 0),     m(u): upright through the middle of the hips
//
//   u (share of the height)      a, direction of the line     tau, tilt of slices      phi, turn of slices
//   below the ankles (0.04)      upright: there x = p         0                        0
//   knees (0.285) ... hips       tau - lean                   0 ... pelvis_list        0 ... pelvis_turn, from the ankles on
//   hips ... ribs                tau                          ... - spine - chest      ... + spine + chest
//   shoulders ... head           tau                          ... - neck               ... + neck
//
// Every "..." is the cubic step 3w^2 - 2w^3, so x is C1 in space, and as smooth in time as the posture.  Legs lean side by side, as two rods under a
// level pelvis do, so that the hips come to pelvis_x (to first order in the angles) while soles and pelvis keep their slope.  The chest, from the ribs to
// the shoulders, is rigid; all of an arm belongs to the slice at its root, so it moves rigidly with the chest.
//
// Lengths along the line are kept; at the distance d beside it they change by d dtau/du, and a turn shears by d dphi/du.
#pragma once
#include "body/posture.hpp"
#include "core/types.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace toile::internal {

class MiddleLine {
 public:
  // For an upright person facing +z.  Throws InputError, with `file` as its place, if no two arms and hips below them are found.
  MiddleLine(std::string_view file, std::span<const Vec3> standing, std::span<const Triangle> triangles);

  std::size_t vertex_count() const { return standing_.size(); }
  // Uses the channels of trunk and pelvis, except leaning forwards; metres are those of a person of 1.72 m and scale with the height.
  void bend(const Posture& posture, std::span<Vec3> x) const;

  double hips_m() const { return levels_.hips_m; }
  double ribs_m() const { return levels_.ribs_m; }

 private:
  struct Levels {  // m above the soles
    double height_m = 0, ankles_m = 0, knees_m = 0, hips_m = 0, ribs_m = 0, shoulders_m = 0, head_m = 0;
  };
  // The shares of each angle that a slice has.
  struct Shares {
    double lean = 0, list = 0, pelvis = 0, spine = 0, neck = 0;
  };
  struct Angles {
    double line = 0, tilt = 0, turn = 0;  // rad
  };
  struct Node {
    Vec3 place, slope;  // c, c'
  };
  Shares shares_at(double u_m) const;
  static Angles angles(const Shares& shares, const Posture& posture, double lean);
  double lean_of(const Posture& posture) const;
  std::vector<Node> bent_line(const Posture& posture, double lean) const;

  Vec3s standing_;
  Vec3 middle_{0, 0, 0};  // on the soles' level, under the hips
  Levels levels_;
  std::vector<double> slice_m_;  // [vertex] u
  std::vector<Shares> shares_;   // [vertex]
};

}  // namespace toile::internal
