#include "body/mannequin_figure.hpp"

namespace toile::internal {

Figure mannequin_figure(const Mannequin& mannequin) {
  Figure figure;
  FigureSkin skin;
  for (std::size_t j = 0; j < mannequin.joints.size(); ++j) {
    const Joint& joint = mannequin.joints[j];
    figure.nodes.push_back({joint.name, joint.parent});
    NodePose pose;
    pose.translation = joint.position_m;
    if (joint.parent >= 0) pose.translation -= mannequin.joints[at(joint.parent)].position_m;
    figure.rest.nodes.push_back(pose);
    Affine to_joint;
    to_joint << Mat3::Identity(), -joint.position_m;
    skin.joints.push_back(static_cast<Index>(j));
    skin.to_joint.push_back(to_joint);
  }
  figure.order = parents_first(figure.nodes, "mannequin");
  figure.skins.push_back(std::move(skin));
  figure.modelled = mannequin.positions;
  figure.parts.push_back({0, 0, 0, mannequin.positions.size()});
  figure.first_influence.push_back(0);
  for (const SkinWeights& weights : mannequin.skin) {
    for (std::size_t k = 0; k < 4; ++k)
      if (weights.weight[k] > 0) figure.influences.push_back({weights.joint[k], weights.weight[k]});
    figure.first_influence.push_back(figure.influences.size());
  }
  return figure;
}

Pose mannequin_pose(const Figure& figure, const FigurePose& pose) {
  Pose own;
  own.root_m = pose.nodes.front().translation - figure.rest.nodes.front().translation;
  // Of the two quaternions of a turn the one below half a turn: the skin blends a joint with its parent.
  for (const NodePose& node : pose.nodes)
    own.turns.push_back(node.turn.w < 0 ? Quaternion{-node.turn.w, -node.turn.v} : node.turn);
  return own;
}

}  // namespace toile::internal
