#include "bench_limits.hpp"

#include "assembly/elements.hpp"
#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "read_stream.hpp"
#include "sim/setup.hpp"
#include "solver/modified_pcg.hpp"

#include <algorithm>
#include <array>
#include <functional>

namespace toile {
namespace {

constexpr double h_s = 1.0 / 60;
constexpr double noise_m = 1e-3;
// Of a solve.  The difference is timed: residuals in double before the first iteration and after the fiftieth are not of it.
constexpr int few_iterations = 9, many_iterations = 49;
constexpr double bytes_per_measurement = 64e6;  // some milliseconds

// The system of a flat sheet with noise: without contacts, so that the sum of bytes is that of the mesh alone.
class SheetSystem {
 public:
  explicit SheetSystem(const LoadedCloth& cloth)
      : model_(build_model(cloth.garment.mesh, cloth.fabrics)),
        elements_(model_),
        A_(elements_.pattern()),
        system_(A_),
        constraints_(model_.particle_count()),
        b_(cloth.garment.x.size()),
        reference_(b_.size()) {
    ClothState state{cloth.garment.x, Vec3s(b_.size(), Vec3::Zero())};
    const Vec3 step(0.8191725134, 0.6710436067, 0.5497004779);  // of a sequence that fills a cube evenly
    for (std::size_t i = 0; i < state.x.size(); ++i) {
      const Vec3 at = static_cast<double>(i) * step;
      state.x[i] += noise_m * Vec3(at - at.array().floor().matrix());
    }
    for (Index i = 0; i < A_.rows(); ++i)
      A_.grounded(i) = model_.mass_kg[static_cast<std::size_t>(i)] * Mat3::Identity();
    elements_.evaluate(model_, state);
    elements_.assemble(h_s, A_);
    elements_.forces(b_);
    for (std::size_t i = 0; i < b_.size(); ++i) {
      reference_[i] = h_s * model_.mass_kg[i] * model_.gravity_m_per_s2;
      b_[i] = h_s * b_[i] + reference_[i];
    }
    system_.update({}, constraints_);
  }
  SheetSystem(const SheetSystem&) = delete;
  SheetSystem& operator=(const SheetSystem&) = delete;

  const ClothMesh& mesh() const { return model_.mesh; }
  const BlockMatrix<float>& A() const { return A_; }
  const LinearSystem<float>& system() const { return system_; }
  std::span<const Vec3> b() const { return b_; }
  std::span<const Vec3> reference() const { return reference_; }

