#include "assembly/edge_threads.hpp"

#include <algorithm>

namespace toile::internal {

EdgeThreads::EdgeThreads(const ClothModel& model, const BlockPattern& pattern) {
  threads_.resize(model.threads.size());
  for (std::size_t k = 0; k < threads_.size(); ++k) {
    threads_[k].a = model.threads[k].a;
    threads_[k].b = model.threads[k].b;
    threads_[k].slot = pattern.slot(std::min(threads_[k].a, threads_[k].b), std::max(threads_[k].a, threads_[k].b));
  }
  pack(model);
}

void EdgeThreads::pack(const ClothModel& model) {
  for (std::size_t k = 0; k < threads_.size(); ++k) {
    const EdgeThread& of = model.threads[k];
    const auto t = at(of.triangle);
    const std::array<Vec2, 3> uv = model.rest_uv(t);
    const Vec2 side = uv[(of.side + 1U) % 3] - uv[of.side];
    const MembraneRest& rest = model.membrane[t];
    const MembraneStiffness& cloth = model.stiffness_of(t);
    const double share = model.stiffness_share.empty() ? 1 : model.stiffness_share[at(model.mesh.panel[t])].stretch;
    threads_[k].length_m = Vec2(rest.b_u * side.x(), rest.b_v * side.y()).norm();
    threads_[k].stiffness_N = model.finished * share * of.stretch_N;
    threads_[k].compression_ratio = cloth.compression;
    threads_[k].tau_s = cloth.tau_stretch;
  }
}

void EdgeThreads::evaluate(std::span<const Vec3> x, std::span<const Vec3> v) {
  for (Thread& thread : threads_) {
    const Vec3 d = x[at(thread.b)] - x[at(thread.a)];
    const double l = d.norm(), L = thread.length_m;
    thread.K.setZero();
    thread.D.setZero();
    thread.energy_J = thread.tension_N = 0;
    thread.n = Vec3::Zero();
    if (!(l > 0)) continue;  // no direction: the triangle's own threads part its corners
    const Vec3 n = d / l;
    const double e = l / L - 1, stiffness = e < 0 ? thread.compression_ratio * thread.stiffness_N : thread.stiffness_N;
    const double elastic_N = stiffness * e, damping_N_s = thread.stiffness_N * thread.tau_s;
    thread.n = n;
    thread.energy_J = 0.5 * elastic_N * e * L;
    thread.tension_N = elastic_N + damping_N_s * (v[at(thread.b)] - v[at(thread.a)]).dot(n) / L;
    const Mat3 along = n * n.transpose();
    thread.K = stiffness / L * along;
    if (elastic_N > 0) thread.K += elastic_N / l * (Mat3::Identity() - along);
    thread.D = damping_N_s / L * along;
  }
}

double EdgeThreads::energy_J() const {
  double energy = 0;
  for (const Thread& thread : threads_) energy += thread.energy_J;
  return energy;
}

void EdgeThreads::add_forces(std::span<Vec3> f) const {
  for (const Thread& thread : threads_) {
    const Vec3 pull = thread.tension_N * thread.n;
    f[at(thread.a)] += pull;
    f[at(thread.b)] -= pull;
  }
}

void EdgeThreads::subtract_stiffness(std::span<const Vec3> displacement, std::span<const Vec3> velocity,
                                     std::span<Vec3> f) const {
  for (const Thread& thread : threads_) {
    Vec3 change = thread.K * (displacement[at(thread.b)] - displacement[at(thread.a)]);
    if (!velocity.empty()) change += thread.D * (velocity[at(thread.b)] - velocity[at(thread.a)]);
    f[at(thread.a)] += change;
    f[at(thread.b)] -= change;
  }
}

template <class T>
void EdgeThreads::assemble(double h_s, BlockMatrix<T>& A) const {
  for (const Thread& thread : threads_) {
    const Block<T> block = Block<T>::from(Mat3(h_s * h_s * thread.K + h_s * thread.D));
    Block<T>& below = A.below(thread.slot);
    below.c0 -= block.c0;
    below.c1 -= block.c1;
    below.c2 -= block.c2;
  }
}

template void EdgeThreads::assemble(double, BlockMatrix<float>&) const;
template void EdgeThreads::assemble(double, BlockMatrix<double>&) const;

}  // namespace toile::internal
