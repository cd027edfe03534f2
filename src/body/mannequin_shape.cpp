// body/mannequin_shape.cpp: places the parts of a mannequin and blends them.
//
// Every part is written for the left side (x > 0).  Parts beside the middle come with their image, so that breasts,
// buttocks and thighs blend with each other across x = 0 instead of meeting in a crease.
#include "body/mannequin_shape.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {

ArmAxis left_arm_axis(const MannequinForm& form) {
  const double r = std::sqrt(0.5);
  return {form.shoulder_m, Vec3(r, -r, 0), form.elbow_m, form.wrist_m, form.finger_tip_m};
}

struct MannequinShape::Parts {
  MannequinForm form;
  ArmAxis axis;
  Loft trunk, neck, face, leg, foot, arm;
  RoundCone thumb, thumb_tip;

  explicit Parts(const MannequinForm& f)
      : form(f),
        axis(left_arm_axis(f)),
        trunk(Vec3::Zero(), y_axis, x_axis, z_axis, 0.03, f.trunk),
        neck(Vec3::Zero(), y_axis, x_axis, z_axis, 0.01, f.neck),
        face(Vec3::Zero(), y_axis, x_axis, z_axis, 0.012, f.face),
        leg(Vec3::Zero(), y_axis, x_axis, z_axis, 0.02, f.leg),
        foot(Vec3::Zero(), z_axis, x_axis, y_axis, 0.018, f.foot),
        arm(axis.shoulder, axis.along, across(axis), z_axis, 0.0095, f.arm),
        thumb{on(axis, f.thumb[0]), on(axis, f.thumb[1]), f.thumb_radius[0], f.thumb_radius[1]},
        thumb_tip{on(axis, f.thumb[1]), on(axis, f.thumb[2]), f.thumb_radius[1], f.thumb_radius[2]} {}

  static Vec3 across(const ArmAxis& a) { return {-a.along.y(), a.along.x(), 0}; }
  static Vec3 on(const ArmAxis& a, const Vec3& tuv) {
    return a.shoulder + tuv.x() * a.along + tuv.y() * across(a) + tuv.z() * z_axis;
  }

  // A part and its image, blended over k.
  template <class Part>
  static double both(const Part& part, const Vec3& p, double k) {
    return smooth_min(part(p), part(image(p)), k);
  }
  // Whether that distance is more than d.
  template <class Part>
  static bool both_far(const Part& part, const Vec3& p, double k, double d) {
    return part.far(p, d + k / 6) && part.far(image(p), d + k / 6);
  }

  double head(const Vec3& p, double from_face) const {
    double head = smooth_min(form.skull(p), from_face, 0.05);
    head = smooth_min(head, form.nose(p), 0.032);
    if (both_far(form.eye_socket, p, 0.01, -head + 0.024)) return head;
    return smooth_max(head, -both(form.eye_socket, p, 0.01), 0.024);
  }
};

MannequinShape::MannequinShape(const MannequinForm& form) : parts_(std::make_unique<const Parts>(form)) {}
MannequinShape::~MannequinShape() = default;

double MannequinShape::operator()(const Vec3& point) const {
  const Parts& part = *parts_;
  const MannequinForm& form = part.form;
  const Vec3 p(std::abs(point.x()), point.y(), point.z());
  double d = part.trunk(p);
  // A part farther than d + k leaves d unchanged, to the last bit; most parts are that far from most points.
  const auto blend = [&](const auto& shape, double k_both, double k) {
    if (!Parts::both_far(shape, p, k_both, d + k)) d = smooth_min(d, Parts::both(shape, p, k_both), k);
  };
  blend(form.buttock, 0.02, 0.07);
  blend(form.breast, 0.07, 0.07);
  blend(form.shoulder, 0.04, 0.06);
  d = smooth_min(d, part.neck(p), 0.05);

  const double face = part.face(p), beyond_head = d + 0.03 + (0.05 + 0.032) / 6;
  if (!(face > beyond_head && form.skull.far(p, beyond_head) && form.nose.far(p, beyond_head)))
    d = smooth_min(d, part.head(p, face), 0.03);

  double leg = smooth_min(part.leg(p), part.foot(p), 0.05);
  leg = smooth_max(leg, -p.y(), 0.010);  // the sole
  const double other = smooth_min(part.leg(image(p)), part.foot(image(p)), 0.05);
  d = smooth_min(d, smooth_min(leg, other, 0.02), 0.06);

  double arm = part.arm(p);
  const double beyond_thumb = arm + 0.030 + 0.004 / 6;
  if (!(part.thumb.far(p, beyond_thumb) && part.thumb_tip.far(p, beyond_thumb)))
    arm = smooth_min(arm, smooth_min(part.thumb(p), part.thumb_tip(p), 0.004), 0.030);
  return smooth_min(d, arm, 0.05);
}

