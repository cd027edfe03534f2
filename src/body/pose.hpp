// body/pose.hpp: poses a mannequin's skeleton, and skins it.
//
// Joint rotations q_j are relative to the parent and written in the axes of the world of the A-pose, so that the
// identity everywhere is the A-pose and rotations of a limb add up along it:
//   Q_j = Q_parent q_j,    T_j(p) = Q_j (p - c_j) + T_parent(c_j)          c_j: the joint in the A-pose
// The skin follows by dual quaternions [Kavan, Collins, Zara & O'Sullivan, Geometric Skinning with Approximate Dual
// Quaternion Blending, ACM TOG 27(4), 2008]: vertex i moves by the rigid motion  sum_j w_ij T_j / |sum_j w_ij T_j|.  A
// ring of skin with equal weights around a limb moves as one rigid piece, so it keeps its girth however far the joint
// bends or twists; linear blending would average matrices and pinch it by up to 1 - cos(angle / 2).
//
// Mind: between two joints turned by more than 180 degrees against each other a blend takes the wrong way round; our motions
// keep neighbours below 140.
#pragma once
#include "body/mannequin.hpp"
#include "core/quaternion.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct Pose {
  Vec3 root_m = Vec3::Zero();     // shift of the first joint
  std::vector<Quaternion> turns;  // per joint, of unit length
};

struct RigidTransform {
  Quaternion turn;
  Vec3 shift_m = Vec3::Zero();
  Vec3 operator()(const Vec3& p) const { return turn * p + shift_m; }
};

Pose a_pose(std::size_t joints);

// The transform of each joint from the A-pose to the pose.  Throws InputError for another number of joints.
std::vector<RigidTransform> joint_transforms(std::span<const Joint> joints, const Pose& pose);

class SkinnedBody {
 public:
  // Copies the data of the mannequin that it needs.
  explicit SkinnedBody(const Mannequin& mannequin);

  std::size_t vertex_count() const { return rest_.size(); }
  std::span<const Joint> joints() const { return joints_; }

  // Throws InputError unless `x` has one entry per vertex and the pose one turn per joint.  The A-pose gives the
  // mannequin's positions to the last bit.  About 0.2 ms for 10,000 vertices on one thread.
  void positions(const Pose& pose, std::span<Vec3> x) const;

 private:
  std::vector<Vec3> rest_;
  std::vector<SkinWeights> skin_;
  std::vector<Joint> joints_;
};

}  // namespace toile::internal
