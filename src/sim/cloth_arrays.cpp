#include "sim/cloth_arrays.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "dress/rigid_path.hpp"
#include "mesh/check.hpp"
#include "sim/setup.hpp"

#include <numeric>
#include <string>
#include <utility>

namespace toile::internal {
namespace {

// Below this share of a right angle's the vertical says nothing about a plane.
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

GarmentMesh cloth_of_arrays(const SceneCloth& cloth) {
  const SceneClothArrays& arrays = *cloth.arrays;
  const std::size_t faces = arrays.triangles.size();
  const std::string for_each = std::to_string(faces) + ", one for each face";
  require(arrays.uv.empty() || arrays.uv.size() == faces, "uv_m", for_each, std::to_string(arrays.uv.size()));
  require(arrays.panel.empty() || arrays.panel.size() == faces, "panel", for_each, std::to_string(arrays.panel.size()));
  check_triangles("faces", arrays.x, arrays.triangles);
  check_areas("faces", arrays.x, arrays.triangles);

  GarmentMesh garment;
  garment.name = cloth.name;
  ClothMesh& mesh = garment.mesh;
  mesh.particle_count = static_cast<Index>(arrays.x.size());
  mesh.triangles = arrays.triangles;
  mesh.panel = arrays.panel;
  if (mesh.panel.empty()) mesh.panel.assign(faces, 0);
  mesh.panel_names = arrays.panel_names;
  if (mesh.panel_names.empty()) mesh.panel_names = {cloth.name};
  for (std::size_t t = 0; t < faces; ++t)
    require(mesh.panel[t] >= 0 && at(mesh.panel[t]) < mesh.panel_names.size(), "panel of face " + std::to_string(t),
            "a number below " + std::to_string(mesh.panel_names.size()), std::to_string(mesh.panel[t]));
  mesh.uv = arrays.uv;
  if (mesh.uv.empty()) {
    mesh.uv.reserve(faces);
    for (const Triangle& t : mesh.triangles)
      mesh.uv.push_back(laid_flat(arrays.x[at(t[0])], arrays.x[at(t[1])], arrays.x[at(t[2])]));
  }
  const Mat3 turn = rotation_from_degrees(cloth.rotation_deg);
  garment.x.reserve(arrays.x.size());
  for (const Vec3& x : arrays.x) garment.x.push_back(turn * x + cloth.translation_m);
  garment.merged.resize(arrays.x.size());
  std::iota(garment.merged.begin(), garment.merged.end(), 0);
  garment.on_panel_edge.assign(arrays.x.size(), false);
  return garment;
}

std::uint64_t hash_of(const SceneClothArrays& arrays) {
  Hash hash;
  hash.add_counted(std::span<const Vec3>(arrays.x));
  hash.add_counted(std::span<const Triangle>(arrays.triangles));
  hash.add_counted(std::span<const std::array<Vec2, 3>>(arrays.uv));
  hash.add_counted(std::span<const Index>(arrays.panel));
  const std::uint64_t names = arrays.panel_names.size();
  hash.add_bytes(&names, sizeof names);
  for (const std::string& name : arrays.panel_names) hash.add_text(name);
  return hash.value();
}

}  // namespace toile::internal
