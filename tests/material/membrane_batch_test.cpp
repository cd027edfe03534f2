#include "material/membrane_batch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "material/random_elements.hpp"
#include "support/every_target.hpp"

namespace toile::internal {
namespace {

constexpr std::size_t batches = 40, triangles = batches * batch_size, particles = 200;
constexpr double h_s = 1.0 / 60;

// Triangles that have nothing to do with each other, some of them beyond a strain limit, some squeezed to nothing.
struct Batches {
  std::vector<MembraneRest> rest;
  std::vector<MembraneStiffness> k;
  std::vector<Triangle> corners;
  Vec3s x, v, end;
  std::vector<MembraneRestBatch> packed{batches};
  MembraneForm form;

  explicit Batches(DampingJacobian damping) {
    form.damping_jacobian = damping;
    Random random(7);
    for (Vec3s* of : {&x, &v, &end}) {
      for (std::size_t i = 0; i < particles; ++i) of->push_back(random.vector(of == &v ? 3 : 0.02));
    }
    for (std::size_t t = 0; t < triangles; ++t) {
      const RestTriangle triangle = random_rest_triangle(random);
      rest.push_back(triangle.membrane);
      rest.back().alpha *= triangle.size / 0.02;  // as large as the particles are apart
      rest.back().beta *= triangle.size / 0.02;
      k.push_back(random_stiffness(random));
      if (t / batch_size % 3 == 0) k.back().strain_limit = 0.05;
      if (t % 5 == 0) k.back().compression = 0.1;
      Triangle c = {random.below(50), 50 + random.below(50), 100 + random.below(50)};
      if (t % 2 == 0) std::swap(c[0], c[2]);
      if (t % 3 == 0) std::swap(c[0], c[1]);
      if (t == 100) c = {c[0], c[0], c[0]};
      corners.push_back(c);
      packed[t / batch_size].set(t % batch_size, rest[t], k[t], c);
    }
  }
  std::array<Vec3, 3> at(const Vec3s& of, std::size_t t) const {
    std::array<Vec3, 3> corner;
    for (std::size_t c = 0; c < 3; ++c) corner[c] = of[static_cast<std::size_t>(corners[t][c])];
    return corner;
  }
};

struct Results {
  std::vector<MembraneStateBatch> state{batches};
  std::vector<Mat3> force{triangles}, stiffness_times{triangles}, with_damping{triangles}, blocks{3 * triangles};
  Vec2s stretch{triangles};
  std::vector<double> beyond = std::vector<double>(triangles);

