// The triangulation as a data structure: every edit leaves it whole, and a rolled-back trial leaves no trace.
#include "garment/delaunay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace toile::internal {
namespace {

class RandomGrid {
 public:
  explicit RandomGrid(std::uint64_t seed) : bits_(seed) {}
  std::int32_t operator()(std::int32_t low, std::int32_t high) {
    return low + static_cast<std::int32_t>(bits_() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::mt19937_64 bits_;
};

const std::vector<GridPoint> ell{{0, 0}, {4000, 0}, {4000, 1000}, {1000, 1000}, {1000, 4000}, {0, 4000}};  // L-shaped

std::int64_t twice_area(const std::vector<GridPoint>& polygon) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) sum += orient2d({}, polygon[i], polygon[(i + 1) % polygon.size()]);
  return sum;
}

// Links mutual, faces counter-clockwise, every inner edge Delaunay, the outline's area covered, vertices' faces right.
void expect_whole(const Delaunay& mesh, std::int64_t area, bool delaunay = true) {
  std::int64_t sum = 0;
  std::size_t faces = 0, border = 0, inner = 0;
  for (std::size_t f = 0; f < mesh.faces().size(); ++f) {
    const Delaunay::Face& face = mesh.faces()[f];
    if (!face.alive()) continue;
    ++faces;
    const auto [a, b, c] = mesh.corners(face);
    ASSERT_GT(orient2d(a, b, c), 0);
    sum += orient2d(a, b, c);
    for (std::size_t k = 0; k < 3; ++k) {
      const Index g = face.neighbour[k];
      if (g == Delaunay::none) {
        ++border;
        continue;
      }
      const Delaunay::Face& other = mesh.faces()[static_cast<std::size_t>(g)];
      ASSERT_TRUE(other.alive());
      std::size_t j = 0;
      while (j < 3 && other.neighbour[j] != static_cast<Index>(f)) ++j;
      ASSERT_LT(j, 3U);
      EXPECT_EQ(other.corner[(j + 1) % 3], face.corner[(k + 2) % 3]);
      EXPECT_EQ(other.corner[(j + 2) % 3], face.corner[(k + 1) % 3]);
      if (delaunay) {
        EXPECT_LE(incircle(a, b, c, mesh.points()[static_cast<std::size_t>(other.corner[j])]), 0);
      }
    }
  }
  for (std::size_t v = 0; v < mesh.points().size(); ++v) {
    const Index vertex = static_cast<Index>(v);
    if (!mesh.alive(vertex)) continue;
    if (!mesh.on_outline(vertex)) ++inner;
    const Triangle& corner = mesh.faces()[static_cast<std::size_t>(mesh.face_of(vertex))].corner;
    EXPECT_NE(std::find(corner.begin(), corner.end(), vertex), corner.end());
  }
  EXPECT_EQ(sum, area);
  EXPECT_EQ(border, static_cast<std::size_t>(mesh.outline_count()));
  EXPECT_EQ(faces, 2 * inner + border - 2);
}

TEST(ClipEars, KeepsCornersOnAStraightRunAndMakesNoFlatTriangle) {
  // Only the last corner sees the others: cutting it off first would leave a line.
  const std::vector<GridPoint> points{{0, 0}, {1, 0}, {2, 0}, {5, 0}, {9, 0}, {3, 7}};
  for (Index first = 0; first < 6; ++first) {
    std::vector<Index> ring;
    for (Index i = 0; i < 6; ++i) ring.push_back((first + i) % 6);
    const std::vector<Triangle> triangles = clip_ears(points, ring);
    ASSERT_EQ(triangles.size(), 4U);
    std::int64_t sum = 0;
    for (const Triangle& t : triangles) {
      const auto p = [&](std::size_t k) { return points[static_cast<std::size_t>(t[k])]; };
      EXPECT_GT(orient2d(p(0), p(1), p(2)), 0);
      sum += orient2d(p(0), p(1), p(2));
    }
    EXPECT_EQ(sum, 63);
  }
}

TEST(Delaunay, TriangulatesEitherOrientationOfAnOutline) {
  expect_whole(Delaunay(ell), twice_area(ell));
  expect_whole(Delaunay({ell.rbegin(), ell.rend()}), twice_area(ell));
}

TEST(Delaunay, StaysWholeThroughInsertionsMovesAndRemovals) {
  RandomGrid random(3);
  Delaunay mesh(ell);
  std::vector<Index> inner;
  int refused = 0, stopped = 0;
  for (int i = 0; i < 1500; ++i) {
    const std::int32_t kind = random(0, 9);
    if (kind < 5 || inner.size() < 3) {
      // A coarse grid of places, so that many fall on edges, on vertices and on the outline.
      const GridPoint p{100 * random(0, 40), 100 * random(0, 40)};
      const bool outside = p.x > 1000 && p.y > 1000;
      const Index start = mesh.face_of(0);
      const Index f = mesh.locate(p, start);
      ASSERT_EQ(f == Delaunay::none, outside);
      if (outside) continue;
      stopped += mesh.walk(p, start) == Delaunay::none ? 1 : 0;
      const bool on_outline = p.x == 0 || p.y == 0 || p.x == 4000 || p.y == 4000 || (p.x == 1000 && p.y >= 1000) ||
                              (p.y == 1000 && p.x >= 1000);
      bool known = on_outline;
      for (const Index v : inner) known = known || mesh.points()[static_cast<std::size_t>(v)] == p;
      const Index v = mesh.insert(p, f);
      ASSERT_EQ(v == Delaunay::none, known);
      if (v == Delaunay::none)
        ++refused;
      else
        inner.push_back(v);
    } else {
      const std::size_t which = static_cast<std::size_t>(random(0, static_cast<std::int32_t>(inner.size()) - 1));
      if (kind < 8) {
        mesh.remove(inner[which]);
        EXPECT_FALSE(mesh.alive(inner[which]));
        inner.erase(inner.begin() + static_cast<std::ptrdiff_t>(which));
      } else {
        const GridPoint here = mesh.points()[static_cast<std::size_t>(inner[which])];
        if (mesh.move(inner[which], {here.x + random(-200, 200), here.y + random(-200, 200)})) {
          expect_whole(mesh, twice_area(ell), false);
          mesh.legalize_around(inner[which]);
        }
      }
    }
    if (i % 10 == 0) expect_whole(mesh, twice_area(ell));
  }
  expect_whole(mesh, twice_area(ell));
  EXPECT_GT(refused, 50);
  EXPECT_GT(stopped, 0);  // the walk was stopped by the notch, and locate still found the face
  for (const Index v : inner) mesh.remove(v);
  expect_whole(mesh, twice_area(ell));
}

TEST(Delaunay, LeavesNoTraceOfATrialRolledBack) {
  RandomGrid random(4);
  Delaunay mesh(ell);
  std::vector<Index> inner;
  for (int i = 0; i < 60; ++i) {
    const GridPoint p{random(1, 999), random(1, 3999)};
    if (const Index v = mesh.insert(p, mesh.locate(p, 0)); v != Delaunay::none) inner.push_back(v);
  }
  for (int i = 0; i < 200; ++i) {
    const Delaunay before = mesh;
    mesh.begin();
    for (int k = 0; k < 3; ++k) {
      const GridPoint p{random(1, 999), random(1, 3999)};
      mesh.insert(p, mesh.locate(p, mesh.face_of(0)));
    }
    const Index gone = inner[static_cast<std::size_t>(random(0, static_cast<std::int32_t>(inner.size()) - 1))];
    mesh.remove(gone);
    for (const Index v : inner) {
      if (v == gone) continue;
      const GridPoint here = mesh.points()[static_cast<std::size_t>(v)];
      if (mesh.move(v, {here.x + random(-50, 50), here.y + random(-50, 50)})) mesh.legalize_around(v);
    }
    for (const Delaunay::Changed& changed : mesh.changed()) {
      ASSERT_LT(changed.face, mesh.face_count_at_begin());
      const Delaunay::Face& old = before.faces()[static_cast<std::size_t>(changed.face)];
      EXPECT_EQ(changed.before.corner, old.corner);
      if (old.alive()) {
        EXPECT_EQ(changed.corners_before, before.corners(old));
      }
    }
    mesh.roll_back();
    ASSERT_EQ(mesh.points(), before.points());
    ASSERT_EQ(mesh.faces().size(), before.faces().size());
    for (std::size_t f = 0; f < mesh.faces().size(); ++f) {
      ASSERT_EQ(mesh.faces()[f].corner, before.faces()[f].corner);
      ASSERT_EQ(mesh.faces()[f].neighbour, before.faces()[f].neighbour);
    }
    for (std::size_t v = 0; v < mesh.points().size(); ++v)
      ASSERT_EQ(mesh.face_of(static_cast<Index>(v)), before.face_of(static_cast<Index>(v)));
  }
  expect_whole(mesh, twice_area(ell));
}

TEST(Delaunay, RefusesAMoveThatWouldTurnATriangleOver) {
  Delaunay mesh(ell);
  const GridPoint p{500, 500};
  const Index v = mesh.insert(p, mesh.locate(p, 0));
  ASSERT_NE(v, Delaunay::none);
  EXPECT_FALSE(mesh.move(v, {3000, 3000}));
  EXPECT_FALSE(mesh.move(v, {0, 500}));  // flat against the outline
  EXPECT_EQ(mesh.points()[static_cast<std::size_t>(v)], p);
  EXPECT_TRUE(mesh.move(v, {501, 502}));
}

}  // namespace
}  // namespace toile::internal
