#include "sim/cloth_drawing.hpp"

#include "core/error.hpp"
#include "garment/triangulate.hpp"
#include "sim/cloths.hpp"
#include "sim/collider.hpp"

#include <fmt/printf.h>

#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

struct Drawing {
  PlanarMesh sheet;
  std::vector<Index> particle;  // [point of the sheet]
  Index particles = 0;
};

Drawing draw(const ClothRectangle& rectangle) {
  Drawing drawing{equilateral_sheet(rectangle.width_m, rectangle.height_m, rectangle.edge_m), {}, 0};
  const std::vector<Vec2>& points = drawing.sheet.points;
  drawing.particle.assign(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!rectangle.joined || points[i].x() != rectangle.width_m) drawing.particle[i] = drawing.particles++;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (drawing.particle[i] >= 0) continue;
    // Both sides have the same points: the nearest in height on the other side is the match.
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double distance = std::abs(points[j].y() - points[i].y());
      if (points[j].x() != 0 || distance >= nearest) continue;
      nearest = distance;
      drawing.particle[i] = drawing.particle[j];
    }
  }
  return drawing;
}

}  // namespace

void check_length(std::string_view key, std::string_view what, double length_m) {
  if (length_m <= longest_drawn_m) return;
  throw InputError("", key, fmt::sprintf("at most %g m %s", longest_drawn_m, std::string(what)),
                   fmt::sprintf("%.4g m", length_m));
}

Vec2 warp_upright(const Vec2& p) { return {p.y(), -p.x()}; }

MeshedCloth drawn(const ClothRectangle& rectangle, const SceneCloth& whole,
                  const std::function<Vec2(const Vec2&)>& grain, const std::function<Vec3(const Vec2&)>& where) {
  const Drawing drawing = draw(rectangle);
  const std::vector<Vec2>& points = drawing.sheet.points;
  MeshedCloth meshed;
  meshed.edge_m = rectangle.edge_m;
  GarmentMesh& garment = meshed.garment;
  garment.name = whole.name;
  garment.mesh.particle_count = drawing.particles;
  garment.mesh.panel.assign(drawing.sheet.triangles.size(), 0);
  garment.mesh.panel_names = {whole.name};
  for (const auto& [a, b, c] : drawing.sheet.triangles) {
    garment.mesh.triangles.push_back({drawing.particle[at(a)], drawing.particle[at(b)], drawing.particle[at(c)]});
    garment.mesh.uv.push_back({grain(points[at(a)]), grain(points[at(b)]), grain(points[at(c)])});
  }
  const Mat3 turn = rotation_from_degrees(whole.rotation_deg);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (drawing.particle[i] != static_cast<Index>(garment.x.size())) continue;  // of the joined side: a duplicate
    garment.x.push_back(turn * where(points[i]) + whole.translation_m);
    garment.merged.push_back(static_cast<Index>(garment.merged.size()));
  }
  check_areas("", garment.x, garment.mesh.triangles);
  return meshed;
}

ClothCost cost_of_drawing(std::string_view key, const ClothSize& size, double edge_m, const SceneCloth& whole) {
  ClothCost cost;
  cost.parts.push_back(part_of_area(cloth_in_words(whole.name) + " (" + std::string(key) + ')', size.area_m2,
                                    size.outline_m / edge_m, edge_m));
  return cost;
}

}  // namespace toile::internal
