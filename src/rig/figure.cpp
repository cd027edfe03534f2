#include "rig/figure.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numeric>

namespace toile::internal {
namespace {

constexpr std::size_t vertices_per_task = 512;

// [skin][joint] from the mesh's space to the world.
std::vector<std::vector<Affine>> palettes(const Figure& figure, const std::vector<Affine>& world) {
  std::vector<std::vector<Affine>> all;
  for (const FigureSkin& skin : figure.skins) {
    std::vector<Affine>& palette = all.emplace_back();
    for (std::size_t j = 0; j < skin.joints.size(); ++j)
      palette.push_back(product(world[at(skin.joints[j])], skin.to_joint[j]));
  }
  return all;
}

// The modelled vertices with what the morph targets add; empty where none has a weight.
std::vector<Vec3> morphed(const Figure& figure, const std::vector<double>& weights) {
  std::vector<Vec3> x;
  for (const MorphTarget& target : figure.morphs) {
    const double weight = weights[at(target.weight)];
    if (weight == 0) continue;
    if (x.empty()) x = figure.modelled;
    for (std::size_t k = 0; k < target.vertices.size(); ++k) x[at(target.vertices[k])] += weight * target.shifts[k];
  }
  return x;
}

std::vector<Index> part_of_vertex(const Figure& figure) {
  std::vector<Index> part(figure.modelled.size(), 0);
  for (std::size_t p = 0; p < figure.parts.size(); ++p)
    for (std::size_t k = 0; k < figure.parts[p].count; ++k) part[figure.parts[p].first + k] = static_cast<Index>(p);
  return part;
}

}  // namespace

Affine product(const Affine& outer, const Affine& inner) {
  Affine m;
  m.leftCols<3>() = outer.leftCols<3>() * inner.leftCols<3>();
  m.col(3) = operator_on(outer, inner.col(3));
  return m;
}

Affine transform_of(const NodePose& pose) {
  Affine m;
  m.leftCols<3>() = rotation_matrix(pose.turn) * pose.stretch;
  m.col(3) = pose.translation;
  return m;
}

NodePose pose_of(const Affine& matrix) {
  NodePose pose;
  pose.translation = matrix.col(3);
  const Mat3 linear = matrix.leftCols<3>();
  const double length = std::sqrt(linear.col(0).squaredNorm());
  Vec3 first = linear.col(0), second = linear.col(1);
  if (length > 0) {
    first /= length;
    second -= first.dot(second) * first;
  }
  const double across = std::sqrt(second.squaredNorm());
  pose.stretch = linear;
  if (!(length > 0) || !(across > 0)) return pose;  // flat: nothing turns
  second /= across;
  Mat3 turn;
  turn << first, second, first.cross(second);
  pose.turn = quaternion_of(turn);
  pose.stretch = turn.transpose() * linear;
  return pose;
}

std::vector<Affine> world_transforms(const Figure& figure, const FigurePose& pose) {
  std::vector<Affine> world(figure.nodes.size());
  for (const Index node : figure.order) {
    const Affine own = transform_of(pose.nodes[at(node)]);
    const Index parent = figure.nodes[at(node)].parent;
    world[at(node)] = parent < 0 ? own : product(world[at(parent)], own);
  }
  return world;
}

std::vector<Affine> world_transforms(const Figure& figure) { return world_transforms(figure, figure.rest); }

void pose_vertices(const Figure& figure, const FigurePose& pose, std::span<const Index> vertices, std::span<Vec3> x) {
  const std::vector<Affine> world = world_transforms(figure, pose);
  const std::vector<std::vector<Affine>> palette = palettes(figure, world);
  const std::vector<Vec3> moved = morphed(figure, pose.weights);
  const std::vector<Vec3>& from = moved.empty() ? figure.modelled : moved;
  const std::vector<Index> part = part_of_vertex(figure);
  parallel_for(vertices.size(), vertices_per_task, [&](std::size_t k) {
    const std::size_t i = at(vertices[k]);
    const FigurePart& own = figure.parts[at(part[i])];
    if (own.skin < 0) {
      x[k] = operator_on(world[at(own.node)], from[i]);
      return;
    }
    Vec3 sum = Vec3::Zero();
    for (std::size_t n = figure.first_influence[i]; n < figure.first_influence[i + 1]; ++n)
      sum += figure.influences[n].weight * operator_on(palette[at(own.skin)][at(figure.influences[n].joint)], from[i]);
    x[k] = sum;
  });
}

std::vector<Vec3> all_vertices(const Figure& figure, const FigurePose& pose) {
  std::vector<Vec3> x(figure.modelled.size());
  pose_vertices(figure, pose, every_vertex(figure), x);
  return x;
}

std::vector<Index> every_vertex(const Figure& figure) {
  std::vector<Index> all(figure.modelled.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::vector<Index> parents_first(const std::vector<FigureNode>& nodes, std::string_view file) {
  std::vector<std::vector<Index>> children(nodes.size());
  std::vector<Index> order;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent < 0)
      order.push_back(static_cast<Index>(i));
    else
      children[at(nodes[i].parent)].push_back(static_cast<Index>(i));
  }
  for (std::size_t done = 0; done < order.size(); ++done) {
    const std::vector<Index>& below = children[at(order[done])];
    order.insert(order.end(), below.begin(), below.end());
  }
  if (order.size() < nodes.size()) {
    std::vector<char> reached(nodes.size(), 0);
    for (const Index i : order) reached[at(i)] = 1;
    std::size_t first = 0;
    while (reached[first] != 0) ++first;
    throw InputError(file, "node " + std::to_string(first), "a node that hangs on a root",
                     "one that hangs on itself, over others");
  }
  return order;
}

}  // namespace toile::internal
