// body/mannequin_shape.cpp: the numbers of the mannequin: sections of trunk, head and limbs, and how softly they blend.
//
// Every part is written for the left side (x > 0).  Parts beside the middle come with their image, so that breasts,
// buttocks and thighs blend with each other across x = 0 instead of meeting in a crease.
#include "body/mannequin_shape.hpp"

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

const Vec3 x_axis(1, 0, 0), y_axis(0, 1, 0), z_axis(0, 0, 1);

Vec3 image(const Vec3& p) { return {-p.x(), p.y(), p.z()}; }

// Trunk from the crotch to the root of the neck; t is the height.
//  t      cu  cv      half   front  back   square
const LoftSection trunk_sections[] = {
    {0.800, 0, -0.012, 0.142, 0.070, 0.080, 0.30},  //
    {0.850, 0, -0.014, 0.163, 0.081, 0.090, 0.38},  //
    {0.900, 0, -0.014, 0.168, 0.089, 0.096, 0.42},  // hips
    {0.950, 0, -0.012, 0.160, 0.094, 0.096, 0.42},  //
    {1.000, 0, -0.008, 0.144, 0.094, 0.087, 0.40},  //
    {1.065, 0, -0.004, 0.128, 0.089, 0.081, 0.35},  // waist
    {1.120, 0, -0.006, 0.127, 0.090, 0.085, 0.35},  //
    {1.180, 0, -0.010, 0.135, 0.097, 0.095, 0.40},  // below the bust
    {1.250, 0, -0.018, 0.145, 0.101, 0.096, 0.45},  //
    {1.310, 0, -0.024, 0.150, 0.094, 0.088, 0.45},  // armpits
    {1.360, 0, -0.026, 0.142, 0.078, 0.078, 0.40},  //
    {1.400, 0, -0.028, 0.112, 0.062, 0.068, 0.30},  //
    {1.440, 0, -0.032, 0.072, 0.055, 0.058, 0.20},
};

const LoftSection neck_sections[] = {
    {1.380, 0, -0.034, 0.066, 0.062, 0.060, 0},  //
    {1.440, 0, -0.032, 0.056, 0.056, 0.056, 0},  //
    {1.480, 0, -0.024, 0.051, 0.051, 0.053, 0},  //
    {1.520, 0, -0.016, 0.050, 0.050, 0.054, 0},  //
    {1.580, 0, -0.010, 0.050, 0.050, 0.056, 0},
};

// Face and jaw, from under the chin to the forehead.
const LoftSection face_sections[] = {
    {1.494, 0, 0.048, 0.022, 0.022, 0.040, 0.1},    //
    {1.508, 0, 0.042, 0.033, 0.037, 0.060, 0.15},   // chin
    {1.530, 0, 0.022, 0.047, 0.060, 0.075, 0.25},   //
    {1.560, 0, 0.006, 0.059, 0.078, 0.080, 0.35},   // mouth, ear lobes
    {1.600, 0, 0.000, 0.067, 0.084, 0.085, 0.4},    // cheek bones
    {1.640, 0, -0.004, 0.067, 0.082, 0.080, 0.35},  //
    {1.680, 0, -0.006, 0.045, 0.058, 0.060, 0.2},
};

// Left leg: hip to ankle.
const LoftSection leg_sections[] = {
    {0.070, 0.129, -0.030, 0.029, 0.034, 0.035, 0},  //
    {0.100, 0.128, -0.029, 0.030, 0.031, 0.034, 0},  // ankle
    {0.150, 0.126, -0.027, 0.032, 0.032, 0.035, 0},  //
    {0.220, 0.124, -0.022, 0.042, 0.038, 0.045, 0},  //
    {0.290, 0.122, -0.016, 0.052, 0.042, 0.059, 0},  //
    {0.345, 0.120, -0.012, 0.055, 0.045, 0.063, 0},  // calf
    {0.410, 0.117, -0.005, 0.050, 0.048, 0.053, 0},  //
    {0.470, 0.114, 0.002, 0.050, 0.055, 0.049, 0},   // knee
    {0.520, 0.111, 0.004, 0.055, 0.060, 0.056, 0},   //
    {0.600, 0.106, 0.004, 0.067, 0.071, 0.069, 0},   //
    {0.700, 0.101, 0.000, 0.079, 0.081, 0.081, 0},   //
    {0.780, 0.098, -0.006, 0.085, 0.085, 0.090, 0},  // top of the thigh
    {0.840, 0.092, -0.012, 0.081, 0.076, 0.086, 0},  //
    {0.890, 0.080, -0.016, 0.062, 0.056, 0.066, 0},  // fades out inside the trunk
    {0.930, 0.072, -0.018, 0.040, 0.036, 0.040, 0},
};

