// apps/bench/bench_probe.hpp: a cloth in the middle of its drape, and the linear system of one step from there.
//
//   (A + sum a g g^T) dv = b  under S, z          as ImplicitEuler poses it in the last pass of the active set
//
// To compare two fabrics or two solvers on the same problem: state, contacts and constraints are the drape's.
#pragma once
#include "dress/outfit_run.hpp"
#include "sim/scene.hpp"
#include "step/implicit_euler.hpp"

#include <optional>

namespace toile::internal {

inline constexpr int state_frame = 30;  // of the drape: the cloth touches itself, and still moves
inline constexpr int most_iterations = 5000;

// A scene of grids, without motion.
class Drape {
 public:
  explicit Drape(const Scene& scene);
  Drape(const Drape&) = delete;
  Drape& operator=(const Drape&) = delete;

  // False when a step collapsed.
  bool advance(int frames);

  const Scene& scene() const { return scene_; }
  const Outfit& outfit() const { return outfit_; }
  const ClothState& state() const { return outfit_.state; }
  const ClothModel& model() const { return run_->model(); }
  const StepOptions& step() const { return step_; }
  BodySurface* body() { return body_ ? &*body_ : nullptr; }
  std::span<const Pin> pins() const { return run_->pins(); }  // of the last frame

 private:
  Scene scene_;
  Outfit outfit_;
  std::optional<BodySurface> body_;
  StepOptions step_;
  std::optional<OutfitRun> run_;
};

class StepSystem {
 public:
  // The system of the drape's own cloth, or of another fabric at the same positions and with the same contacts.  `drape` must outlive
  // this object and stay where it is.
  StepSystem(Drape& drape, double h_s) : StepSystem(drape, h_s, drape.model()) {}
  StepSystem(Drape& drape, double h_s, const Fabric& fabric);
  StepSystem(const StepSystem&) = delete;
  StepSystem& operator=(const StepSystem&) = delete;

  // With the initial guess dv = 0.
  PcgReport solve(const PcgOptions& options) { return solve(options, b_); }
  // The same with another right-hand side, to compare matrices alone.
  PcgReport solve(const PcgOptions& options, std::span<const Vec3> b);

  // Its two halves, to be timed.
  void prepare(const PcgOptions& options) { pcg_.prepare(system_, options); }
  PcgReport solve_prepared(const PcgOptions& options, std::span<const Vec3> b);

  const ClothModel& model() const { return model_; }
  Elements& elements() { return elements_; }
  BlockMatrix<float>& A() { return A_; }
  const LinearSystem<float>& system() const { return system_; }
  std::span<const Vec3> b() const { return b_; }
  std::span<const Vec3> reference() const { return reference_; }
  int constrained() const { return static_cast<int>(constraints_.constrained().size()); }
  int rows() const { return static_cast<int>(rows_.size()); }

 private:
  StepSystem(Drape& drape, double h_s, ClothModel model);
  void find_contacts(Drape& drape);
  void assemble();

  const ClothState* state_;
  double h_s_;
  ClothModel model_;
  Elements elements_;
  BlockMatrix<float> A_;
  LinearSystem<float> system_;
  ModifiedPcg<float> pcg_;
  ParticleConstraints constraints_;
  std::vector<LinearSpring> springs_;
  std::vector<ImplicitRow> rows_;
  Vec3s y_, landing_, b_, reference_;
};

}  // namespace toile::internal
