// garment/refine.hpp: cuts a garment finer without moving its cloth: long edges are halved.
//
//     3 long edges   four triangles       2   three, by the shorter diagonal       1   two
//
// The sides of a triangle are halved in the drawing, in the gathered rest shape and in space alike, so shape, rest shape and strain of the
// cloth stay what they are, and cloth that passed through nothing does not afterwards.  Sides that the weld makes one edge are halved
// together.  A curved outline keeps the corners that it had.
#pragma once
#include "garment/garment_mesh.hpp"

#include <array>
#include <span>
#include <vector>

namespace toile::internal {

struct RefinedGarment {
  GarmentMesh garment;  // its first particles are the old ones
  // [particle - old particles] the two particles in whose middle it lies, both before it in order
  std::vector<std::array<Index, 2>> ends;
};

// Until no edge of the drawing is longer than sqrt(2) edge_m, so that edges are nearer to edge_m than their halves would be.
RefinedGarment refine(const GarmentMesh& garment, double edge_m);

// Values of the old particles, and of the new ones the mean of their ends.
template <class T>
void interpolate(std::span<const std::array<Index, 2>> ends, std::vector<T>& values) {
  for (const auto& [a, b] : ends) {
    const T middle = 0.5 * (values[at(a)] + values[at(b)]);
    values.push_back(middle);
  }
}

}  // namespace toile::internal
