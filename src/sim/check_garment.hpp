// sim/check_garment.hpp: what is refused of a meshed cloth before anything moves, so that `check` finds it as well as a run does.
#pragma once
#include "core/error.hpp"
#include "garment/garment_mesh.hpp"

#include <string>

namespace toile::internal {

// Throws InputError whose place begins with `where` (a file, or a file's line and a pointer) for panels that check_cloth refuses, as they lie and as
// their seams will weld them.
void check_garment(const std::string& where, const GarmentMesh& garment);

// The error with `where` before its message, unless it names that place itself.
[[noreturn]] void throw_within(const std::string& where, const InputError& error);

}  // namespace toile::internal