// Left foot: t runs along z from heel to toes, u outwards, v up; the sole is cut at y = 0 later.
const LoftSection foot_sections[] = {
    {-0.085, 0.128, 0.032, 0.021, 0.024, 0.050, 0.3},  // heel
    {-0.060, 0.128, 0.034, 0.028, 0.038, 0.052, 0.3},  //
    {-0.020, 0.130, 0.034, 0.031, 0.054, 0.052, 0.3},  //
    {0.020, 0.133, 0.034, 0.033, 0.050, 0.052, 0.3},   //
    {0.060, 0.138, 0.030, 0.038, 0.035, 0.048, 0.35},  //
    {0.100, 0.142, 0.026, 0.044, 0.022, 0.044, 0.4},   // ball
    {0.130, 0.143, 0.022, 0.044, 0.014, 0.040, 0.4},   //
    {0.160, 0.140, 0.018, 0.034, 0.010, 0.036, 0.4},
};

// Left arm: t along the arm from the shoulder joint, u across it and up, v forwards.
const LoftSection arm_sections[] = {
    {-0.045, 0.000, 0.000, 0.022, 0.024, 0.024, 0},       // fades out inside the shoulder
    {-0.020, 0.000, 0.000, 0.039, 0.042, 0.042, 0},       //
    {0.020, 0.002, 0.000, 0.047, 0.050, 0.050, 0},        //
    {0.065, 0.003, 0.000, 0.048, 0.051, 0.051, 0},        // deltoid
    {0.110, 0.001, 0.000, 0.044, 0.048, 0.047, 0},        //
    {0.170, 0.000, 0.000, 0.041, 0.043, 0.043, 0},        //
    {0.230, 0.000, 0.000, 0.037, 0.039, 0.040, 0},        //
    {0.290, 0.000, -0.003, 0.035, 0.036, 0.036, 0},       // elbow
    {0.340, 0.000, 0.001, 0.037, 0.037, 0.037, 0},        //
    {0.390, -0.001, 0.006, 0.035, 0.035, 0.035, 0},       //
    {0.450, -0.002, 0.012, 0.029, 0.030, 0.029, 0},       //
    {0.510, -0.003, 0.018, 0.024, 0.027, 0.026, 0.2},     //
    {0.540, -0.004, 0.021, 0.0215, 0.0275, 0.0265, 0.3},  // wrist
    {0.575, -0.004, 0.025, 0.018, 0.034, 0.033, 0.4},     //
    {0.620, -0.006, 0.028, 0.0165, 0.040, 0.039, 0.5},    // knuckles
    {0.665, -0.010, 0.029, 0.0145, 0.038, 0.036, 0.5},    //
    {0.705, -0.016, 0.029, 0.0125, 0.032, 0.031, 0.5},    //
    {0.728, -0.020, 0.029, 0.0105, 0.024, 0.024, 0.4},    // finger tips
};

constexpr double arm_elbow = 0.29, arm_wrist = 0.54, arm_finger_tip = 0.728;

}  // namespace

ArmAxis left_arm_axis() {
  const double r = std::sqrt(0.5);
  return {Vec3(0.170, 1.367, -0.024), Vec3(r, -r, 0), arm_elbow, arm_wrist, arm_finger_tip};
}

struct MannequinShape::Parts {
  Loft trunk{Vec3::Zero(), y_axis, x_axis, z_axis, 0.03, trunk_sections};
  Loft neck{Vec3::Zero(), y_axis, x_axis, z_axis, 0.01, neck_sections};
  Loft face{Vec3::Zero(), y_axis, x_axis, z_axis, 0.012, face_sections};
  Ellipsoid skull{Vec3(0, 1.622, -0.014), Vec3(0.0745, 0.0985, 0.097)};
  RoundCone nose{Vec3(0, 1.612, 0.080), Vec3(0, 1.577, 0.0920), 0.0090, 0.0100};
  Ellipsoid eye_socket{Vec3(0.031, 1.612, 0.094), Vec3(0.020, 0.013, 0.016)};
  RoundCone shoulder{Vec3(0.025, 1.426, -0.034), Vec3(0.158, 1.376, -0.026), 0.045, 0.043};
  Ellipsoid breast{Vec3(0.073, 1.240, 0.050), Vec3(0.063, 0.067, 0.064)};
  Ellipsoid buttock{Vec3(0.076, 0.865, -0.062), Vec3(0.084, 0.090, 0.078)};
  Loft leg{Vec3::Zero(), y_axis, x_axis, z_axis, 0.02, leg_sections};
  Loft foot{Vec3::Zero(), z_axis, x_axis, y_axis, 0.018, foot_sections};
  Loft arm;
  RoundCone thumb, thumb_tip;

  Parts() : Parts(left_arm_axis()) {}
  explicit Parts(const ArmAxis& a)
      : arm(a.shoulder, a.along, across(a), z_axis, 0.0095, arm_sections),
        thumb{on(a, 0.566, -0.006, 0.040), on(a, 0.614, -0.014, 0.080), 0.0160, 0.0120},
        thumb_tip{on(a, 0.614, -0.014, 0.080), on(a, 0.645, -0.018, 0.096), 0.0120, 0.0100} {}

  static Vec3 across(const ArmAxis& a) { return {-a.along.y(), a.along.x(), 0}; }
  static Vec3 on(const ArmAxis& a, double t, double u, double v) {
    return a.shoulder + t * a.along + u * across(a) + v * z_axis;
  }

