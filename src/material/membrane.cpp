#include "material/membrane.hpp"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

// Below this |w| has no direction that double precision could name; it is 120 orders away from any cloth.
constexpr double no_direction = 1e-140;

// Of one thread direction, and of the barrier before its strain limit.
double stretch_energy(const Vec3& w, double b, double tension, double compression) {
  const double excess = w.norm() - b;
  return 0.5 * (excess < 0 ? compression : 1) * tension * excess * excess;
}

// Stretch along one thread direction: adds to P, Q and the diagonal blocks K and D.
void add_stretch(const Vec3& w, const Vec3& w_dot, double b, double tension, double compression, double tau,
                 bool damping_in_K, bool project, Vec3& P, Vec3& Q, Mat3& K, Mat3& D) {
  const double length = w.norm();
  const double excess = length - b;
  const double softness = excess < 0 ? compression : 1;
  const double stiffness = softness * tension;
  if (!(length > no_direction)) return;  // no direction to push in: no force, no stiffness, no NaN

  const Vec3 along = w / length;
  const double rate = along.dot(w_dot);  // d|w|/dt
  P += (stiffness * excess) * along;
  Q += (tension * tau * rate) * along;

  // Bracket of 1.1: eigenvalue 1 along the thread, `across` twice; only the latter can be negative.
  double across = excess / length;
  if (damping_in_K) across += tau * rate / length / softness;
  if (project) across = std::max(0.0, across);
  const Mat3 outer = along * along.transpose();
  K += (stiffness * (1 - across)) * outer;
  K.diagonal().array() += stiffness * across;
  D += (tension * tau) * outer;
}

// The barrier before the strain limit, of a thread of length |w|.
struct Barrier {
  double energy_J = 0, force = 0, stiffness = 0;
};
Barrier barrier(double length, double b, double tension, double limit) {
  constexpr double last = 0.95;  // y_1
  const double from = limited_from(b), d = 0.5 * limit * from;
  const double y = (length - from) / d - 1;
  if (!(limit > 0) || !(y > 0)) return {};
  const double inner = std::min(y, last), beyond = y - inner, left = 1 - inner;
  const double phi = inner * inner * inner / left, phi1 = inner * inner * (3 - 2 * inner) / (left * left),
               phi2 = 6 * inner / left + 2 * phi1 / left;
  return {tension * d * d * (phi + beyond * (phi1 + 0.5 * beyond * phi2)), tension * d * (phi1 + beyond * phi2),
          tension * phi2};
}

// Adds force and stiffness along the thread; across it, the force over the length.
void add_limit(const Vec3& w, double b, double tension, double limit, Vec3& P, Mat3& K) {
  const double length = w.norm();
  const auto [energy_J, force, stiffness] = barrier(length, b, tension, limit);
  if (!(force > 0)) return;
  const Vec3 along = w / length;
  P += force * along;
  K += (stiffness - force / length) * along * along.transpose();
  K.diagonal().array() += force / length;
}

// Adds stiffness * (g g^T + c J) with g = [w_v; w_u], J = [[0, I], [I, 0]].
void add_shear_hessian(const Vec3& w_u, const Vec3& w_v, double c, double stiffness, FMatrix& K) {
  K.uu += stiffness * w_v * w_v.transpose();
  K.vv += stiffness * w_u * w_u.transpose();
  K.uv += stiffness * w_v * w_u.transpose();
  K.uv.diagonal().array() += stiffness * c;
}

// The same with its negative eigenvalues set to zero.
//
// J is +1 on vectors [a; a] and -1 on [a; -a].  g meets these spaces in one direction each, e+ ~ [z+; z+] and
// e- ~ [z-; -z-] with z+- = w_v +- w_u; what is orthogonal to both is an eigenspace with eigenvalue +c or -c.
// In (e+, e-), with p = |z+|^2/2 and m = |z-|^2/2, the matrix is
//     S = [ p + c     sqrt(pm) ]      trace p + m = I2,   det = -c (c + 2 I6),
//         [ sqrt(pm)  m - c    ]
// whose larger eigenvalue lambda+ is never negative; its projection is S where lambda- >= 0, and otherwise
// lambda+/(lambda+ - lambda-) (S - lambda- I).  With c = I6 this is lambda q q^T + |I6| (... - y y^T) of the theory
// page, without the eigenvector q, which for other c may vanish.
void add_projected_shear_hessian(const Vec3& w_u, const Vec3& w_v, double I6, double c, double stiffness, FMatrix& K) {
  const Vec3 z_plus = w_v + w_u;
  const Vec3 z_minus = w_v - w_u;
  const double p = 0.5 * z_plus.squaredNorm();
  const double m = 0.5 * z_minus.squaredNorm();
  const double I2 = p + m;
  const double root = std::sqrt(std::max(0.0, I2 * I2 + 4 * c * (c + 2 * I6)));
  const double lambda_minus = 0.5 * (I2 - root);
  const bool indefinite = lambda_minus < 0;  // implies root > 0
  const double shift = indefinite ? lambda_minus : 0.0;
  const double share = indefinite ? 0.5 * (I2 + root) / root : 1.0;

  // Each space: its eigenvalue on all of it, then the correction along z.  z = 0 needs none.
  const double c_plus = std::max(0.0, c);
  const double c_minus = std::max(0.0, -c);
  const double along_plus = p > 0 ? (share * (p + c - shift) - c_plus) / (2 * p) : 0.0;
  const double along_minus = m > 0 ? (share * (m - c - shift) - c_minus) / (2 * m) : 0.0;

  const double half = 0.5 * stiffness;
  const Mat3 plus = (half * along_plus) * z_plus * z_plus.transpose();
  const Mat3 minus = (half * along_minus) * z_minus * z_minus.transpose();
  const Mat3 mixed = (half * 0.5 * share) * z_plus * z_minus.transpose();
  const Mat3 sum = plus + minus;
  const Mat3 mixed_sum = mixed + mixed.transpose();
  K.uu += sum + mixed_sum;
  K.vv += sum - mixed_sum;
  K.uv += plus - minus - mixed + mixed.transpose();
  const double trace_part = half * (c_plus + c_minus);
  K.uu.diagonal().array() += trace_part;
  K.vv.diagonal().array() += trace_part;
  K.uv.diagonal().array() += half * (c_plus - c_minus);
}

}  // namespace

