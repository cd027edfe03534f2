#include "sim/cloth_mesh.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "io/json.hpp"
#include "io/mesh_file.hpp"
#include "mesh/join_sides.hpp"
#include "sim/cloths.hpp"
#include "sim/collider_person.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>

namespace toile::internal {
namespace {

// A drawing in metres has the surface's area, but for ease and gathers; a texture's is off with the size of the garment.
constexpr double metric_ratio = 1.5;
// Relative to a triangle's longer sides; below this it has no area in the drawing.
constexpr double flat_share = 1e-9;

using Corners = std::array<Vec2, 3>;

double twice_area(const Corners& uv) {
  const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
  return a.x() * b.y() - a.y() * b.x();
}

bool has_area(const Corners& uv) {
  const double longest = std::max((uv[1] - uv[0]).squaredNorm(), (uv[2] - uv[0]).squaredNorm());
  return std::abs(twice_area(uv)) > flat_share * longest;
}

// [triangle] (u, v) of the drawing; empty when a face has no vt.
std::vector<Corners> drawing_of(const SurfaceMesh& mesh) {
  std::vector<Corners> uv;
  if (mesh.texcoord.empty()) return uv;
  uv.reserve(mesh.triangles.size());
  for (const std::array<Index, 3>& corners : mesh.texcoord) {
    Corners& drawn = uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] < 0) return {};
      const Vec2& vt = mesh.texcoords[at(corners[k])];
      drawn[k] = Vec2(vt.y(), -vt.x());
    }
  }
  return uv;
}

// Mirrored islands are turned over.  An island: faces connected by two shared vt.
void face_up(const SurfaceMesh& mesh, std::vector<Corners>& uv) {
  std::vector<std::size_t> island(uv.size());
  std::iota(island.begin(), island.end(), std::size_t{0});
  const auto root = [&](std::size_t t) {
    while (island[t] != t) t = island[t] = island[island[t]];
    return t;
  };
  std::map<std::array<Index, 2>, std::size_t> beside;  // side in the drawing -> a face with that side
  for (std::size_t t = 0; t < uv.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<Index, 2> side{mesh.texcoord[t][k], mesh.texcoord[t][(k + 1) % 3]};
      std::sort(side.begin(), side.end());
      const auto [place, is_new] = beside.try_emplace(side, t);
      if (!is_new) island[std::max(root(t), root(place->second))] = std::min(root(t), root(place->second));
    }
  std::vector<double> area(uv.size(), 0);
  for (std::size_t t = 0; t < uv.size(); ++t) area[root(t)] += twice_area(uv[t]);
  for (std::size_t t = 0; t < uv.size(); ++t)
    if (area[root(t)] < 0)
      for (Vec2& p : uv[t]) p.y() = -p.y();
}

// The shape at the start, laid into the plane with its warp as in the drawing.
Corners as_it_starts(const std::array<Vec3, 3>& x, const Corners& uv) {
  const Vec3 ab = x[1] - x[0], ac = x[2] - x[0];
  const Vec2 p = uv[1] - uv[0], q = uv[2] - uv[0];
  const Vec3 normal = ab.cross(ac).normalized();
  // dx/du of the linear map from the drawing, up to its length.
  const double d = p.x() * q.y() - p.y() * q.x();
  Vec3 warp = (q.y() * ab - p.y() * ac) * (d < 0 ? -1 : 1);
  warp.normalize();
  const Vec3 weft = normal.cross(warp);
  return {Vec2(0, 0), Vec2(ab.dot(warp), ab.dot(weft)), Vec2(ac.dot(warp), ac.dot(weft))};
}

// Vertices that the file had to split are one particle; unused ones are left out, the others keep their order.
struct Particles {
  std::vector<Index> of;  // [vertex of the file]; -1: no face uses it
  Vec3s x;
  std::size_t joined = 0, unused = 0, sides_left = 0;
};

Particles particles_of(const SurfaceMesh& mesh, double unit_m) {
  std::vector<char> used(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const Index i : t) used[at(i)] = 1;
  const JoinedSides joined = join_sides(mesh.positions, mesh.triangles, mesh.object);
  Particles particles;
  particles.joined = joined.joined;
  particles.sides_left = joined.left;
  particles.of.assign(mesh.positions.size(), -1);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (used[i] == 0) {
      ++particles.unused;
    } else if (at(joined.same_as[i]) < i) {
      particles.of[i] = particles.of[at(joined.same_as[i])];
    } else {
      particles.of[i] = static_cast<Index>(particles.x.size());
      particles.x.push_back(unit_m * mesh.positions[i]);
    }
  }
  return particles;
}

}  // namespace

