// material/random_elements.hpp: triangles and hinges in every state that a garment can get into, for the tests here.
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "material/condition.hpp"
#include "material/membrane.hpp"

namespace toile::internal {

// The same numbers on every platform: std::uniform_real_distribution does not promise that.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1.0p-53);
  }
  int below(int count) { return static_cast<int>(bits_() % static_cast<std::uint64_t>(count)); }
  Vec3 vector(double size) {
    const double a = uniform(-size, size), b = uniform(-size, size), c = uniform(-size, size);
    return {a, b, c};
  }
  Vec3 direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  Mat3 rotation() {
    const Vec3 axis = direction();
    return Eigen::AngleAxisd(uniform(-3, 3), axis).toRotationMatrix();
  }
  template <std::size_t N>
  std::array<Vec3, N> vectors(double size) {
    std::array<Vec3, N> out;
    for (Vec3& v : out) v = vector(size);
    return out;
  }

 private:
  std::mt19937_64 bits_;
};

struct RestTriangle {
  std::array<Vec2, 3> uv;
  Vec3 alpha, beta;
  double area = 0, size = 0;  // m^2, m
  MembraneRest membrane;      // with scale2 = area
};

// alpha and beta from their definition: sum alpha_i u_i = 1, sum alpha_i v_i = 0, sum alpha_i = 0, and so for beta.
inline RestTriangle rest_triangle(const std::array<Vec2, 3>& uv) {
  RestTriangle t;
  t.uv = uv;
  const Vec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
  const double d = d1.x() * d2.y() - d2.x() * d1.y();
  t.area = 0.5 * std::abs(d);
  t.size = std::sqrt(t.area);
  t.alpha = Vec3(-(d2.y() - d1.y()), d2.y(), -d1.y()) / d;
  t.beta = Vec3(-(d1.x() - d2.x()), -d2.x(), d1.x()) / d;
  t.membrane.alpha = t.alpha;
  t.membrane.beta = t.beta;
  t.membrane.scale2 = t.area;
  return t;
}

inline RestTriangle random_rest_triangle(Random& random) {
  for (;;) {
    const double size = random.uniform(0.005, 0.05);
    std::array<Vec2, 3> uv;
    for (Vec2& p : uv) {
      const double v = random.uniform(-size, size), u = random.uniform(-size, size);
      p = Vec2(u, v);
    }
    const Vec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
    const double d = d1.x() * d2.y() - d2.x() * d1.y();
    const double longest = std::max({d1.norm(), d2.norm(), (uv[2] - uv[1]).norm()});
    if (d < 0.05 * longest * longest) continue;  // counter-clockwise, and not a needle
    RestTriangle t = rest_triangle(uv);
    t.membrane.b_u = random.uniform(0.7, 1.2);
    t.membrane.b_v = random.uniform(0.7, 1.2);
    return t;
  }
}

// Columns w_u, w_v: near rest, stretched, compressed, sheared far past the right angle, nearly parallel or
// opposite, one thread nearly collapsed, or anything.
inline std::array<Vec3, 2> random_deformation(Random& random) {
  const Mat3 R = random.rotation();
  Vec3 w_u = R.col(0), w_v = R.col(1);
  switch (random.below(7)) {
    case 0:
      w_u += random.vector(0.05), w_v += random.vector(0.05);
      break;
    case 1:
      w_u *= random.uniform(1, 2), w_v *= random.uniform(1, 2), w_v += random.vector(0.1);
      break;
    case 2:
      w_u *= random.uniform(0.02, 0.9), w_v *= random.uniform(0.02, 0.9), w_u += random.vector(0.01);
      break;
    case 3:
      w_v += random.uniform(-3, 3) * w_u;
      break;
    case 4:
      w_v = random.uniform(-1.5, 1.5) * w_u + random.vector(0.02);
      break;
    case 5:
      w_v = 0.02 * random.direction();
      break;
    default:
      w_u = random.vector(1.5), w_v = random.vector(1.5);
  }
  return {w_u, w_v};
}

inline std::array<Vec3, 3> deformed(const RestTriangle& t, const Vec3& w_u, const Vec3& w_v, const Vec3& origin) {
  std::array<Vec3, 3> x;
  for (std::size_t i = 0; i < 3; ++i) x[i] = origin + t.uv[i].x() * w_u + t.uv[i].y() * w_v;
  return x;
}

