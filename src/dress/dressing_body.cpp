#include "dress/dressing_body.hpp"

#include "core/elementary.hpp"

#include <algorithm>
#include <utility>

namespace toile::internal {
namespace {

// Times since the weld: it waits; arms come out; they are lowered, and are down before the body is full.
constexpr double waits_s = 0.3, out_s = 0.4, lowers_s = 0.4, grows_at_s = 0.6, grows_s = 1;
constexpr double drawn_in_m = 0.08;  // what stays of a drawn-in arm: past its root
// The shoulder turns with the arm: fully from the armpit outwards, less towards the neck.  Shares of the height.
constexpr double turns_from = -0.05, turns_fully = 0.02;

double smooth(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// In the frontal plane.
Vec3 turned(const Vec3& p, const Vec3& about, double angle_rad) {
  const double c = ieee_cos(angle_rad), s = ieee_sin(angle_rad), x = p.x() - about.x(), y = p.y() - about.y();
  return {about.x() + c * x - s * y, about.y() + s * x + c * y, p.z()};
}

double height_of(std::span<const Vec3> x) {
  if (x.empty()) return 0;
  const auto [low, high] =
      std::minmax_element(x.begin(), x.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  return high->y() - low->y();
}

}  // namespace

DressingBody::DressingBody(std::span<const Vec3> standing, std::span<const Triangle> triangles,
                           std::size_t person_vertices, std::size_t person_triangles, std::array<Arm, 2> arms)
    : thin_(standing.first(person_vertices), triangles.first(person_triangles)),
      arms_(std::move(arms)),
      person_vertices_(person_vertices),
      height_m_(height_of(standing.first(person_vertices))),
      standing_(standing.begin(), standing.end()) {}

DressingBody::Pose DressingBody::pose_within(double lift, const std::array<bool, 2>& covered) const {
  Pose pose;
  for (std::size_t k = 0; k < 2; ++k) {
    pose.lift[k] = covered[k] ? lift : 1;
    pose.reach[k] = covered[k] ? 1 : std::min(1.0, drawn_in_m / arms_[k].length_m);
  }
  return pose;
}

// In the frontal plane, about the arm's root.
double DressingBody::lift_rad(std::size_t arm, double share) const {
  const Vec3& d = arms_[arm].direction;
  const double outwards = arm == 0 ? 1 : -1;
  return -share * outwards * ieee_atan2(d.y(), outwards * d.x());
}

std::array<DressingBody::ArmAxis, 2> DressingBody::arm_axes() const {
  std::array<ArmAxis, 2> axes;
  for (std::size_t k = 0; k < 2; ++k)
    axes[k] = {arms_[k].root, turned(arms_[k].direction, Vec3::Zero(), lift_rad(k, pose_.lift[k]))};
  return axes;
}

void DressingBody::pose_arm(std::size_t k, double lift, double reach, std::span<Vec3> x) const {
  if (lift == 0 && reach == 1) return;
  const Arm& arm = arms_[k];
  const double angle_rad = lift_rad(k, lift);
  for (std::size_t i = 0; i < person_vertices_; ++i) {
    const double share = smooth((arm.past[i] / height_m_ - turns_from) / (turns_fully - turns_from));
    if (share == 0) continue;
    const double along_m = std::max(0.0, (x[i] - arm.root).dot(arm.direction));
    x[i] = turned(x[i] - share * (1 - reach) * along_m * arm.direction, arm.root, share * angle_rad);
  }
}

void DressingBody::lifted(std::span<Vec3> x) const {
  std::copy(standing_.begin(), standing_.end(), x.begin());
  for (std::size_t k = 0; k < 2; ++k) pose_arm(k, pose_.lift[k], pose_.reach[k], x);
}

void DressingBody::at(double t_s, std::span<Vec3> x) const {
  t_s -= pose_.falls_s;
  std::copy(standing_.begin(), standing_.end(), x.begin());
  thin_.at(std::clamp((t_s - grows_at_s) / grows_s, 0.0, 1.0), x.first(person_vertices_));
  const double out = smooth((t_s - waits_s) / out_s), down = smooth((t_s - waits_s - out_s) / lowers_s);
  for (std::size_t k = 0; k < 2; ++k) {
    const double reach = pose_.reach[k] + out * (1 - pose_.reach[k]);
    pose_arm(k, (1 - down) * pose_.lift[k], reach, x);
  }
}

}  // namespace toile::internal
