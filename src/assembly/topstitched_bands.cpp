#include "assembly/topstitched_bands.hpp"

#include "assembly/plate_moments.hpp"
#include "material/edge_finish.hpp"

#include <Eigen/LU>  // inverse
#include <algorithm>
#include <set>

namespace toile::internal {
namespace {

// The part of a convex polygon where n.p <= most.
std::vector<Vec2> cut_off(const std::vector<Vec2>& polygon, const Vec2& n, double most) {
  std::vector<Vec2> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double a_beyond = n.dot(a) - most, b_beyond = n.dot(b) - most;
    if (a_beyond <= 0) kept.push_back(a);
    if ((a_beyond < 0) != (b_beyond < 0) && a_beyond != b_beyond)
      kept.push_back(a + a_beyond / (a_beyond - b_beyond) * (b - a));
  }
  return kept;
}

double area_m2(const std::vector<Vec2>& polygon) {
  double twice = 0;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const Vec2 a = polygon[k] - polygon[0], b = polygon[k + 1] - polygon[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

}  // namespace

TopstitchedBands::TopstitchedBands(const ClothModel& model)
    : model_(&model), hinges_(hinges_of_sides(model.topology)) {}

void TopstitchedBands::add(const Fabric& fabric, std::size_t triangle, std::size_t side, double width_m) {
  const ClothMesh& mesh = model_->mesh;
  const Vec2 from = mesh.uv[triangle][side], to = mesh.uv[triangle][(side + 1) % 3];
  const Vec2 along = (to - from).normalized(), inward(-along.y(), along.x());
  const Mat3 compliance = topstitched_rigidity(fabric, inward).inverse();
  // From the side's triangle through its panel, as far as the rectangle reaches.
  std::vector<std::size_t> open{triangle};
  std::set<std::size_t> seen{triangle};
  while (!open.empty()) {
    const std::size_t t = open.back();
    open.pop_back();
    std::vector<Vec2> part(mesh.uv[t].begin(), mesh.uv[t].end());
    part = cut_off(part, -along, -along.dot(from));
    part = cut_off(part, along, along.dot(to));
    part = cut_off(part, -inward, -inward.dot(from));
    part = cut_off(part, inward, inward.dot(from) + width_m);
    const double share = area_m2(part) / material_frame(mesh.uv[t]).area_m2;
    if (!(share > 1e-9)) continue;
    Covered& covered = covered_[t];
    covered.share += share;
    covered.compliance += share * compliance;
    for (const Index hinge : hinges_[t]) {
      if (hinge < 0) continue;
      for (const Index next : model_->topology.hinges[at(hinge)].triangle)
        if (mesh.panel[at(next)] == mesh.panel[t] && seen.insert(at(next)).second) open.push_back(at(next));
    }
  }
}

void TopstitchedBands::apply(std::span<const Fabric> fabrics, ClothModel& model) const {
  for (const auto& [t, covered] : covered_) {
    const double share = std::min(1.0, covered.share);
    const Mat3 bare = bending_rigidity(fabric_of(model.mesh, fabrics, t)).inverse();
    const Mat3 compliance = (1 - share) * bare + (share / covered.share) * covered.compliance;
    model.plate_compliance[t] = plate_compliance(model.mesh.uv[t], compliance.inverse());
  }
}

}  // namespace toile::internal
