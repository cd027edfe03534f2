// body/mannequin_figure.hpp: a mannequin's skeleton and skin as a figure, for motions that are made for skeletons.
//
// Its nodes are the joints, in their order, and not turned in the A-pose: a node's turn is the joint's (body/pose.hpp).
#pragma once
#include "body/pose.hpp"
#include "rig/figure.hpp"

namespace toile::internal {

Figure mannequin_figure(const Mannequin& mannequin);

Pose mannequin_pose(const Figure& figure, const FigurePose& pose);

}  // namespace toile::internal
