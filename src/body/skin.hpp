// body/skin.hpp: skin weights: which joints move a vertex of the mannequin, and how much.
//
// d_j is the distance from the flesh of bone j, the round cone of its joint's radii: so a breast belongs to the ribs,
// whose bone is deep inside, and not to the arm, whose bone is nearer to its own skin.  A vertex starts with
// max(0, 1 - (d_j - d_min) / fade)^3, d_min being the smallest distance: one bone along a limb, a hand-over around a
// joint.  Averaging with the neighbours on the mesh then softens armpits and crotch, where the nearest bone changes
// fast.  The four largest weights stay, normalised.
#pragma once
#include "body/mannequin.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// The mesh is that of mirror(): first the vertices with x = 0, then the left ones, then their images in the same
// order; joints that end in _left have a partner that ends in _right.  An image gets its original's weights with
// left and right exchanged, exactly.
std::vector<SkinWeights> skin_weights(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                      const std::vector<Joint>& joints);

}  // namespace toile::internal
