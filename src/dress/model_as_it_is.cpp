#include "dress/model_as_it_is.hpp"

#include "core/elementary.hpp"

#include <Eigen/Geometry>

namespace toile::internal {
namespace {

// The uv of every triangle is its present shape: rest lengths are those of x.  The threads of neighbours do not line up, which is why the
// fabric is the same both ways.
ClothMesh cut_as_it_is(std::span<const Triangle> triangles, std::span<const Vec3> x) {
  ClothMesh mesh;
  mesh.particle_count = static_cast<Index>(x.size());
  mesh.triangles.assign(triangles.begin(), triangles.end());
  mesh.panel.assign(triangles.size(), 0);
  mesh.panel_names = {"cloth"};
  for (const Triangle& t : triangles) {
    const Vec3 a = x[at(t[1])] - x[at(t[0])], b = x[at(t[2])] - x[at(t[0])];
    const double length = a.norm();
    mesh.uv.push_back({Vec2(0, 0), Vec2(length, 0), Vec2(a.dot(b) / length, a.cross(b).norm() / length)});
  }
  return mesh;
}

double angle_of(const Hinge& hinge, std::span<const Vec3> x) {
  const Vec3 &x0 = x[at(hinge.particle[0])], &x1 = x[at(hinge.particle[1])];
  const Vec3 e = x1 - x0, a = e.cross(x[at(hinge.particle[2])] - x0), b = (x[at(hinge.particle[3])] - x0).cross(e);
  const double length = e.norm();
  return length > 0 ? ieee_atan2(a.cross(b).dot(e) / length, a.dot(b)) : 0;
}

}  // namespace

ClothModel model_as_it_is(std::span<const Triangle> triangles, std::span<const Vec3> x, const Fabric& fabric) {
  ModelOptions weightless;
  weightless.gravity_m_per_s2.setZero();
  ClothModel model = build_model(cut_as_it_is(triangles, x), {&fabric, 1}, weightless);
  for (std::size_t h = 0; h < model.bend.size(); ++h) model.bend[h].theta_0 = angle_of(model.topology.hinges[h], x);
  return model;
}

}  // namespace toile::internal
