// What is written in one format and read in another is the same surface.
#include "io/mesh_writer.hpp"

#include "io/mesh_file.hpp"
#include "io/scratch.hpp"
#include "mesh/join_sides.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace toile::internal {
namespace {

// Two garments: a shirt of two panels whose seam has a uv per panel, and a skirt without drawing where `whole` is false.
SurfaceMesh clothes(bool whole) {
  SurfaceMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.1, 0}, {2, 1, 0.3}, {0, -1, 0}, {1, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}, {6, 7, 1}};
  mesh.texcoords = {{0, 0},     {1, 0},     {1, 1}, {0, 1}, {0.1, 0.2}, {1.1, 0.2},
                    {1.1, 1.2}, {0.1, 1.2}, {7, 8}, {9, 8}, {9, 9}};
  mesh.texcoord = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {8, 9, 10}};
  if (!whole) mesh.texcoord[4] = {-1, -1, -1};
  mesh.group = {0, 0, 1, 1, 2};
  mesh.group_names = {"front", "left\tsleeve \xc3\xa9", "skirt front"};
  mesh.object = {0, 0, 0, 0, 1};
  mesh.object_names = {"shirt", "skirt"};
  mesh.group_material = {"cotton", "silk", "cotton"};
  return mesh;
}

// A corner as it is, whatever its vertex is called.
struct Corner {
  Vec3 x;
  Vec2 uv;
  std::string panel, garment;
};
std::vector<Corner> corners_of(const SurfaceMesh& mesh) {
  std::vector<Corner> corners;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index vt = mesh.texcoord.empty() ? -1 : mesh.texcoord[t][k];
      corners.push_back({mesh.positions[at(mesh.triangles[t][k])], vt < 0 ? Vec2(-99, -99) : mesh.texcoords[at(vt)],
                         mesh.group_names[at(mesh.group[t])], mesh.object_names[at(mesh.object[t])]});
    }
  return corners;
}

TEST(MeshWriter, EveryFormatKeepsCornersPanelsAndGarments) {
  const Scratch scratch;
  for (const bool whole : {true, false}) {
    const SurfaceMesh mesh = clothes(whole);
    const std::vector<Corner> expected = corners_of(mesh);
    for (const MeshWriter& writer : mesh_writers()) {
      const std::string path = scratch / std::string("a").append(writer.ending);
      writer.write(path, mesh);
      const SurfaceMesh read = load_mesh(path);
      const std::vector<Corner> got = corners_of(read);
      ASSERT_EQ(got.size(), expected.size()) << writer.name;
      for (std::size_t i = 0; i < got.size(); ++i) {
        EXPECT_LT((got[i].x - expected[i].x).norm(), 1e-7) << writer.name << i;
        EXPECT_LT((got[i].uv - expected[i].uv).norm(), 1e-6) << writer.name << i;
        EXPECT_EQ(name_on_one_line(got[i].panel), name_on_one_line(expected[i].panel)) << writer.name;
        EXPECT_EQ(got[i].garment, expected[i].garment) << writer.name;
      }
      const JoinedSides joined = join_sides(read.positions, read.triangles, read.object);
      const auto alone = [&](Index i) { return at(joined.same_as[at(i)]) == at(i); };
      std::vector<Index> used;
      for (const Triangle& t : read.triangles)
        for (const Index i : t)
          if (alone(i)) used.push_back(i);
      std::sort(used.begin(), used.end());
      used.erase(std::unique(used.begin(), used.end()), used.end());
      // The skirt hangs from one corner of the shirt: a point, and no seam.
      EXPECT_EQ(used.size(), read.positions.size() > 8 ? 9U : 8U)
          << writer.name << ": the seam of the drawing is one again";
    }
  }
}

TEST(MeshWriter, TheSameSurfaceIsTheSameBytesInEveryLocale) {
  const Scratch scratch;
  for (const MeshWriter& writer : mesh_writers()) {
    writer.write(scratch / "a", clothes(true));
    const CommaLocale comma;
    writer.write(scratch / "b", clothes(true));
    EXPECT_EQ(scratch.get("a"), scratch.get("b")) << writer.name;
  }
}

TEST(MeshWriter, WhatCannotBeWrittenIsRefusedAndLeavesWhatWasThere) {
  const Scratch scratch;
  for (const MeshWriter& writer : mesh_writers()) {
    const std::string path = scratch.put(std::string("a").append(writer.ending), "before");
    SurfaceMesh mesh = clothes(true);
    mesh.positions[3].y() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(message_of<InputError>([&] { writer.write(path, mesh); }),
              path + ": vertex 3: expected a number that a float can hold, got nan");
    mesh = clothes(true);
    mesh.triangles[1][2] = 8;
    EXPECT_EQ(message_of<InputError>([&] { writer.write(path, mesh); }),
              path + ": triangle 1: expected a vertex below 8, got 8");
    EXPECT_EQ(scratch.get(std::string("a").append(writer.ending)), "before");
  }
}

TEST(MeshWriter, ASurfaceWithoutNamesOrDrawingIsOne) {
  const Scratch scratch;
  SurfaceMesh body;
  body.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  body.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (const MeshWriter& writer : mesh_writers()) {
    const std::string path = scratch / std::string("body").append(writer.ending);
    writer.write(path, body);
    const SurfaceMesh read = load_mesh(path);
    EXPECT_EQ(read.triangles, body.triangles) << writer.name;
    EXPECT_EQ(read.positions, body.positions) << writer.name;
    EXPECT_TRUE(read.texcoord.empty());
  }
}

}  // namespace
}  // namespace toile::internal
