#include "contact/triangle_tree.hpp"

#include "contact/meshes.hpp"
#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace toile::internal {
namespace {

using contact_test::Mesh;
using contact_test::Random;
using Pairs = std::vector<std::pair<Index, Index>>;

Mesh soup(Random& random, Index count, double size) {
  Mesh mesh;
  for (Index t = 0; t < count; ++t) {
    const Vec3 at = random.vector(1);
    for (int k = 0; k < 3; ++k) mesh.x.push_back(at + random.vector(size));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

// The box of triangle t over the motion, in double precision; `grow` on every side.
Box exact_box(const Mesh& mesh, std::span<const Vec3> end, std::size_t t, double grow) {
  Box box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
  for (const Index i : mesh.triangles[t]) {
    for (const Vec3& p : {mesh.x[static_cast<std::size_t>(i)], end[static_cast<std::size_t>(i)]}) {
      box.low = box.low.cwiseMin(p);
      box.high = box.high.cwiseMax(p);
    }
  }
  box.low.array() -= grow;
  box.high.array() += grow;
  return box;
}

// Every pair of overlapping boxes must be listed, and nothing whose boxes stay apart when grown by the rounding.
void expect_pairs(const Pairs& pairs, const std::vector<Box>& a, const std::vector<Box>& b, bool same) {
  ASSERT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
  ASSERT_TRUE(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end()) << "a pair twice";
  std::size_t listed = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = same ? i + 1 : 0; j < b.size(); ++j) {
      const bool found =
          listed < pairs.size() && pairs[listed] == std::pair(static_cast<Index>(i), static_cast<Index>(j));
      listed += found;
      if (found) {
        Box grown = a[i];
        grown.low.array() -= 1e-5;
        grown.high.array() += 1e-5;
        ASSERT_TRUE(grown.overlaps(b[j])) << i << " " << j << " listed without reason";
      } else {
        ASSERT_FALSE(a[i].overlaps(b[j])) << i << " " << j << " missed";
      }
    }
  }
  ASSERT_EQ(listed, pairs.size());
}

TEST(TriangleTree, ListsExactlyTheOverlappingPairs) {
  Random random(1);
  PairWorkspace workspace;
  for (int trial = 0; trial < 300; ++trial) {
    const Mesh first = soup(random, random.below(90), random.in(0, 0.4));
    const Mesh second = soup(random, random.below(90), random.in(0, 0.4));
    Vec3s end = first.x;
    for (Vec3& p : end) p += random.vector(0.1);
    const double margin = random.in(0, 0.05);
    TriangleTree tree(first.x, first.triangles);
    const TriangleTree other(second.x, second.triangles);
    tree.refit(first.x, end, margin);
    std::vector<Box> a, b;
    for (std::size_t t = 0; t < first.triangles.size(); ++t) a.push_back(exact_box(first, end, t, margin));
    for (std::size_t t = 0; t < second.triangles.size(); ++t) b.push_back(exact_box(second, second.x, t, 0));
    Pairs pairs;
    tree.self_pairs(pairs, workspace);
    ASSERT_NO_FATAL_FAILURE(expect_pairs(pairs, a, a, true));
    tree.cross_pairs(other, pairs, workspace);
    ASSERT_NO_FATAL_FAILURE(expect_pairs(pairs, a, b, false));

    const Box query = b.empty() ? Box{Vec3::Zero(), Vec3::Zero()} : b[0];
    std::vector<Index> found;
    tree.overlapping(query, found);
    Pairs as_pairs;
    for (const Index t : found) as_pairs.emplace_back(0, t);
    ASSERT_NO_FATAL_FAILURE(expect_pairs(as_pairs, {query}, a, false));
  }
}

TEST(TriangleTree, ListsTheSamePairsWhenTheMeshIsCutIntoManyTasks) {
  Mesh mesh;
  for (int layer = 0; layer < 3; ++layer) {
    contact_test::add_sheet(mesh, 22, 22, 0.01, Vec3(0.003 * layer, 0.002 * layer, 0));
  }
  Random random(2);
  for (Vec3& p : mesh.x) p += random.vector(1e-3);
  TriangleTree tree(mesh.x, mesh.triangles);
  tree.refit(mesh.x, mesh.x, 1e-3);
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) boxes.push_back(exact_box(mesh, mesh.x, t, 1e-3));
  Pairs pairs;
  tree.self_pairs(pairs);
  ASSERT_GT(pairs.size(), 10000u);
  ASSERT_NO_FATAL_FAILURE(expect_pairs(pairs, boxes, boxes, true));
  std::vector<TreeTask> tasks;
  tree.self_tasks(tasks);
  EXPECT_GT(tasks.size(), 10u);
}

TEST(TriangleTree, RefittedBoxesHoldTheTrianglesAllTheWay) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const Mesh mesh = soup(random, 60, 0.1);
    Vec3s end = mesh.x;
    for (Vec3& p : end) p += random.vector(0.5);
    TriangleTree tree(mesh.x, mesh.triangles);
    const double margin = 0.01;
    tree.refit(mesh.x, end, margin);
    Pairs pairs;
    tree.self_pairs(pairs);
    for (int step = 0; step <= 10; ++step) {
      const double time = step / 10.0;
      std::vector<Box> now;
      for (const Triangle& c : mesh.triangles) {
        Box box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
        for (const Index i : c) {
          const auto k = static_cast<std::size_t>(i);
          const Vec3 p = (1 - time) * mesh.x[k] + time * end[k];
          box.low = box.low.cwiseMin((p.array() - margin).matrix());
          box.high = box.high.cwiseMax((p.array() + margin).matrix());
        }
        const OuterBox& held = tree.triangle_box(static_cast<Index>(now.size()));
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_LE(static_cast<double>(held.low[k]), box.low[static_cast<Eigen::Index>(k)] + 1e-15);
          ASSERT_GE(static_cast<double>(held.high[k]), box.high[static_cast<Eigen::Index>(k)] - 1e-15);
        }
        now.push_back(box);
      }
      for (Index i = 0; i < 60; ++i) {
        for (Index j = i + 1; j < 60; ++j) {
          if (now[static_cast<std::size_t>(i)].overlaps(now[static_cast<std::size_t>(j)])) {
            ASSERT_TRUE(std::binary_search(pairs.begin(), pairs.end(), std::pair(i, j)));
          }
        }
      }
    }
  }
}

