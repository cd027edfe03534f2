// body/posture.cpp: from channels to joint rotations; legs that stand and legs that swing.
#include "body/posture.hpp"

#include "body/implicit_shape.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace toile::internal {

namespace {

constexpr double touch_m = 0.011;  // width of the smooth minimum over the soles
constexpr double heel_m = 0.050;   // how far the sole's rear edge stands behind the ankle

Quaternion about(const Vec3& axis, double degrees) { return rotation_about(axis, degrees * degree); }

std::size_t find(std::span<const Joint> joints, std::string_view name, Side side) {
  const std::string full = std::string(name) + (side == Side::left ? "_left" : "_right");
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints[j].name == full || joints[j].name == name) return j;
  throw InputError("", "skeleton", "a joint " + full, "none");
}

// The knee's flexion, rad, at which hip and ankle stand `distance` apart; `thigh` and `shank` are the bones in the
// A-pose.  v . Rx(k) w = A cos k + B sin k + C.
double knee_flexion(const Vec3& thigh, const Vec3& shank, double distance) {
  const double a = thigh.y() * shank.y() + thigh.z() * shank.z();
  const double b = thigh.z() * shank.y() - thigh.y() * shank.z();
  const double c = thigh.x() * shank.x();
  const double wanted = 0.5 * (distance * distance - thigh.dot(thigh) - shank.dot(shank)) - c;
  const double u = std::clamp(wanted / std::sqrt(a * a + b * b), -1.0, 1.0);  // 1: out of reach, the leg is straight
  return ieee_atan2(b, a) + ieee_atan2(std::sqrt(1.0 - u * u), u);
}

double smooth_lowest(std::span<const double> heights) {
  double low = heights[0];
  for (const double h : heights.subspan(1)) low = smooth_min(low, h, touch_m);
  return low;
}

class Poser {
 public:
  Poser(const Posture& posture, std::span<const Joint> joints)
      : p_(posture), joints_(joints), pose_(a_pose(joints.size())) {}

  Pose make(Legs legs) {
    const Quaternion whole = about(y_axis, p_(Channel::turn));
    const Vec3& hips = joints_[0].position_m;
    const Vec3 shift(p_(Channel::pelvis_x), p_(Channel::pelvis_y), p_(Channel::pelvis_z));
    pose_.root_m = whole * (hips + shift) - hips;
    pose_.turns[0] = whole * about(y_axis, p_(Channel::pelvis_turn)) * about(x_axis, p_(Channel::pelvis_tilt)) *
                     about(z_axis, p_(Channel::pelvis_list));
    trunk("spine", Channel::spine_turn, Channel::spine_left, Channel::spine_forward, 1.0);
    trunk("chest", Channel::chest_turn, Channel::chest_left, Channel::chest_forward, 1.0);
    trunk("neck", Channel::neck_turn, Channel::neck_left, Channel::neck_forward, 0.5);
    trunk("head", Channel::neck_turn, Channel::neck_left, Channel::neck_forward, 0.5);
    for (const Side side : {Side::left, Side::right}) {
      arm(side);
      leg(side, legs, whole);
    }
    if (legs == Legs::free)
      pose_.root_m.y() += smooth_lowest(soles(a_pose(joints_.size()))) - smooth_lowest(soles(pose_));
    return std::move(pose_);
  }

 private:
  void trunk(std::string_view name, Channel turn, Channel left, Channel forward, double share) {
    pose_.turns[find(joints_, name, Side::left)] =
        about(y_axis, share * p_(turn)) * about(x_axis, share * p_(forward)) * about(z_axis, -share * p_(left));
  }

  // Rotations are written for the left side.
  void set(std::string_view name, Side side, const Quaternion& q) {
    pose_.turns[find(joints_, name, side)] = side == Side::left ? q : q.mirrored();
  }

