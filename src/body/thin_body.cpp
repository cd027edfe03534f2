#include "body/thin_body.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::internal {
namespace {

// Of the square of the height: arms become tubes of some 6 cm.  Thinner ones (1e-3: 2 cm) let cuffs collapse around them while they are
// sewn, and layers are caught in their seams; the full arm stands in the way of sleeves.
constexpr double flow_time = 2e-4;
constexpr std::array<double, 4> steps{1.0 / 15, 2.0 / 15, 4.0 / 15, 8.0 / 15};  // of the time: details vanish first
constexpr double largest_cotangent = 50;                                        // of a needle
constexpr double least_area_m2 = 1e-9;                                          // of a vertex in no triangle

using Matrix = Eigen::SparseMatrix<double>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

double cotangent(const Vec3& apex, const Vec3& a, const Vec3& b) {
  const Vec3 p = a - apex, q = b - apex;
  const double area = p.cross(q).norm();
  return area > 0 ? std::clamp(p.dot(q) / area, 0.0, largest_cotangent) : 0;
}

// L, positive semidefinite: row i is the sum over neighbours of (cot a + cot b) / 2 (x_i - x_j).
Matrix cotangents(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * triangles.size() + x.size());
  for (std::size_t i = 0; i < x.size(); ++i) entries.emplace_back(static_cast<Index>(i), static_cast<Index>(i), 0.0);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      const double w = 0.5 * cotangent(x[at(t[k])], x[at(a)], x[at(b)]);
      entries.emplace_back(a, b, -w);
      entries.emplace_back(b, a, -w);
      entries.emplace_back(a, a, w);
      entries.emplace_back(b, b, w);
    }
  }
  Matrix laplacian(static_cast<Eigen::Index>(x.size()), static_cast<Eigen::Index>(x.size()));
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

std::vector<double> vertex_areas(const Columns& x, std::span<const Triangle> triangles) {
  std::vector<double> areas(static_cast<std::size_t>(x.rows()), least_area_m2);
  for (const Triangle& t : triangles) {
    const Vec3 a = x.row(t[0]), b = x.row(t[1]), c = x.row(t[2]);
    const double third = (b - a).cross(c - a).norm() / 6;
    for (const Index i : t) areas[at(i)] += third;
  }
  return areas;
}

double way(const Vec3s& a, const Vec3s& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, a.size())));
}

}  // namespace

ThinBody::ThinBody(std::span<const Vec3> full, std::span<const Triangle> triangles) {
  shapes_.emplace_back(full.begin(), full.end());
  double low = 0, high = 0;
  if (!full.empty()) {
    const auto [least, most] =
        std::minmax_element(full.begin(), full.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
    low = least->y();
    high = most->y();
  }
  const double time_m2 = flow_time * (high - low) * (high - low);
  const Matrix laplacian = cotangents(full, triangles);
  Columns x(static_cast<Eigen::Index>(full.size()), 3);
  for (std::size_t i = 0; i < full.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = full[i];
  Eigen::SimplicialLDLT<Matrix> solver;
  solver.analyzePattern(laplacian);
  for (const double step : steps) {
    const std::vector<double> areas = vertex_areas(x, triangles);
    Matrix system = step * time_m2 * laplacian;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const double area = areas[static_cast<std::size_t>(i)];
      system.coeffRef(i, i) += area;
      x.row(i) *= area;
    }
    solver.factorize(system);
    if (solver.info() != Eigen::Success) break;  // keep the thinnest shape so far
    x = solver.solve(x).eval();
    Vec3s shape(full.size());
    for (std::size_t i = 0; i < shape.size(); ++i) shape[i] = x.row(static_cast<Eigen::Index>(i));
    shapes_.push_back(std::move(shape));
  }
  std::reverse(shapes_.begin(), shapes_.end());
  shares_.push_back(0);
  for (std::size_t k = 1; k < shapes_.size(); ++k) shares_.push_back(shares_.back() + way(shapes_[k - 1], shapes_[k]));
  const double whole = shares_.back();
  for (double& share : shares_) share = whole > 0 ? share / whole : 1;
}

void ThinBody::at(double share, std::span<Vec3> x) const {
  std::size_t k = 1;
  while (k < shares_.size() && shares_[k] <= share) ++k;
  if (k >= shares_.size()) {
    std::copy(shapes_.back().begin(), shapes_.back().end(), x.begin());
    return;
  }
  const double s = (share - shares_[k - 1]) / (shares_[k] - shares_[k - 1]);
  for (std::size_t i = 0; i < shapes_[k].size(); ++i) x[i] = (1 - s) * shapes_[k - 1][i] + s * shapes_[k][i];
}

}  // namespace toile::internal
