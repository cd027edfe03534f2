// toile/simulation.hpp: the simulation of cloth on a body.
//
//   toile::Simulation sim(toile::Cloth::from_pattern("tshirt.json"), toile::Body::mannequin("woman", "walk"));
//   if (toile::DressReport worn = sim.dress(); !worn.ok()) { std::puts(worn.explain().c_str()); return 1; }
//   while (sim.time_s() < 4) {
//     if (toile::StepReport step = sim.advance(1.0 / 30); !step.ok()) { std::puts(step.explain().c_str()); break; }
//     draw(sim.positions_m(), sim.faces());
//   }
//
// Every call throws Error for invalid input.  A simulation that fails says so in its report.  The same calls give the same bits, on any
// number of threads; two simulations may run in two threads at once.
#pragma once
#include "toile/body.hpp"
#include "toile/cloth.hpp"
#include "toile/error.hpp"
#include "toile/export.hpp"
#include "toile/types.hpp"
#include "toile/verify.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

struct Progress {
  std::string_view phase;    // "meshing", "placing", "sewing", "untangling", "fitting", "draping" ...
  double share = 0;          // of the phase that is done, 0 ... 1
  double seconds_left = -1;  // of the phase; -1: unknown
};

struct SimulationOptions {
  Point gravity_m_per_s2{0, -9.81, 0};
  Point wind_m_per_s{0, 0, 0};
  double air_density_kg_per_m3 = 1.2;  // 0: cloth moves as in a vacuum
  int threads = 0;                     // 0: one per core; the bits do not depend on it
  // Polled while a call works; true ends the call, but not a constructor.  A cancelled dress() leaves the simulation as it was before; a cancelled
  // advance() leaves it at the last good step, from which the next one goes on.
  std::function<bool()> cancelled = {};
  std::function<void(const Progress&)> progress = {};
};

// The result of dress().
struct TOILE_EXPORT DressReport {
  bool ok() const { return reasons.empty(); }
  std::string ended;            // "still", "time", "seam_blocked", "step_collapsed", "time_limit", "interrupted" ...
  std::vector<Reason> reasons;  // why it is not worn as it should be; empty: it is worn well
  std::vector<std::string> warnings;  // of what was mended and chosen, and reservations: "pinched_cloth: 8 edges ..."
  double simulated_s = 0;
  // One line for each reason and warning.
  TOILE_EXPORT std::string explain() const;
};

// The result of one advance().
struct TOILE_EXPORT StepReport {
  bool ok() const { return reached; }
  bool reached = true;  // false: the cloth and the time are those of the last good step
  bool cancelled = false;
  int steps = 0, rejected = 0;
  double step_min_s = 0, step_max_s = 0;
  int cg_iterations = 0;
  std::string diagnosis;  // of a step that failed at every step size: which triangles, and why
  TOILE_EXPORT std::string explain() const;
};

// The complete state of a simulation between two frames: all that decides how it goes on.
class TOILE_EXPORT State {
 public:
  State() = default;
  // Bytes from another process or machine.  Simulation::set_state checks them.
  explicit State(std::string bytes) : bytes_(std::move(bytes)) {}
  const std::string& bytes() const { return bytes_; }
  static State load(const std::string& path);
  void save(const std::string& path) const;

 private:
  std::string bytes_;
};

class TOILE_EXPORT Simulation {
 public:
  // Cloth that is no pattern hangs at once where it starts; intersections at the start are resolved first.  Several cloths are given from the inside
  // out.
  explicit Simulation(const Cloth& cloth, const Body& body = Body::none(), const SimulationOptions& options = {});
  explicit Simulation(std::span<const Cloth> cloths, const Body& body = Body::none(),
                      const SimulationOptions& options = {});
  // With solids beside the worn body, which may be Body::none().
  Simulation(std::span<const Cloth> cloths, const Body& body, std::span<const Body> solids,
             const SimulationOptions& options = {});
  // The simulation that a scene file describes, in memory: no folder is made.
  static Simulation from_scene(const std::string& path, const SimulationOptions& options = {});
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  // Sews the patterns around the body, and lets them hang until they are at rest, or for longest_s.  Cloth that is no pattern only comes to rest.
  // `time_limit_s` is wall time; 0: no limit.
  DressReport dress(double longest_s = 20, double time_limit_s = 0);
  // Runs a scene to its end, as the program does.
  DressReport run();
  // Advances by exactly h_s.  A body with a motion begins it at the first call.
  StepReport advance(double h_s);
  // Time since all garments are on: after dress() it is how long the cloth hung.
  double time_s() const;
  // Back to the state after construction.
  void reset();