TEST(TriangleTree, RoundsBoxesOutwardAtEveryMagnitude) {
  Random random(4);
  for (int n = 0; n < 100000; ++n) {
    const double x = (random.unit() - 0.5) * std::pow(10.0, random.in(-60, 20));
    ASSERT_LT(static_cast<double>(OuterBox::below(x)), x);
    ASSERT_GT(static_cast<double>(OuterBox::above(x)), x);
    ASSERT_LE(static_cast<double>(OuterBox::above(x)) - static_cast<double>(OuterBox::below(x)),
              6e-7 * std::fabs(x) + 1e-36);
  }
}

TEST(TriangleTree, NearestFindsTheNearest) {
  Random random(5);
  for (int trial = 0; trial < 300; ++trial) {
    const Mesh mesh = soup(random, 1 + random.below(300), random.in(0, 0.3));
    const TriangleTree tree(mesh.x, mesh.triangles);
    const auto distance2 = [&](Index t,
                               const Vec3& p) {  // to the first corner: any distance will do that is inside the box
      return (mesh.x[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(t)][0])] - p).squaredNorm();
    };
    for (int n = 0; n < 20; ++n) {
      const Vec3 p = random.vector(1.5);
      double least = 1e300, bound = random.unit() < 0.5 ? 1e300 : 0.01;
      for (Index t = 0; t < tree.triangle_count(); ++t) least = std::min(least, distance2(t, p));
      std::vector<Index> visited;
      const double found = tree.nearest(p, bound, [&](Index t, double bound2) {
        visited.push_back(t);
        return std::min(bound2, distance2(t, p));
      });
      ASSERT_EQ(found, std::min(least, bound));
      std::sort(visited.begin(), visited.end());
      ASSERT_TRUE(std::adjacent_find(visited.begin(), visited.end()) == visited.end());
    }
  }
}

TEST(TriangleTree, NearestLeavesMostOfAMeshAlone) {
  const Mesh mesh = contact_test::torus(80, 40, 1, 0.3);
  const TriangleTree tree(mesh.x, mesh.triangles);
  int visits = 0;
  tree.nearest(Vec3(1.35, 0, 0), 1e300, [&](Index t, double bound2) {
    ++visits;
    const Vec3& corner = mesh.x[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(t)][0])];
    return std::min(bound2, (corner - Vec3(1.35, 0, 0)).squaredNorm());
  });
  EXPECT_LT(visits, 100);  // of 6,400
}

TEST(TriangleTree, AnEmptyTreeAndASingleTriangleAreLegal) {
  const TriangleTree empty({}, {}), none;
  const Vec3s x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> one{{0, 1, 2}};
  const TriangleTree single(x, one);
  Pairs pairs{{7, 7}};
  empty.self_pairs(pairs);
  EXPECT_TRUE(pairs.empty());
  none.self_pairs(pairs);
  EXPECT_TRUE(pairs.empty());
  single.self_pairs(pairs);
  EXPECT_TRUE(pairs.empty());
  single.cross_pairs(empty, pairs);
  EXPECT_TRUE(pairs.empty());
  single.cross_pairs(single, pairs);
  EXPECT_EQ(pairs, (Pairs{{0, 0}}));
  EXPECT_EQ(empty.nearest(Vec3(0, 0, 0), 4.0, [](Index, double) { return 0.0; }), 4.0);
}

TEST(TriangleTree, ACopySharesTheHierarchyAndHasItsOwnBoxes) {
  Random random(6);
  const Mesh mesh = soup(random, 50, 0.1);
  const TriangleTree tree(mesh.x, mesh.triangles);
  TriangleTree copy = tree;
  Pairs before, after, copied;
  tree.self_pairs(before);
  copy.refit(mesh.x, mesh.x, 10);
  tree.self_pairs(after);
  copy.self_pairs(copied);
  EXPECT_EQ(before, after);
  EXPECT_EQ(copied.size(), 50u * 49u / 2u);
}

TEST(TriangleTree, TheListDoesNotDependOnTheNumberOfThreads) {
  Mesh mesh;
  for (int layer = 0; layer < 2; ++layer) contact_test::add_sheet(mesh, 40, 40, 0.01, Vec3(0, 0.002 * layer, 0));
  TriangleTree tree(mesh.x, mesh.triangles);
  tree.refit(mesh.x, mesh.x, 2e-3);
  Pairs one, many;
  with_threads(1, [&] { tree.self_pairs(one); });
  for (const int threads : {2, 5}) {
    with_threads(threads, [&] { tree.self_pairs(many); });
    EXPECT_EQ(one, many);
  }
}

TEST(TriangleTree, TrianglesThatAllLieInOnePlaceStillMakeATree) {
  Mesh mesh;
  mesh.x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (int t = 0; t < 100; ++t) mesh.triangles.push_back({0, 1, 2});
  Pairs pairs;
  TriangleTree(mesh.x, mesh.triangles).self_pairs(pairs);
  EXPECT_EQ(pairs.size(), 4950u);
}

}  // namespace
}  // namespace toile::internal
