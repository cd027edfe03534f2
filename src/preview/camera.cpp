// preview/camera.cpp: cameras that frame a subject, and projection into their pictures.
#include "preview/camera_rays.hpp"

#include "core/error.hpp"

#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

constexpr double frame_share = 0.92;        // of the picture's half width and height that the box may fill
constexpr double smallest_distance = 0.05;  // m from the box to the eye, also for a degenerate box

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

// The picture's axes for a viewing direction of unit length.
void view_axes(const Vec3& forward, Vec3& right, Vec3& up) {
  const Vec3 world_up = std::abs(forward.y()) < 0.99999 ? Vec3(0, 1, 0) : Vec3(0, 0, forward.y() < 0 ? -1 : 1);
  right = forward.cross(world_up).normalized();
  up = right.cross(forward);
}

}  // namespace

CameraAxes camera_axes(const Camera& camera, int width, int height) {
  if (!camera.eye.allFinite() || !camera.target.allFinite()) {
    throw InputError("", "camera", "finite eye and target", "a number that is not finite");
  }
  if (!(camera.vertical_fov_deg > 0 && camera.vertical_fov_deg < 180)) {
    throw InputError("", "camera", "a field of view in (0, 180) degrees", std::to_string(camera.vertical_fov_deg));
  }
  const Vec3 view = camera.target - camera.eye;
  const double distance = view.norm();
  if (!(distance > 0)) throw InputError("", "camera", "an eye apart from its target", "the same point twice");

  CameraAxes axes;
  axes.eye = camera.eye;
  axes.forward = view / distance;
  view_axes(axes.forward, axes.right, axes.up);
  axes.tan_y = std::tan(radians(camera.vertical_fov_deg) / 2);
  axes.tan_x = axes.tan_y * width / height;
  return axes;
}

CameraRays::CameraRays(const CameraAxes& axes, int width, int height, const Vec3& origin)
    : eye((axes.eye - origin).cast<float>()),
      right((axes.right * axes.tan_x).cast<float>()),
      up((axes.up * axes.tan_y).cast<float>()),
      forward(axes.forward.cast<float>()),
      step_x(2.0f / static_cast<float>(width)),
      step_y(2.0f / static_cast<float>(height)) {}

Camera frame_subject(const Vec3& low, const Vec3& high, double azimuth_deg, double elevation_deg, double aspect) {
  if (!low.allFinite() || !high.allFinite() || !(low.array() <= high.array()).all()) {
    throw InputError("", "frame_subject", "a finite box with low <= high", "a box that is empty or not finite");
  }
  if (!std::isfinite(azimuth_deg) || !(std::abs(elevation_deg) <= 90)) {
    throw InputError("", "frame_subject", "a finite azimuth and an elevation in [-90, 90] degrees", "other angles");
  }
  if (!(aspect > 0) || !std::isfinite(aspect)) {
    throw InputError("", "frame_subject", "an aspect above 0", std::to_string(aspect));
  }
  Camera camera;
  const double azimuth = radians(azimuth_deg), elevation = radians(elevation_deg);
  const Vec3 to_eye(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                    std::cos(azimuth) * std::cos(elevation));
  Vec3 right, up;
  view_axes(-to_eye, right, up);
  const double tan_y = std::tan(radians(camera.vertical_fov_deg) / 2) * frame_share;
  const double tan_x = tan_y * aspect;

  // A corner at (x, y) across and z towards the eye lies inside when |x| <= tan_x (d - z) and |y| <= tan_y (d - z):
  // the distance d is the largest that a corner needs.
  camera.target = 0.5 * (low + high);
  double distance = smallest_distance;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p =
        Vec3((corner & 1) ? high.x() : low.x(), (corner & 2) ? high.y() : low.y(), (corner & 4) ? high.z() : low.z()) -
        camera.target;
    const double across = std::max(std::abs(p.dot(right)) / tan_x, std::abs(p.dot(up)) / tan_y);
    distance = std::max(distance, p.dot(to_eye) + std::max(across, smallest_distance));
  }
  camera.eye = camera.target + distance * to_eye;
  return camera;
}

std::vector<Camera> turntable(const Vec3& low, const Vec3& high, double elevation_deg, double aspect, int count) {
  if (count < 0) throw InputError("", "turntable", "0 cameras or more", std::to_string(count));
  std::vector<Camera> cameras;
  double farthest = 0;
  for (int k = 0; k < count; ++k) {
    cameras.push_back(frame_subject(low, high, 360.0 * k / count, elevation_deg, aspect));
    farthest = std::max(farthest, (cameras.back().eye - cameras.back().target).norm());
  }
  for (Camera& camera : cameras) camera.eye = camera.target + farthest * (camera.eye - camera.target).normalized();
  return cameras;
}

Vec3 project(const Camera& camera, int width, int height, const Vec3& point) {
  const CameraAxes axes = camera_axes(camera, width, height);
  const Vec3 p = point - axes.eye;
  const double depth = p.dot(axes.forward);
  if (!(depth > 0)) return {0, 0, depth};
  return {0.5 * width * (1 + p.dot(axes.right) / (depth * axes.tan_x)),
          0.5 * height * (1 - p.dot(axes.up) / (depth * axes.tan_y)), depth};
}

}  // namespace toile::internal
