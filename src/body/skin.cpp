// body/skin.cpp: weights from distances to bones, softened along the mesh.
#include "body/skin.hpp"

#include "body/implicit_shape.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace toile::internal {

namespace {

constexpr double fade_m = 0.08;
constexpr int softening_sweeps = 12;

// 0 for the other side's limbs, 1 for the own side's, smooth across the middle: thighs that are close do not share
// bones.
double same_side(const Joint& joint, const Vec3& p) {
  const bool left = joint.name.ends_with("_left"), right = joint.name.ends_with("_right");
  if (!left && !right) return 1;
  const double s = std::clamp((left ? p.x() : -p.x()) / 0.03 + 0.5, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// For each joint, the one of the same name on the other side; itself in the middle.
std::vector<Index> partners(const std::vector<Joint>& joints) {
  std::vector<Index> partner(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    partner[j] = static_cast<Index>(j);
    std::string name = joints[j].name;
    if (name.ends_with("_left")) {
      name.replace(name.size() - 4, 4, "right");
    } else if (name.ends_with("_right")) {
      name.replace(name.size() - 5, 5, "left");
    }
    for (std::size_t k = 0; k < joints.size(); ++k)
      if (joints[k].name == name) partner[j] = static_cast<Index>(k);
  }
  return partner;
}

using Weights = std::vector<double>;  // one row of joints per vertex

Weights by_distance(std::span<const Vec3> positions, const std::vector<Joint>& joints) {
  const std::size_t width = joints.size();
  Weights weights(positions.size() * width);
  parallel_for(positions.size(), 512, [&](std::size_t i) {
    double* row = &weights[i * width];
    for (std::size_t j = 0; j < width; ++j) {
      const Joint& bone = joints[j];
      row[j] = RoundCone{bone.position_m, bone.end_m, bone.radius_m, bone.end_radius_m}(positions[i]);
    }
    const double nearest = *std::min_element(row, row + width);
    double sum = 0;
    for (std::size_t j = 0; j < width; ++j) {
      const double near = std::max(0.0, 1.0 - (row[j] - nearest) / fade_m);
      row[j] = near * near * near * same_side(joints[j], positions[i]);
      sum += row[j];
    }
    for (std::size_t j = 0; j < width; ++j) row[j] /= sum;
  });
  return weights;
}

void soften(Weights& weights, std::size_t width, std::span<const Triangle> triangles) {
  const std::size_t count = weights.size() / width;
  std::vector<std::vector<Index>> next(count);  // on a closed mesh each neighbour follows exactly once
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) next[at(t[k])].push_back(t[(k + 1) % 3]);
  Weights softer(weights.size());
  for (int sweep = 0; sweep < softening_sweeps; ++sweep) {
    parallel_for(count, 512, [&](std::size_t i) {
      for (std::size_t j = 0; j < width; ++j) {
        double sum = 0;
        for (Index n : next[i]) sum += weights[at(n) * width + j];
        softer[i * width + j] = 0.5 * weights[i * width + j] + 0.5 * sum / static_cast<double>(next[i].size());
      }
    });
    std::swap(weights, softer);
  }
}

SkinWeights four_largest(std::span<const double> row) {
  std::vector<std::pair<double, Index>> order;  // (-weight, joint): largest first, then by joint
  for (std::size_t j = 0; j < row.size(); ++j) order.emplace_back(-row[j], static_cast<Index>(j));
  std::sort(order.begin(), order.end());
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum -= order[k].first;
  SkinWeights skin;
  for (std::size_t k = 0; k < 4; ++k) {
    const double w = -order[k].first / sum;
    if (w < 1e-4) break;  // a dust of far joints would cost as much as a real one
    skin.joint[k] = order[k].second;
    skin.weight[k] = w;
  }
  const double kept = skin.weight[0] + skin.weight[1] + skin.weight[2] + skin.weight[3];
  for (double& w : skin.weight) w /= kept;
  return skin;
}

}  // namespace

std::vector<SkinWeights> skin_weights(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                      const std::vector<Joint>& joints) {
  const std::size_t width = joints.size();
  Weights weights = by_distance(positions, joints);
  soften(weights, width, triangles);

  std::size_t on_plane = 0;
  while (on_plane < positions.size() && positions[on_plane].x() == 0) ++on_plane;
  const std::size_t beside = (positions.size() - on_plane) / 2;
  const std::vector<Index> partner = partners(joints);
  std::vector<SkinWeights> skin(positions.size());
  for (std::size_t i = 0; i < on_plane + beside; ++i) {
    skin[i] = four_largest(std::span(weights).subspan(i * width, width));
    if (i < on_plane) continue;
    skin[i + beside] = skin[i];
    for (std::size_t k = 0; k < 4; ++k)
      if (skin[i].weight[k] > 0) skin[i + beside].joint[k] = partner[at(skin[i].joint[k])];
  }
  return skin;
}

}  // namespace toile::internal
