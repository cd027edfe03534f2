#include "garment/gathers.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace toile::internal {
namespace {

// Of the area as drawn.  A triangle that would get less, or whose three lengths violate the triangle inequality, stays as drawn.
constexpr double least_area = 0.02;
constexpr double fine_edge_m = 0.01;

using Pair = std::pair<Index, Index>;  // of particles, the smaller first

struct Piece {  // of a gathered seam, in the drawing
  Vec2 from, to;
  double ratio = 1, reach_m = 0;
};

// The symmetric matrix G with e . G e = the squared rest length of each of the three sides e of a triangle.
Mat2 metric(const std::array<Vec2, 3>& uv, const std::array<double, 3>& side_m) {
  Mat2 sides;
  sides << uv[1] - uv[0], uv[2] - uv[0];
  const double a = side_m[0] * side_m[0], b = side_m[2] * side_m[2], opposite = side_m[1] * side_m[1];
  Mat2 gram;
  gram << a, (a + b - opposite) / 2, (a + b - opposite) / 2, b;
  const Mat2 inverse = sides.inverse();
  return inverse.transpose() * gram * inverse;
}

// The square root of a symmetric positive definite matrix, by Cayley and Hamilton.
Mat2 root(const Mat2& g) {
  const double area = std::sqrt(g.determinant());
  return (g + area * Mat2::Identity()) / std::sqrt(g.trace() + 2 * area);
}

class Gathering {
 public:
  Gathering(const ClothMesh& mesh, std::span<const Gather> gathers) : mesh_(mesh) {
    std::vector<Vec2> drawn(at(mesh.particle_count));
    std::vector<Index> panel_of(at(mesh.particle_count), -1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index i = mesh.triangles[t][k], j = mesh.triangles[t][(k + 1) % 3];
        drawn[at(i)] = mesh.uv[t][k];
        panel_of[at(i)] = mesh.panel[t];
        ++triangles_of_[std::minmax(i, j)];
      }
    }
    pieces_.resize(mesh.panel_names.size());
    reached_.resize(mesh.panel_names.size());
    for (const Gather& gather : gathers) {
      for (std::size_t k = 0; k + 1 < gather.particles.size(); ++k) {
        const Index i = gather.particles[k], j = gather.particles[k + 1];
        const double reach_m = std::max(gather_reach_m, gather_reach_edges * (drawn[at(j)] - drawn[at(i)]).norm());
        pieces_[at(panel_of[at(i)])].push_back({drawn[at(i)], drawn[at(j)], gather.ratio, reach_m});
        for (const Vec2& p : {drawn[at(i)], drawn[at(j)]}) {
          reached_[at(panel_of[at(i)])].extend(p + Vec2::Constant(reach_m));
          reached_[at(panel_of[at(i)])].extend(p - Vec2::Constant(reach_m));
        }
        sewn_[std::minmax(i, j)] = gather.piece_m[k];
      }
    }
  }

  std::array<Vec2, 3> shape(std::size_t t) const {
    const std::array<Vec2, 3>& uv = mesh_.uv[t];
    const std::vector<Piece>& pieces = pieces_[at(mesh_.panel[t])];
    if (std::none_of(uv.begin(), uv.end(), [&](const Vec2& p) { return reached_[at(mesh_.panel[t])].contains(p); }))
      return uv;
    std::array<double, 3> side_m{};
    bool changed = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const double drawn_m = (uv[(k + 1) % 3] - uv[k]).norm();
      side_m[k] = rest_length(std::minmax(mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3]), uv[k],
                              uv[(k + 1) % 3], pieces);
      changed = changed || side_m[k] != drawn_m;
    }
    if (!changed) return uv;
    const Mat2 g = metric(uv, side_m);
    if (!(g.determinant() > least_area * least_area) || !(g.trace() > 0)) return uv;
    const Mat2 stretch = root(g);
    return {stretch * uv[0], stretch * uv[1], stretch * uv[2]};
  }

 private:
  double rest_length(const Pair& edge, const Vec2& a, const Vec2& b, const std::vector<Piece>& pieces) const {
    const double drawn_m = (b - a).norm();
    if (const auto sewn = sewn_.find(edge); sewn != sewn_.end()) return sewn->second;
    if (triangles_of_.at(edge) == 1) return drawn_m;  // another seam, or a hem
    const Vec2 middle = 0.5 * (a + b);
    const Piece* nearest = nullptr;
    double distance2 = std::numeric_limits<double>::infinity();
    for (const Piece& piece : pieces) {
      const Vec2 along = piece.to - piece.from;
      const double s = std::clamp((middle - piece.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double d2 = (middle - piece.from - s * along).squaredNorm();
      if (d2 >= distance2) continue;
      distance2 = d2;
      nearest = &piece;
    }
    const double share = std::sqrt(distance2) / nearest->reach_m;
    if (share >= 1) return drawn_m;
    const double s = 1 / nearest->ratio + (1 - 1 / nearest->ratio) * share;
    const double along_m = (b - a).dot((nearest->to - nearest->from).normalized());
    return std::sqrt(drawn_m * drawn_m - (1 - s * s) * along_m * along_m);
  }

  const ClothMesh& mesh_;
  std::map<Pair, int> triangles_of_;          // [edge] the number of its triangles
  std::map<Pair, double> sewn_;               // [edge on a gathered seam] rest length
  std::vector<std::vector<Piece>> pieces_;    // [panel]
  std::vector<Eigen::AlignedBox2d> reached_;  // [panel] around its pieces; empty of a panel without
};

}  // namespace

double gather_edge_m(double resolution_m) { return std::min(resolution_m, std::max(fine_edge_m, resolution_m / 2)); }

std::vector<GatheredSeam> gathered_seams(const Pattern& pattern) {
  std::vector<GatheredSeam> seams;
  for (const Stitch& stitch : pattern.stitches) {
    const auto length = [&](const StitchSide& side) {
      const Panel& panel = pattern.panels[at(side.panel)];
      return edge_length_m(panel, panel.edges[at(side.edge)]);
    };
    const double a_m = length(stitch.a), b_m = length(stitch.b);
    if (a_m > gathered_ratio * b_m) seams.push_back({stitch.a, stitch.b, a_m});
    if (b_m > gathered_ratio * a_m) seams.push_back({stitch.b, stitch.a, b_m});
  }
  return seams;
}

void gather(ClothMesh& mesh, std::span<const Gather> gathers) {
  if (gathers.empty()) return;
  const Gathering gathering(mesh, gathers);
  mesh.gathered_uv = mesh.uv;
  for (std::size_t t = 0; t < mesh.uv.size(); ++t) mesh.gathered_uv[t] = gathering.shape(t);
}

}  // namespace toile::internal