 private:
  ClothModel model_;
  Elements elements_;
  BlockMatrix<float> A_;
  LinearSystem<float> system_;
  ParticleConstraints constraints_;
  Vec3s b_, reference_;
};

struct Traffic {  // bytes
  double worked_on = 0, moved = 0;
};
struct Sizes {  // as doubles: bytes are their products
  double particles, blocks, coarse_entries, coarse_directions;
};

constexpr double lane = sizeof(Lane<float>), block = sizeof(Block<float>), index = sizeof(Index);
constexpr double stored_block = block + index;  // with its column

// Every block and vector once: y is added to where it is in the cache.
Traffic traffic_of_product(const Sizes& n) {
  const double bytes = n.blocks * stored_block + n.particles * (index + block + 2 * lane);
  return {bytes, bytes};
}

// A gather reads each block for both of its rows, but the second time from a cache: rows that share a block lie near each other.
Traffic traffic_of_residual_product(const Sizes& n) {
  const double bytes = n.blocks * (stored_block + sizeof(BlockPattern::Above)) +
                       n.particles * (2 * index + sizeof(Mat3) + 2 * sizeof(Vec3));
  return {bytes, bytes};
}

// Of a particle, G = D^-1 and in lanes; a vector that changes is read and written:
//   forward sweep    G, 3     r to As, s
//   backward sweep   G, 4     s, As
//   delta               2     r.s
//   direction           6     s, As to c, q, and c.q
//   residual         G, 6     c, q to w, r, and r.G r
// and the blocks in both sweeps.  A row's own slots begin with an index.
Traffic traffic_of_ssor(const Sizes& n) {
  return {n.blocks * stored_block + n.particles * (index + block + 6 * lane),
          2 * n.blocks * stored_block + n.particles * (2 * index + 3 * block + 21 * lane)};
}

// Besides:
//   restrict         basis, aggregate, 2     r, As
//   substitute       the triangles of the factor and of its transpose
//   prolong          basis, aggregate, 5     s, Zy, As, and the columns of A' Z
Traffic traffic_of_coarse(const Sizes& n) {
  const double own = sizeof(Vec3) + index;  // of a particle's place in the coarse space
  const double columns = n.coarse_entries * (9 * lane + index) + n.particles * index;
  const double factor = n.coarse_directions * (n.coarse_directions + 1) * sizeof(double);
  const Traffic ssor = traffic_of_ssor(n);
  return {ssor.worked_on + columns + factor + n.particles * (own + lane),
          ssor.moved + columns + factor + n.particles * (2 * own + 7 * lane)};
}

struct Piece {
  std::string name;
  Traffic traffic;
  int most_threads;
  std::function<double()> seconds;  // of one measurement
};

double median(std::vector<double> of) {
  std::sort(of.begin(), of.end());
  return of[of.size() / 2];
}

// One call of many.
double time_calls(const Traffic& traffic, const std::function<void()>& call) {
  const int calls = std::max(1, static_cast<int>(bytes_per_measurement / traffic.worked_on));
  call();
  const Stopwatch watch;
  for (int k = 0; k < calls; ++k) call();
  return watch.seconds() / calls;
}

double time_iteration(const SheetSystem& sheet, Preconditioner kind) {
  PcgOptions options;
  options.preconditioner = kind;
  options.loosen = 0;  // never good enough
  // A solver of its own for each measurement: one that waited too long for its threads would go on alone for a hundred solves.
  ModifiedPcg<float> pcg(sheet.mesh());
  pcg.prepare(sheet.system(), options);
  Vec3s dv(sheet.b().size());
  const auto seconds = [&](int iterations) {
    options.max_iterations = iterations;
    std::fill(dv.begin(), dv.end(), Vec3::Zero());
    const Stopwatch watch;
    const PcgReport report = pcg.solve(sheet.system(), sheet.b(), sheet.reference(), options, dv);
    const double spent = watch.seconds();
    if (report.iterations != iterations) throw Error(ExitCode::internal, "bench limits: " + report.explain());
    return spent;
  };
  seconds(few_iterations);  // caches are warm
  const double few = seconds(few_iterations);
  return (seconds(many_iterations) - few) / (many_iterations - few_iterations);
}

BenchRow row_of(const Piece& piece, const Sizes& sizes, int threads, int repeats) {
  ReadStream stream(static_cast<std::size_t>(piece.traffic.worked_on), threads);
  std::vector<double> measured, limit;
  for (int k = 0; k < repeats; ++k) {  // in turn, so that other work on the machine meets both
    limit.push_back(piece.traffic.moved * stream.seconds_per_byte(static_cast<std::size_t>(bytes_per_measurement)));
    measured.push_back(piece.seconds());
  }
  BenchRow row;
  row.add("piece", "piece", piece.name);
  row.add("particles", "particles", static_cast<long>(sizes.particles));
  row.add("threads", "threads", static_cast<long>(threads));
  row.add("worked_on_bytes", "bytes worked on", static_cast<long>(piece.traffic.worked_on));
  row.add("moved_bytes", "moved", static_cast<long>(piece.traffic.moved));
  row.add("microseconds", "us", 1e6 * median(measured), 1);
  row.add("limit_microseconds", "limit us", 1e6 * median(limit), 1);
  row.add("limit_gb_per_s", "GB/s", 1e-9 * piece.traffic.moved / median(limit), 1);
  row.add("share_percent", "share %", 100 * median(limit) / median(measured), 0);
  return row;
}

void measure(const LoadedCloth& cloth, BenchRuns& runs, std::vector<BenchRow>& rows) {
  const SheetSystem sheet(cloth);
  const BlockMatrix<float>& A = sheet.A();
  CoarseSpace<float> coarse(sheet.mesh());
  coarse.factorise(sheet.system());
  const Sizes sizes{static_cast<double>(A.rows()), static_cast<double>(A.pattern().block_count()),
                    static_cast<double>(coarse.entries()), static_cast<double>(coarse.dimension())};
  const std::size_t n = sheet.b().size();
  std::vector<Lane<float>> x(n, to_lane<float>(Vec3(1, 2, 3))), y(n);
  const Vec3s wide_x(n, Vec3(1, 2, 3));
  Vec3s wide_y(n);
  const Traffic product = traffic_of_product(sizes), residual_product = traffic_of_residual_product(sizes);
  const auto multiply = [&] { A.multiply(std::span<const Lane<float>>(x), std::span<Lane<float>>(y)); };
  const auto multiply_wide = [&] { A.multiply(std::span<const Vec3>(wide_x), std::span<Vec3>(wide_y)); };
  const std::array<Piece, 4> pieces = {
      {{"matrix product, float", product, 1, [&] { return time_calls(product, multiply); }},
       {"residual product, double", residual_product, 2, [&] { return time_calls(residual_product, multiply_wide); }},
       {"iterate block_ssor", traffic_of_ssor(sizes), 2,
        [&] { return time_iteration(sheet, Preconditioner::block_ssor); }},
       {"iterate block_ssor_coarse", traffic_of_coarse(sizes), 2,
        [&] { return time_iteration(sheet, Preconditioner::block_ssor_coarse); }}}};
  for (const Piece& piece : pieces) {
    for (int threads = 1; threads <= std::min(piece.most_threads, available_threads()); ++threads) {
      if (interrupted()) return;
      runs.say("limits", 0);
      with_threads(threads, [&] { rows.push_back(row_of(piece, sizes, threads, runs.line().repeats)); });
    }
  }
}

}  // namespace

BenchTable measure_limits(BenchRuns& runs) {
  BenchTable table{"limits", {}, false};
  for (const int size : runs.line().limit_sizes) {
    Scene scene = embedded_scene("fig1-drape");
    SceneCloth& cloth = scene.cloth.front();
    cloth.grid->edge_m = edge_for(*cloth.grid, size);
    Hash unused;
    measure(load_cloth(scene, cloth, read_text_file, unused), runs, table.rows);
  }
  return table;
}

}  // namespace toile
