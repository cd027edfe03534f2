// contact/crossing_finder.cpp: see the header; pairs of triangles from two trees, then each edge by the triangle that owns it.
#include "contact/crossing_finder.hpp"

#include "contact/whole_orientation.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

namespace toile::internal {
namespace {

constexpr std::size_t particle_grain = 4096;
constexpr int least_exponent = -960;  // of a coordinate; 2^(whole_bits + 960) is still a double

void check_finite(std::span<const Vec3> x) {
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!x[i].allFinite())
      throw InputError("", "vertex " + std::to_string(i), "a finite position", "infinity or not a number");
}

// The largest coordinate of the cloth and of the triangles of the body that it may meet.  Distant triangles must not matter: another step
// size would resolve degenerate positions differently.
double largest_coordinate(std::span<const Vec3> cloth, std::span<const Vec3> body,
                          std::span<const Triangle> body_triangles) {
  Eigen::AlignedBox3d around;
  for (const Vec3& p : cloth) around.extend(p);
  if (around.isEmpty()) return 0;
  double largest = std::max(around.min().cwiseAbs().maxCoeff(), around.max().cwiseAbs().maxCoeff());
  const Vec3 margin = Vec3::Constant(1e-3 * std::max(largest, around.diagonal().norm()));  // boxes are rounded outwards
  around = Eigen::AlignedBox3d(around.min() - margin, around.max() + margin);
  for (const Triangle& t : body_triangles) {
    Eigen::AlignedBox3d box;
    for (const Index i : t) box.extend(body[at(i)]);
    if (box.intersects(around))
      largest = std::max({largest, box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()});
  }
  return largest;
}

// x in steps of 2^(e - whole_bits), where `largest` < 2^e.
void round_to_whole(std::span<const Vec3> x, double largest, Vec3s& whole) {
  const int exponent = std::max(largest > 0 ? std::ilogb(largest) + 1 : least_exponent, least_exponent);
  const double steps = std::ldexp(1.0, whole_bits - exponent);  // per metre
  whole.resize(x.size());
  parallel_for(x.size(), particle_grain, [&](std::size_t i) {
    for (Eigen::Index k = 0; k < 3; ++k) whole[i][k] = std::rint(steps * x[i][k]);
  });
}

// Approximate position; anywhere on the edge when it lies in the triangle's plane.
Vec3 position_of(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double above = normal.dot(p - a), below = normal.dot(q - a);
  const double t = above / (above - below);
  return p + (std::isfinite(t) ? std::clamp(t, 0.0, 1.0) : 0.5) * (q - p);
}

bool before(const SurfaceCrossing& a, const SurfaceCrossing& b) {
  return std::tie(a.edge, a.triangle) < std::tie(b.edge, b.triangle);
}

}  // namespace

