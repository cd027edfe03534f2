// step/contact_rows.hpp: implicit contact of cloth on cloth, and of body edges and vertices on cloth.              (L2)
//
//   gap after the step, linear in dv:   g(dv) = d + n . ( sum_i w_i (h (v_i + dv_i) + y_i) - body travel )
//   active while g < r:                 E = k/2 (r - g)^2     -> one rank-one row (assembly/implicit_row.hpp)
//   k = (m_eff + h^2 k_n) / h^2,  m_eff = 1 / sum(w_i^2/m_i),  k_n = sum w_i^2 n.K_ii n     for inertia and elasticity
//       between layers at most c / (h^2 sum w_i^2 n.D_i^-1 n),  D_i = M_i + h^2 K_ii:  c over the compliance of the
//       pair along n with its particles free; c = 3 with a face, 1 between edges.  n.K n alone makes a row at a hem,
//       whose n leans into the cloth, a hundred times as stiff as its neighbours, and layers interlock like gears;
//       c = 1 everywhere lets a fold in an armpit tremble.
//   k grows while the contact lives, so that the load of the last step compresses it by a tenth of r.  It never
//   shrinks: a spring that softened under load would return more energy than it took.
//   friction: a bristle with k_t = k (step/bristle.hpp), with lambda and the tangential motion of the previous pass.
#pragma once
#include "assembly/block_matrix.hpp"
#include "assembly/cloth_model.hpp"
#include "assembly/implicit_row.hpp"
#include "contact/proximity.hpp"
#include "step/bristle.hpp"
#include "step/collider_contact.hpp"
#include "step/flypaper.hpp"
#include "step/layer_distance.hpp"
#include "step/layer_gap.hpp"
#include "step/step_formula.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct ContactRowOptions {
  bool cloth_cloth = true;
  double body_share = 0.5;  // r of body rows over the body's offset: they stop features that poke between particles
  double damping_s = 2e-3;  // relaxation time of contact springs
  double region_tolerance =
      0.5;  // contact/proximity.hpp; 0.1 lost contacts in the corners of seams (docs/deviations.md#contact-rows)
  double look_ahead = 1;  // pairs farther apart than r + look_ahead r are left to the next step
};

class ContactRows {
 public:
  // `merged_particle`: open seams, as in contact/features.hpp; may be empty.
  ContactRows(const ClothModel& model, const BodySurface* body, std::span<const Index> merged_particle,
              const BodyContactOptions& body_contact, const ContactRowOptions& options);

  // L0: finds the near pairs at the state's positions.
  void detect(const ClothState& state, double h_s);
  // The stiffness of each pair and the first active rows of a step.  `base_h_s` is the frame's own step, before any
  // halving.  A pair that was active in the last step, or that the guess `dv` brings below r, starts active.
  void begin(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step, double base_h_s,
             std::span<const Mat3> diagonal);
  void append_springs(std::vector<LinearSpring>& springs) const;

  struct Change {
    int dropped = 0, added = 0, active = 0;
    int turned_back = 0;  // bristles turned back (Bristle::decide)
  };
  Change update(const ClothState& state, std::span<const Vec3> dv, std::span<const Vec3> y, const StepFormula& step,
                bool may_drop);
  // Whether the active rows differ from those at the end of the last accepted step.
  bool changed() const;
  void accept(const ClothState& end_state);

  // Scales the contact distance of layers, per particle (empty: 1 everywhere).  Four layers in a corner of a seam are a
  // centimetre thick: sewing thins them there to let the corner close.  0 switches the contact of layers off.
  void set_thickness_scale(std::span<const double> scale) { distance_.set_scale(scale); }

  // [particle] From the next detect on, pairs whose particles are all pinched (contact/pinched.hpp) get no rows, neither
  // with layers nor with the body.  Empty: all pairs do.
  void let_be(std::span<const Pinched> particles) { pinched_.assign(particles.begin(), particles.end()); }

  // For the safe filter: which features touch, a hierarchy over the triangles (after detect), lists of near features,
  // and the distance that neighbours keep, per particle; the separation that the filter keeps is far less than either.
  const ClothTopology& topology() const { return topology_; }
  TriangleTree& tree() { return tree_; }
  const FeaturePairs& near() const { return near_; }
  std::span<const double> contact_m() const { return distance_.of_neighbours_m(); }