double MannequinShape::edge_m(const Vec3& p) const {
  const ArmAxis& arm = parts_->axis;
  const MannequinForm::Mesh& mesh = parts_->form.mesh;
  const double hand = (p - arm.shoulder).dot(arm.along) - (arm.wrist + 0.02);  // > 0 beyond the wrist
  const double foot = mesh.foot_below - p.y();
  const double head = p.y() - mesh.head_above;
  const auto ramp = [&](double beyond, double fine) {
    return mesh.body + (fine - mesh.body) * std::clamp((beyond + 0.06) / 0.06, 0.0, 1.0);
  };
  const double face = ramp(std::min(head, 0.0), mesh.head);
  const double nose = mesh.nose + 0.16 * std::sqrt((p - mesh.nose_at).squaredNorm());
  return std::min({mesh.body, p.x() > 0.4 ? ramp(hand, mesh.hand) : mesh.body, ramp(foot, mesh.foot), face, nose});
}

std::vector<Joint> mannequin_joints(const MannequinForm& form) {
  std::vector<Joint> joints;
  const auto add = [&](const std::string& name, Index parent, const Vec3& position, const Vec3& end, double radius,
                       double end_radius) {
    joints.push_back({name, parent, position, end, radius, end_radius});
    return static_cast<Index>(joints.size()) - 1;
  };
  const ArmAxis arm = left_arm_axis(form);
  const auto on_arm = [&](double t, double forwards) { return Vec3(arm.shoulder + t * arm.along + forwards * z_axis); };
  const Vec3 elbow_at = on_arm(arm.elbow, form.elbow_z_m), wrist_at = on_arm(arm.wrist, form.wrist_z_m);
  const Vec3 finger_tips = on_arm(arm.finger_tip, form.hand_z_m);
  const MannequinForm::Joints& at = form.joints;
  const MannequinForm::Flesh& r = form.flesh_m;
  const Index hips = add("hips", -1, at.hips, at.spine, r.hips, r.waist);
  const Index spine = add("spine", hips, at.spine, at.chest, r.waist, r.ribs);
  const Index chest = add("chest", spine, at.chest, at.neck, r.ribs, r.neck_root);
  const Index neck = add("neck", chest, at.neck, at.head, r.neck, r.neck);
  add("head", neck, at.head, at.crown, r.neck, r.head);
  for (const bool left : {true, false}) {
    const auto limb = [&](const char* name, Index parent, const Vec3& p, const Vec3& end, double radius,
                          double end_radius) {
      return add(std::string(name) + (left ? "_left" : "_right"), parent, left ? p : image(p), left ? end : image(end),
                 radius, end_radius);
    };
    const Index collar = limb("collar", chest, at.collar, arm.shoulder, r.collar, r.shoulder);
    const Index shoulder = limb("shoulder", collar, arm.shoulder, elbow_at, r.shoulder, r.elbow);
    const Index elbow = limb("elbow", shoulder, elbow_at, wrist_at, r.elbow, r.wrist);
    limb("wrist", elbow, wrist_at, finger_tips, r.wrist, r.finger_tips);
    const Index hip = limb("hip", hips, at.hip, at.knee, r.hip, r.knee);
    const Index knee = limb("knee", hip, at.knee, at.ankle, r.knee, r.ankle);
    const Index ankle = limb("ankle", knee, at.ankle, at.toes, r.ankle, r.ball);
    limb("toes", ankle, at.toes, at.toe_tips, r.ball, r.toe_tips);
  }
  return joints;
}

}  // namespace toile::internal