inline MembraneStiffness random_stiffness(Random& random) {
  return {.k_u = random.uniform(100, 5000),
          .k_v = random.uniform(100, 5000),
          .k_shear = random.uniform(20, 1000),
          .tau_stretch = random.uniform(1e-3, 5e-3),
          .tau_shear = random.uniform(1e-3, 5e-3)};
}

// A hinge with the angle theta: edge of about a centimetre, apexes at any height and also beyond its ends (obtuse).
inline std::array<Vec3, 4> hinge_at(Random& random, double theta) {
  const double L = random.uniform(0.005, 0.02);
  const auto apex = [&] { return std::pair(random.uniform(-0.8, 1.8) * L, random.uniform(0.15, 1.5) * L); };
  const auto [along_a, height_a] = apex();
  const auto [along_b, height_b] = apex();
  // Flat in the plane z = 0 with normals +z; A stays, and B sinks by theta: a ridge.
  std::array<Vec3, 4> x = {Vec3(0, 0, 0), Vec3(L, 0, 0), Vec3(along_a, height_a, 0),
                           Vec3(along_b, -height_b * std::cos(theta), -height_b * std::sin(theta))};
  const Mat3 R = random.rotation();
  const Vec3 shift = random.vector(2);
  for (Vec3& p : x) p = R * p + shift;
  return x;
}

template <std::size_t N>
Eigen::VectorXd flat(const std::array<Vec3, N>& x) {
  Eigen::VectorXd out(3 * N);
  for (std::size_t i = 0; i < N; ++i) out.segment<3>(static_cast<Eigen::Index>(3 * i)) = x[i];
  return out;
}

template <std::size_t N>
std::array<Vec3, N> corners(const Eigen::VectorXd& x) {
  std::array<Vec3, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = x.segment<3>(static_cast<Eigen::Index>(3 * i));
  return out;
}

template <std::size_t N>
Eigen::MatrixXd dense(const ElementMatrix<N>& K) {
  Eigen::MatrixXd out(3 * N, 3 * N);
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < N; ++j)
      out.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) = K[i][j];
  return out;
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;

inline Matrix6 dense(const FMatrix& K) {
  Matrix6 out;
  out << K.uu, K.uv, K.uv.transpose(), K.vv;
  return out;
}

// The corners' 9 x 9 matrix and forces from the six numbers of F, as membrane.hpp tells the assembly to do.
inline Eigen::MatrixXd expand(const RestTriangle& t, const FMatrix& K) {
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(6, 9);
  for (Eigen::Index i = 0; i < 3; ++i) {
    B.block<3, 3>(0, 3 * i) = t.alpha[i] * Mat3::Identity();
    B.block<3, 3>(3, 3 * i) = t.beta[i] * Mat3::Identity();
  }
  return B.transpose() * dense(K) * B;
}

inline std::array<Vec3, 3> corner_forces(const RestTriangle& t, const Vec3& P_u, const Vec3& P_v) {
  std::array<Vec3, 3> f;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    f[i] = -(t.alpha[row] * P_u + t.beta[row] * P_v);
  }
  return f;
}

template <std::size_t N>
std::array<Vec3, N> moved(const std::array<Vec3, N>& x, const Mat3& R, const Vec3& shift) {
  std::array<Vec3, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = R * x[i] + shift;
  return out;
}

// v_i = velocity + omega x x_i
template <std::size_t N>
std::array<Vec3, N> rigid_velocity(const std::array<Vec3, N>& x, const Vec3& velocity, const Vec3& omega) {
  std::array<Vec3, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = velocity + omega.cross(x[i]);
  return out;
}

// Sum of forces, and of moments about the element, each relative to what is added up.
template <std::size_t N>
void expect_no_net_force(const std::array<Vec3, N>& x, const std::array<Vec3, N>& f, const std::string& what) {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double force_size = 0, moment_size = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const Vec3 arm = x[i] - x[0];
    force += f[i];
    moment += arm.cross(f[i]);
    force_size += f[i].norm();
    moment_size += arm.norm() * f[i].norm();
  }
  EXPECT_GT(force_size, 0) << what;
  EXPECT_LE(force.norm(), 1e-12 * force_size) << what;
  EXPECT_LE(moment.norm(), 1e-10 * moment_size) << what;
}

}  // namespace toile::internal
