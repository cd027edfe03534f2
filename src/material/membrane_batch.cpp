#include "material/membrane_batch.hpp"

// Vectors of unknown width cannot be members of a struct.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material/membrane_batch.cpp"
#include <hwy/foreach_target.h>
// After it.
#include "material/wide-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace toile::internal::HWY_NAMESPACE {
namespace {

// Below this, |w| has no direction in double precision; it is 120 orders of magnitude away from any cloth.
constexpr double no_direction = 1e-140;

struct Rest {
  Wide k_u, k_v, k_shear, b_u, b_v, tau_stretch, tau_shear, compression, strain_limit, stiffening_u, stiffening_v;
  bool curved;
};
HWY_INLINE Rest load_rest(const MembraneRestBatch& rest, std::size_t lane) {
  return {load(rest.k_u, lane),          load(rest.k_v, lane),          load(rest.k_shear, lane),
          load(rest.b_u, lane),          load(rest.b_v, lane),          load(rest.tau_stretch, lane),
          load(rest.tau_shear, lane),    load(rest.compression, lane),  load(rest.strain_limit, lane),
          load(rest.stiffening_u, lane), load(rest.stiffening_v, lane), rest.curved};
}

struct Gradient {
  WideVec3 w_u, w_v, w_u_dot, w_v_dot;
};
HWY_INLINE Gradient load_state(const MembraneStateBatch& state, std::size_t lane) {
  return {load(state.w_u, lane), load(state.w_v, lane), load(state.w_u_dot, lane), load(state.w_v_dot, lane)};
}

struct WideFMatrix {  // material/membrane.hpp: FMatrix
  WideMat3 uu, uv, vv;
};
struct Response {
  WideVec3 P_u, P_v, Q_u, Q_v;
  WideFMatrix K, D;
};

HWY_INLINE Wide zero() { return wide(0); }

// Corners of the triangles of some lanes.
HWY_INLINE void gather(const MembraneRestBatch& rest, const Vec3* at, Batched (&corner)[3][3]) {
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < batch_size; ++k) {
      const double* from = at[rest.corner[c][k]].data();
      corner[c][0][k] = from[0];
      corner[c][1][k] = from[1];
      corner[c][2][k] = from[2];
    }
  }
}

// Of one thread direction.
HWY_INLINE Wide stretch_energy(Wide length, Wide b, Wide tension, Wide compression) {
  const Wide excess = length - b;
  return 0.5 * select(excess < zero(), compression, wide(1)) * tension * excess * excess;
}

// What a thread of length |w| has beyond k (|w| - b).
struct Beyond {
  Wide energy, force, stiffness;
};

HWY_INLINE Beyond stiffening(Wide length, Wide b, Wide tension, Wide per_excess2) {
  const Wide excess = at_least_zero(length - b), cubic = tension * per_excess2 * excess * excess;
  return {0.25 * cubic * excess * excess, cubic * excess, 3 * cubic};
}

// The barrier before the strain limit.
HWY_INLINE Beyond barrier(Wide length, Wide b, Wide tension, Wide limit) {
  constexpr double last = 0.95;                                               // y_1
  const Wide from = select(b > wide(1), b, wide(1)), d = 0.5 * limit * from;  // limited_from(b)
  const Wide y = (length - from) / d - wide(1);
  const WideMask within = select(limit > zero(), y, zero()) > zero();
  const Wide inner = smaller(y, wide(last)), beyond = y - inner, left = wide(1) - inner;
  const Wide phi = inner * inner * inner / left, phi1 = inner * inner * (wide(3) - 2 * inner) / (left * left),
             phi2 = 6 * inner / left + 2 * phi1 / left;
  return {or_zero(within, tension * d * d * (phi + beyond * (phi1 + 0.5 * beyond * phi2))),
          or_zero(within, tension * d * (phi1 + beyond * phi2)), or_zero(within, tension * phi2)};
}

HWY_INLINE Beyond beyond_straight(const Rest& rest, Wide length, Wide b, Wide tension, Wide per_excess2) {
  const Beyond limit = barrier(length, b, tension, rest.strain_limit),
               curve = stiffening(length, b, tension, per_excess2);
  return {limit.energy + curve.energy, limit.force + curve.force, limit.stiffness + curve.stiffness};
}

