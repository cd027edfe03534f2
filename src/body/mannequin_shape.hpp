// body/mannequin_shape.hpp: the shape of the mannequin as a field, and the joints that it is built around.
//
// An adult woman of 1.72 m with the proportions of a dress form; metres, y up, facing +z, so that +x is her left.
// The field is symmetric in x.  Its numbers are ours: heights and girths near the middle of published
// anthropometric ranges, shapes judged by eye.
#pragma once
#include "body/implicit_shape.hpp"
#include "body/mannequin.hpp"

#include <memory>

namespace toile {

class MannequinShape {
 public:
  MannequinShape();
  ~MannequinShape();
  MannequinShape(const MannequinShape&) = delete;
  MannequinShape& operator=(const MannequinShape&) = delete;

  // < 0 inside; about the distance to the skin near it.
  double operator()(const Vec3& p) const;

  // Wanted edge length of the mesh near p: finer at hands, face and feet.
  double edge_m(const Vec3& p) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

// All joints; a parent stands before its children.
std::vector<Joint> mannequin_joints();

// The end of the bone of a joint without children (crown, finger tips, toes); for the others, of their first child.
Vec3 bone_end(const std::vector<Joint>& joints, std::size_t joint);

// The arm's straight axis from the shoulder joint, 45 degrees below the horizontal; its positions by distance, m.
struct ArmAxis {
  Vec3 shoulder, along;
  double elbow, wrist, finger_tip;
};
ArmAxis left_arm_axis();

}  // namespace toile
