// sim/start_run.hpp: starts from the end of another run: another motion, another fabric, a finer mesh, without sewing again.
#pragma once
#include "sim/setup.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace toile::internal {

// The cloth of this scene, welded, as the run in `directory` draped it (its last frame, or the last before its body moved), at rest.  The run
// may be coarser or finer: positions are transferred by panel name and pattern coordinates, linearly within its triangles (exact, but for
// float32, on the same mesh).  Throws IoError (missing, unreadable), or InputError when a panel is not in the run, when its drawing differs,
// or when the run's body stood elsewhere than at `body_x`.
Outfit start_from(const std::string& directory, std::span<const LoadedCloth> cloth, std::span<const Vec3> body_x);

// The hash of the inputs of a start from `directory`: drawing and draped positions.  Throws as above.
std::uint64_t hash_of_start(const std::string& directory);

}  // namespace toile::internal