CrossingFinder::CrossingFinder(const Topology& topology, std::span<const Triangle> triangles,
                               std::size_t cloth_triangles, std::size_t cloth_particles)
    : triangles_(triangles), owned_(triangles.size(), 0) {
  TOILE_ASSERT(cloth_triangles <= triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (at(topology.edges[at(topology.triangle_edges[t][k])].triangle[0]) == t)
        owned_[t] |= static_cast<std::uint8_t>(1u << k);
  body_.triangle = static_cast<Index>(cloth_triangles);
  body_.particle = static_cast<Index>(cloth_particles);
  cloth_.triangles.assign(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(cloth_triangles));
  for (Triangle t : triangles.subspan(cloth_triangles)) {
    for (Index& i : t) i -= body_.particle;
    body_.triangles.push_back(t);
  }
}

void CrossingFinder::refit(std::span<const Vec3> x) {
  check_finite(x);
  const double largest =
      largest_coordinate(x.first(at(body_.particle)), x.subspan(at(body_.particle)), body_.triangles);
  round_to_whole(x, largest, next_whole_);
  const bool first = whole_.size() != x.size();
  const auto cloth = std::span<const Vec3>(next_whole_).first(at(body_.particle));
  const auto body = std::span<const Vec3>(next_whole_).subspan(at(body_.particle));
  if (first) {
    cloth_.tree = TriangleTree(cloth, cloth_.triangles);
    body_.tree = TriangleTree(body, body_.triangles);
  } else {
    cloth_.tree.refit(cloth, cloth, 0);
    // It stands still over many looks.
    if (!std::equal(body.begin(), body.end(), whole_.begin() + body_.particle)) body_.tree.refit(body, body, 0);
  }
  whole_.swap(next_whole_);
}

// Crossings of the edges that triangle `a` owns with triangle `b`.
void CrossingFinder::test(const Side& of_edges, Index a, const Side& of_triangles, Index b, std::span<const Vec3> x,
                          std::vector<SurfaceCrossing>& found) const {
  const std::uint8_t owned = owned_[at(of_edges.triangle + a)];
  const Triangle& local = of_edges.triangles[at(a)];
  const OuterBox& box = of_triangles.tree.triangle_box(b);
  const auto& [i, j, k] = triangles_[at(of_triangles.triangle + b)];
  const auto whole = [&](Index particle) { return WholePoint{whole_[at(particle)], particle}; };
  for (std::size_t side = 0; side < 3; ++side) {
    if ((owned >> side & 1u) == 0) continue;
    Index p = local[side], q = local[(side + 1) % 3];
    if (!of_edges.tree.edge_box(p, q).overlaps(box)) continue;
    if (q < p) std::swap(p, q);
    p += of_edges.particle;
    q += of_edges.particle;
    if (p == i || p == j || p == k || q == i || q == j || q == k) continue;
    if (!passes_through(whole(p), whole(q), whole(i), whole(j), whole(k))) continue;
    found.push_back({{p, q}, of_triangles.triangle + b, position_of(x[at(p)], x[at(q)], x[at(i)], x[at(j)], x[at(k)])});
  }
}

template <class Work>
void CrossingFinder::run_tasks(std::vector<SurfaceCrossing>& found, Work&& work) const {
  std::vector<std::vector<SurfaceCrossing>> by_task(tasks_.size());
  parallel_for(tasks_.size(), 1, [&](std::size_t k) { work(tasks_[k], by_task[k]); });
  const auto first = static_cast<std::ptrdiff_t>(found.size());
  for (const auto& some : by_task) found.insert(found.end(), some.begin(), some.end());
  std::sort(found.begin() + first, found.end(), before);
}

FoundCrossings CrossingFinder::find(std::span<const Vec3> x) {
  TOILE_ASSERT(x.size() >= at(body_.particle));
  refit(x);
  FoundCrossings found;
  cloth_.tree.self_tasks(tasks_);
  run_tasks(found.all, [&](TreeTask task, std::vector<SurfaceCrossing>& some) {
    cloth_.tree.visit_self(task, [&](Index a, Index b) {
      test(cloth_, a, cloth_, b, x, some);
      test(cloth_, b, cloth_, a, x, some);
    });
  });
  found.of_cloth = found.all.size();
  if (body_.triangles.empty()) return found;
  cloth_.tree.cross_tasks(body_.tree, tasks_);
  run_tasks(found.all, [&](TreeTask task, std::vector<SurfaceCrossing>& some) {
    cloth_.tree.visit_cross(body_.tree, task, [&](Index a, Index b) {
      test(cloth_, a, body_, b, x, some);
      test(body_, b, cloth_, a, x, some);
    });
  });
  return found;
}

std::vector<Triangle> joined_triangles(std::span<const Triangle> cloth, std::size_t particles,
                                       std::span<const Triangle> body) {
  std::vector<Triangle> all(cloth.begin(), cloth.end());
  for (Triangle t : body) {
    for (Index& i : t) i += static_cast<Index>(particles);
    all.push_back(t);
  }
  return all;
}

FoundCrossings find_crossings(std::span<const Triangle> cloth, std::span<const Vec3> x, std::span<const Triangle> body,
                              std::span<const Vec3> body_x) {
  const std::vector<Triangle> all = joined_triangles(cloth, x.size(), body);
  Vec3s all_x(x.begin(), x.end());
  all_x.insert(all_x.end(), body_x.begin(), body_x.end());
  const Topology topology = build_topology(static_cast<Index>(all_x.size()), all);
  return CrossingFinder(topology, all, cloth.size(), x.size()).find(all_x);
}

int count_crossing_edges(std::span<const SurfaceCrossing> crossings) {
  int count = 0;
  for (std::size_t k = 0; k < crossings.size(); ++k)
    if (k == 0 || crossings[k].edge != crossings[k - 1].edge) ++count;
  return count;
}

}  // namespace toile::internal
