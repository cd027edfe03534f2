#include "step/body_attachment.hpp"

#include "contact/distance.hpp"

#include <Eigen/Geometry>

#include <array>
#include <limits>

namespace toile::internal {
namespace {

std::array<Vec3, 3> corners(const BodySurface& body, Index triangle) {
  const auto& [a, b, c] = body.triangle(triangle);
  const auto x = body.next_positions();
  return {x[at(a)], x[at(b)], x[at(c)]};
}

Mat3 frame(const std::array<Vec3, 3>& corner) {
  const Vec3 along = (corner[1] - corner[0]).normalized();
  const Vec3 normal = along.cross(corner[2] - corner[0]).normalized();
  Mat3 axes;
  axes << along, normal.cross(along), normal;
  return axes;
}

Vec3 point(const std::array<Vec3, 3>& corner, const Vec3& barycentric) {
  return barycentric[0] * corner[0] + barycentric[1] * corner[1] + barycentric[2] * corner[2];
}

}  // namespace

BodyAttachment attach(const BodySurface& body, const Vec3& x) {
  BodyAttachment attachment;
  double least2 = std::numeric_limits<double>::infinity();
  for (Index t = 0; t < static_cast<Index>(body.triangles().size()); ++t) {
    const auto corner = corners(body, t);
    const VertexTriangle near = closest_vertex_triangle(x, corner[0], corner[1], corner[2]);
    const double distance2 = (x - point(corner, near.barycentric)).squaredNorm();
    if (distance2 >= least2) continue;
    least2 = distance2;
    attachment.triangle = t;
    attachment.barycentric = near.barycentric;
  }
  const auto corner = corners(body, attachment.triangle);
  attachment.local_m = frame(corner).transpose() * (x - point(corner, attachment.barycentric));
  return attachment;
}

Vec3 carried(const BodyAttachment& attachment, const BodySurface& body) {
  const auto corner = corners(body, attachment.triangle);
  return point(corner, attachment.barycentric) + frame(corner) * attachment.local_m;
}

}  // namespace toile::internal
