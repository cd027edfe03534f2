#include "assembly/elements.hpp"

#include "assembly/line_moments.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <functional>
#include <type_traits>
#include <utility>

namespace toile::internal {
namespace {

constexpr std::size_t element_grain = 512;  // elements per block of work
constexpr std::size_t batch_grain = element_grain / batch_size;

template <class Parts>
std::vector<std::int32_t> offsets(const Parts& keyed, std::size_t key_count) {
  std::vector<std::int32_t> begin(key_count + 1, 0);
  for (const auto& part : keyed) ++begin[static_cast<std::size_t>(part.first) + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  return begin;
}

// What d(moment)/d(theta) is taken for: one number per hinge, which keeps the matrix that of hinges by themselves.
double in_matrix_N_m(const BendRest& rest) { return rest.kappa_N_m + rest.plate_N_m; }

// work(begin, end) for ranges of batches.
template <class Work>
void for_batches(std::size_t count, const Work& work) {
  parallel_blocks(count, batch_grain, std::cref(work));  // by reference: no copy of the lambda on the heap
}

}  // namespace

Elements::Elements(const ClothModel& model)
    : model_(&model),
      triangles_(model.mesh.triangles),
      hinges_(model.topology.hinges),
      bend_rest_(model.bend),
      rest_(batches_for(triangles_.size())),
      state_(rest_.size()),
      bend_(hinges_.size()),
      of_triangles_(3 * rest_.size() * batch_size + 1),
      of_hinges_(hinges_.size()),
      beyond_linear_(rest_.size() * batch_size) {
  if (!model.plate_compliance.empty()) {
    plates_.emplace(model);
    if (!model.hysteresis.empty()) memory_.emplace(model);
  }
  if (plates_ || !model.line_bends.empty()) {
    turned_.resize(hinges_.size());
    plate_moment_.resize(hinges_.size());
  }
  pattern_ = std::make_shared<const BlockPattern>(pattern_of_cloth(model.particle_count(), triangles_, hinges_));
  if (!model.threads.empty()) threads_.emplace(model, *pattern_);
  pack_rest(model);
  add_incidence(model);
}

void Elements::pack_rest(const ClothModel& model) {
  rest_version_ = model.rest_version;
  if (plates_) plates_->pack(model);
  if (threads_) threads_->pack(model);
  form_.damping_jacobian = model.damping_jacobian;
  for (std::size_t k = 0; k < rest_.size() * batch_size && !triangles_.empty(); ++k) {
    const std::size_t t = std::min(k, triangles_.size() - 1);
    MembraneStiffness stiffness = model.stiffness_of(t);
    stiffness.stiffened = model.stiffened;
    rest_[k / batch_size].set(k % batch_size, model.membrane[t], stiffness, triangles_[t]);
  }
}

void Elements::add_incidence(const ClothModel& model) {
  // Which element adds to which block, in element order: (key, part), sorted by key only (stable).
  std::vector<std::pair<Slot, BlockParts::OfTriangle>> in_triangles;
  std::vector<std::pair<Slot, BlockParts::OfHinge>> in_hinges;
  std::vector<std::pair<Index, std::pair<Index, std::uint8_t>>> at_triangles, at_hinges;
  const auto by_key = [](const auto& p, const auto& q) { return p.first < q.first; };
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::uint8_t a = 0; a < 3; ++a) {
      at_triangles.push_back({triangles_[t][a], {static_cast<Index>(t), a}});
      for (std::uint8_t b = 0; b < 3; ++b) {
        const Index i = triangles_[t][a], j = triangles_[t][b];
        const std::uint8_t pair = (a + 1) % 3 == b ? a : b;
        if (i < j) in_triangles.push_back({pattern_->slot(i, j), {static_cast<Index>(t), pair}});
      }
    }
  }
  for (std::size_t h = 0; h < hinges_.size(); ++h) {
    for (std::uint8_t a = 0; a < 4; ++a) {
      at_hinges.push_back({hinges_[h].particle[a], {static_cast<Index>(h), a}});
      for (std::uint8_t b = 0; b < 4; ++b) {
        const Index i = hinges_[h].particle[a], j = hinges_[h].particle[b];
        if (i < j) in_hinges.push_back({pattern_->slot(i, j), {static_cast<Index>(h), a, b}});
      }
    }
  }
  std::stable_sort(in_triangles.begin(), in_triangles.end(), by_key);
  std::stable_sort(in_hinges.begin(), in_hinges.end(), by_key);
  std::stable_sort(at_triangles.begin(), at_triangles.end(), by_key);
  std::stable_sort(at_hinges.begin(), at_hinges.end(), by_key);
  const auto slots = static_cast<std::size_t>(pattern_->block_count());
  const auto particles = static_cast<std::size_t>(model.particle_count());
  triangle_begin_ = offsets(in_triangles, slots);
  hinge_begin_ = offsets(in_hinges, slots);
  particle_triangle_begin_ = offsets(at_triangles, particles);
  particle_hinge_begin_ = offsets(at_hinges, particles);
  triangle_parts_.reserve(in_triangles.size());
  hinge_parts_.reserve(in_hinges.size());
  particle_triangles_.reserve(at_triangles.size());
  particle_hinges_.reserve(at_hinges.size());
  for (const auto& part : in_triangles) triangle_parts_.push_back(part.second);
  for (const auto& part : in_hinges) hinge_parts_.push_back(part.second);
  for (const auto& part : at_triangles) particle_triangles_.push_back(part.second);
  for (const auto& part : at_hinges) particle_hinges_.push_back(part.second);
}

