#include "sim/dressing_body.hpp"

#include "core/elementary.hpp"

#include <algorithm>
#include <utility>

namespace toile {
namespace {

constexpr double waits_s = 0.3, grows_s = 1, lowers_s = 0.7;  // the arms are down before the body is full
// The shoulder turns with the arm, of the height: fully from beyond the armpit, less and less towards the neck.
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

void DressingBody::lift_arms(double share) {
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3& d = arms_[k].direction;
    const double outwards = k == 0 ? 1 : -1;
    lift_rad_[k] = -share * outwards * ieee_atan2(d.y(), outwards * d.x());
  }
}

std::array<DressingBody::ArmAxis, 2> DressingBody::arm_axes() const {
  std::array<ArmAxis, 2> axes;
  for (std::size_t k = 0; k < 2; ++k) axes[k] = {arms_[k].root, turned(arms_[k].direction, Vec3::Zero(), lift_rad_[k])};
  return axes;
}

void DressingBody::lift(double share, std::span<Vec3> x) const {
  if (share == 0) return;
  for (std::size_t k = 0; k < 2; ++k) {
    const Arm& arm = arms_[k];
    for (std::size_t i = 0; i < person_vertices_; ++i) {
      const double turns = smooth((arm.past[i] / height_m_ - turns_from) / (turns_fully - turns_from));
      if (turns > 0) x[i] = turned(x[i], arm.root, turns * share * lift_rad_[k]);
    }
  }
}

void DressingBody::lifted(std::span<Vec3> x) const {
  std::copy(standing_.begin(), standing_.end(), x.begin());
  lift(1, x);
}

void DressingBody::at(double t_s, std::span<Vec3> x) const {
  std::copy(standing_.begin(), standing_.end(), x.begin());
  thin_.at(std::clamp((t_s - waits_s) / grows_s, 0.0, 1.0), x.first(person_vertices_));
  lift(1 - smooth((t_s - waits_s) / lowers_s), x);
}

}  // namespace toile