HWY_INLINE Wide energy(const Rest& rest, const WideVec3& w_u, const WideVec3& w_v) {
  const Wide length_u = norm(w_u), length_v = norm(w_v), I6 = dot(w_u, w_v);
  Wide sum = stretch_energy(length_u, rest.b_u, rest.k_u, rest.compression) +
             stretch_energy(length_v, rest.b_v, rest.k_v, rest.compression);
  if (rest.curved) {
    sum = sum + beyond_straight(rest, length_u, rest.b_u, rest.k_u, rest.stiffening_u).energy;
    sum = sum + beyond_straight(rest, length_v, rest.b_v, rest.k_v, rest.stiffening_v).energy;
  }
  return sum + 0.5 * rest.k_shear * I6 * I6;
}

// Stretch along one thread direction: P, Q and the diagonal blocks K and D.
HWY_INLINE void stretch(const Rest& rest, const MembraneForm& form, const WideVec3& w, const WideVec3& w_dot, Wide b,
                        Wide tension, Wide per_excess2, WideVec3& P, WideVec3& Q, WideMat3& K, WideMat3& D) {
  const Wide length = norm(w);
  const Wide excess = length - b;
  const Wide softness = select(excess < zero(), rest.compression, wide(1));
  const Wide stiffness = softness * tension;
  const WideMask directed =
      length > wide(no_direction);  // else no direction to push in: no force, no stiffness, no NaN

  const WideVec3 along = or_zero(directed, w / length);
  const Wide rate = dot(along, w_dot);  // d|w|/dt
  P = (stiffness * excess) * along;
  Q = (tension * rest.tau_stretch * rate) * along;

  // Bracket of 1.1: eigenvalue 1 along the thread, `across` twice; only the latter can be negative.
  Wide across = excess / length;
  if (form.damping_jacobian == DampingJacobian::paper) across = across + rest.tau_stretch * rate / length / softness;
  if (form.projection == Projection::semidefinite) across = at_least_zero(across);
  across = or_zero(directed, across);
  const WideMat3 both = outer(along, along);
  K = (stiffness * (wide(1) - across)) * both;
  add_to_diagonal(stiffness * across, K);
  D = (tension * rest.tau_stretch) * both;

  if (!rest.curved) return;
  // Force and stiffness along the thread; across it, the force over the length.
  const Beyond beyond = beyond_straight(rest, length, b, tension, per_excess2);
  const WideMask pulls = beyond.force > zero();
  P = P + or_zero(pulls, beyond.force * along);
  const Wide over_length = or_zero(pulls, beyond.force / length);
  const WideVec3 stiff_along = or_zero(pulls, (beyond.stiffness - over_length) * along);
  K = K + outer(stiff_along, along);
  add_to_diagonal(over_length, K);
}

// stiffness * (g g^T + c J) with g = [w_v; w_u], J = [[0, I], [I, 0]].
HWY_INLINE WideFMatrix shear_hessian(const WideVec3& w_u, const WideVec3& w_v, Wide c, Wide stiffness) {
  WideFMatrix H{outer(stiffness * w_v, w_v), outer(stiffness * w_v, w_u), outer(stiffness * w_u, w_u)};
  add_to_diagonal(stiffness * c, H.uv);
  return H;
}