ClothSurface surface_of_mesh(const SurfaceMesh& mesh, std::string_view file, double unit_m, RestShape rest,
                             std::vector<std::string>& warnings) {
  const std::string name(file);
  if (mesh.triangles.empty()) throw InputError(file, "mesh", "faces", "none");
  Particles particles = particles_of(mesh, unit_m);
  ClothSurface surface;
  surface.x = std::move(particles.x);
  for (const Triangle& t : mesh.triangles)
    surface.triangles.push_back({particles.of[at(t[0])], particles.of[at(t[1])], particles.of[at(t[2])]});
  warnings.insert(warnings.end(), mesh.notes.begin(), mesh.notes.end());
  if (particles.joined > 0)
    warnings.push_back(name + ": " + std::to_string(particles.joined) +
                       " vertices lie where another one does, along a seam, and are one with it");
  if (particles.sides_left > 0)
    warnings.push_back(name + ": " + std::to_string(particles.sides_left) +
                       " edges lie exactly on others and are not joined: it cannot be told which belong together");
  if (particles.unused > 0)
    warnings.push_back(name + ": " + std::to_string(particles.unused) + " vertices that no face uses are left out");

  const bool groups = mesh.group_names.size() > 1 || (mesh.group_names.size() == 1 && !mesh.group_names[0].empty());
  if (groups || mesh.object_names.size() > 1) {
    surface.panel = groups ? mesh.group : mesh.object;
    surface.panel_names = groups ? mesh.group_names : mesh.object_names;
    for (std::string& panel : surface.panel_names)
      if (panel.empty()) panel = "(no group)";
  }

  std::vector<Corners> uv = drawing_of(mesh);
  const auto flat_face = std::find_if_not(uv.begin(), uv.end(), has_area);
  if (rest == RestShape::drawing && (uv.empty() || flat_face != uv.end()))
    throw InputError(file, uv.empty() ? "faces" : "face " + std::to_string(flat_face - uv.begin()),
                     "a vt for every corner, and an area in the drawing", uv.empty() ? "faces without vt" : "none");
  if (uv.empty() || flat_face != uv.end()) {
    if (rest == RestShape::automatic)
      warnings.push_back(name + (uv.empty() ? ": not every face has vt" : ": a face has no area in the drawing") +
                         "; the cloth is at rest as it starts, its warp upright");
    return surface;
  }
  face_up(mesh, uv);
  double drawn = 0, area = 0;
  for (std::size_t t = 0; t < uv.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    drawn += 0.5 * std::abs(twice_area(uv[t]));
    area += 0.5 * (surface.x[at(b)] - surface.x[at(a)]).cross(surface.x[at(c)] - surface.x[at(a)]).norm();
  }
  const bool metric = drawn < metric_ratio * area && area < metric_ratio * drawn;
  if (rest == RestShape::drawing || (rest == RestShape::automatic && metric)) {
    surface.uv = std::move(uv);
    return surface;
  }
  if (rest == RestShape::automatic)
    warnings.push_back(name +
                       fmt::sprintf(": the drawing has %.3g m2 and the surface %.3g m2, so it is not in metres; the "
                                    "cloth is at rest as it starts, its warp as drawn",
                                    drawn, area));
  for (std::size_t t = 0; t < uv.size(); ++t) {
    const Triangle& c = surface.triangles[t];
    surface.uv.push_back(as_it_starts({surface.x[at(c[0])], surface.x[at(c[1])], surface.x[at(c[2])]}, uv[t]));
  }
  return surface;
}

void refuse_beside(const Json& value, const SceneClothMesh&, const SceneCloth&) {
  for (const std::string_view key : {"mesh_unit", "rest_shape"})
    if (const Json* given = value.find(key)) given->fail("a mesh beside it", given->describe());
}

std::string usual_name(const SceneClothMesh& mesh) { return std::filesystem::path(mesh.path).stem().string(); }

MeshedCloth load(const SceneClothMesh& given, const SceneCloth& whole, const TextSource& read) {
  MeshedCloth meshed;
  const std::string text = read(given.path);
  Hash bytes;
  bytes.add_text(text);
  const SurfaceMesh mesh = parse_mesh(text, given.path, [&](std::string_view beside) { bytes.add_text(beside); });
  meshed.input_hash = bytes.value();
  meshed.garment = cloth_of_surface(
      surface_of_mesh(mesh, printable(given.path), metres_in(given.unit), given.rest_shape, meshed.warnings), whole);
  meshed.edge_m = mesh_quality(meshed.garment.mesh).mean_edge_m;
  return meshed;
}

ClothCost cost(const SceneClothMesh& given, const SceneCloth& whole, const TextSource&) {
  const double triangles = cost_of_file(given.path).triangles;
  ClothCost cost;
  cost.parts.push_back({cloth_in_words(whole.name), triangles / 2, triangles});
  return cost;
}

}  // namespace toile::internal
