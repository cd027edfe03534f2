// apps/bench/bench_micro.cpp: `toile bench micro`: the cost of the pieces of a step, each repeated on one state.
//
// The state is the paper's first row after 45 frames, so that contact queries find as many contacts as in a run.  Medians: a mean would
// include other work of the machine.  `make bench` has the solver's pieces with more statistics.
#include "bench.hpp"
#include "bench_limits.hpp"
#include "bench_probe.hpp"
#include "body/mannequin.hpp"
#include "contact/ccd.hpp"
#include "contact/impacts.hpp"
#include "core/stopwatch.hpp"

#include <Eigen/Geometry>  // cross

#include <algorithm>
#include <array>

namespace toile::internal {
namespace {

constexpr int landed_frame = 45;
constexpr double micro_step_s = 1.0 / 60;
constexpr int pcg_iterations = 50;
constexpr double query_range_m = 5e-3, ccd_separation_m = 1e-4;

class Stopwatches {
 public:
  Stopwatches(BenchRuns& runs, std::vector<BenchRow>& rows) : runs_(&runs), rows_(&rows) {}

  // The median time of `piece`, divided by the number of units of its work.
  template <class Piece>
  void add(const std::string& what, std::string_view unit, double units, Piece&& piece) {
    if (interrupted()) return;
    runs_->say("micro", 0);
    piece();  // allocates memory, warms the caches
    std::vector<double> times;
    for (int k = 0; k < runs_->line().repeats; ++k) {
      const Stopwatch watch;
      piece();
      times.push_back(watch.seconds());
    }
    std::sort(times.begin(), times.end());
    const double median = times[times.size() / 2];
    BenchRow row;
    row.add("what", "what", what);
    row.add("per", "per", std::string(unit));
    row.add("count", "count", static_cast<long>(units));
    row.add("milliseconds", "ms", 1e3 * median, 4);
    row.add("nanoseconds_each", "ns each", 1e9 * median / units, 1);
    row.add("least_nanoseconds_each", "least", 1e9 * times.front() / units, 1);
    rows_->push_back(std::move(row));
  }

