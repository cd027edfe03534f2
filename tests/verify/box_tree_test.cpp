// The judge's tree, against looking at every triangle.
#include "verify/box_tree.hpp"
#include "verify/nearest_point.hpp"

#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace toile::internal {
namespace {

struct Soup {
  std::vector<Triangle> triangles;
  Vec3s x;

  // `count` triangles of about a tenth of `extent`, apart from each other in a cube of that extent.
  Soup(Index count, double extent, std::uint64_t seed) {
    test::Random random(seed);
    for (Index t = 0; t < count; ++t) {
      const Vec3 middle = random.vector(extent);
      for (int k = 0; k < 3; ++k) x.push_back(middle + random.vector(0.1 * extent));
      triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
  }
  ExactBox box(Index t) const {
    ExactBox box;
    for (const Index i : triangles[static_cast<std::size_t>(t)]) box.add(x[static_cast<std::size_t>(i)]);
    return box;
  }
  double squared_distance(const Vec3& p, Index t) const {
    const auto [a, b, c] = triangles[static_cast<std::size_t>(t)];
    return squared_distance_to_triangle(p, x[static_cast<std::size_t>(a)], x[static_cast<std::size_t>(b)],
                                        x[static_cast<std::size_t>(c)]);
  }
};

bool meet(const ExactBox& a, const ExactBox& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

// Also where single precision would end, and after a refit to somewhere else.
TEST(BoxTree, VisitsExactlyTheTrianglesWhoseBoxIsMet) {
  for (const double extent : {1e-42, 1e-3, 1.0, 1e6, 1e37, 1e60}) {
    for (const Index count : {1, 3, 4, 5, 6, 8, 9, 17, 300}) {
      const Soup soup(count, extent, static_cast<std::uint64_t>(count));
      BoxTree moved(soup.triangles, Soup(count, extent, 1000).x);
      moved.refit(soup.triangles, soup.x);
      for (const BoxTree& tree : {BoxTree(soup.triangles, soup.x), moved}) {
        for (Index t = 0; t < std::min<Index>(count, 40); ++t) {
          const ExactBox box = soup.box(t);
          std::vector<Index> visited;
          tree.visit_meeting(box, [&](Index k) { visited.push_back(k); });
          std::sort(visited.begin(), visited.end());
          std::vector<Index> met;
          for (Index k = 0; k < count; ++k)
            if (meet(box, soup.box(k))) met.push_back(k);
          EXPECT_EQ(visited, met) << extent << " " << count << ": " << t;
        }
      }
    }
  }
}

TEST(BoxTree, FindsTheNearestTriangleFromNothingFromAGuessAndWithinAReach) {
  for (const double extent : {1e-3, 1.0, 1e6, 1e30}) {
    const Soup soup(300, extent, 5);
    const BoxTree tree(soup.triangles, soup.x);
    test::Random random(6);
    for (int q = 0; q < 200; ++q) {
      const Vec3 p = random.vector(1.5 * extent);
      const auto to = [&](Index t) { return soup.squared_distance(p, t); };
      double least = std::numeric_limits<double>::infinity();
      for (Index t = 0; t < 300; ++t) least = std::min(least, to(t));
      EXPECT_EQ(tree.nearest(p, {}, to).squared_distance, least);
      EXPECT_EQ(tree.nearest(p, {7, to(7)}, to).squared_distance, least);
      EXPECT_EQ(tree.nearest(p, {-1, 2 * least}, to).squared_distance, least);
      EXPECT_EQ(tree.nearest(p, {-1, 0.5 * least}, to).triangle, -1);
    }
  }
}

TEST(BoxTree, LooksAtFewOfManyTriangles) {
  const Soup soup(20000, 1, 9);
  const BoxTree tree(soup.triangles, soup.x);
  const Vec3 p(0.1, 0.2, 0.3);  // on no triangle
  int looked = 0;
  tree.nearest(p, {}, [&](Index t) {
    ++looked;
    return soup.squared_distance(p, t);
  });
  EXPECT_LT(looked, 2000);
}

}  // namespace
}  // namespace toile::internal
