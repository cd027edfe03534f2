#include "sim/check_garment.hpp"

#include "core/error.hpp"
#include "mesh/check.hpp"

namespace toile::internal {
namespace {

// A weld joins separate particles: it may collapse a triangle, or give an edge a third triangle.
void check_weld(const std::string& where, const GarmentMesh& garment) {
  const auto& triangles = garment.mesh.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Index a = garment.merged[at(triangles[t][0])], b = garment.merged[at(triangles[t][1])],
                c = garment.merged[at(triangles[t][2])];
    if (a != b && b != c && c != a) continue;
    throw InputError(where, "panel \"" + printable(garment.mesh.panel_names[at(garment.mesh.panel[t])]) + '"',
                     "seams that leave every triangle its three corners",
                     "triangle " + std::to_string(t) +
                         ", two corners of which are sewn together: take a finer resolution, or other stitches");
  }
  try {
    weld(garment);
  } catch (const InputError& error) {
    throw Error(error.kind(), where + ": once its seams are sewn: " + error.what());
  }
}

}  // namespace

void check_garment(const std::string& where, const GarmentMesh& garment) {
  check_cloth(where, garment.mesh, garment.x);
  if (!garment.pairs.empty()) check_weld(where, garment);
}

}  // namespace toile::internal
