// io/makehuman.hpp: a body as MakeHuman and MPFB keep it: a base mesh, targets that shape it, a rig and skin weights.
//
//   target    lines "vertex dx dy dz" in the unit of the mesh: vertices move by a share of that
//   rig       JSON, bones by name: parent, and where the head is: the middle of a group of the mesh (CUBE), of vertices (MEAN), a vertex (VERTEX)
//   weights   JSON, bones by name: pairs of vertex and weight
//
// A vertex without weights, of a helper as a rule, goes with the first bone that hangs on none.
#pragma once
#include "io/surface_mesh.hpp"
#include "rig/figure.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// All throw InputError with file and place.
void apply_target(std::string_view text, std::string_view file, double share, SurfaceMesh& mesh);

// MakeHuman's origin is the middle of the body: moves all so that what the group `body` has lowest is at 0.  Without such a group nothing.
void put_on_floor(SurfaceMesh& mesh);

struct TextOfFile {
  std::string_view text, file;
};
// The mesh's vertices on the rig's bones, which are not turned at rest.  `notes` gets what was mended.
Figure makehuman_figure(const SurfaceMesh& mesh, const TextOfFile& rig, const TextOfFile& weights,
                        std::vector<std::string>& notes);

// "weights.cmu.json" beside "rig.cmu.json"; empty for a rig of another name.
std::string weights_beside(const std::string& rig);

}  // namespace toile::internal