  explicit Results(const Batches& of) {
    std::memset(static_cast<void*>(state.data()), 0, state.size() * sizeof state[0]);
    evaluate_membranes(of.packed.data(), 0, batches, of.x.data(), of.v.data(), state.data());
    const MembraneBatches all{of.packed.data(), state.data(), 0, batches, of.form};
    membrane_forces(all, force.data());
    membrane_stiffness_times(all, of.end.data(), nullptr, stiffness_times.data());
    membrane_stiffness_times(all, of.end.data(), of.v.data(), with_damping.data());
    membrane_blocks(all, h_s, blocks.data());
    membrane_stretch(of.packed.data(), 0, batches, of.end.data(), stretch.data());
    membrane_energy_beyond(all, of.end.data(), beyond.data());
  }
};

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::memcmp(static_cast<const void*>(a.data()), static_cast<const void*>(b.data()), a.size() * sizeof a[0]) ==
         0;
}

TEST(MembraneBatch, GivesTheSameBitsOnEveryInstructionSet) {
  for (const auto damping : {DampingJacobian::gauss_newton, DampingJacobian::paper}) {
    const Batches of(damping);
    const Results widest(of);
    const int targets = test::on_every_target([&](const char* name) {
      const Results r(of);
      EXPECT_TRUE(same(r.state, widest.state)) << name;
      EXPECT_TRUE(same(r.force, widest.force)) << name;
      EXPECT_TRUE(same(r.stiffness_times, widest.stiffness_times)) << name;
      EXPECT_TRUE(same(r.with_damping, widest.with_damping)) << name;
      EXPECT_TRUE(same(r.blocks, widest.blocks)) << name;
      EXPECT_TRUE(same(r.stretch, widest.stretch)) << name;
      EXPECT_TRUE(same(r.beyond, widest.beyond)) << name;
    });
    EXPECT_GE(targets, 2);
  }
}

// Against the response of each triangle alone, combined as assembly and right-hand side combine it.
TEST(MembraneBatch, EveryLaneIsATriangleOfItsOwn) {
  for (const auto damping : {DampingJacobian::gauss_newton, DampingJacobian::paper}) {
    const Batches of(damping);
    const Results got(of);
    int limited = 0;
    for (std::size_t t = 0; t < triangles; ++t) {
      const MembraneResponse r = membrane_response(of.rest[t], of.k[t], of.at(of.x, t), of.at(of.v, t), damping);
      ASSERT_TRUE(std::isfinite(r.energy_J)) << t;
      limited += of.k[t].strain_limit > 0 && r.w_u.norm() > 1.1;
      const Vec3 &alpha = of.rest[t].alpha, &beta = of.rest[t].beta;
      const auto columns = [&](const Vec3s& corners) {
        const std::array<Vec3, 3> corner = of.at(corners, t);
        Vec3 u = Vec3::Zero(), v = Vec3::Zero();
        for (std::size_t c = 0; c < 3; ++c) {
          u += alpha[static_cast<Eigen::Index>(c)] * corner[c];
          v += beta[static_cast<Eigen::Index>(c)] * corner[c];
        }
        return std::pair(u, v);
      };
      const auto [w_u, w_v] = columns(of.end);
      const Vec3 Kw_u = r.K.uu * w_u + r.K.uv * w_v, Kw_v = r.K.uv.transpose() * w_u + r.K.vv * w_v;
      const auto [v_u, v_v] = columns(of.v);
      const Vec3 Dv_u = r.D.uu * v_u + r.D.uv * v_v, Dv_v = r.D.uv.transpose() * v_u + r.D.vv * v_v;
      for (Eigen::Index c = 0; c < 3; ++c) {
        EXPECT_EQ(got.force[t].col(c), alpha[c] * (r.P_u + r.Q_u) + beta[c] * (r.P_v + r.Q_v)) << t;
        const Vec3 f = alpha[c] * Kw_u + beta[c] * Kw_v;
        EXPECT_LE((got.stiffness_times[t].col(c) - f).norm(), 1e-13 * (std::abs(alpha[c]) + std::abs(beta[c])) *
                                                                  (r.K.uu.norm() + r.K.uv.norm() + r.K.vv.norm()) *
                                                                  (w_u.norm() + w_v.norm()))
            << t;
        const Vec3 with_damping = f + alpha[c] * Dv_u + beta[c] * Dv_v;
        EXPECT_LE((got.with_damping[t].col(c) - with_damping).norm(),
                  1e-13 * (std::abs(alpha[c]) + std::abs(beta[c])) *
                      ((r.K.uu.norm() + r.K.uv.norm() + r.K.vv.norm()) * (w_u.norm() + w_v.norm()) +
                       (r.D.uu.norm() + r.D.uv.norm() + r.D.vv.norm()) * (v_u.norm() + v_v.norm())))
            << t;
      }
      EXPECT_EQ(got.stretch[t], Vec2(w_u.norm(), w_v.norm())) << t;
      const FMatrix H{h_s * h_s * r.K.uu + h_s * r.D.uu, h_s * h_s * r.K.uv + h_s * r.D.uv,
                      h_s * h_s * r.K.vv + h_s * r.D.vv};
      for (std::size_t p = 0; p < 3; ++p) {
        Eigen::Index a = static_cast<Eigen::Index>(p), b = static_cast<Eigen::Index>((p + 1) % 3);
        if (!(of.corners[t][p] < of.corners[t][(p + 1) % 3])) std::swap(a, b);  // rows of the lower one
        const Mat3 block = alpha[a] * alpha[b] * H.uu + alpha[a] * beta[b] * H.uv +
                           beta[a] * alpha[b] * H.uv.transpose() + beta[a] * beta[b] * H.vv;
        EXPECT_EQ(got.blocks[3 * t + p], block) << t;
      }
      const Vec3 u = w_u - r.w_u, v = w_v - r.w_v;
      const double end_J = membrane_energy(of.rest[t], of.k[t], w_u, w_v);
      const double known_J = r.energy_J + u.dot(r.P_u) + v.dot(r.P_v) + 0.5 * u.dot(r.K.uu * u) + u.dot(r.K.uv * v) +
                             0.5 * v.dot(r.K.vv * v);
      EXPECT_NEAR(got.beyond[t], end_J - known_J, 1e-12 * (end_J + r.energy_J + std::abs(known_J))) << t;
    }
    EXPECT_GT(limited, 10);
  }
}

}  // namespace
}  // namespace toile::internal