  void arm(Side side) {
    const Vec3 along = (joints_[find(joints_, "elbow", Side::left)].position_m -
                        joints_[find(joints_, "shoulder", Side::left)].position_m)
                           .normalized();
    const Vec3 hinge = along.cross(z_axis).normalized();
    set("collar", side, about(z_axis, p_(Channel::collar, side)));
    set("shoulder", side,
        about(y_axis, -p_(Channel::arm_across, side)) * about(x_axis, -p_(Channel::arm_forward, side)) *
            about(z_axis, p_(Channel::arm_out, side)) * about(along, p_(Channel::arm_turn, side)));
    set("elbow", side, about(hinge, p_(Channel::elbow, side)));
    set("wrist", side, about(z_axis, -p_(Channel::wrist, side)));
  }

  void leg(Side side, Legs legs, const Quaternion& whole) {
    const auto at = [&](std::string_view name) { return joints_[find(joints_, name, Side::left)].position_m; };
    const Vec3 hip = at("hip"), thigh = at("knee") - hip, shank = at("ankle") - at("knee");
    Quaternion stand, flat;  // of the hip, and of the foot against the shank
    double flexion = 0;
    if (legs == Legs::planted) {
      const bool left = side == Side::left;
      // The right leg is solved as the image of a left one.
      Vec3 shift = whole.inverse() * (pose_.root_m + joints_[0].position_m) - joints_[0].position_m;
      Quaternion pelvis = whole.inverse() * pose_.turns[0];
      if (!left) {
        shift = image(shift);
        pelvis = pelvis.mirrored();
      }
      const Vec3& root = joints_[0].position_m;
      const Vec3 hip_now = pelvis * (hip - root) + root + shift;
      const Vec3 ankle = at("ankle") + Vec3(p_(Channel::foot_x, side), 0, p_(Channel::foot_z, side));
      const Vec3 reach = pelvis.inverse() * (ankle - hip_now);
      const double turn = p_(Channel::foot_turn, side) - (left ? 1.0 : -1.0) * p_(Channel::pelvis_turn);
      const Quaternion out = about(y_axis, turn);
      flexion = knee_flexion(thigh, shank, std::sqrt(reach.dot(reach)));
      const Quaternion bent = rotation_about(x_axis, flexion);
      stand = rotation_between(out * (thigh + bent * shank), reach) * out;
      flat = (pelvis * stand * bent).inverse() * about(y_axis, p_(Channel::foot_turn, side));
    }
    set("hip", side,
        about(x_axis, -p_(Channel::leg_forward, side)) * about(z_axis, p_(Channel::leg_out, side)) *
            about(y_axis, p_(Channel::leg_turn, side)) * stand);
    set("knee", side, rotation_about(x_axis, flexion + degree * p_(Channel::knee, side)));
    set("ankle", side, flat * about(x_axis, -p_(Channel::ankle, side)));
    set("toes", side, about(x_axis, -p_(Channel::toes, side)));
  }

  // Heights of heel, ball and toe tips of both feet.
  std::array<double, 6> soles(const Pose& pose) const {
    const std::vector<RigidTransform> transforms = joint_transforms(joints_, pose);
    std::array<double, 6> heights{};
    for (const Side side : {Side::left, Side::right}) {
      const std::size_t ankle = find(joints_, "ankle", side), toes = find(joints_, "toes", side);
      const auto on_floor = [](Vec3 p) {
        p.y() = 0;
        return p;
      };
      const Vec3 heel = on_floor(joints_[ankle].position_m) - heel_m * z_axis;
      const std::size_t first = 3 * static_cast<std::size_t>(side);
      heights[first] = transforms[ankle](heel).y();
      heights[first + 1] = transforms[ankle](on_floor(joints_[toes].position_m)).y();
      heights[first + 2] = transforms[toes](on_floor(joints_[toes].end_m)).y();
    }
    return heights;
  }

  const Posture& p_;
  std::span<const Joint> joints_;
  Pose pose_;
};

}  // namespace

Pose make_pose(const Posture& posture, Legs legs, std::span<const Joint> joints) {
  return Poser(posture, joints).make(legs);
}

}  // namespace toile::internal