  // A part and its image, blended over k.
  template <class Part>
  static double both(const Part& part, const Vec3& p, double k) {
    return smooth_min(part(p), part(image(p)), k);
  }
};

MannequinShape::MannequinShape() : parts_(std::make_unique<const Parts>()) {}
MannequinShape::~MannequinShape() = default;

double MannequinShape::operator()(const Vec3& point) const {
  const Parts& part = *parts_;
  const Vec3 p(std::abs(point.x()), point.y(), point.z());
  double d = part.trunk(p);
  d = smooth_min(d, Parts::both(part.buttock, p, 0.02), 0.07);
  d = smooth_min(d, Parts::both(part.breast, p, 0.07), 0.07);
  d = smooth_min(d, Parts::both(part.shoulder, p, 0.04), 0.06);
  d = smooth_min(d, part.neck(p), 0.05);

  double head = smooth_min(part.skull(p), part.face(p), 0.05);
  head = smooth_min(head, part.nose(p), 0.032);
  head = smooth_max(head, -Parts::both(part.eye_socket, p, 0.01), 0.024);
  d = smooth_min(d, head, 0.03);

  double leg = smooth_min(part.leg(p), part.foot(p), 0.05);
  leg = smooth_max(leg, -p.y(), 0.010);  // the sole
  const double other = smooth_min(part.leg(image(p)), part.foot(image(p)), 0.05);
  d = smooth_min(d, smooth_min(leg, other, 0.02), 0.06);

  double arm = part.arm(p);
  arm = smooth_min(arm, smooth_min(part.thumb(p), part.thumb_tip(p), 0.004), 0.030);
  return smooth_min(d, arm, 0.05);
}

double MannequinShape::edge_m(const Vec3& p) const {
  const ArmAxis arm = left_arm_axis();
  const double coarse = 0.0150;
  const double hand = (p - arm.shoulder).dot(arm.along) - (arm.wrist + 0.02);  // > 0 beyond the wrist
  const double foot = 0.06 - p.y();
  const double head = p.y() - 1.52;
  const auto ramp = [&](double beyond, double fine) {
    return coarse + (fine - coarse) * std::clamp((beyond + 0.06) / 0.06, 0.0, 1.0);
  };
  const double face = ramp(std::min(head, 0.0), 0.0125);
  const double nose = 0.0070 + 0.16 * std::sqrt((p - Vec3(0, 1.585, 0.10)).squaredNorm());
  return std::min({coarse, p.x() > 0.4 ? ramp(hand, 0.0080) : coarse, ramp(foot, 0.0110), face, nose});
}

std::vector<Joint> mannequin_joints() {
  std::vector<Joint> joints;
  const auto add = [&](const char* name, Index parent, const Vec3& position) {
    joints.push_back({name, parent, position});
    return static_cast<Index>(joints.size()) - 1;
  };
  const ArmAxis arm = left_arm_axis();
  const Index hips = add("hips", -1, Vec3(0, 0.930, -0.015));
  const Index spine = add("spine", hips, Vec3(0, 1.065, -0.020));
  const Index chest = add("chest", spine, Vec3(0, 1.220, -0.030));
  const Index neck = add("neck", chest, Vec3(0, 1.440, -0.034));
  add("head", neck, Vec3(0, 1.535, -0.014));
  for (const bool left : {true, false}) {
    const auto side = [&](const Vec3& p) { return left ? p : image(p); };
    const auto named = [&](const char* name) { return std::string(name) + (left ? "_left" : "_right"); };
    const auto limb = [&](const char* name, Index parent, const Vec3& p) {
      return add(named(name).c_str(), parent, side(p));
    };
    const Index collar = limb("collar", chest, Vec3(0.025, 1.405, -0.020));
    const Index shoulder = limb("shoulder", collar, arm.shoulder);
    const Index elbow = limb("elbow", shoulder, arm.shoulder + arm.elbow * arm.along - 0.003 * z_axis);
    limb("wrist", elbow, arm.shoulder + arm.wrist * arm.along + 0.021 * z_axis);
    const Index hip = limb("hip", hips, Vec3(0.090, 0.880, -0.012));
    const Index knee = limb("knee", hip, Vec3(0.115, 0.470, 0.000));
    const Index ankle = limb("ankle", knee, Vec3(0.129, 0.085, -0.028));
    limb("toes", ankle, Vec3(0.140, 0.022, 0.100));
  }
  return joints;
}

Vec3 bone_end(const std::vector<Joint>& joints, std::size_t joint) {
  for (const Joint& child : joints)
    if (child.parent == static_cast<Index>(joint)) return child.position_m;
  const Joint& j = joints[joint];
  if (j.name == "head") return {0, 1.70, -0.014};
  if (j.name.starts_with("toes")) return j.position_m + Vec3(0, 0, 0.070);
  // A hand: on along the forearm's arm axis to the finger tips.
  const ArmAxis arm = left_arm_axis();
  const Vec3 tip = arm.shoulder + arm.finger_tip * arm.along + 0.029 * z_axis;
  return j.position_m.x() > 0 ? tip : image(tip);
}

}  // namespace toile