// Adds the same to K with its negative eigenvalues set to zero.
//
// J is +1 on vectors [a; a] and -1 on [a; -a].  g meets these spaces in one direction each, e+ ~ [z+; z+] and
// e- ~ [z-; -z-] with z+- = w_v +- w_u; all that is orthogonal to both is an eigenspace with eigenvalue +c or -c.
// In (e+, e-), with p = |z+|^2/2 and m = |z-|^2/2, the matrix is
//     S = [ p + c     sqrt(pm) ]      trace p + m = I2,   det = -c (c + 2 I6),
//         [ sqrt(pm)  m - c    ]
// whose larger eigenvalue lambda+ is never negative; its projection is S where lambda- >= 0, and otherwise
// lambda+/(lambda+ - lambda-) (S - lambda- I).  With c = I6 this is lambda q q^T + |I6| (... - y y^T) of the theory
// page, without the eigenvector q, which for other c may vanish.
HWY_INLINE void add_projected_shear_hessian(const WideVec3& w_u, const WideVec3& w_v, Wide I6, Wide c, Wide stiffness,
                                            WideFMatrix& K) {
  const WideVec3 z_plus = w_v + w_u;
  const WideVec3 z_minus = w_v - w_u;
  const Wide p = 0.5 * dot(z_plus, z_plus);
  const Wide m = 0.5 * dot(z_minus, z_minus);
  const Wide I2 = p + m;
  const Wide root = square_root(at_least_zero(I2 * I2 + 4 * c * (c + 2 * I6)));
  const Wide lambda_minus = 0.5 * (I2 - root);
  const WideMask indefinite = lambda_minus < zero();  // implies root > 0
  const Wide shift = or_zero(indefinite, lambda_minus);
  const Wide share = select(indefinite, 0.5 * (I2 + root) / root, wide(1));

  // Each space: its eigenvalue on all of it, then the correction along z.  z = 0 needs none.
  const Wide c_plus = at_least_zero(c);
  const Wide c_minus = at_least_zero(zero() - c);
  const Wide along_plus = or_zero(p > zero(), (share * (p + c - shift) - c_plus) / (2 * p));
  const Wide along_minus = or_zero(m > zero(), (share * (m - c - shift) - c_minus) / (2 * m));

  const Wide half = 0.5 * stiffness;
  const WideMat3 plus = outer((half * along_plus) * z_plus, z_plus);
  const WideMat3 minus = outer((half * along_minus) * z_minus, z_minus);
  const WideMat3 mixed = outer((half * wide(0.5) * share) * z_plus, z_minus);
  const WideMat3 sum = plus + minus;
  const WideMat3 mixed_sum = mixed + transpose(mixed);
  K.uu = K.uu + (sum + mixed_sum);
  K.vv = K.vv + (sum - mixed_sum);
  K.uv = plus - minus - mixed + transpose(mixed);
  const Wide trace_part = half * (c_plus + c_minus);
  add_to_diagonal(trace_part, K.uu);
  add_to_diagonal(trace_part, K.vv);
  add_to_diagonal(half * (c_plus - c_minus), K.uv);
}

// Each caller uses a part of the result; the compiler removes the rest.
HWY_INLINE Response respond(const Rest& rest, const MembraneForm& form, const Gradient& F) {
  Response r;
  stretch(rest, form, F.w_u, F.w_u_dot, rest.b_u, rest.k_u, rest.stiffening_u, r.P_u, r.Q_u, r.K.uu, r.D.uu);
  stretch(rest, form, F.w_v, F.w_v_dot, rest.b_v, rest.k_v, rest.stiffening_v, r.P_v, r.Q_v, r.K.vv, r.D.vv);

  const Wide stiffness = rest.k_shear;
  const Wide I6 = dot(F.w_u, F.w_v);
  const Wide rate = dot(F.w_u_dot, F.w_v) + dot(F.w_u, F.w_v_dot);  // dI6/dt
  r.P_u = r.P_u + (stiffness * I6) * F.w_v;
  r.P_v = r.P_v + (stiffness * I6) * F.w_u;
  const Wide brake = stiffness * rest.tau_shear * rate;
  r.Q_u = r.Q_u + brake * F.w_v;
  r.Q_v = r.Q_v + brake * F.w_u;
  const Wide c = form.damping_jacobian == DampingJacobian::paper ? I6 + rest.tau_shear * rate : I6;
  if (form.projection == Projection::semidefinite) {
    add_projected_shear_hessian(F.w_u, F.w_v, I6, c, stiffness, r.K);
  } else {
    const WideFMatrix H = shear_hessian(F.w_u, F.w_v, c, stiffness);
    r.K.uu = r.K.uu + H.uu;
    r.K.vv = r.K.vv + H.vv;
    r.K.uv = H.uv;
  }
  const WideFMatrix braking = shear_hessian(F.w_u, F.w_v, zero(), stiffness * rest.tau_shear);
  r.D.uu = r.D.uu + braking.uu;
  r.D.vv = r.D.vv + braking.vv;
  r.D.uv = braking.uv;
  return r;
}

// alpha_i u + beta_i v for every corner, to each triangle's own place.
HWY_INLINE void store_corners(const MembraneRestBatch& rest, const WideVec3& u, const WideVec3& v, std::size_t lane,
                              Mat3* force) {
  alignas(64) Batched out[3][3];
  for (std::size_t c = 0; c < 3; ++c) {
    const WideVec3 f = load(rest.alpha[c], lane) * u + load(rest.beta[c], lane) * v;
    store(f, out[c], lane);
  }
  for (std::size_t k = lane; k < lane + wide_lanes; ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      force[k].col(static_cast<Eigen::Index>(c)) = Vec3(out[c][0][k], out[c][1][k], out[c][2][k]);
  }
}

