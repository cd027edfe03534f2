// garment/sleeves.hpp: sleeves are hung around the arms before they are sewn.                        docs/theory/sewing.md#placement
//
// A sleeve is drawn beside its armhole, where its maker found room: ten centimetres above the arm, or at another angle than this body's.
// Sewn there it closes beside the arm.  So every sleeve, with its cuff, is turned and moved in the frontal plane until the line from the
// middle of its armhole to the middle of its hem lies on the arm; along the arm it stays where it was drawn.
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

// Left arm (at larger x) and right one.  Sleeves are the panels labelled "arm"; of a pattern without labels, those that hang beyond the root of
// an arm, not far from its height.  Returns how far along each arm, from its root, they end (m; 0: there are none).
std::array<double, 2> hang_sleeves(GarmentMesh& garment, const std::array<ArmLine, 2>& arms, double body_height_m);

// Whether cloth lies above the root of the left arm and of the right one, over the shoulder: the arm has to go through the garment.  Skirts, trousers
// and strapless tops end below it.
std::array<bool, 2> covers_shoulders(const GarmentMesh& garment, const std::array<ArmLine, 2>& arms);

}  // namespace toile::internal
