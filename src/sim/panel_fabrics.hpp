// sim/panel_fabrics.hpp: which fabric each panel of a run's cloth is of.
#pragma once
#include "io/surface_mesh.hpp"

#include <string>

namespace toile::internal {

// Makes a group of each panel of each garment, with its fabric by report.json, where that lists them: panels of the same name in two garments are one
// group in cloth.obj.
void settle_groups(SurfaceMesh& mesh, const std::string& directory);

}  // namespace toile::internal
