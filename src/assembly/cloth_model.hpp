// assembly/cloth_model.hpp: the integrator's model of a cloth: particles, elements, masses.  Built once, then constant.
#pragma once
#include "material/bend.hpp"
#include "material/bend_hysteresis.hpp"
#include "material/fabric.hpp"
#include "material/membrane.hpp"
#include "material/plate.hpp"
#include "mesh/cloth_mesh.hpp"
#include "mesh/topology.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::internal {

struct ClothState {  // copy to save, assign to restore
  Vec3s x, v;        // m, m/s
  template <class Archive>
  void remember(Archive& archive) {
    archive(x, v);
  }
};

enum class BendElement {
  plate,  // moments of plate.hpp: any Poisson ratio, the same on any triangles
  hinge,  // of 1998 with a weight: each hinge by itself, nu = -1/3 on equilateral triangles
};

struct ModelOptions {
  Vec3 gravity_m_per_s2{0, -9.81, 0};
  BendElement bend_element = BendElement::plate;
  bool threads_buckle = true;  // where they are pushed together (material/membrane.hpp)
  bool paper_scaling = false;  // conditions scaled by area, hinges without geometry, as printed in 1998
  DampingJacobian damping_jacobian = DampingJacobian::gauss_newton;
  // Damps every motion, f = -drag m v.  Unphysical (it would brake falling too); sewing uses it to keep loose panels
  // from whipping.
  double drag_per_s = 0;
  // The friction of layers of two given fabrics; all other pairs have the larger of their two.
  std::vector<PairFriction> pair_friction;
};

// Factors on the stiffness of a panel's fabric; 1: unchanged.
struct StiffnessShare {
  double stretch = 1, shear = 1, bend = 1;
  bool operator==(const StiffnessShare&) const = default;
};

// A thread along a finished edge (assembly/edge_threads.hpp), on side `side` of a triangle: from its corner of that number to the next.
struct EdgeThread {
  Index a = 0, b = 0, triangle = 0;
  std::uint8_t side = 0;
  double stretch_N = 0;  // force per strain
};

// Bending along finished edges, at a particle between two of them (assembly/finished_edges.hpp): of the kink sum share * fold angle.
struct LineBend {
  struct Part {
    Index hinge = 0;
    double share = 0;
  };
  double stiffness_N_m = 0;      // moment per kink
  std::array<Index, 2> panel{};  // of both edges
  std::vector<Part> hinges;
};

struct ClothModel {
  ClothMesh mesh;
  Topology topology;
  std::vector<MembraneRest> membrane;              // [triangle]
  std::vector<MembraneStiffness> stiffness;        // [panel], or one for all
  std::vector<BendRest> bend;                      // [hinge]
  std::vector<Mat3> plate_compliance;              // [triangle], rad/(N m); empty: hinges alone
  std::vector<BendHysteresis> hysteresis;          // [panel], or one for all; empty: bends are forgotten
  std::vector<EdgeThread> threads;                 // along mesh.finished
  std::vector<LineBend> line_bends;                // along mesh.finished
  std::vector<double> mass_kg;                     // [particle]
  std::vector<double> thickness_m;                 // [particle] contact distance of two layers
  std::vector<double> friction;                    // [particle] the largest of its fabrics
  std::vector<Index> fabric;                       // [particle] of its first triangle: one number per name
  std::vector<std::vector<double>> pair_friction;  // [fabric][fabric], < 0: not given; empty: none is
  Vec3 gravity_m_per_s2{0, -9.81, 0};
  DampingJacobian damping_jacobian = DampingJacobian::gauss_newton;
  double drag_per_s = 0;
  double gathered = 1;   // share of mesh.gathered_uv
  double finished = 1;   // share of the stiffness of `threads`
  double stiffened = 1;  // share of what makes threads stiffen (MembraneStiffness::stiffened)
  // As built, once set_panel_stiffness has changed them: [panel], [hinge], [triangle].
  std::vector<MembraneStiffness> built_stiffness;
  std::vector<double> built_kappa_N_m;
  std::vector<Mat3> built_compliance;
  std::vector<StiffnessShare> stiffness_share;  // [panel]
  int rest_version = 0;  // counts changes of b, of gathers and of stiffness, for the batches packed from them

  Index particle_count() const { return mesh.particle_count; }
  const MembraneStiffness& stiffness_of(std::size_t triangle) const {
    return stiffness[stiffness.size() == 1 ? 0 : static_cast<std::size_t>(mesh.panel[triangle])];
  }
  std::array<Vec2, 3> rest_uv(std::size_t triangle) const;  // gathered so far; without b
  // The friction given for the fabrics of particles i and j, else `usual`.
  double friction_between(Index i, Index j, double usual) const;
};

// `fabric_of_panel` has one entry, or one per panel of the mesh.  Hinges on a seam take the mean of both sides.
// Plates: every triangle has the rigidity of its own fabric, on a seam too.  Masses: a third of each triangle's density * area goes to each corner.  Rest angles are those of mesh.folds, zero
// elsewhere; rest shapes are gathered.  Finished edges add mass, a thread, and bending along them (finished_edges.hpp).
ClothModel build_model(ClothMesh mesh, std::span<const Fabric> fabric_of_panel, const ModelOptions& options = {});

// Of `fabric_of_panel` as above.
const Fabric& fabric_of(const ClothMesh& mesh, std::span<const Fabric> fabric_of_panel, std::size_t triangle);

// Rest angles = share * mesh.folds: panels are sewn flat (0) and then folded.  Folds on a free edge have no effect.
void set_folds(ClothModel& model, double share);

// Threads of finished edges with a share of their stiffness: seams close without (0).
void set_finishes(ClothModel& model, double share);

// Threads stiffen by that share of their curves: 0 is the straight line.  Cloth of which a seam or a growing body makes half as much again pulls
// hundreds of times as hard along a curve, which is no cloth's pull any more.
void set_stiffening(ClothModel& model, double share);

// Rest shapes of triangles = uv + share * (mesh.gathered_uv - uv): panels are sewn as cut (0), and gathered as their
// seams close (1).  Mass, bend weight and area stay those of the cloth as cut.
void set_gathers(ClothModel& model, double share);

// Changes the rest stretch (b_u, b_v) of a triangle or of a panel's triangles; 1 is as cut, 0.8 shortens by a fifth.
// Allowed between any two steps: forces, step control and contact distances follow.  Bend keeps its weight, that of the
// cloth as cut.  Throws InputError for an index that the mesh does not have, and for b that is not above zero and
// finite.
void set_rest_stretch(ClothModel& model, Index triangle, const Vec2& b);
void set_panel_rest_stretch(ClothModel& model, Index panel, const Vec2& b);

// What matrices take for plates and finished edges (BendRest::plate_N_m), after a change of plate_compliance or of shares of stiffness.
void set_plate_bounds(ClothModel& model);

// Changes how stiff a panel is, as a share of its fabric; damping keeps its relaxation time, and with it the same share.  Hinges on a seam take
// the mean of both sides.  Allowed between any two steps.  Throws InputError for a missing panel, and for a share that is not above zero.
void set_panel_stiffness(ClothModel& model, Index panel, const StiffnessShare& share);

}  // namespace toile::internal