  // Repairs of the input files, and input that is probably not meant.
  const std::vector<std::string>& warnings() const;

  // The cloth.  Views into the simulation, valid until the next non-const call.  Before dress() of a pattern: its unsewn panels.
  std::span<const Point> positions_m() const;         // [particle]
  std::span<const Point> velocities_m_per_s() const;  // [particle]
  std::span<const Face> faces() const;
  std::span<const CornerUvs> uv_m() const;      // [face]
  std::span<const std::int32_t> panel() const;  // [face] a number below panel_names().size()
  const std::vector<std::string>& panel_names() const;
  // The body and the solids, in this order, as one surface; empty if there is none.
  std::span<const Point> body_positions_m() const;
  std::span<const Face> body_faces() const;
  // One collider by itself: the worn body, if there is one, comes first, then the solids.
  int collider_count() const;
  std::span<const Point> collider_positions_m(int collider) const;

  // Holds particles where they are, until they are released.  Attached particles become pinned ones.
  void pin(std::span<const std::int32_t> particles);
  // Moves pinned particles in a straight line to these points during the next advance(); they stay there.
  void move_pins(std::span<const std::int32_t> particles, std::span<const Point> to_m);
  void release(std::span<const std::int32_t> particles);
  std::vector<std::int32_t> pinned() const;  // ascending

  struct Grip {
    std::int32_t face = 0;
    std::array<double, 3> barycentric{1, 0, 0};
    double stiffness_N_per_m = 50, damping_N_s_per_m = 0.5, max_force_N = 5;
  };
  // A hand that pulls a point of the cloth by a spring; it begins at that point.
  int grab(const Grip& grip);
  // Moves the hand there during the next advance().
  void drag(int hand, const Point& to_m);
  void let_go(int hand);

  // Moves the body, or a solid, there during the next advance(), each vertex in a straight line.  Only for one without a motion of its own.
  void set_body(std::span<const Point> vertices_m) { set_collider(0, vertices_m); }
  void set_collider(int collider, std::span<const Point> vertices_m);
  // Holds particles where they are on the body or a solid: each is carried by the nearest point of its surface, and turns with it.
  void attach(std::span<const std::int32_t> particles);
  // Friction of cloth on this collider (numbered as in set_collider) from now on.
  void set_friction(int collider, double friction);
  // Factors on a panel's stiffness and damping, relative to its fabric, from now on.
  struct Stiffness {
    double stretch = 1, shear = 1, bend = 1;
  };
  void set_stiffness(std::int32_t panel, const Stiffness& share);
  // The pressure of a panel from now on (Cloth::set_panel_pressure).
  void set_pressure(std::int32_t panel, double Pa);
  void set_gravity(const Point& m_per_s2);
  void set_wind(const Point& m_per_s);

  // A state from which this simulation, or another of the same cloth, body and options, dressed or not, in any process, goes on with the same
  // bits.
  State state() const;
  // Throws InputError for a state of a different simulation, or an incomplete one.
  void set_state(const State& state);
  // Hash of the bits of all positions and velocities: 16 hexadecimal digits, as in report.json.
  std::string state_hash() const;

  // Crossings of the positions rounded to float32, as files hold them.
  Crossings crossings() const;

  struct TOILE_HIDDEN Implementation;

  const Implementation& implementation() const { return *implementation_; }  // for the library itself

 private:
  explicit Simulation(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace toile