void Elements::evaluate(const ClothModel& model, const ClothState& state) {
  const Vec3s &x = state.x, &v = state.v;
  if (rest_version_ != model.rest_version) pack_rest(model);
  for_batches(rest_.size(), [&](std::size_t begin, std::size_t end) {
    evaluate_membranes(rest_.data(), begin, end, x.data(), v.data(), state_.data());
  });
  parallel_for(hinges_.size(), element_grain, [&](std::size_t h) {
    std::array<Vec3, 4> corner_x, corner_v;
    for (std::size_t c = 0; c < 4; ++c) {
      corner_x[c] = x[static_cast<std::size_t>(hinges_[h].particle[c])];
      corner_v[c] = v[static_cast<std::size_t>(hinges_[h].particle[c])];
    }
    bend_[h] = bend_response(model.bend[h], corner_x, corner_v);
  });
  if (threads_) threads_->evaluate(x, v);
  if (turned_.empty()) return;
  // A relaxation time tau: angle and rate have one moment, that of C + tau dC/dt.
  parallel_for(hinges_.size(), element_grain, [&](std::size_t h) {
    turned_[h] =
        bend_[h].degenerate() ? 0 : bend_[h].theta - bend_rest_[h].theta_0 + bend_rest_[h].tau_s * bend_[h].theta_dot;
  });
  if (memory_) memory_->subtract_rest(turned_);
  find_moments(plate_moment_);
}

// Of hinges folded by turned_.
void Elements::find_moments(std::span<double> moment) {
  if (plates_)
    plates_->solve(turned_, moment);
  else
    std::fill(moment.begin(), moment.end(), 0);
  add_line_moments(*model_, turned_, moment);
}

void Elements::follow_bends(const ClothModel& model, std::span<const Vec3> x, double h_s) {
  if (!memory_) return;
  parallel_for(hinges_.size(), element_grain, [&](std::size_t h) {
    std::array<Vec3, 4> corners;
    for (std::size_t c = 0; c < 4; ++c) corners[c] = x[at(hinges_[h].particle[c])];
    const BendResponse still = bend_response({}, corners, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
    turned_[h] = still.degenerate() ? 0 : still.theta - bend_rest_[h].theta_0;
  });
  memory_->subtract_rest(turned_);
  plates_->solve(turned_, plate_moment_);
  memory_->follow(model, plate_moment_, h_s);
}

double Elements::energy_J() {
  double energy = threads_ ? threads_->energy_J() : 0;
  if (!turned_.empty()) {
    for (std::size_t h = 0; h < hinges_.size(); ++h)
      turned_[h] = bend_[h].degenerate() ? 0 : bend_[h].theta - bend_rest_[h].theta_0;
    if (memory_) memory_->subtract_rest(turned_);
    std::vector<double> moment(hinges_.size());
    find_moments(moment);
    for (std::size_t h = 0; h < hinges_.size(); ++h) energy += 0.5 * moment[h] * turned_[h];
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) energy += state_[t / batch_size].energy_J[t % batch_size];
  for (std::size_t h = 0; h < bend_.size(); ++h) energy += bend_[h].energy_J(bend_rest_[h]);
  return energy;
}

int Elements::degenerate_hinges() const {
  return static_cast<int>(
      std::count_if(bend_.begin(), bend_.end(), [](const BendResponse& r) { return r.degenerate(); }));
}

void Elements::gather(std::span<Vec3> f, double sign) const {
  parallel_for(f.size(), element_grain, [&](std::size_t i) {
    Vec3 sum = Vec3::Zero();
    for (auto k = particle_triangle_begin_[i]; k < particle_triangle_begin_[i + 1]; ++k) {
      const auto [t, corner] = particle_triangles_[static_cast<std::size_t>(k)];
      sum += of_triangles_[static_cast<std::size_t>(t)].col(corner);
    }
    for (auto k = particle_hinge_begin_[i]; k < particle_hinge_begin_[i + 1]; ++k) {
      const auto [h, corner] = particle_hinges_[static_cast<std::size_t>(k)];
      sum += of_hinges_[static_cast<std::size_t>(h)] * bend_[static_cast<std::size_t>(h)].g[corner];
    }
    f[i] += sign * sum;
  });
}

void Elements::forces(std::span<Vec3> f) const {
  for_batches(rest_.size(),
              [&](std::size_t begin, std::size_t end) { membrane_forces(batches(begin, end), of_triangles_.data()); });
  parallel_for(hinges_.size(), element_grain, [&](std::size_t h) {
    of_hinges_[h] = bend_[h].moment + bend_[h].damping + (plate_moment_.empty() ? 0 : plate_moment_[h]);
  });
  std::fill(f.begin(), f.end(), Vec3::Zero());
  gather(f, -1);
  if (threads_) threads_->add_forces(f);
}

void Elements::subtract_stiffness(std::span<const Vec3> displacement, std::span<const Vec3> velocity,
                                  std::span<Vec3> f) const {
  const Vec3* moving = velocity.empty() ? nullptr : velocity.data();
  for_batches(rest_.size(), [&](std::size_t begin, std::size_t end) {
    membrane_stiffness_times(batches(begin, end), displacement.data(), moving, of_triangles_.data());
  });
  parallel_for(hinges_.size(), element_grain, [&](std::size_t h) {
    double angle = 0, rate = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const auto i = static_cast<std::size_t>(hinges_[h].particle[c]);
      angle += bend_[h].g[c].dot(displacement[i]);
      if (moving) rate += bend_[h].g[c].dot(moving[i]);
    }
    of_hinges_[h] = in_matrix_N_m(bend_rest_[h]) * (angle + bend_rest_[h].tau_s * rate);
  });
  gather(f, -1);
  if (threads_) threads_->subtract_stiffness(displacement, velocity, f);
}

