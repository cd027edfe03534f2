#include "material/bend.hpp"

#include "core/elementary.hpp"

#include <Eigen/Geometry>  // cross
#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double smallest_sine = 1e-4;       // of an angle between the hinge and a side of its triangles
constexpr double smallest_normal2 = 1e-200;  // |N|^2 below which 1/|N|^2 leaves the range of double
constexpr double largest_weight = 20;

// Terms that theta and its gradient share.
struct HingeFrame {
  Vec3 e, N_A, N_B;           // hinge edge and triangle normals, of length twice the area
  double L = 0;               // |e|
  double N_A2 = 0, N_B2 = 0;  // squared lengths of the normals
  bool degenerate = true;
};

HingeFrame hinge_frame(const std::array<Vec3, 4>& x) {
  HingeFrame f;
  f.e = x[1] - x[0];
  const Vec3 a0 = x[2] - x[0], b0 = x[3] - x[0];
  f.N_A = f.e.cross(a0);
  f.N_B = b0.cross(f.e);
  f.N_A2 = f.N_A.squaredNorm();
  f.N_B2 = f.N_B.squaredNorm();
  const double L2 = f.e.squaredNorm();
  f.L = std::sqrt(L2);
  // sine at x0 is |N_A| / (L |x2 - x0|), and likewise at x1: the longer side has the smaller one.
  const double limit = smallest_sine * smallest_sine * L2;
  const double side_A2 = std::max(a0.squaredNorm(), (x[2] - x[1]).squaredNorm());
  const double side_B2 = std::max(b0.squaredNorm(), (x[3] - x[1]).squaredNorm());
  f.degenerate = !(f.N_A2 >= limit * side_A2 && f.N_B2 >= limit * side_B2 && f.N_A2 > smallest_normal2 &&
                   f.N_B2 > smallest_normal2);
  return f;
}

double angle(const HingeFrame& f) {
  if (!(f.L > 0)) return 0;
  return ieee_atan2(f.N_A.cross(f.N_B).dot(f.e) / f.L, f.N_A.dot(f.N_B));
}

std::array<Vec3, 4> gradient(const HingeFrame& f, const std::array<Vec3, 4>& x) {
  const Vec3 a = f.N_A / f.N_A2, b = f.N_B / f.N_B2;
  const Vec3 along = f.e / f.L;
  std::array<Vec3, 4> g;
  g[2] = -f.L * a;
  g[3] = -f.L * b;
  g[0] = -(x[2] - x[1]).dot(along) * a - (x[3] - x[1]).dot(along) * b;
  g[1] = (x[2] - x[0]).dot(along) * a + (x[3] - x[0]).dot(along) * b;
  return g;
}

// f of a hinge with a crushed triangle, else 1.
double share_of_gradient(const HingeFrame& f, double least_normal2) {
  const double flatter = std::min(f.N_A2, f.N_B2);
  return flatter < least_normal2 ? flatter / least_normal2 : 1;
}

}  // namespace

BendResponse bend_response(const BendRest& rest, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& v) {
  BendResponse r;
  const HingeFrame frame = hinge_frame(x);
  if (frame.degenerate) {
    r.g.fill(Vec3::Zero());
    return r;
  }
  r.theta = angle(frame);
  r.g = gradient(frame, x);
  if (const double share = share_of_gradient(frame, rest.least_normal2); share < 1)
    for (Vec3& g : r.g) g *= share;
  // The gradient's rows sum to zero: velocities relative to x0, so that a fast common motion costs no digits.
  r.theta_dot = r.g[1].dot(v[1] - v[0]) + r.g[2].dot(v[2] - v[0]) + r.g[3].dot(v[3] - v[0]);
  const double C = r.theta - rest.theta_0;  // never wrapped by 2 pi: a fold that passes pi has passed through itself
  r.moment = rest.kappa_N_m * C;
  r.damping = rest.tau_s * rest.kappa_N_m * r.theta_dot;
  return r;
}

double hinge_angle(const std::array<Vec3, 4>& x) { return angle(hinge_frame(x)); }

std::array<Vec3, 4> hinge_angle_gradient(const std::array<Vec3, 4>& x) { return gradient(hinge_frame(x), x); }

