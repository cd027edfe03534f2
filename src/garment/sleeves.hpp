// garment/sleeves.hpp: places sleeves around the arms before they are sewn.                          docs/theory/sewing.md#placement
//
// A sleeve is drawn beside its armhole, often ten centimetres above the arm, or at another angle than this body's.  Sewn there it would
// close beside the arm.  So every sleeve, with its cuff, is turned and moved in the frontal plane until the line from the middle of
// its armhole to the middle of its hem lies on the arm; along the arm it keeps its place.
#pragma once
#include "garment/garment_mesh.hpp"

#include <array>
#include <span>

namespace toile::internal {

inline constexpr double near_an_arm =
    0.2;  // of the body's height: how far from an arm's root a sleeve without a label may hang

struct ArmLine {
  Vec3 root{0, 0, 0};       // middle of the arm at the armpit
  Vec3 direction{0, 0, 0};  // unit, towards the hand
};

// `arms`: left (at larger x) and right.  Sleeves are the panels labelled "arm"; in a pattern without labels, those that hang beyond the root
// of an arm, near its height.
void hang_sleeves(GarmentMesh& garment, const std::array<ArmLine, 2>& arms, double body_height_m);

// Whether cloth lies over the shoulder, above the root of the left arm and of the right one: then the arm has to go through the garment.
// Skirts, trousers and strapless tops end below it.
std::array<bool, 2> covers_shoulders(const GarmentMesh& garment, const std::array<ArmLine, 2>& arms);

}  // namespace toile::internal
