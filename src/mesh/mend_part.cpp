// mesh/mend_part.cpp: makes one part a closed surface, seen from outside.
#include "core/disjoint_sets.hpp"
#include "mesh/boundary_loops.hpp"
#include "mesh/half_edges.hpp"
#include "mesh/inner_walls.hpp"
#include "mesh/triangle_repair.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

namespace toile::internal {
namespace {

constexpr double small_holes = 0.1;  // discs of their girths, of the part's area

// Pairs of triangles at one edge.
struct Neighbour {
  Index triangle, other;
  bool agrees;  // they walk it in opposite directions
  std::array<Index, 2> edge;
};

// Those of edges with two triangles, both ways, sorted; the first edge with more goes to `crowded`.
std::vector<Neighbour> neighbours(std::span<const Triangle> triangles, std::array<Index, 2>& crowded) {
  const std::vector<HalfEdge> sides = sorted_half_edges(triangles);
  std::vector<Neighbour> result;
  for (std::size_t first = 0; first < sides.size();) {
    const std::size_t end = edge_end(sides, first);
    const HalfEdge& one = sides[first];
    if (end - first == 2) {
      const HalfEdge& two = sides[first + 1];
      const bool agrees = one.forward != two.forward;
      result.push_back({one.triangle, two.triangle, agrees, {one.a, one.b}});
      result.push_back({two.triangle, one.triangle, agrees, {one.a, one.b}});
    } else if (end - first > 2 && crowded[0] < 0) {
      crowded = {one.a, one.b};
    }
    first = end;
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Neighbour& l, const Neighbour& r) { return l.triangle < r.triangle; });
  return result;
}

// The triangles of a piece that hangs together by edges, the smallest first.
using Shell = std::vector<Index>;

// Which triangles have to be turned, so that all agree with the first of their shell.
std::vector<Shell> make_agree(std::span<const Neighbour> of, std::size_t count, std::vector<char>& turned,
                              std::array<Index, 2>& one_sided) {
  std::vector<std::size_t> first(count + 1, 0);
  for (const Neighbour& n : of) ++first[at(n.triangle) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  turned.assign(count, 0);
  std::vector<char> reached(count, 0);
  std::vector<Shell> shells;
  for (std::size_t start = 0; start < count; ++start) {
    if (reached[start] != 0) continue;
    reached[start] = 1;
    Shell shell{static_cast<Index>(start)};
    for (std::size_t k = 0; k < shell.size(); ++k) {
      const std::size_t t = at(shell[k]);
      for (std::size_t n = first[t]; n < first[t + 1]; ++n) {
        const std::size_t other = at(of[n].other);
        const char wanted = of[n].agrees ? turned[t] : static_cast<char>(1 - turned[t]);
        if (reached[other] == 0) {
          reached[other] = 1;
          turned[other] = wanted;
          shell.push_back(of[n].other);
        } else if (turned[other] != wanted && one_sided[0] < 0) {
          one_sided = of[n].edge;
        }
      }
    }
    shells.push_back(std::move(shell));
  }
  return shells;
}

double volume(std::span<const Triangle> triangles, std::span<const Index> of, std::span<const Vec3> x) {
  const Vec3& origin = x[at(triangles[at(of[0])][0])];  // near the part: the volume keeps its digits
  double sum = 0;
  for (const Index t : of) {
    const auto [a, b, c] = triangles[at(t)];
    sum += (x[at(a)] - origin).dot((x[at(b)] - origin).cross(x[at(c)] - origin));
  }
  return sum;
}

Hole hole_of(std::vector<Index> loop, std::span<const Vec3> x) {
  Hole hole;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    hole.girth += (x[at(loop[(i + 1) % loop.size()])] - x[at(loop[i])]).norm();
    hole.middle += x[at(loop[i])] / static_cast<double>(loop.size());
  }
  hole.loop = std::move(loop);
  return hole;
}

void cap_holes(MendedTriangles& part, std::span<const Vec3> x, MendedPart& mended) {
  double area = 0, discs = 0;
  for (const auto& [a, b, c] : part.triangles) area += 0.5 * (x[at(b)] - x[at(a)]).cross(x[at(c)] - x[at(a)]).norm();
  std::vector<Hole> holes;
  for (std::vector<Index>& loop : boundary_loops(part.triangles)) {
    holes.push_back(hole_of(std::move(loop), x));
    discs += holes.back().girth * holes.back().girth / (4 * std::numbers::pi);
  }
  if (holes.empty()) return;
  if (discs > small_holes * area) {
    mended.open = std::move(holes);
    return;
  }
  const std::vector<Triangle> before = part.triangles;
  for (const Hole& hole : holes)
    for (const Triangle& t : cap(hole.loop, before, x)) {
      part.triangles.push_back(t);
      part.source.push_back(-1);
    }
  mended.capped = std::move(holes);
  swap_flat(part, x);
}

// A sheet has no outside: it looks where most of its triangles looked.
void look_as_most_did(std::span<const Shell> shells, MendedTriangles& part, std::vector<char>& turned) {
  for (const Shell& shell : shells) {
    std::size_t count = 0;
    for (const Index t : shell) count += turned[at(t)] != 0 ? 1 : 0;
    if (2 * count <= shell.size()) continue;
    for (const Index t : shell) {
      std::swap(part.triangles[at(t)][1], part.triangles[at(t)][2]);
      turned[at(t)] = static_cast<char>(1 - turned[at(t)]);
    }
  }
}

}  // namespace

MendedPart mend_part(MendedTriangles& part, std::span<const Vec3> positions) {
  MendedPart mended;
  const std::vector<char> wall = inner_walls(part.triangles, positions);
  MendedTriangles kept;
  for (std::size_t t = 0; t < part.triangles.size(); ++t) {
    if (wall[t] != 0) continue;
    kept.triangles.push_back(part.triangles[t]);
    kept.source.push_back(part.source[t]);
  }
  mended.walls = part.triangles.size() - kept.triangles.size();
  part = std::move(kept);

  const auto turn = [&](std::size_t t) { std::swap(part.triangles[t][1], part.triangles[t][2]); };
  std::vector<char> turned;
  const std::vector<Neighbour> near = neighbours(part.triangles, mended.crowded);
  const std::vector<Shell> shells = make_agree(near, part.triangles.size(), turned, mended.one_sided);
  const std::size_t of_file = part.triangles.size();
  for (std::size_t t = 0; t < of_file; ++t)
    if (turned[t] != 0) turn(t);
  if (mended.closed()) cap_holes(part, positions, mended);
  if (!mended.open.empty()) look_as_most_did(shells, part, turned);
  if (mended.closed()) {
    std::vector<char> ignored;
    turned.resize(part.triangles.size(), 0);
    const std::vector<Neighbour> capped = neighbours(part.triangles, mended.crowded);
    for (const Shell& shell : make_agree(capped, part.triangles.size(), ignored, mended.one_sided)) {
      if (volume(part.triangles, shell, positions) >= 0) continue;
      for (const Index t : shell) {
        turn(at(t));
        turned[at(t)] = static_cast<char>(1 - turned[at(t)]);
      }
    }
  }
  for (std::size_t t = 0; t < of_file; ++t) mended.turned += turned[t] != 0 ? 1 : 0;
  return mended;
}

}  // namespace toile::internal
