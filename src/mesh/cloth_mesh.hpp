// mesh/cloth_mesh.hpp: cloth as it was cut: triangles with pattern coordinates per corner.        [BW98 2.1]
//
// (u, v) belong to the corner of a triangle, not to the particle, so that a welded seam keeps the coordinates
// of both panels.  u runs along the warp, v along the weft, in metres.
#pragma once
#include "core/types.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

struct Interfacing {              // fused to a panel (material/fabric.hpp)
  std::string fabric;             // a preset's name; empty: none
  std::optional<double> apart_m;  // absent: fused_apart_m
};

struct PanelCloth {         // the panel's own wishes; a scene may override them
  std::string fabric;       // a preset's name; empty: the garment's
  Vec2 rest_stretch{1, 1};  // (b_u, b_v)
  Interfacing interfacing;
};

struct FoldedEdge {  // an edge whose hinge is not flat at rest
  Index a = 0, b = 0;
  double angle_rad = 0;  // theta of mesh/topology.hpp: > 0 is a ridge on the right side
};

// An edge with a hem, a tape or a seam allowance along it (material/edge_finish.hpp), as the triangle walks it that is finished: both sides of a seam have their own.
struct FinishedEdge {
  Index a = 0, b = 0;
  double hem_m = 0, tape_m = 0, allowance_m = 0;  // widths
  bool topstitched = false;                       // the allowance
};

struct ClothMesh {
  Index particle_count = 0;
  std::vector<Triangle> triangles;      // counter-clockwise in (u, v) and seen from the right side
  std::vector<std::array<Vec2, 3>> uv;  // [triangle][corner], m
  std::vector<Index> panel;             // [triangle] index into panel_names
  std::vector<std::string> panel_names;
  std::vector<PanelCloth> panel_cloth;  // as panel_names, or empty
  std::vector<FoldedEdge> folds;
  std::vector<FinishedEdge> finished;
  // [triangle][corner], or empty: the shape at rest where a gathering thread holds the cloth together (garment/gathers.hpp); elsewhere uv.
  std::vector<std::array<Vec2, 3>> gathered_uv;

  Index triangle_count() const { return static_cast<Index>(triangles.size()); }
};

// The derivatives of a triangle's map from (u, v) to space, as linear maps of its corners:
//   w_u = sum_i alpha_i x_i        w_v = sum_i beta_i x_i                                           [BW98 4.2, eq. 9]
// with   alpha_1 =  dv2 / d,  alpha_2 = -dv1 / d,  alpha_0 = -(alpha_1 + alpha_2)
//        beta_1  = -du2 / d,  beta_2  =  du1 / d,  beta_0  = -(beta_1 + beta_2),      d = du1 dv2 - du2 dv1,
// where du_i, dv_i are the pattern coordinates of corner i less those of corner 0.
struct MaterialFrame {
  Vec3 alpha, beta;  // 1/m, one entry per corner; each adds up to zero
  double area_m2;    // rest area; negative when the triangle is flipped in the pattern
};
// Not finite when the triangle has no area in the pattern: check_cloth (mesh/check.hpp) refuses it first.
MaterialFrame material_frame(const std::array<Vec2, 3>& uv);

}  // namespace toile::internal