// w_u and w_v of corners, summed over all three.
HWY_INLINE void columns(const MembraneRestBatch& rest, const Batched (&corner)[3][3], std::size_t lane, WideVec3& w_u,
                        WideVec3& w_v) {
  for (std::size_t c = 0; c < 3; ++c) {
    const WideVec3 x = load(corner[c], lane);
    const WideVec3 u = load(rest.alpha[c], lane) * x, v = load(rest.beta[c], lane) * x;
    w_u = c == 0 ? u : w_u + u;
    w_v = c == 0 ? v : w_v + v;
  }
}

void evaluate(const MembraneRestBatch* rests, std::size_t begin, std::size_t end, const Vec3* x, const Vec3* v,
              MembraneStateBatch* states) {
  alignas(64) Batched at[3][3], moving[3][3];
  for (std::size_t b = begin; b < end; ++b) {
    const MembraneRestBatch& rest = rests[b];
    gather(rest, x, at);
    gather(rest, v, moving);
    for (std::size_t lane = 0; lane < batch_size; lane += wide_lanes) {
      // alpha and beta sum to zero: differences first, so that a distant origin costs no digits.
      const WideVec3 x0 = load(at[0], lane), x1 = load(at[1], lane) - x0, x2 = load(at[2], lane) - x0;
      const WideVec3 v0 = load(moving[0], lane), v1 = load(moving[1], lane) - v0, v2 = load(moving[2], lane) - v0;
      const Wide alpha1 = load(rest.alpha[1], lane), alpha2 = load(rest.alpha[2], lane),
                 beta1 = load(rest.beta[1], lane), beta2 = load(rest.beta[2], lane);
      const WideVec3 w_u = alpha1 * x1 + alpha2 * x2, w_v = beta1 * x1 + beta2 * x2;
      store(w_u, states[b].w_u, lane);
      store(w_v, states[b].w_v, lane);
      store(alpha1 * v1 + alpha2 * v2, states[b].w_u_dot, lane);
      store(beta1 * v1 + beta2 * v2, states[b].w_v_dot, lane);
      store(energy(load_rest(rest, lane), w_u, w_v), states[b].energy_J, lane);
    }
  }
}

void forces(const MembraneBatches& of, Mat3* force) {
  for (std::size_t b = of.begin; b < of.end; ++b) {
    for (std::size_t lane = 0; lane < batch_size; lane += wide_lanes) {
      const Response r = respond(load_rest(of.rest[b], lane), of.form, load_state(of.state[b], lane));
      store_corners(of.rest[b], r.P_u + r.Q_u, r.P_v + r.Q_v, lane, force + b * batch_size);
    }
  }
}

// H moved by the corners, to the columns of F.
HWY_INLINE void add_product(const MembraneRestBatch& rest, const WideFMatrix& H, const Batched (&corner)[3][3],
                            std::size_t lane, WideVec3& f_u, WideVec3& f_v) {
  WideVec3 u, v;
  columns(rest, corner, lane, u, v);
  f_u = f_u + (H.uu * u + H.uv * v);
  f_v = f_v + (transpose(H.uv) * u + H.vv * v);
}

void stiffness_times(const MembraneBatches& of, const Vec3* displacement, const Vec3* velocity, Mat3* force) {
  alignas(64) Batched moved[3][3], moving[3][3];
  for (std::size_t b = of.begin; b < of.end; ++b) {
    const MembraneRestBatch& rest = of.rest[b];
    gather(rest, displacement, moved);
    if (velocity) gather(rest, velocity, moving);
    for (std::size_t lane = 0; lane < batch_size; lane += wide_lanes) {
      const Response r = respond(load_rest(rest, lane), of.form, load_state(of.state[b], lane));
      WideVec3 f_u{zero(), zero(), zero()}, f_v = f_u;
      add_product(rest, r.K, moved, lane, f_u, f_v);
      if (velocity) add_product(rest, r.D, moving, lane, f_u, f_v);
      store_corners(rest, f_u, f_v, lane, force + b * batch_size);
    }
  }
}

