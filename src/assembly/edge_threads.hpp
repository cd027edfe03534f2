// assembly/edge_threads.hpp: the threads along finished edges, a hem or a tape, which resist stretch.     material/edge_finish.hpp
//
//   e = l/L - 1,   N = K (c e + tau de/dt),   c the compression ratio where e < 0, else 1           forces N n and -N n, n along the edge
//   matrix:  (c K/L) n n^T, and where pulled (K e/l) (I - n n^T), the turning of a tight thread: both semidefinite
//
// L follows rest stretch and gathers, K the panel's share of stiffness, as the triangle does that has the edge.
#pragma once
#include "assembly/block_matrix.hpp"
#include "assembly/cloth_model.hpp"

#include <span>
#include <vector>

namespace toile::internal {

class EdgeThreads {
 public:
  EdgeThreads(const ClothModel& model, const BlockPattern& pattern);

  void pack(const ClothModel& model);  // again, after the model's rest shapes or stiffness have changed
  void evaluate(std::span<const Vec3> x, std::span<const Vec3> v);
  double energy_J() const;

  void add_forces(std::span<Vec3> f) const;
  // f -= K displacement + D velocity; an empty velocity is none.
  void subtract_stiffness(std::span<const Vec3> displacement, std::span<const Vec3> velocity, std::span<Vec3> f) const;
  // Off-diagonal blocks of h D + h^2 K; the diagonal is the caller's to update.
  template <class T>
  void assemble(double h_s, BlockMatrix<T>& A) const;

 private:
  struct Thread {
    Index a = 0, b = 0;
    Slot slot = 0;
    double length_m = 0, stiffness_N = 0, compression_ratio = 1, tau_s = 0;
    // Of the last evaluate():
    double energy_J = 0, tension_N = 0;  // tension with damping
    Vec3 n = Vec3::Zero();
    Mat3 K = Mat3::Zero();  // N/m
    Mat3 D = Mat3::Zero();  // N s/m
  };
  std::vector<Thread> threads_;
};

extern template void EdgeThreads::assemble(double, BlockMatrix<float>&) const;
extern template void EdgeThreads::assemble(double, BlockMatrix<double>&) const;

}  // namespace toile::internal
