// sim/cloths.hpp: a cloth of a scene: its kind, and the members common to all kinds.
//
// A kind of cloth is a struct that says whether it is `sewn`, with the key that chooses it (none: it is only given in memory) and three
// functions: `describe_choice` (that key, sim/settings.hpp), `load` (its panels, meshed and placed) and `cost` (of loading it).  Optional members,
// and their effect:
//   path             a member: the file that it is read from; errors name that file, and it is among the inputs of a run
//   edge_m           a member: the edge length of its triangles; absent: the cloth's resolution_m
//   settle           checks the keys of its object against each other (sim/scene_settle.hpp)
//   describe_beside  its keys beside the one that chooses it; they may be in describe_choice, too
//   refuse_beside    the error for these keys where another kind is chosen
//   usual_name       the default name of the cloth
//   size_of          its area: too many triangles are refused as it is read
// Everything else follows from its line in ClothKind.                                       docs/howto/add-a-kind-of-cloth.md
#pragma once
#include "dress/events.hpp"
#include "dress/keyed.hpp"
#include "dress/label_springs.hpp"
#include "dress/rigid_path.hpp"
#include "material/fabric.hpp"
#include "sim/cloth_arrays.hpp"
#include "sim/cloth_mesh.hpp"
#include "sim/cloth_pattern.hpp"
#include "sim/cloth_ribbon.hpp"
#include "sim/cloth_shapes.hpp"
#include "sim/kinds.hpp"
#include "step/drag.hpp"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace toile::internal {

using ClothKind = std::variant<ScenePattern, SceneClothMesh, SceneGrid, SceneTube, SceneRibbon, SceneClothArrays>;

struct ScenePanel : PanelInTime {  // the settings of one panel
  std::string name;
  std::optional<Fabric> fabric, interfacing;
  std::optional<double> interfacing_mm;
  std::optional<double> rest_stretch_u,
      rest_stretch_v;  // b of the warp and the weft, < 1 pulls together; absent: the pattern's
};

struct ScenePin {
  Vec3 near_m{0, 0, 0};                         // pins the particle nearest to it at the start
  std::optional<std::array<Vec3, 2>> in_box_m;  // instead: all particles within a box at the start
  enum class Hold { fixed, path, moves, body };
  Hold hold = Hold::fixed;
  std::vector<VectorKey> path;  // ascending times; straight in between, at rest before and after
  RigidPath moves;  // instead: the pinned particles move rigidly, from their positions when pinned; times from then
  double from_s = 0, to_s = std::numeric_limits<double>::infinity();  // pinned in this time
};

// Pulls the nearest particle by a damped spring to a place that may move.
struct SceneDrag {
  Vec3 near_m{0, 0, 0};
  std::vector<VectorKey> path;  // of the hand
  double stiffness_N_per_m = Drag{}.stiffness_N_per_m, damping_N_s_per_m = Drag{}.damping_N_s_per_m,
         max_force_N = Drag{}.max_force_N;
  double from_s = 0, to_s = 0;  // it pulls in this time
};

struct SceneCloth {
  std::string name;
  ClothKind kind;
  double resolution_m = 0.01;  // edge length of triangles where the kind has none
  Fabric fabric;
  std::vector<ScenePanel> panels;
  Vec3 translation_m{0, 0, 0};
  Vec3 rotation_deg{0, 0, 0};  // R = Rz Ry Rx, as in patterns
  std::vector<ScenePin> pins;
  std::vector<SceneDrag> drags;
  std::vector<LabelHeight> label_heights;  // of edges with a label; a missing waist is measured

  template <class Kind>
  const Kind* as() const {
    return std::get_if<Kind>(&kind);
  }
  bool is_sewn() const;
  bool has_own_edge() const;
  double edge_m() const;
  void set_edge_m(double edge_m);  // overrides a number of vertices
  // The file that it is read from; empty: none.
  std::string_view path() const;
};

// `path` is the cloth's own in the scene, "/cloth/2".  Errors name the cloth's file, if it has one.  Throws InputError, IoError, also for cloth
// that check_garment refuses.
MeshedCloth mesh_cloth(const SceneCloth& cloth, std::string_view path, const TextSource& read);
// Reads patterns by `read`, and only the sizes of other files.
ClothCost cost_of(const SceneCloth& cloth, const TextSource& read);

}  // namespace toile::internal