double membrane_energy(const MembraneRest& rest, const MembraneStiffness& k, const Vec3& w_u, const Vec3& w_v) {
  const double u = k.k_u * rest.scale2, v = k.k_v * rest.scale2, I6 = w_u.dot(w_v);
  return stretch_energy(w_u, rest.b_u, u, k.compression) + stretch_energy(w_v, rest.b_v, v, k.compression) +
         barrier(w_u.norm(), rest.b_u, u, k.strain_limit).energy_J +
         barrier(w_v.norm(), rest.b_v, v, k.strain_limit).energy_J + 0.5 * k.k_shear * rest.scale2 * I6 * I6;
}

double energy_beyond_linear(const MembraneRest& rest, const MembraneStiffness& k, const MembraneResponse& at,
                            const Vec3& w_u, const Vec3& w_v) {
  const Vec3 u = w_u - at.w_u, v = w_v - at.w_v;
  const double known = at.energy_J + u.dot(at.P_u) + v.dot(at.P_v) + 0.5 * u.dot(at.K.uu * u) + u.dot(at.K.uv * v) +
                       0.5 * v.dot(at.K.vv * v);
  return membrane_energy(rest, k, w_u, w_v) - known;
}

MembraneResponse membrane_response(const MembraneRest& rest, const MembraneStiffness& k, const std::array<Vec3, 3>& x,
                                   const std::array<Vec3, 3>& v, DampingJacobian damping_jacobian,
                                   Projection projection) {
  const bool damping_in_K = damping_jacobian == DampingJacobian::paper;
  const bool project = projection == Projection::semidefinite;

  // alpha and beta sum to zero: differences first, so that a distant origin costs no digits.
  const Vec3 x1 = x[1] - x[0], x2 = x[2] - x[0];
  const Vec3 v1 = v[1] - v[0], v2 = v[2] - v[0];
  MembraneResponse r;
  r.w_u = rest.alpha[1] * x1 + rest.alpha[2] * x2;
  r.w_v = rest.beta[1] * x1 + rest.beta[2] * x2;
  const Vec3 w_u_dot = rest.alpha[1] * v1 + rest.alpha[2] * v2;
  const Vec3 w_v_dot = rest.beta[1] * v1 + rest.beta[2] * v2;

  r.P_u.setZero(), r.P_v.setZero(), r.Q_u.setZero(), r.Q_v.setZero();
  r.K.uu.setZero(), r.K.uv.setZero(), r.K.vv.setZero();
  r.D.uu.setZero(), r.D.uv.setZero(), r.D.vv.setZero();

  r.energy_J = membrane_energy(rest, k, r.w_u, r.w_v);
  const double s2 = rest.scale2;
  add_stretch(r.w_u, w_u_dot, rest.b_u, k.k_u * s2, k.compression, k.tau_stretch, damping_in_K, project, r.P_u, r.Q_u,
              r.K.uu, r.D.uu);
  add_stretch(r.w_v, w_v_dot, rest.b_v, k.k_v * s2, k.compression, k.tau_stretch, damping_in_K, project, r.P_v, r.Q_v,
              r.K.vv, r.D.vv);

  if (k.strain_limit > 0) {
    add_limit(r.w_u, rest.b_u, k.k_u * s2, k.strain_limit, r.P_u, r.K.uu);
    add_limit(r.w_v, rest.b_v, k.k_v * s2, k.strain_limit, r.P_v, r.K.vv);
  }

  const double stiffness = k.k_shear * s2;
  const double I6 = r.w_u.dot(r.w_v);
  const double rate = w_u_dot.dot(r.w_v) + r.w_u.dot(w_v_dot);  // dI6/dt
  r.P_u += (stiffness * I6) * r.w_v;
  r.P_v += (stiffness * I6) * r.w_u;
  const double brake = stiffness * k.tau_shear * rate;
  r.Q_u += brake * r.w_v;
  r.Q_v += brake * r.w_u;
  const double c = damping_in_K ? I6 + k.tau_shear * rate : I6;
  if (project)
    add_projected_shear_hessian(r.w_u, r.w_v, I6, c, stiffness, r.K);
  else
    add_shear_hessian(r.w_u, r.w_v, c, stiffness, r.K);
  add_shear_hessian(r.w_u, r.w_v, 0, stiffness * k.tau_shear, r.D);
  return r;
}

}  // namespace toile
