#include "assembly/plate_moments.hpp"

#include "core/parallel.hpp"

#include <Eigen/LU>  // inverse
#include <algorithm>
#include <functional>

namespace toile::internal {
namespace {

constexpr std::size_t grain = 2048;   // hinges per block of work
constexpr double tolerance = 1e-6;    // of the residual, by the inverse of the diagonal
constexpr int most_iterations = 200;  // some twenty are needed on good triangles

// sum(begin, end) over blocks, added in order.
template <class Sum>
double ordered_sum(std::size_t count, std::vector<double>& parts, const Sum& sum) {
  const auto block = [&](std::size_t begin, std::size_t end) { parts[begin / grain] = sum(begin, end); };
  parallel_blocks(count, grain, std::cref(block));  // by reference: no copy of the lambda on the heap
  double total = 0;
  for (const double part : parts) total += part;
  return total;
}

}  // namespace

std::vector<std::array<Index, 3>> hinges_of_sides(const Topology& topology) {
  // Hinges are sorted by their edge, as the edges are.
  std::vector<Index> of_edge(topology.edges.size(), -1);
  Index next = 0;
  for (std::size_t e = 0; e < of_edge.size(); ++e)
    if (topology.edges[e].triangle[1] >= 0) of_edge[e] = next++;
  std::vector<std::array<Index, 3>> sides(topology.triangle_edges.size());
  for (std::size_t t = 0; t < sides.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) sides[t][k] = of_edge[at(topology.triangle_edges[t][k])];
  return sides;
}

std::vector<double> plate_bounds_N_m(const Topology& topology, std::span<const Mat3> compliance) {
  const std::vector<std::array<Index, 3>> sides = hinges_of_sides(topology);
  std::vector<double> bounds(topology.hinges.size(), 0);
  for (std::size_t t = 0; t < sides.size(); ++t) {
    Mat3 F = compliance[t];
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (sides[t][static_cast<std::size_t>(k)] >= 0) continue;  // free: no moment
      F.row(k).setZero();
      F.col(k).setZero();
      F(k, k) = 1;
    }
    const Mat3 Q = F.inverse();
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Index hinge = sides[t][static_cast<std::size_t>(k)];
      if (hinge >= 0) bounds[at(hinge)] += 0.25 * Q.row(k).cwiseAbs().sum();
    }
  }
  return bounds;
}

PlateMoments::PlateMoments(const ClothModel& model)
    : rows_(model.topology.hinges.size()),
      r_(rows_.size()),
      p_(rows_.size()),
      q_(rows_.size()),
      sums_((rows_.size() + grain - 1) / grain) {
  pack(model);
}

void PlateMoments::pack(const ClothModel& model) {
  const std::vector<std::array<Index, 3>> sides = hinges_of_sides(model.topology);
  for (std::size_t h = 0; h < rows_.size(); ++h) {
    Row& row = rows_[h];
    row.diagonal = 0;
    row.entry.fill(0);
    row.other.fill(static_cast<Index>(h));
    std::size_t next = 0;
    for (const Index triangle : model.topology.hinges[h].triangle) {
      const std::array<Index, 3>& side = sides[at(triangle)];
      const Mat3& F = model.plate_compliance[at(triangle)];
      const auto own = std::find(side.begin(), side.end(), static_cast<Index>(h)) - side.begin();
      row.diagonal += F(own, own);
      for (const auto k : {(own + 1) % 3, (own + 2) % 3}) {
        if (const Index other = side[static_cast<std::size_t>(k)]; other >= 0) {
          row.other[next] = other;
          row.entry[next] = F(own, k);
        }
        ++next;
      }
    }
  }
}

// Conjugate gradients with the diagonal; F is well conditioned on any mesh of decent triangles, since no derivative is in it.
void PlateMoments::solve(std::span<const double> C, std::span<double> m) {
  const std::size_t count = rows_.size();
  double rz = ordered_sum(count, sums_, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t h = begin; h < end; ++h) {
      m[h] = 0;
      r_[h] = C[h];
      p_[h] = C[h] / rows_[h].diagonal;
      sum += C[h] * p_[h];
    }
    return sum;
  });
  const double enough = tolerance * tolerance * rz;
  for (int iteration = 0; iteration < most_iterations && rz > enough; ++iteration) {
    const double pq = ordered_sum(count, sums_, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t h = begin; h < end; ++h) {
        const Row& row = rows_[h];
        q_[h] = row.diagonal * p_[h];
        for (std::size_t k = 0; k < 4; ++k) q_[h] += row.entry[k] * p_[at(row.other[k])];
        sum += p_[h] * q_[h];
      }
      return sum;
    });
    const double alpha = rz / pq;
    const double before = rz;
    rz = ordered_sum(count, sums_, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t h = begin; h < end; ++h) {
        m[h] += alpha * p_[h];
        r_[h] -= alpha * q_[h];
        sum += r_[h] * r_[h] / rows_[h].diagonal;
      }
      return sum;
    });
    const double beta = rz / before;
    parallel_for(count, grain, [&](std::size_t h) { p_[h] = r_[h] / rows_[h].diagonal + beta * p_[h]; });
  }
}

}  // namespace toile::internal
