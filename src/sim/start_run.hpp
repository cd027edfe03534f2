// sim/start_run.hpp: begins where another run ended: another motion, another fabric, a finer mesh, without sewing again.
#pragma once
#include "sim/setup.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace toile::internal {

// The cloth of this scene, welded, as the run in `directory` had draped it (its last frame, or the last before its body moved), at rest.  The run may be coarser or finer: positions
// are carried over by panel name and pattern coordinates, linearly within its triangles (exact, but for float32, on the same mesh).
// Throws IoError (missing, unreadable), or InputError when a panel is not in the run, when its drawing is another, or when the run's body stood
// elsewhere than `body_x` begins.
Outfit start_from(const std::string& directory, std::span<const LoadedCloth> cloth, std::span<const Vec3> body_x);

// Of what a start from `directory` is made of: drawing, and the positions in which it is draped.  Throws as above.
std::uint64_t hash_of_start(const std::string& directory);

}  // namespace toile::internal
