#include "io/obj_replace.hpp"

#include "core/error.hpp"
#include "io/obj.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

const std::string cube_corner =
    "# a cloth\r\nmtllib a.mtl\no shirt\nv 0 0 0 0.5 0.25 1\n  v 1 0 0 # seam\nvt 0 0\nvn 0 0 1\nv 1 1 \\\n0\nv 0 1 0\n"
    "g front\nusemtl cotton\nf 1/1/1 2/1/1 3/1/1 4/1/1\n";

TEST(ObjReplace, ChangesCoordinatesAndNothingElse) {
  const Vec3s moved = {{0.1, 0, 0}, {1, 0, 0}, {1, 1, 1.0 / 3}, {0, 1, -2e-9}};
  EXPECT_EQ(with_positions(cube_corner, moved, "a.obj"),
            "# a cloth\r\nmtllib a.mtl\no shirt\nv 0.1 0 0 0.5 0.25 1\n  v 1 0 0 # seam\nvt 0 0\nvn 0 0 1\n"
            "v 1 1 0.3333333333333333\nv 0 1 -2e-09\ng front\nusemtl cotton\nf 1/1/1 2/1/1 3/1/1 4/1/1\n");
}

TEST(ObjReplace, ReadsBackToTheSameBits) {
  const Vec3s moved = {{0.1, 1e-300, -1e22}, {1.0 / 3, 2.0 / 3, 0}, {5e-324, 1, 1}, {-0.7, 0, 123456.789}};
  const SurfaceMesh read = parse_obj(with_positions(cube_corner, moved, "a.obj"), "a.obj");
  ASSERT_EQ(read.positions.size(), moved.size());
  for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_EQ(read.positions[i], moved[i]) << i;
  EXPECT_EQ(read.triangles, parse_obj(cube_corner, "a.obj").triangles);
}

TEST(ObjReplace, LeavesAFileWhosePositionsStayAsItIs) {
  EXPECT_EQ(with_positions(cube_corner, parse_obj(cube_corner, "a.obj").positions, "a.obj"), cube_corner);
}

TEST(ObjReplace, ACommentThatEndsInABackslashHidesNoVertex) {
  const Vec3s moved = {{1, 2, 3}};
  EXPECT_EQ(with_positions("# C:\\cloth\\\nv 0 0 0", moved, "a.obj"), "# C:\\cloth\\\nv 1 2 3");
}

TEST(ObjReplace, RefusesAnotherNumberOfVertices) {
  EXPECT_THROW(with_positions(cube_corner, Vec3s(3, Vec3::Zero()), "a.obj"), InputError);
  EXPECT_THROW(with_positions(cube_corner, Vec3s(5, Vec3::Zero()), "a.obj"), InputError);
}

}  // namespace
}  // namespace toile::internal
