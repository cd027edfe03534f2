#include "garment/layering.hpp"

#include "contact/triangle_tree.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace toile::internal {
namespace {

constexpr double parallel = 0.98;  // cosine between normals of panels that can cover each other: 11 degrees
// Panels drawn edge along edge share a sliver where the edge is curved, e^2 / 8R: they do not cover each other.  A tenth of the thinner
// triangle, for hems of 2 mm.
constexpr double beside_m = 1e-3, beside_share = 0.1;

struct Sheet {
  std::vector<Triangle> triangles;
  std::vector<Index> particles;
  Vec3 outward{0, 0, 0};            // its normal
  double drawn_m = 0, along_m = 0;  // of its plane, outwards: as drawn, and now
  double lowest_m = std::numeric_limits<double>::infinity();
};

std::vector<Sheet> sheets_of(const GarmentMesh& garment, const Vec3& middle) {
  std::vector<Sheet> panels(garment.mesh.panel_names.size());
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t)
    panels[at(garment.mesh.panel[t])].triangles.push_back(garment.mesh.triangles[t]);
  const std::vector<Index> panel_of = garment.panel_of_particle();
  for (std::size_t i = 0; i < garment.x.size(); ++i) {
    if (panel_of[i] < 0) continue;
    Sheet& panel = panels[at(panel_of[i])];
    panel.particles.push_back(static_cast<Index>(i));
    panel.lowest_m = std::min(panel.lowest_m, garment.x[i].y());
  }
  for (Sheet& panel : panels) {
    for (const Triangle& t : panel.triangles)
      panel.outward += (garment.x[at(t[1])] - garment.x[at(t[0])]).cross(garment.x[at(t[2])] - garment.x[at(t[0])]);
    if (panel.particles.empty() || panel.outward.norm() == 0) continue;
    panel.outward.normalize();
    const Vec3& on = garment.x[at(panel.particles.front())];
    if (panel.outward.dot(on - middle) < 0) panel.outward = -panel.outward;
    panel.drawn_m = panel.along_m = panel.outward.dot(on);
  }
  return panels;
}

using Corners = std::array<Vec3, 3>;

// Whether two triangles of one plane lie on each other, not only beside: by how far one must be moved to be beside.     [separating axes]
bool overlap(const Corners& a, const Corners& b, const Vec3& normal) {
  double depth_m = std::numeric_limits<double>::infinity(), thinner_m = depth_m;
  for (const Corners* of : {&a, &b}) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 across = normal.cross((*of)[(k + 1) % 3] - (*of)[k]).normalized();
      const auto [a_low, a_high] = std::minmax({across.dot(a[0]), across.dot(a[1]), across.dot(a[2])});
      const auto [b_low, b_high] = std::minmax({across.dot(b[0]), across.dot(b[1]), across.dot(b[2])});
      depth_m = std::min(depth_m, std::min(a_high, b_high) - std::max(a_low, b_low));
      thinner_m = std::min(thinner_m, of == &a ? a_high - a_low : b_high - b_low);
    }
  }
  return depth_m > std::min(beside_m, beside_share * thinner_m);
}

// Whether `one`, seen along the normal, covers some of `other`: by corners, or only where their edges cross, as the flared legs of trousers do.
bool cover(const GarmentMesh& garment, const Sheet& one, const Sheet& other) {
  const TriangleTree tree(garment.x, other.triangles);
  const Vec3& n = other.outward;
  std::vector<Index> near;
  for (const Triangle& t : one.triangles) {
    Corners shown;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = garment.x[at(t[k])];
      shown[k] = p + (other.along_m - n.dot(p)) * n;
    }
    tree.overlapping({shown[0].cwiseMin(shown[1]).cwiseMin(shown[2]), shown[0].cwiseMax(shown[1]).cwiseMax(shown[2])},
                     near);
    for (const Index i : near) {
      const Triangle& u = other.triangles[at(i)];
      if (overlap(shown, {garment.x[at(u[0])], garment.x[at(u[1])], garment.x[at(u[2])]}, n)) return true;
    }
  }
  return false;
}

}  // namespace

void separate_layers(GarmentMesh& garment, const Vec3& middle) {
  std::vector<Sheet> sheets = sheets_of(garment, middle);
  std::vector<std::size_t> order(sheets.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sheets[a].lowest_m > sheets[b].lowest_m; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    Sheet& panel = sheets[order[k]];
    double out_m = 0;
    for (std::size_t j = 0; j < k; ++j) {
      const Sheet& under = sheets[order[j]];
      const double short_m = layer_gap_m - (panel.along_m - under.along_m);
      const bool drawn_inside = panel.drawn_m - under.drawn_m <= -layer_gap_m;
      if (panel.outward.dot(under.outward) < parallel || drawn_inside || short_m <= out_m) continue;
      if (cover(garment, panel, under)) out_m = short_m;
    }
    if (out_m == 0) continue;
    panel.along_m += out_m;
    for (const Index i : panel.particles) garment.x[at(i)] += out_m * panel.outward;
  }
}

}  // namespace toile::internal