template <class T>
void Elements::assemble(double h_s, BlockMatrix<T>& A) {
  const double h2 = h_s * h_s;
  for_batches(rest_.size(), [&](std::size_t begin, std::size_t end) {
    membrane_blocks(batches(begin, end), h_s, of_triangles_.data());
  });
  for (std::size_t h = 0; h < hinges_.size(); ++h)
    of_hinges_[h] = (h2 + h_s * bend_rest_[h].tau_s) * in_matrix_N_m(bend_rest_[h]);
  const auto slots = [&](std::size_t begin, std::size_t end) {
    if constexpr (std::is_same_v<T, float>) {
      gather_blocks({triangle_begin_.data(), hinge_begin_.data(), triangle_parts_.data(), hinge_parts_.data()},
                    static_cast<Slot>(begin), static_cast<Slot>(end), of_triangles_.data(), bend_.data(),
                    of_hinges_.data(), A.blocks().data());
    } else {  // where single precision is not enough (solver/step_solver.hpp), and for references
      for (std::size_t s = begin; s < end; ++s) {
        Mat3 block = Mat3::Zero();  // above the diagonal
        for (auto k = triangle_begin_[s]; k < triangle_begin_[s + 1]; ++k) {
          const auto [triangle, pair] = triangle_parts_[static_cast<std::size_t>(k)];
          block += of_triangles_[3 * static_cast<std::size_t>(triangle) + pair];
        }
        for (auto k = hinge_begin_[s]; k < hinge_begin_[s + 1]; ++k) {
          const auto [hinge, a, b] = hinge_parts_[static_cast<std::size_t>(k)];
          const auto h = static_cast<std::size_t>(hinge);
          block += (of_hinges_[h] * bend_[h].g[a]) * bend_[h].g[b].transpose();
        }
        A.below(static_cast<Slot>(s)) = Block<T>::from(block.transpose());
      }
    }
  };
  parallel_blocks(static_cast<std::size_t>(pattern_->block_count()), element_grain, std::cref(slots));
  if (threads_) threads_->assemble(h_s, A);
  A.update_diagonal();
}

void Elements::stretch(std::span<const Vec3> x, std::span<Vec2> w) const {
  const std::size_t whole = triangles_.size() / batch_size;
  for_batches(whole, [&](std::size_t begin, std::size_t end) {
    membrane_stretch(rest_.data(), begin, end, x.data(), w.data());
  });
  if (whole == rest_.size()) return;
  std::array<Vec2, batch_size> last;
  membrane_stretch(&rest_[whole], 0, 1, x.data(), last.data());
  std::copy_n(last.begin(), triangles_.size() - whole * batch_size,
              w.begin() + static_cast<std::ptrdiff_t>(whole * batch_size));
}

Elements::BeyondLinear Elements::energy_beyond_linear(std::span<const Vec3> x) {
  for_batches(rest_.size(), [&](std::size_t begin, std::size_t end) {
    membrane_energy_beyond(batches(begin, end), x.data(), beyond_linear_.data());
  });
  BeyondLinear sum;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    sum.made += std::max(0.0, beyond_linear_[t]);
    sum.net += beyond_linear_[t];
  }
  return sum;
}

MembraneResponse Elements::membrane(Index triangle) const {
  const auto t = static_cast<std::size_t>(triangle);
  return membrane_response_of(rest_[t / batch_size], state_[t / batch_size], t % batch_size, form_);
}

template void Elements::assemble(double, BlockMatrix<float>&);
template void Elements::assemble(double, BlockMatrix<double>&);

}  // namespace toile::internal
