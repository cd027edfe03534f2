// mesh/mend_corners.cpp: what single vertices and triangles have wrong.
#include "core/disjoint_sets.hpp"
#include "mesh/half_edges.hpp"
#include "mesh/triangle_repair.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace toile::internal {
namespace {

std::array<Vec3, 3> corners(const Triangle& t, std::span<const Vec3> x) {
  return {x[at(t[0])], x[at(t[1])], x[at(t[2])]};
}

bool has_corner_twice(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// Calls with the first and one past the last half edge of every edge.
template <class F>
void for_each_edge(std::span<const HalfEdge> half_edges, const F& f) {
  for (std::size_t first = 0; first < half_edges.size();) {
    const std::size_t end = edge_end(half_edges, first);
    f(half_edges.subspan(first, end - first));
    first = end;
  }
}

// Removes the triangles for which `is_gone`, and returns their number.
template <class F>
std::size_t remove_triangles(MendedTriangles& mesh, const F& is_gone) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_gone(t)) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    mesh.source[kept++] = mesh.source[t];
  }
  const std::size_t gone = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  mesh.source.resize(kept);
  return gone;
}

std::size_t drop_degenerate(MendedTriangles& mesh) {
  return remove_triangles(mesh, [&](std::size_t t) { return has_corner_twice(mesh.triangles[t]); });
}

// Two that face each other enclose nothing, so they are one, too.
std::size_t drop_duplicates(MendedTriangles& mesh) {
  std::vector<std::pair<Triangle, std::size_t>> named;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    named.emplace_back(mesh.triangles[t], t);
    std::sort(named.back().first.begin(), named.back().first.end());
  }
  std::sort(named.begin(), named.end());
  std::vector<char> gone(mesh.triangles.size(), 0);
  for (std::size_t n = 1; n < named.size(); ++n)
    if (named[n].first == named[n - 1].first) gone[named[n].second] = 1;
  return remove_triangles(mesh, [&](std::size_t t) { return gone[t] != 0; });
}

std::size_t weld(MendedTriangles& mesh, std::span<const Vec3> x, double reach) {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh.triangles);
  DisjointSets sets(x.size());
  std::vector<Index> loose;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2 || edge[0].forward == edge[1].forward) loose.insert(loose.end(), {edge[0].a, edge[0].b});
    if ((x[at(edge[0].a)] - x[at(edge[0].b)]).norm() <= reach) sets.join(edge[0].a, edge[0].b);  // no length
  });
  std::sort(loose.begin(), loose.end());
  loose.erase(std::unique(loose.begin(), loose.end()), loose.end());
  // Along a direction to which no face of a model is square: few vertices lie at one place of it.
  const Vec3 way = Vec3(0.803, 0.211, 0.557).normalized();
  const auto along = [&](Index i) { return way.dot(x[at(i)]); };
  std::sort(loose.begin(), loose.end(),
            [&](Index i, Index j) { return std::tuple(along(i), i) < std::tuple(along(j), j); });
  for (std::size_t i = 0; i < loose.size(); ++i)
    for (std::size_t j = i + 1; j < loose.size() && along(loose[j]) - along(loose[i]) <= reach; ++j)
      if ((x[at(loose[i])] - x[at(loose[j])]).norm() <= reach) sets.join(loose[i], loose[j]);
  const std::vector<Index> same_as = sets.representatives();
  std::size_t welded = 0;
  for (std::size_t i = 0; i < same_as.size(); ++i) welded += at(same_as[i]) != i ? 1 : 0;
  for (Triangle& t : mesh.triangles)
    for (Index& corner : t) corner = same_as[at(corner)];
  return welded;
}

// The side across from which the third corner lies flat: the longest.
std::size_t longest_side(const Triangle& t, std::span<const Vec3> x) {
  const auto length2 = [&](std::size_t k) { return (x[at(t[k])] - x[at(t[(k + 1) % 3])]).squaredNorm(); };
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (length2(k) > length2(longest)) longest = k;
  return longest;
}

std::size_t swap_flat_once(MendedTriangles& mesh, std::span<const Vec3> x) {
  std::vector<Index> flat;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_flat(corners(mesh.triangles[t], x))) flat.push_back(static_cast<Index>(t));
  if (flat.empty()) return 0;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh.triangles);
  const auto edge_of = [&](Index a, Index b) {
    const std::pair key(std::min(a, b), std::max(a, b));
    const auto first = std::lower_bound(sides.begin(), sides.end(), key,
                                        [](const HalfEdge& s, const auto& k) { return std::pair(s.a, s.b) < k; });
    std::size_t count = 0;
    while (first + static_cast<std::ptrdiff_t>(count) != sides.end() &&
           first[static_cast<std::ptrdiff_t>(count)].a == key.first &&
           first[static_cast<std::ptrdiff_t>(count)].b == key.second)
      ++count;
    return std::span(sides).subspan(static_cast<std::size_t>(first - sides.begin()), count);
  };
  std::vector<char> touched(mesh.triangles.size(), 0);
  std::size_t swapped = 0;
  for (const Index t : flat) {
    const Triangle thin = mesh.triangles[at(t)];
    const std::size_t k = longest_side(thin, x);
    const Index a = thin[k], b = thin[(k + 1) % 3], c = thin[(k + 2) % 3];
    const auto edge = edge_of(a, b);
    if (edge.size() != 2 || edge[0].forward == edge[1].forward) continue;
    const HalfEdge& across = edge[0].triangle == t ? edge[1] : edge[0];
    const Index d = mesh.triangles[at(across.triangle)][(static_cast<std::size_t>(across.side) + 2) % 3];
    if (touched[at(t)] != 0 || touched[at(across.triangle)] != 0 || d == c || !edge_of(c, d).empty()) continue;
    mesh.triangles[at(t)] = {a, d, c};
    mesh.triangles[at(across.triangle)] = {d, b, c};
    touched[at(t)] = touched[at(across.triangle)] = 1;
    ++swapped;
  }
  return swapped;
}

}  // namespace

bool is_flat(const std::array<Vec3, 3>& corner) {
  constexpr double smallest = 1e-9;
  const Vec3 a = corner[1] - corner[0], b = corner[2] - corner[0];
  return !(0.5 * a.cross(b).norm() > smallest * std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()}));
}

std::size_t swap_flat(MendedTriangles& mesh, std::span<const Vec3> positions) {
  constexpr int most_passes = 16;  // flat triangles beside flat ones wait for each other
  std::size_t swapped = 0;
  for (int pass = 0; pass < most_passes; ++pass) {
    const std::size_t more = swap_flat_once(mesh, positions);
    if (more == 0) break;
    swapped += more;
  }
  return swapped;
}

MendedCorners mend_corners(MendedTriangles& mesh, std::span<const Vec3> positions, double reach) {
  MendedCorners mended;
  mended.degenerate = drop_degenerate(mesh);
  mended.welded = weld(mesh, positions, reach);
  mended.degenerate += drop_degenerate(mesh);
  mended.duplicate = drop_duplicates(mesh);
  mended.flat = swap_flat(mesh, positions);
  return mended;
}

}  // namespace toile::internal
