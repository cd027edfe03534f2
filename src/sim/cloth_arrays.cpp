#include "sim/cloth_arrays.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "dress/rigid_path.hpp"
#include "mesh/check.hpp"
#include "sim/cloths.hpp"
#include "sim/collider.hpp"

#include <Eigen/Geometry>

#include <numeric>
#include <string>
#include <utility>

namespace toile::internal {
namespace {

// Sine of the angle between plane and horizontal, below which the plane counts as level.
constexpr double level = 1e-3;

std::array<Vec2, 3> laid_flat(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, normal = ab.cross(ac).normalized();
  const Vec3 up(0, 1, 0);
  Vec3 warp = up - up.dot(normal) * normal;
  if (warp.norm() < level) warp = ab;
  warp.normalize();
  const Vec3 weft = normal.cross(warp);
  return {Vec2(0, 0), Vec2(ab.dot(warp), ab.dot(weft)), Vec2(ac.dot(warp), ac.dot(weft))};
}

void require(bool good, const std::string& place, const std::string& expected, const std::string& got) {
  if (!good) throw InputError("", place, expected, got);
}

}  // namespace

GarmentMesh cloth_of_surface(const ClothSurface& surface, const SceneCloth& whole) {
  const std::size_t faces = surface.triangles.size();
  const std::string for_each = std::to_string(faces) + ", one for each face";
  require(surface.uv.empty() || surface.uv.size() == faces, "uv_m", for_each, std::to_string(surface.uv.size()));
  require(surface.panel.empty() || surface.panel.size() == faces, "panel", for_each,
          std::to_string(surface.panel.size()));
  check_triangles("faces", surface.x, surface.triangles);
  check_areas("faces", surface.x, surface.triangles);

  GarmentMesh garment;
  garment.name = whole.name;
  ClothMesh& mesh = garment.mesh;
  mesh.particle_count = static_cast<Index>(surface.x.size());
  mesh.triangles = surface.triangles;
  mesh.panel = surface.panel;
  if (mesh.panel.empty()) mesh.panel.assign(faces, 0);
  mesh.panel_names = surface.panel_names;
  if (mesh.panel_names.empty()) mesh.panel_names = {whole.name};
  for (std::size_t t = 0; t < faces; ++t)
    require(mesh.panel[t] >= 0 && at(mesh.panel[t]) < mesh.panel_names.size(), "panel of face " + std::to_string(t),
            "a number below " + std::to_string(mesh.panel_names.size()), std::to_string(mesh.panel[t]));
  mesh.uv = surface.uv;
  if (mesh.uv.empty()) {
    mesh.uv.reserve(faces);
    for (const Triangle& t : mesh.triangles)
      mesh.uv.push_back(laid_flat(surface.x[at(t[0])], surface.x[at(t[1])], surface.x[at(t[2])]));
  }
  const Mat3 turn = rotation_from_degrees(whole.rotation_deg);
  garment.x.reserve(surface.x.size());
  for (const Vec3& x : surface.x) garment.x.push_back(turn * x + whole.translation_m);
  garment.merged.resize(surface.x.size());
  std::iota(garment.merged.begin(), garment.merged.end(), 0);
  garment.on_panel_edge.assign(surface.x.size(), false);
  return garment;
}

std::uint64_t hash_of(const ClothSurface& surface) {
  Hash hash;
  hash.add_counted(std::span<const Vec3>(surface.x));
  hash.add_counted(std::span<const Triangle>(surface.triangles));
  hash.add_counted(std::span<const std::array<Vec2, 3>>(surface.uv));
  hash.add_counted(std::span<const Index>(surface.panel));
  const std::uint64_t names = surface.panel_names.size();
  hash.add_bytes(&names, sizeof names);
  for (const std::string& name : surface.panel_names) hash.add_text(name);
  return hash.value();
}

MeshedCloth load(const SceneClothArrays& arrays, const SceneCloth& whole, const TextSource&) {
  MeshedCloth meshed;
  meshed.input_hash = hash_of(*arrays.surface);
  meshed.garment = cloth_of_surface(*arrays.surface, whole);
  meshed.edge_m = mesh_quality(meshed.garment.mesh).mean_edge_m;
  return meshed;
}

ClothCost cost(const SceneClothArrays& arrays, const SceneCloth& whole, const TextSource&) {
  ClothCost cost;
  cost.parts.push_back({cloth_in_words(whole.name), static_cast<double>(arrays.surface->x.size()),
                        static_cast<double>(arrays.surface->triangles.size())});
  return cost;
}

}  // namespace toile::internal
