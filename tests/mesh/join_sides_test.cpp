// Which vertices of a file are one: those along seams, and never those of two layers.
#include "mesh/join_sides.hpp"

#include "mesh/check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace toile::internal {
namespace {

// Two squares beside each other, each with vertices of its own.
const Vec3s two_squares{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
const std::vector<Triangle> of_two{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};

TEST(JoinSides, ASeamOfTheDrawingIsOneEdge) {
  const JoinedSides joined = join_sides(two_squares, of_two, {});
  EXPECT_EQ(joined.joined, 2U);
  EXPECT_EQ(joined.left, 0U);
  EXPECT_EQ(joined.same_as, (std::vector<Index>{0, 1, 2, 3, 1, 5, 6, 2}));
  EXPECT_EQ(joined_triangles(of_two, joined), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 5, 6}, {1, 6, 2}}));
}

TEST(JoinSides, NearIsNotTogether) {
  Vec3s x = two_squares;
  x[4].x() = std::nextafter(1.0, 2.0);
  EXPECT_EQ(join_sides(x, of_two, {}).joined, 0U);
  x[4] = Vec3(1, -0.0, 0);  // the same place
  EXPECT_EQ(join_sides(x, of_two, {}).joined, 2U);
}

// A square twice at one place; `turned`: the second faces the other way; `other`: it is cut along the other diagonal.
std::vector<Triangle> two_layers(bool turned, bool other) {
  std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  for (Triangle t : other ? std::vector<Triangle>{{4, 5, 7}, {5, 6, 7}} : std::vector<Triangle>{{4, 5, 6}, {4, 6, 7}}) {
    if (turned) std::swap(t[1], t[2]);
    triangles.push_back(t);
  }
  return triangles;
}

TEST(JoinSides, TwoLayersThatLieOnEachOtherStayTwo) {
  const Vec3s x{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const bool turned : {false, true}) {
    const JoinedSides joined = join_sides(x, two_layers(turned, false), {});
    EXPECT_EQ(joined.joined, 0U) << turned;
    EXPECT_EQ(joined.left, 8U) << "the four sides of each hem";
  }
  EXPECT_EQ(join_sides(x, two_layers(false, true), {}).joined, 0U);
  EXPECT_EQ(join_sides(x, two_layers(true, true), {}).joined, 4U) << "a pillow, as far as anybody can tell";
}

// Two layers, each with a seam of its drawing at the same place: which halves belong together says the part.
TEST(JoinSides, SidesOfOnePartComeFirst) {
  Vec3s x = two_squares;
  x.insert(x.end(), two_squares.begin(), two_squares.end());
  for (std::size_t i = 8; i < 16; ++i)
    if (x[i].x() != 1) x[i].z() = 0.1;  // the layers touch along the seam
  std::vector<Triangle> triangles = of_two;
  for (const Triangle& t : of_two) triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  const JoinedSides blind = join_sides(x, triangles, {});
  EXPECT_EQ(blind.joined, 0U);
  EXPECT_EQ(blind.left, 4U);
  const JoinedSides told = join_sides(x, triangles, std::vector<Index>{0, 0, 0, 0, 1, 1, 1, 1});
  EXPECT_EQ(told.joined, 4U);
  EXPECT_EQ(told.left, 0U);
  EXPECT_EQ(told.same_as[4], 1);
  EXPECT_EQ(told.same_as[12], 9);
}

TEST(JoinSides, ASoupOfTrianglesIsClosedAgain) {
  const Vec3s corners{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const std::vector<Triangle> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  Vec3s x;
  std::vector<Triangle> triangles;
  for (const Triangle& t : faces) {
    const auto first = static_cast<Index>(x.size());
    for (const Index i : t) x.push_back(corners[at(i)]);
    triangles.push_back({first, first + 1, first + 2});
  }
  const JoinedSides joined = join_sides(x, triangles, {});
  EXPECT_EQ(joined.joined, 18U);
  Vec3s kept;
  std::vector<Index> place(x.size(), -1);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (at(joined.same_as[i]) == i) {
      place[i] = static_cast<Index>(kept.size());
      kept.push_back(x[i]);
    }
  std::vector<Triangle> whole = joined_triangles(triangles, joined);
  for (Triangle& t : whole)
    for (Index& i : t) i = place[at(i)];
  EXPECT_NO_THROW(check_closed("", kept, whole));
}

// Quadratic work on one edge would take minutes.
TEST(JoinSides, ManyTrianglesOnOneEdgeTakeNoTime) {
  Vec3s x{{0, 0, 0}, {1, 0, 0}};
  std::vector<Triangle> triangles;
  for (Index i = 0; i < 200'000; ++i) {
    x.emplace_back(0, 1, i);
    triangles.push_back({0, 1, i + 2});
  }
  EXPECT_EQ(join_sides(x, triangles, {}).left, 200'000U);
}

}  // namespace
}  // namespace toile::internal
