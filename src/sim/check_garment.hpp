// sim/check_garment.hpp: refuses invalid meshed cloth before anything moves, in `check` as well as in a run.
#pragma once
#include "garment/garment_mesh.hpp"

#include <string>

namespace toile::internal {

// Throws InputError whose place begins with `where` (a file, or the cloth's name) for panels that check_cloth refuses, as they lie and as
// their seams will weld them.
void check_garment(const std::string& where, const GarmentMesh& garment);

}  // namespace toile::internal
