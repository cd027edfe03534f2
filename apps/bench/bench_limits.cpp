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
#include <limits>
#include <memory>

namespace toile::internal {
namespace {

constexpr double limit_step_s = 1.0 / 60;
constexpr double noise_m = 1e-3;
constexpr int solve_iterations = 49;            // of a solve; the next one would recompute the residual
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
    elements_.assemble(limit_step_s, A_);
    elements_.forces(b_);
    for (std::size_t i = 0; i < b_.size(); ++i) {
      reference_[i] = limit_step_s * model_.mass_kg[i] * model_.gravity_m_per_s2;
      b_[i] = limit_step_s * b_[i] + reference_[i];
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

// Bytes of a piece: its working set, which it reads at least once, and the bytes that it reads again, from the cache that holds the
// bytes read in between.
struct Traffic {
  double worked_on = 0;
  double again_in_domain = 0, domain = 0;    // while the sweeps work on one domain
  double again_in_vectors = 0, vectors = 0;  // while only vectors are worked on
  double moved() const { return worked_on + again_in_domain + again_in_vectors; }
};
struct Sizes {  // as doubles: bytes are their products
  double particles, blocks, domains, coarse_entries, factor_blocks;
};

constexpr double lane = sizeof(Lane<float>), block = sizeof(Block<float>), index = sizeof(Index);
constexpr double stored_block = block + index;  // with its column

// Every block and vector once: y is updated in the cache.
Traffic traffic_of_product(const Sizes& n) {
  return {n.blocks * stored_block + n.particles * (index + block + 2 * lane)};
}

// A gather reads each block for both of its rows, but the second time from a cache: rows that share a block are near each other.
Traffic traffic_of_residual_product(const Sizes& n) {
  return {n.blocks * (stored_block + sizeof(BlockPattern::Above)) +
          n.particles * (2 * index + sizeof(Mat3) + 2 * sizeof(Vec3))};
}

// Per particle, with G = D^-1 in lanes; a vector that changes is read and written:
//   forward sweep    G, 3     r to As, s
//   backward sweep   G, 4     s, As                          again in the domain
//   delta               2     r.s
//   direction           6     s, As to c, q, and c.q
//   residual         G, 6     c, q to w, r, and r.G r
// and the blocks in both sweeps.  A row's own slots begin with an index.
Traffic traffic_of_ssor(const Sizes& n) {
  const double rows = n.blocks * stored_block + n.particles * index;
  Traffic traffic;
  traffic.worked_on = rows + n.particles * (block + 6 * lane);
  traffic.again_in_domain = rows + n.particles * (block + 4 * lane);
  traffic.domain = (rows + n.particles * (block + 3 * lane)) / n.domains;
  const double moved = 2 * rows + n.particles * (3 * block + 21 * lane);
  traffic.again_in_vectors = moved - traffic.worked_on - traffic.again_in_domain;
  traffic.vectors = n.particles * (block + 6 * lane);
  return traffic;
}

// In addition:
//   restrict         basis, aggregate, 2     r, As
//   substitute       the factor's blocks, which are read again at once in the back substitution
//   prolong          basis, aggregate, 5     s, Zy, As, and the columns of A' Z
Traffic traffic_of_coarse(const Sizes& n) {
  const double place = sizeof(Vec3) + index;  // per particle in the coarse space
  const double columns = n.coarse_entries * (9 * lane + index) + n.particles * index;
  const double factor = n.factor_blocks * (sizeof(double) * BlockCholesky::side * BlockCholesky::side + index);
  Traffic traffic = traffic_of_ssor(n);
  traffic.worked_on += columns + factor + n.particles * (place + lane);
  traffic.again_in_vectors += factor + n.particles * (place + 6 * lane);
  traffic.vectors += factor + n.particles * (place + lane);
  return traffic;
}

struct Piece {
  std::string name;
  Traffic traffic;
  int most_threads;
  std::function<double()> seconds;  // of one measurement
};

// The mean time of a call.
double time_calls(const Traffic& traffic, const std::function<void()>& call) {
  const int calls = std::max(1, static_cast<int>(bytes_per_measurement / traffic.worked_on));
  call();
  const Stopwatch watch;
  for (int k = 0; k < calls; ++k) call();
  return watch.seconds() / calls;
}

// The mean time of an iteration, including its share of the solve's start, a few percent.
double time_iteration(const SheetSystem& sheet, Preconditioner kind) {
  PcgOptions options;
  options.preconditioner = kind;
  options.loosen = 0;  // never converges
  options.max_iterations = solve_iterations;
  // A new solver for every measurement: one that waited too long for its threads goes on alone for a hundred solves.
  ModifiedPcg<float> pcg(sheet.mesh());
  pcg.prepare(sheet.system(), options);
  Vec3s dv(sheet.b().size(), Vec3::Zero());
  const Stopwatch watch;
  const PcgReport report = pcg.solve(sheet.system(), sheet.b(), sheet.reference(), options, dv);
  const double seconds = watch.seconds();
  if (report.iterations != solve_iterations) throw Error(ErrorKind::internal, "bench limits: " + report.explain());
  return seconds / solve_iterations;
}

// The time in which the machine only reads as many bytes from the same caches.
class Limit {
 public:
  Limit(const Traffic& traffic, int threads) {
    add(traffic.worked_on, traffic.worked_on, threads);
    add(traffic.again_in_domain, std::min(threads * traffic.domain, traffic.worked_on), threads);
    add(traffic.again_in_vectors, traffic.vectors, threads);
  }
  void measure() {
    for (Part& part : parts_)
      part.least_s = std::min(
          part.least_s, part.bytes * part.stream->seconds_per_byte(static_cast<std::size_t>(bytes_per_measurement)));
  }
  double seconds() const {
    double sum = 0;
    for (const Part& part : parts_) sum += part.least_s;
    return sum;
  }

 private:
  struct Part {
    double bytes;
    std::unique_ptr<ReadStream> stream;
    double least_s = std::numeric_limits<double>::infinity();
  };
  void add(double bytes, double size, int threads) {
    if (bytes > 0) parts_.push_back({bytes, std::make_unique<ReadStream>(static_cast<std::size_t>(size), threads)});
  }
  std::vector<Part> parts_;
};

BenchRow row_of(const Piece& piece, const Sizes& sizes, int threads, int repeats) {
  Limit limit(piece.traffic, threads);
  std::vector<double> seconds;
  for (int k = 0; k < repeats; ++k) {  // in turn: other work on the machine comes and goes
    limit.measure();
    seconds.push_back(piece.seconds());
  }
  std::sort(seconds.begin(), seconds.end());
  const double least = seconds.front(), median = seconds[seconds.size() / 2];
  BenchRow row;
  row.add("piece", "piece", piece.name);
  row.add("particles", "particles", static_cast<long>(sizes.particles));
  row.add("threads", "threads", static_cast<long>(threads));
  row.add("worked_on_bytes", "bytes worked on", static_cast<long>(piece.traffic.worked_on));
  row.add("moved_bytes", "moved", static_cast<long>(piece.traffic.moved()));
  row.add("microseconds", "us", 1e6 * median, 1);
  row.add("least_microseconds", "least", 1e6 * least, 1);
  row.add("limit_microseconds", "limit", 1e6 * limit.seconds(), 1);
  row.add("limit_gb_per_s", "GB/s", 1e-9 * piece.traffic.moved() / limit.seconds(), 1);
  row.add("share_percent", "share %", 100 * limit.seconds() / median, 0);
  row.add("best_share_percent", "best %", 100 * limit.seconds() / least, 0);
  return row;
}

void measure(const LoadedCloth& cloth, BenchRuns& runs, std::vector<BenchRow>& rows) {
  const SheetSystem sheet(cloth);
  const BlockMatrix<float>& A = sheet.A();
  CoarseSpace<float> coarse(sheet.mesh());
  coarse.factorise(sheet.system());
  SweepDomains<float> domains;
  domains.cut(A.pattern());
  const Sizes sizes{static_cast<double>(A.rows()), static_cast<double>(A.pattern().block_count()),
                    static_cast<double>(domains.count()), static_cast<double>(coarse.entries()),
                    static_cast<double>(coarse.factor_blocks())};
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
    SceneGrid& grid = std::get<SceneGrid>(scene.cloth.front().kind);
    grid.edge_m = edge_for(grid, size);
    measure(load_cloth(scene, 0, read_text_file), runs, table.rows);
  }
  return table;
}

}  // namespace toile::internal
