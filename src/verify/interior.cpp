#include "verify/interior.hpp"

#include "mesh/surface_parts.hpp"

#include <vector>

namespace toile::internal {
namespace {

std::optional<ClosedSurface> surface_of(const std::vector<Triangle>& triangles, std::span<const Vec3> x) {
  if (triangles.empty()) return std::nullopt;
  return ClosedSurface(triangles, x);
}

}  // namespace

Interior::Interior(std::span<const Triangle> body, std::span<const Vec3> x) {
  const SurfaceParts found = surface_parts(body, x);
  std::vector<Triangle> solids, inwards;
  const auto faces_inwards = [](const SurfacePart& part) { return part.closed && part.volume_m3 < 0; };
  std::vector<Index> vertex(found.parts.size(), -1);  // a vertex of each part
  for (std::size_t t = 0; t < body.size(); ++t) {
    const auto part = at(found.of[t]);
    vertex[part] = body[t][0];
    if (!faces_inwards(found.parts[part])) solids.push_back(body[t]);
  }
  solids_ = surface_of(solids, x);
  std::vector<char> room(found.parts.size(), 0);
  for (std::size_t part = 0; part < room.size(); ++part)
    room[part] = faces_inwards(found.parts[part]) && !(solids_ && solids_->winding_number(x[at(vertex[part])]) > 0);
  for (std::size_t t = 0; t < body.size(); ++t) {
    const auto part = at(found.of[t]);
    if (room[part] != 0)
      inwards.push_back(body[t]);
    else if (faces_inwards(found.parts[part]))
      solids.push_back(body[t]);
  }
  solids_ = surface_of(solids, x);
  rooms_ = surface_of(inwards, x);
}

int Interior::depth(const Vec3& p) const {
  return (solids_ ? solids_->winding_number(p) : 0) + (rooms_ && rooms_->winding_number(p) == 0 ? 1 : 0);
}

}  // namespace toile::internal
