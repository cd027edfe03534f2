// assembly/air.hpp: the pressure and the friction of air on every triangle, still or in wind.              [BW98 4.4]
//
//   u    = mean of the corners' velocities - wind              u_n = n.u,   u_t = u - u_n n
//   F    = -rho a/2 ( c_n |u_n| u_n n  +  c_t |u_t| u_t )      a third on each corner;  a: the triangle's area now
//   B    = -dF/du = rho a ( c_n |u_n| n n^T  +  c_t/2 (|u_t| (I - n n^T) + u_t u_t^T / |u_t|) )
//   in A   h B/9 on all nine blocks of a triangle: semidefinite in any wind
//
// dF/dx, through n and a, is left out: it is not symmetric.
//
// Easily got wrong: this acts on the motion of a triangle's centroid.  Air does not damp a flutter of the corners about
// it; damping of bend and stretch does.
#pragma once
#include "assembly/force.hpp"
#include "core/bucket_order.hpp"

#include <functional>
#include <span>
#include <vector>

namespace toile::internal {

struct AirOptions {
  Vec3 wind_m_per_s{0, 0, 0};
  double density_kg_per_m3 = 1.2;        // at sea level;  0: no air
  double normal_coefficient = 1.2;       // c_n: a flat plate across the stream
  double tangential_coefficient = 0.02;  // c_t: both sides of a plate along it
};

class Air final : public Force {
 public:
  // `wind`: in a step that ends at t_s; empty: the options' at all times.
  explicit Air(const AirOptions& options, std::function<Vec3(double t_s)> wind = {})
      : options_(options), wind_(std::move(wind)) {}

  bool acts(double) override { return options_.density_kg_per_m3 > 0; }
  void prepare(const ClothModel& model, const BlockPattern& pattern) override;
  void evaluate(const ClothState& state, double end_s) override;
  void add_forces(std::span<Vec3> f) const override;
  void add_damping(std::span<const Vec3> u, std::span<Vec3> f) const override;
  void assemble(double h_s, BlockMatrix<float>& A) const override;
  void assemble(double h_s, BlockMatrix<double>& A) const override;

 private:
  template <class T>
  void add_to(BlockMatrix<T>& A, double h_s) const;

  AirOptions options_;
  std::function<Vec3(double t_s)> wind_;
  std::vector<Triangle> triangles_;
  BucketOrder at_slots_, at_particles_;  // sides and corners, numbered three per triangle
  std::vector<Vec3> force_;              // [triangle]
  std::vector<Mat3> B_;                  // [triangle]
};

}  // namespace toile::internal
