// body/mannequin_shape.hpp: the shape of a mannequin as a field, and the joints that it is built around.
//
// Parts of a form (mannequin_form.hpp) are blended; metres, y up, facing +z, so that +x is the left.  The field is
// symmetric in x.
#pragma once
#include "body/mannequin_form.hpp"

#include <memory>

namespace toile::internal {

class MannequinShape {
 public:
  explicit MannequinShape(const MannequinForm& form = woman_form());
  ~MannequinShape();
  MannequinShape(const MannequinShape&) = delete;
  MannequinShape& operator=(const MannequinShape&) = delete;

  // < 0 inside; about the distance to the skin near it.
  double operator()(const Vec3& p) const;

  // Target edge length of the mesh near p: finer at hands, face and feet.
  double edge_m(const Vec3& p) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

// All joints; a parent comes before its children.
std::vector<Joint> mannequin_joints(const MannequinForm& form);

// The arm's straight axis from the shoulder joint, 45 degrees below the horizontal; its positions by distance, m.
struct ArmAxis {
  Vec3 shoulder, along;
  double elbow, wrist, finger_tip;
};
ArmAxis left_arm_axis(const MannequinForm& form = woman_form());

}  // namespace toile::internal
