#include "step/explicit_reference.hpp"

#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

constexpr int power_iterations = 200;

// A start without symmetry: the fractional parts of multiples of the golden ratio.
Vec3s rough(std::size_t n) {
  Vec3s u(n);
  double turn = 0;
  for (Vec3& u_i : u) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      turn += 0.6180339887498949;
      turn -= std::floor(turn);
      u_i[c] = turn - 0.5;
    }
  }
  return u;
}

}  // namespace

ExplicitReference::ExplicitReference(const ClothModel& model, std::vector<Index> held)
    : model_(&model), elements_(model), held_(at(model.particle_count()), 0) {
  for (const Index i : held) held_[at(i)] = 1;
  for (Vec3s& a : a_) a.resize(held_.size());
}

void ExplicitReference::accelerations(const ClothState& state, Vec3s& a) {
  elements_.evaluate(*model_, state);
  elements_.forces(a);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (held_[i])
      a[i].setZero();
    else
      a[i] = a[i] / model_->mass_kg[i] + model_->gravity_m_per_s2 - model_->drag_per_s * state.v[i];
  }
}

void ExplicitReference::step(ClothState& state, double h_s, ExplicitScheme scheme) {
  const std::size_t n = state.x.size();
  accelerations(state, a_[0]);
  if (scheme == ExplicitScheme::symplectic_euler) {
    for (std::size_t i = 0; i < n; ++i) {
      state.v[i] += h_s * a_[0][i];
      state.x[i] += h_s * state.v[i];
    }
    return;
  }
  // x'' = a(x, x'): the velocities of the stages are v, v + h/2 a0, v + h/2 a1, v + h a2.
  stage_ = state;
  for (int k = 0; k < 3; ++k) {
    const double part = k < 2 ? 0.5 * h_s : h_s;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 velocity = k == 0 ? state.v[i] : Vec3(state.v[i] + 0.5 * h_s * a_[k - 1][i]);
      stage_.x[i] = state.x[i] + part * velocity;
      stage_.v[i] = state.v[i] + part * a_[k][i];
    }
    accelerations(stage_, a_[k + 1]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    state.x[i] += h_s * state.v[i] + (h_s * h_s / 6) * (a_[0][i] + a_[1][i] + a_[2][i]);
    state.v[i] += (h_s / 6) * (a_[0][i] + 2 * a_[1][i] + 2 * a_[2][i] + a_[3][i]);
  }
}

ExplicitLimit ExplicitReference::limit(const ClothState& state) {
  const std::size_t n = state.x.size();
  // Forces are -K u where u displaces, and -D u where it moves: the largest |M^-1 . u| / |u| in the norm of M.
  const auto largest = [&](const auto& product) {
    Vec3s u = rough(n), f(n);
    double eigenvalue = 0;
    for (int k = 0; k < power_iterations; ++k) {
      double size2 = 0;
      for (std::size_t i = 0; i < n; ++i) {
        if (held_[i]) u[i].setZero();
        size2 += model_->mass_kg[i] * u[i].squaredNorm();
      }
      if (!(size2 > 0)) return 0.0;
      for (Vec3& u_i : u) u_i /= std::sqrt(size2);
      product(u, f);
      eigenvalue = 0;
      for (std::size_t i = 0; i < n; ++i) {
        eigenvalue -= u[i].dot(f[i]);
        u[i] = -f[i] / model_->mass_kg[i];
      }
    }
    return eigenvalue;
  };
  ClothState still = state;
  for (Vec3& v : still.v) v.setZero();
  elements_.evaluate(*model_, still);
  Vec3s elastic(n);
  elements_.forces(elastic);
  ExplicitLimit limit;
  limit.omega_per_s = std::sqrt(largest([&](const Vec3s& u, Vec3s& f) {
    f.assign(n, Vec3::Zero());
    elements_.subtract_stiffness(u, f);
  }));
  limit.gamma_per_s = model_->drag_per_s + largest([&](const Vec3s& u, Vec3s& f) {
                        still.v = u;
                        elements_.evaluate(*model_, still);
                        elements_.forces(f);
                        for (std::size_t i = 0; i < n; ++i) f[i] -= elastic[i];
                      });
  const double w = limit.omega_per_s, g = limit.gamma_per_s;
  // The same as above without the difference of two close numbers.
  limit.h_s = w > 0 || g > 0 ? 4 / (std::sqrt(g * g + 4 * w * w) + g) : std::numeric_limits<double>::infinity();
  return limit;
}

bool ExplicitReference::stands(ClothState state, double h_s, int steps, ExplicitScheme scheme) {
  std::vector<Vec2> w(model_->mesh.triangles.size());
  for (int k = 0; k < steps; ++k) {
    step(state, h_s, scheme);
    elements_.stretch(state.x, w);
    for (std::size_t t = 0; t < w.size(); ++t) {
      const MembraneRest& rest = model_->membrane[t];
      if (!(w[t].x() < 2 * rest.b_u && w[t].y() < 2 * rest.b_v)) return false;
    }
  }
  return true;
}

double ExplicitReference::energy_J(const ClothState& state) {
  elements_.evaluate(*model_, state);
  double energy = elements_.energy_J();
  for (std::size_t i = 0; i < state.x.size(); ++i)
    energy += model_->mass_kg[i] * (0.5 * state.v[i].squaredNorm() - model_->gravity_m_per_s2.dot(state.x[i]));
  return energy;
}

}  // namespace toile::internal