std::array<std::array<Mat3, 4>, 4> hinge_angle_hessian(const std::array<Vec3, 4>& x) {
  std::array<std::array<Mat3, 4>, 4> H;
  for (auto& row : H) row.fill(Mat3::Zero());

  // One triangle at a time: apex p, hinge ends i and j in the triangle's own direction of travel.
  const auto add_triangle = [&](std::size_t p, std::size_t i, std::size_t j) {
    const Vec3 e_p = x[j] - x[i], e_i = x[p] - x[j], e_j = x[i] - x[p];  // edges opposite to p, i, j
    const double L = e_p.norm(), l_i = e_i.norm(), l_j = e_j.norm();
    const Vec3 N = e_p.cross(x[p] - x[i]);
    const double area2 = N.norm();
    const Vec3 n = N / area2;
    const Vec3 m_p = e_p.cross(n) / L, m_i = e_i.cross(n) / l_i, m_j = e_j.cross(n) / l_j;  // outward, in the plane
    const double h_p = area2 / L, h_i = area2 / l_i, h_j = area2 / l_j;                     // heights
    const double c_i = -e_p.dot(e_j) / (L * l_j), c_j = -e_p.dot(e_i) / (L * l_i);          // cosines at i and j
    const auto outer = [](const Vec3& a, const Vec3& b) -> Mat3 { return a * b.transpose(); };
    const auto symmetric = [&](const Vec3& m) -> Mat3 { return outer(n, m) + outer(m, n); };

    const Mat3 S = symmetric(m_p) / (2 * L * L);
    const Mat3 H_pi = (c_j * outer(n, m_p) - outer(m_i, n)) / (h_p * h_i);
    const Mat3 H_pj = (c_i * outer(n, m_p) - outer(m_j, n)) / (h_p * h_j);
    const Mat3 H_ij = (c_j * outer(m_j, n) + c_i * outer(n, m_i)) / (h_i * h_j) + S;
    H[p][p] -= symmetric(m_p) / (h_p * h_p);
    H[i][i] += (c_j / (h_i * h_i)) * symmetric(m_i) - S;
    H[j][j] += (c_i / (h_j * h_j)) * symmetric(m_j) - S;
    H[p][i] += H_pi, H[i][p] += H_pi.transpose();
    H[p][j] += H_pj, H[j][p] += H_pj.transpose();
    H[i][j] += H_ij, H[j][i] += H_ij.transpose();
  };
  add_triangle(2, 0, 1);
  add_triangle(3, 1, 0);
  return H;
}

double bend_weight(double edge_length_m, double area_a_m2, double area_b_m2) {
  const double area = area_a_m2 + area_b_m2;
  if (!(area > 0)) return largest_weight;
  return std::min(largest_weight, edge_length_m * edge_length_m / area);
}

double hinge_rigidity(const Vec2& across, double bend_u_N_m, double bend_v_N_m) {
  const double stiffer = std::max(bend_u_N_m, bend_v_N_m);
  if (bend_u_N_m == bend_v_N_m || !(stiffer > 0)) return bend_u_N_m;
  const double least = stiffer / largest_bend_ratio;
  const double root_u = std::sqrt(std::max(bend_u_N_m, least)), root_v = std::sqrt(std::max(bend_v_N_m, least));
  const double length2 = across.squaredNorm();
  if (!(length2 > 0)) return root_u * root_v;  // no direction: neither thread has the better claim
  const double cos_2b = (across.x() * across.x() - across.y() * across.y()) / length2;
  const double cos_6b = cos_2b * (4 * cos_2b * cos_2b - 3);
  const double z = 1.5 * (root_u - root_v) / (root_u + root_v) * (cos_2b - 0.25 * cos_6b);  // |z| <= 0.74
  return root_u * root_v * (1 + z) / (1 - z);
}

double paper_bend_stiffness(const Vec2& along, double k_u, double k_v) {
  const double length = along.norm();
  if (!(length > 0)) return 0.5 * (k_u + k_v);
  const Vec2 d = along / length;
  return k_u * d.x() * d.x() + k_v * d.y() * d.y();
}

}  // namespace toile::internal
