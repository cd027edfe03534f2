// rig/figure.hpp: a surface that nodes carry: a skeleton with skin weights, rigid pieces, morph targets.
//
//   node      a joint or a piece, placed in its parent's axes:  T(p) = translation + turn (stretch p);  world = parent's world * T
//   morphs    p_i = modelled_i + sum_m weight_m shift_mi
//   a piece   x_i = world(node) p_i
//   a skin    x_i = sum_j w_ij world(joint_j) to_joint_j p_i: linear blending; the node that the mesh hangs on does not count
//
// All that is here is independent of the file's format: glTF, a rig of MakeHuman's.                docs/motions.md#bodies-with-a-skeleton
//
// Mind: parents may have larger numbers than their children; `order` has them first.
#pragma once
#include "core/quaternion.hpp"
#include "core/types.hpp"

#include <span>
#include <string>
#include <vector>

namespace toile::internal {

using Affine = Eigen::Matrix<double, 3, 4>;  // [linear | shift]
inline Vec3 operator_on(const Affine& m, const Vec3& p) { return m.leftCols<3>() * p + m.col(3); }
Affine product(const Affine& outer, const Affine& inner);

struct NodePose {
  Vec3 translation = Vec3::Zero();
  Quaternion turn;
  Mat3 stretch = Mat3::Identity();  // scale, in a node that was given as a matrix shear too
};
Affine transform_of(const NodePose& pose);
// translation, turn and stretch whose product is the matrix: its columns made orthonormal in their order.
NodePose pose_of(const Affine& matrix);

struct FigurePose {
  std::vector<NodePose> nodes;
  std::vector<double> weights;  // of the morph targets
};

struct FigureNode {
  std::string name;
  Index parent = -1;
  Index first_weight = 0, weights = 0;  // of its mesh, in FigurePose::weights
};

struct FigureSkin {
  std::vector<Index> joints;     // nodes
  std::vector<Affine> to_joint;  // [joint] from the space of the mesh
};

struct Influence {
  Index joint = 0;  // of the skin
  double weight = 0;
};

// Vertices that share a node, and a skin (-1: none).
struct FigurePart {
  Index node = 0, skin = -1;
  std::size_t first = 0, count = 0;
};

struct MorphTarget {
  Index weight = 0;
  std::vector<Index> vertices;
  std::vector<Vec3> shifts;
};

struct Figure {
  std::vector<FigureNode> nodes;
  std::vector<Index> order;
  FigurePose rest;
  std::vector<FigureSkin> skins;
  std::vector<FigurePart> parts;  // in the order of their vertices, without gaps
  std::vector<MorphTarget> morphs;
  std::vector<Vec3> modelled;
  std::vector<std::size_t> first_influence;  // [vertex], and the end; weights of a vertex sum to 1; of a piece none
  std::vector<Influence> influences;
};

// Where every node is.
std::vector<Affine> world_transforms(const Figure& figure, const FigurePose& pose);
// The same at rest.
std::vector<Affine> world_transforms(const Figure& figure);

// x[k] is where vertices[k] is.  May be called from several threads.
void pose_vertices(const Figure& figure, const FigurePose& pose, std::span<const Index> vertices, std::span<Vec3> x);
std::vector<Vec3> all_vertices(const Figure& figure, const FigurePose& pose);

// The numbers of all vertices.
std::vector<Index> every_vertex(const Figure& figure);

// `order`, by the parents.  Throws InputError with `file` as its place for nodes that hang on each other in a ring.
std::vector<Index> parents_first(const std::vector<FigureNode>& nodes, std::string_view file);

}  // namespace toile::internal