  // The distances of layers at x, of cloth without open seams.  Shares the memory of `detect` and leaves its pairs
  // alone.
  LayerGap layer_gap(std::span<const Vec3> x);

  void set_body_friction(std::optional<Index> collider, double friction) {
    body_contact_.set_friction(collider, friction);
  }

  int active() const;
  // Energy of the springs of the last step, J, each by its load.
  double stored_J() const;
  std::size_t candidates() const { return pairs_.size(); }

  // State between two steps (core/state_archive.hpp); set_thickness_scale is the caller's.
  template <class Archive>
  void remember(Archive& archive) {
    archive(memory_, cloth_seconds, body_seconds);
  }
  double cloth_seconds = 0, body_seconds = 0;  // time spent in detect, accumulated; for reports

 private:
  struct Key {
    ContactKind kind;
    bool body;
    std::array<Index, 5> feature;
    auto operator<=>(const Key&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 sees a 0 in it
    template <class Archive>
    void remember(Archive& archive) {
      archive(kind, body, feature);
    }
  };
  struct Pair {
    Key key;
    LinearSpring spring;  // direction, particles, weights, stiffness, body travel
    double gap_m, r_m, friction;
    Vec3 normal{0, 0, 0};  // at the start of the step; the spring's may be that of its end
    std::array<double, 4> weight{0, 0, 0, 0};
    bool passes_by = false;  // is farther apart than r at the end of the step
    bool loaded = false;     // carried a load in the last step
    double lambda_N = 0;     // for friction: load of the last step, for a new contact of the last pass
    Bristle bristle{};
    Vec3 start_m{0, 0, 0};        // sum of weight x at the start of the step
    Vec3 body_travel_m{0, 0, 0};  // of the body's point over the step; cloth-cloth: 0
    double body_parameter = 0;    // of the point on the body's edge
    bool active = false;
    int idle_steps = 0;      // since it was last active
    double predicted_m = 0;  // gap in the last update
  };
  struct Memory {  // of a pair, from step to step
    Key key;
    double stiffness, lambda_N;
    Bristle bristle;
    Vec3 way_m, normal;  // tangential motion, in the last step
    int idle_steps;      // 0: was active
    bool rests;          // was active and hardly slid
    template <class Archive>
    void remember(Archive& archive) {
      archive(key, stiffness, lambda_N, bristle, way_m, normal, idle_steps, rests);
    }
  };
  struct Orphan {  // a vertex's contact whose pair no longer exists
    Index vertex;
    std::size_t memory;
    auto operator<=>(const Orphan&) const = default;  // NOLINT(modernize-use-nullptr)
  };
  Vec3 relative_velocity(const Pair& pair, const Vec3s& v, double h_s) const;
  void place(Pair& pair, const ClothState& state, std::span<const Vec3> dv, const StepFormula& step, double base_h_s,
             std::span<const Mat3> diagonal) const;
  void carry_on(Pair& pair, std::size_t memory);
  void take_over_contacts();
  void aim_at_the_end(Pair& pair, const ClothState& state, std::span<const Vec3> dv, const StepFormula& step) const;
  double friction_of(std::span<const Index> particles) const;  // of the cloth: the largest
  void find_acting_edges();
  void ready_for(std::span<const Vec3> x);

  const ClothModel* model_;
  const BodySurface* body_;
  BodyContactOptions body_contact_;
  double largest_body_r_m_;
  ContactRowOptions options_;
  std::vector<Pinched> pinched_;  // [particle] or empty
  ClothTopology topology_;
  LayerDistance distance_;
  TriangleTree tree_;
  FeaturePairs near_;
  ProximityWorkspace workspace_;
  std::vector<std::array<Index, 2>>
      acting_edges_;  // of edge-edge rows that were active in the last accepted step and hardly slid
  std::vector<ClothContact> cloth_contacts_;
  std::vector<BodyContact> body_contacts_;
  std::vector<Pair> pairs_;     // sorted by key
  std::vector<Memory> memory_;  // sorted by key
  std::vector<Orphan> orphans_;
  std::vector<char> kept_;  // [memory] its pair still exists
  double h_s_ = 0;
};

}  // namespace toile::internal
