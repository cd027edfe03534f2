#include "mesh/join_sides.hpp"

#include "core/disjoint_sets.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

namespace toile::internal {
namespace {

// A side of a triangle, from vertex `a` to `b`, and the places of its ends and of the corner beside it.
struct Side {
  Index low, high;  // places, low < high
  bool forward;     // from low to high
  Index part, a, b, beside;

  auto key() const { return std::tie(low, high); }
  auto order() const { return std::tie(low, high, part, forward, a, b, beside); }
};

// [vertex] a number that vertices at one place share.
std::vector<Index> places_of(std::span<const Vec3> x) {
  std::vector<Index> order(x.size()), place(x.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at_place = [&](Index i) { return std::tie(x[at(i)].x(), x[at(i)].y(), x[at(i)].z()); };
  std::sort(order.begin(), order.end(), [&](Index i, Index j) {
    const auto p = at_place(i), q = at_place(j);
    return p < q || (p == q && i < j);
  });
  Index number = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && at_place(order[k]) != at_place(order[k - 1])) ++number;
    place[at(order[k])] = number;
  }
  return place;
}

// Of the sides between two places those without a neighbour on the same vertices.
std::vector<Side> without_neighbour(std::span<const Side> sides) {
  const auto ends = [](const Side& s) { return std::pair(std::min(s.a, s.b), std::max(s.a, s.b)); };
  std::vector<Side> sorted(sides.begin(), sides.end()), open;
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Side& l, const Side& r) { return ends(l) < ends(r); });
  for (std::size_t i = 0, j = 0; i < sorted.size(); i = j) {
    std::array<std::vector<Side>, 2> ways;
    for (; j < sorted.size() && ends(sorted[j]) == ends(sorted[i]); ++j)
      ways[sorted[j].a < sorted[j].b ? 0 : 1].push_back(sorted[j]);
    const std::size_t answered = std::min(ways[0].size(), ways[1].size());
    for (const auto& way : ways)
      open.insert(open.end(), way.begin() + static_cast<std::ptrdiff_t>(answered), way.end());
  }
  std::stable_sort(open.begin(), open.end(), [](const Side& l, const Side& r) { return l.part < r.part; });
  return open;
}

}  // namespace

JoinedSides join_sides(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                       std::span<const Index> part) {
  const std::vector<Index> place = places_of(positions);
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3], c = triangles[t][(k + 2) % 3];
      const Index from = place[at(a)], to = place[at(b)];
      if (from == to) continue;  // no side
      sides.push_back({std::min(from, to), std::max(from, to), from < to, part.size() == triangles.size() ? part[t] : 0,
                       a, b, place[at(c)]});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& l, const Side& r) { return l.order() < r.order(); });

  JoinedSides joined;
  DisjointSets sets(positions.size());  // the first vertex of a set represents it
  // Joins the two, if no other pair is possible.
  const auto join = [&](std::span<const Side> open) {
    if (open.size() != 2 || open[0].forward == open[1].forward || open[0].beside == open[1].beside) return false;
    sets.join(open[0].a, open[1].b);
    sets.join(open[0].b, open[1].a);
    return true;
  };
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].key() == sides[begin].key()) ++end;
    const std::vector<Side> open = without_neighbour(std::span(sides).subspan(begin, end - begin));
    std::vector<Side> rest;
    for (std::size_t i = 0, j = 0; i < open.size(); i = j) {
      while (j < open.size() && open[j].part == open[i].part) ++j;
      const auto of_part = std::span(open).subspan(i, j - i);
      if (!join(of_part)) rest.insert(rest.end(), of_part.begin(), of_part.end());
    }
    if (rest.size() > 1 && !join(rest)) joined.left += rest.size();
  }

  joined.same_as = sets.representatives();
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (at(joined.same_as[i]) != i) ++joined.joined;
  return joined;
}

std::vector<Triangle> joined_triangles(std::span<const Triangle> triangles, const JoinedSides& joined) {
  std::vector<Triangle> of_first(triangles.begin(), triangles.end());
  for (Triangle& t : of_first)
    for (Index& i : t) i = joined.same_as[at(i)];
  return of_first;
}

}  // namespace toile::internal
