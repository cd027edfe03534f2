// verify/crossings.cpp: see the header; one tree query per edge.
#include "verify/crossings.hpp"

#include "core/parallel.hpp"
#include "verify/box_tree.hpp"
#include "verify/predicates.hpp"
#include "verify/surface.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace toile::internal {
namespace {

using EdgeEnds = std::array<Index, 2>;

constexpr int frames_per_tree = 30;  // for folding cloth a tree that is only refitted degrades

// A surface and the rank of its particle 0.
struct Surface {
  std::span<const Triangle> triangles;
  std::span<const EdgeEnds> edges;
  std::span<const Vec3> x;
  const BoxTree& tree;
  std::int64_t first_rank = 0;

  const Vec3& at(Index i) const { return x[static_cast<std::size_t>(i)]; }
  RankedPoint ranked(Index i) const { return {at(i), first_rank + i}; }
};

// Each undirected edge once.  Not from mesh/topology: the judge takes surfaces that no solver would (three triangles at
// an edge, flipped neighbours).
std::vector<EdgeEnds> edges_of(std::span<const Triangle> triangles) {
  std::vector<EdgeEnds> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      edges.push_back({low, high});
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  edges.shrink_to_fit();  // nearly every edge was listed twice
  return edges;
}

Vec3 crossing_position(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double above = normal.dot(p - a), below = normal.dot(q - a);
  double t = above / (above - below);
  if (!std::isfinite(t)) t = 0.5;  // coplanar
  return p + std::clamp(t, 0.0, 1.0) * (q - p);
}

// `same`: edges and triangles are of one surface.
std::vector<Crossing> edges_through(const Surface& of_edges, const Surface& of_triangles, bool same,
                                    bool edge_of_body) {
  const std::span<const EdgeEnds> edges = of_edges.edges;
  constexpr std::size_t grain = 2048;
  std::vector<std::vector<Crossing>> found((edges.size() + grain - 1) / grain);
  parallel_blocks(edges.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> triangles;
    for (std::size_t e = begin; e < end; ++e) {
      const Index i = edges[e][0], j = edges[e][1];
      const Vec3 &p = of_edges.at(i), &q = of_edges.at(j);
      ExactBox box;
      box.add(p);
      box.add(q);
      triangles.clear();
      of_triangles.tree.visit_meeting(box, [&](Index t) {
        const auto [a, b, c] = of_triangles.triangles[static_cast<std::size_t>(t)];
        if (same && (i == a || i == b || i == c || j == a || j == b || j == c)) return;
        if (segment_crosses_triangle(of_edges.ranked(i), of_edges.ranked(j), of_triangles.ranked(a),
                                     of_triangles.ranked(b), of_triangles.ranked(c)))
          triangles.push_back(t);
      });
      std::sort(triangles.begin(), triangles.end());
      for (const Index t : triangles) {
        const auto [a, b, c] = of_triangles.triangles[static_cast<std::size_t>(t)];
        const Vec3 position = crossing_position(p, q, of_triangles.at(a), of_triangles.at(b), of_triangles.at(c));
        found[begin / grain].push_back({edges[e], t, position, edge_of_body});
      }
    }
  });
  std::vector<Crossing> all;
  for (const auto& block : found) all.insert(all.end(), block.begin(), block.end());
  return all;
}

// Cloth edges through the body, then the body's through the cloth; most of these lie beside all of the cloth.
std::vector<Crossing> between(const Surface& cloth, const Surface& body) {
  std::vector<Crossing> all = edges_through(cloth, body, false, false);
  const std::vector<Crossing> poking = edges_through(body, cloth, false, true);
  all.insert(all.end(), poking.begin(), poking.end());
  return all;
}

}  // namespace

std::vector<Crossing> find_body_crossings(std::span<const Triangle> cloth, std::span<const Vec3> x,
                                          std::span<const Triangle> body, std::span<const Vec3> body_x) {
  check_surface("cloth", cloth, x);
  check_surface("body", body, body_x);
  const std::vector<EdgeEnds> edges = edges_of(cloth), body_edges = edges_of(body);
  const BoxTree tree(cloth, x), body_tree(body, body_x);
  return between({cloth, edges, x, tree}, {body, body_edges, body_x, body_tree, static_cast<std::int64_t>(x.size())});
}

std::vector<Crossing> find_cloth_crossings(std::span<const Triangle> cloth, std::span<const Vec3> x) {
  check_surface("cloth", cloth, x);
  const std::vector<EdgeEnds> edges = edges_of(cloth);
  const BoxTree tree(cloth, x);
  const Surface surface{cloth, edges, x, tree};
  return edges_through(surface, surface, true, false);
}

CrossingSearch::CrossingSearch(std::vector<Triangle> cloth, std::vector<Triangle> body) {
  cloth_.edges = edges_of(cloth);
  body_.edges = edges_of(body);
  cloth_.triangles = std::move(cloth);
  body_.triangles = std::move(body);
}

CrossingSearch::Found CrossingSearch::find(std::span<const Vec3> x, std::span<const Vec3> body_x) {
  const bool fresh = frames_++ % frames_per_tree == 0;
  const auto moved = [&](Moving& surface, const char* name, std::span<const Vec3> to, std::size_t first_rank) {
    check_surface(name, surface.triangles, to);
    if (fresh || !surface.tree)
      surface.tree.emplace(surface.triangles, to);
    else
      surface.tree->refit(surface.triangles, to);
    return Surface{surface.triangles, surface.edges, to, *surface.tree, static_cast<std::int64_t>(first_rank)};
  };
  const Surface cloth = moved(cloth_, "cloth", x, 0), body = moved(body_, "body", body_x, x.size());
  return {between(cloth, body), edges_through(cloth, cloth, true, false)};
}

int count_edges(std::span<const Crossing> crossings) {
  int count = 0;
  for (std::size_t k = 0; k < crossings.size(); ++k)
    if (k == 0 || crossings[k].edge != crossings[k - 1].edge ||
        crossings[k].edge_of_body != crossings[k - 1].edge_of_body)
      ++count;
  return count;
}

}  // namespace toile::internal