 private:
  BenchRuns* runs_;
  std::vector<BenchRow>* rows_;
};

void measure_solver(Stopwatches& time, Drape& drape, StepSystem& system) {
  const ClothModel& model = system.model();
  const double elements = static_cast<double>(model.membrane.size() + model.bend.size());
  time.add("evaluate elements", "triangle or hinge", elements,
           [&] { system.elements().evaluate(model, drape.state()); });
  const double blocks = system.A().pattern().block_count() + static_cast<double>(system.A().rows());
  time.add("assemble", "block", blocks, [&] { system.elements().assemble(micro_step_s, system.A()); });
  std::vector<Lane<float>> x(drape.state().x.size(), to_lane<float>(Vec3(1, 2, 3))), y(x.size());
  time.add("matrix product", "block", blocks,
           [&] { system.A().multiply(std::span<const Lane<float>>(x), std::span<Lane<float>>(y)); });
  for (const auto kind : {Preconditioner::diagonal, Preconditioner::block_jacobi, Preconditioner::block_ssor,
                          Preconditioner::block_ssor_coarse}) {
    PcgOptions options;
    options.preconditioner = kind;
    options.tolerance = 1e-12;
    options.max_iterations = pcg_iterations;
    const std::string name(to_string(kind));
    if (kind == Preconditioner::block_ssor_coarse) {
      time.add("prepare, other blocks", "solve", 1, [&] {
        system.A().update_diagonal();
        system.prepare(options);
      });
      time.add("prepare, blocks as they were", "solve", 1, [&] { system.prepare(options); });
    } else {
      system.prepare(options);
    }
    time.add("iterate " + name, "iteration", pcg_iterations, [&] { (void)system.solve_prepared(options, system.b()); });
  }
}

void measure_contact(Stopwatches& time, Drape& drape) {
  const ClothModel& model = drape.model();
  const ClothState& state = drape.state();
  const Mannequin man = make_mannequin(MannequinKind::man);
  BodySurface body(man.positions, man.triangles);
  Vec3s here = man.positions, there = man.positions;
  const auto to_and_fro = [&] {
    body.set_motion(here, there);
    std::swap(here, there);
  };
  for (std::size_t i = 0; i < there.size(); i += 1 + there.size() / 100) there[i] += Vec3(0, 0, 0.02);
  time.add("refit a body of which little moves", "triangle", static_cast<double>(man.triangles.size()), to_and_fro);
  for (std::size_t i = 0; i < there.size(); ++i) there[i] = here[i] + Vec3(0, 0, 0.02);
  time.add("refit a body, its normals", "triangle", static_cast<double>(man.triangles.size()), to_and_fro);

  const ClothTopology topology(state.x.size(), model.mesh.triangles, model.topology);
  TriangleTree tree(state.x, model.mesh.triangles);
  ProximityWorkspace workspace;
  ProximityOptions options;
  options.range_m = query_range_m;
  std::vector<ClothContact> contacts;
  const auto triangles = static_cast<double>(model.mesh.triangles.size());
  time.add("cloth near cloth", "triangle", triangles,
           [&] { find_cloth_contacts(topology, tree, state.x, options, workspace, contacts); });

  Vec3s next = state.x;
  for (std::size_t i = 0; i < next.size(); ++i) next[i] += micro_step_s * state.v[i];
  const std::vector<double> contact_m(state.x.size(), 1e-3);
  ImpactWorkspace impact_workspace;
  std::vector<Impact> impacts;
  time.add("impacts on the way", "triangle", triangles, [&] {
    static_cast<void>(find_impacts(topology, tree, state.x, next, contact_m, impact_workspace, impacts));
  });

  // A vertex over the middle of every face that comes down from 5 mm to 0.2 mm, and slides.
  std::vector<std::array<Vec3, 4>> x, u;
  for (const Triangle& t : model.mesh.triangles) {
    const Vec3 &a = state.x[at(t[0])], &b = state.x[at(t[1])], &c = state.x[at(t[2])];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    x.push_back({Vec3((a + b + c) / 3 + 5e-3 * normal), a, b, c});
    u.push_back({Vec3(-4.8e-3 * normal + 0.1 * (b - a)), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
  }
  double sum = 0;  // so that the queries are not optimised away
  time.add("continuous collision, vertex and face", "query", triangles, [&] {
    for (std::size_t k = 0; k < x.size(); ++k) sum += vertex_face_impact(x[k], u[k], ccd_separation_m);
  });
  if (sum < 0) throw Error(ErrorKind::internal, "an impact before the step");
}

}  // namespace

BenchResult bench_micro(BenchRuns& runs) {
  BenchResult result{"micro", {{"rows", {}, false}}, {}, {}, true};
  Scene scene = embedded_scene("fig1-drape");
  SceneGrid& grid = std::get<SceneGrid>(scene.cloth.front().kind);
  grid.edge_m = edge_for(grid, runs.line().sizes.front());
  runs.say("state", 0);
  Drape drape(scene);
  if (!drape.advance(landed_frame)) throw Error(ErrorKind::simulation_failed, "bench micro: the drape failed");
  StepSystem system(drape, micro_step_s);
  result.facts.add("particles", "particles", static_cast<long>(system.model().particle_count()));
  result.facts.add("constrained", "constrained particles", static_cast<long>(system.constrained()));
  result.facts.add("contact_rows", "rows of contact and friction", static_cast<long>(system.rows()));
  Stopwatches time(runs, result.tables.front().rows);
  measure_solver(time, drape, system);
  measure_contact(time, drape);
  result.tables.push_back(measure_limits(runs));
  return result;
}

}  // namespace toile::internal