void blocks(const MembraneBatches& of, double h_s, Mat3* to) {
  const double h2 = h_s * h_s;
  for (std::size_t b = of.begin; b < of.end; ++b) {
    const MembraneRestBatch& rest = of.rest[b];
    alignas(64) Batched out[3][3][3];  // [pair][column][row]
    for (std::size_t lane = 0; lane < batch_size; lane += wide_lanes) {
      const Response r = respond(load_rest(rest, lane), of.form, load_state(of.state[b], lane));
      const WideMat3 uu = wide(h2) * r.K.uu + wide(h_s) * r.D.uu, uv = wide(h2) * r.K.uv + wide(h_s) * r.D.uv,
                     vv = wide(h2) * r.K.vv + wide(h_s) * r.D.vv;
      const WideMat3 vu = transpose(uv);
      for (std::size_t p = 0; p < 3; ++p) {
        const std::size_t q = (p + 1) % 3;
        const Wide alpha_p = load(rest.alpha[p], lane), alpha_q = load(rest.alpha[q], lane),
                   beta_p = load(rest.beta[p], lane), beta_q = load(rest.beta[q], lane);
        const WideMask forward = load(rest.forward[p], lane) > zero();
        const Wide pq = alpha_p * beta_q, qp = alpha_q * beta_p;
        const Wide first = select(forward, pq, qp), second = select(forward, qp, pq);
        const WideMat3 block = (alpha_p * alpha_q) * uu + first * uv + second * vu + (beta_p * beta_q) * vv;
        const WideMat3 by_columns = transpose(block);
        for (std::size_t c = 0; c < 3; ++c) store(by_columns.row[c], out[p][c], lane);
      }
    }
    for (std::size_t k = 0; k < batch_size; ++k) {
      for (std::size_t p = 0; p < 3; ++p) {
        double* block = to[3 * (b * batch_size + k) + p].data();
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t row = 0; row < 3; ++row) block[3 * c + row] = out[p][c][row][k];
        }
      }
    }
  }
}

void stretches(const MembraneRestBatch* rests, std::size_t begin, std::size_t end, const Vec3* x, Vec2* w) {
  alignas(64) Batched corner[3][3], length[2];
  for (std::size_t b = begin; b < end; ++b) {
    gather(rests[b], x, corner);
    for (std::size_t lane = 0; lane < batch_size; lane += wide_lanes) {
      WideVec3 w_u, w_v;
      columns(rests[b], corner, lane, w_u, w_v);
      store(norm(w_u), length[0], lane);
      store(norm(w_v), length[1], lane);
    }
    for (std::size_t k = 0; k < batch_size; ++k) w[b * batch_size + k] = Vec2(length[0][k], length[1][k]);
  }
}

void energy_beyond(const MembraneBatches& of, const Vec3* x, double* energy_J) {
  alignas(64) Batched corner[3][3], beyond;
  for (std::size_t b = of.begin; b < of.end; ++b) {
    gather(of.rest[b], x, corner);
    for (std::size_t lane = 0; lane < batch_size; lane += wide_lanes) {
      WideVec3 w_u, w_v;
      columns(of.rest[b], corner, lane, w_u, w_v);
      const Rest rest = load_rest(of.rest[b], lane);
      const Gradient at = load_state(of.state[b], lane);
      const Response r = respond(rest, of.form, at);
      const WideVec3 u = w_u - at.w_u, v = w_v - at.w_v;
      const Wide known = load(of.state[b].energy_J, lane) + dot(u, r.P_u) + dot(v, r.P_v) + 0.5 * dot(u, r.K.uu * u) +
                         dot(u, r.K.uv * v) + 0.5 * dot(v, r.K.vv * v);
      store(energy(rest, w_u, w_v) - known, beyond, lane);
    }
    for (std::size_t k = 0; k < batch_size; ++k) energy_J[b * batch_size + k] = beyond[k];
  }
}

void energies(const MembraneRestBatch& rest, MembraneStateBatch& state) {
  for (std::size_t lane = 0; lane < batch_size; lane += wide_lanes)
    store(energy(load_rest(rest, lane), load(state.w_u, lane), load(state.w_v, lane)), state.energy_J, lane);
}

HWY_INLINE void copy_lane(const WideVec3& from, std::size_t lane, Vec3& to) {
  alignas(64) Batched numbers[3];
  store(from, numbers, 0);
  to = Vec3(numbers[0][lane], numbers[1][lane], numbers[2][lane]);
}
HWY_INLINE void copy_lane(const WideFMatrix& from, std::size_t lane, FMatrix& to) {
  const WideMat3* matrices[3] = {&from.uu, &from.uv, &from.vv};
  Mat3* all[3] = {&to.uu, &to.uv, &to.vv};
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t row = 0; row < 3; ++row) {
      Vec3 numbers;
      copy_lane(matrices[m]->row[row], lane, numbers);
      all[m]->row(static_cast<Eigen::Index>(row)) = numbers.transpose();
    }
  }
}

