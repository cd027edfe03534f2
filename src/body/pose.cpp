// body/pose.cpp: joint transforms and dual quaternion skinning.
#include "body/pose.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <string>

namespace toile::internal {

namespace {

// real + eps dual, with dual = (0, shift) real / 2.
struct DualQuaternion {
  Quaternion real, dual{0, Vec3::Zero()};
};

DualQuaternion dual_quaternion(const RigidTransform& t) {
  const Quaternion twice = Quaternion{0, t.shift_m} * t.turn;
  return {t.turn, {0.5 * twice.w, 0.5 * twice.v}};
}

void add(Quaternion& sum, double factor, const Quaternion& q) {
  sum.w += factor * q.w;
  sum.v += factor * q.v;
}

}  // namespace

Pose a_pose(std::size_t joints) { return {Vec3::Zero(), std::vector<Quaternion>(joints)}; }

std::vector<RigidTransform> joint_transforms(std::span<const Joint> joints, const Pose& pose) {
  if (pose.turns.size() != joints.size())
    throw InputError("", "pose", std::to_string(joints.size()) + " joint rotations", std::to_string(pose.turns.size()));
  std::vector<RigidTransform> transforms(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Vec3& centre = joints[j].position_m;
    RigidTransform& t = transforms[j];
    Vec3 moved = centre + pose.root_m;
    t.turn = pose.turns[j];
    if (joints[j].parent >= 0) {
      const RigidTransform& parent = transforms[at(joints[j].parent)];
      moved = parent(centre);
      t.turn = parent.turn * pose.turns[j];
    }
    t.shift_m = moved - t.turn * centre;
  }
  return transforms;
}

SkinnedBody::SkinnedBody(const Mannequin& mannequin)
    : rest_(mannequin.positions), skin_(mannequin.skin), joints_(mannequin.joints) {}

void SkinnedBody::positions(const Pose& pose, std::span<Vec3> x) const {
  if (x.size() != rest_.size())
    throw InputError("", "pose", "room for " + std::to_string(rest_.size()) + " vertices", std::to_string(x.size()));
  std::vector<DualQuaternion> bones;
  for (const RigidTransform& t : joint_transforms(joints_, pose)) bones.push_back(dual_quaternion(t));
  parallel_for(rest_.size(), 1024, [&](std::size_t i) {
    const SkinWeights& skin = skin_[i];
    const DualQuaternion& first = bones[at(skin.joint[0])];
    Quaternion real{0, Vec3::Zero()}, dual{0, Vec3::Zero()};
    for (std::size_t k = 0; k < 4 && skin.weight[k] > 0; ++k) {
      const DualQuaternion& bone = bones[at(skin.joint[k])];
      const double w = bone.real.dot(first.real) < 0 ? -skin.weight[k] : skin.weight[k];  // the shorter way
      add(real, w, bone.real);
      add(dual, w, bone.dual);
    }
    const double n2 = real.dot(real);
    const Vec3& p = rest_[i];
    x[i] = p + (2.0 * real.v.cross(real.v.cross(p) + real.w * p) +
                2.0 * (real.w * dual.v - dual.w * real.v + real.v.cross(dual.v))) /
                   n2;
  });
}

}  // namespace toile::internal