void response_of(const MembraneRestBatch& rest, const MembraneStateBatch& state, std::size_t lane,
                 const MembraneForm& form, MembraneResponse& to) {
  const std::size_t first = lane / wide_lanes * wide_lanes, own = lane - first;
  const Gradient F = load_state(state, first);
  const Response r = respond(load_rest(rest, first), form, F);
  to.energy_J = state.energy_J[lane];
  copy_lane(F.w_u, own, to.w_u);
  copy_lane(F.w_v, own, to.w_v);
  copy_lane(r.P_u, own, to.P_u);
  copy_lane(r.P_v, own, to.P_v);
  copy_lane(r.Q_u, own, to.Q_u);
  copy_lane(r.Q_v, own, to.Q_v);
  copy_lane(r.K, own, to.K);
  copy_lane(r.D, own, to.D);
}

}  // namespace
}  // namespace toile::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace toile::internal {
namespace {
HWY_EXPORT(evaluate);
HWY_EXPORT(forces);
HWY_EXPORT(stiffness_times);
HWY_EXPORT(blocks);
HWY_EXPORT(stretches);
HWY_EXPORT(energy_beyond);
HWY_EXPORT(energies);
HWY_EXPORT(response_of);
}  // namespace

void MembraneRestBatch::set(std::size_t lane, const MembraneRest& rest, const MembraneStiffness& k,
                            const Triangle& corners) {
  const double s2 = rest.scale2;
  for (std::size_t c = 0; c < 3; ++c) {
    alpha[c][lane] = rest.alpha[static_cast<Eigen::Index>(c)];
    beta[c][lane] = rest.beta[static_cast<Eigen::Index>(c)];
    corner[c][lane] = corners[c];
    forward[c][lane] = corners[c] < corners[(c + 1) % 3] ? 1 : 0;
  }
  k_u[lane] = k.k_u * s2;
  k_v[lane] = k.k_v * s2;
  k_shear[lane] = k.k_shear * s2;
  b_u[lane] = rest.b_u;
  b_v[lane] = rest.b_v;
  tau_stretch[lane] = k.tau_stretch;
  tau_shear[lane] = k.tau_shear;
  compression[lane] = k.bend > 0
                          ? std::min(k.compression, pushed_stiffness_N_per_m(k.bend, s2) / (0.5 * (k.k_u + k.k_v)))
                          : k.compression;
  strain_limit[lane] = k.strain_limit;
  stiffening_u[lane] = k.doubling_u > 0 ? k.stiffened / (k.doubling_u * k.doubling_u) : 0;
  stiffening_v[lane] = k.doubling_v > 0 ? k.stiffened / (k.doubling_v * k.doubling_v) : 0;
  curved = false;
  for (std::size_t n = 0; n < batch_size; ++n)
    curved |= strain_limit[n] > 0 || stiffening_u[n] > 0 || stiffening_v[n] > 0;
}

void evaluate_membranes(const MembraneRestBatch* rest, std::size_t begin, std::size_t end, const Vec3* x, const Vec3* v,
                        MembraneStateBatch* state) {
  HWY_DYNAMIC_DISPATCH(evaluate)(rest, begin, end, x, v, state);
}

void membrane_forces(const MembraneBatches& of, Mat3* force) { HWY_DYNAMIC_DISPATCH(forces)(of, force); }

void membrane_stiffness_times(const MembraneBatches& of, const Vec3* displacement, const Vec3* velocity, Mat3* force) {
  HWY_DYNAMIC_DISPATCH(stiffness_times)(of, displacement, velocity, force);
}

void membrane_blocks(const MembraneBatches& of, double h_s, Mat3* to) { HWY_DYNAMIC_DISPATCH(blocks)(of, h_s, to); }

void membrane_stretch(const MembraneRestBatch* rest, std::size_t begin, std::size_t end, const Vec3* x, Vec2* w) {
  HWY_DYNAMIC_DISPATCH(stretches)(rest, begin, end, x, w);
}

void membrane_energy_beyond(const MembraneBatches& of, const Vec3* x, double* energy_J) {
  HWY_DYNAMIC_DISPATCH(energy_beyond)(of, x, energy_J);
}

void membrane_energies(const MembraneRestBatch& rest, MembraneStateBatch& state) {
  HWY_DYNAMIC_DISPATCH(energies)(rest, state);
}

MembraneResponse membrane_response_of(const MembraneRestBatch& rest, const MembraneStateBatch& state, std::size_t lane,
                                      const MembraneForm& form) {
  MembraneResponse response;
  HWY_DYNAMIC_DISPATCH(response_of)(rest, state, lane, form, response);
  return response;
}

}  // namespace toile::internal
#endif
