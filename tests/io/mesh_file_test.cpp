// Which format a file has, and what it may bring along.
#include "io/mesh_file.hpp"

#include "io/scratch.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

const std::string obj = "# a triangle\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST(MeshFile, TheContentSaysWhatItIs) {
  for (const char* name : {"a.obj", "a.OBJ", "a", "a.txt", "a.b/c"}) {
    const SurfaceMesh mesh = parse_mesh(obj, name);
    EXPECT_EQ(mesh.triangles.size(), 1U) << name;
    EXPECT_TRUE(mesh.notes.empty()) << name;
  }
  EXPECT_TRUE(parse_mesh(ply, "a.PLY").notes.empty());
  EXPECT_EQ(parse_mesh(ply, "a.obj").notes,
            std::vector<std::string>{"a.obj: is PLY by its content, not OBJ, and is read as such"});
  EXPECT_EQ(parse_mesh(obj, "a.glb").notes,
            std::vector<std::string>{"a.glb: is OBJ by its content, not glTF, and is read as such"});
}

TEST(MeshFile, WhatIsNoneOfThemIsNamed) {
  const auto complaint = [](std::string_view bytes, const std::string& path) {
    return message_of<InputError>([&] { parse_mesh(bytes, path); });
  };
  EXPECT_EQ(complaint("solid cube\n", "a.fbx"), "a.fbx: format: expected OBJ, PLY, STL or glTF, got \"solid cube\"");
  EXPECT_EQ(complaint("", "a.fbx"), "a.fbx: format: expected OBJ, PLY, STL or glTF, got an empty line");
  EXPECT_EQ(complaint("solid cube\n", "a.obj").substr(0, 9), "a.obj:1: ") << "its reader says what is wrong";
  EXPECT_EQ(complaint("", "a.ply").substr(0, 6), "a.ply:");
}

TEST(MeshFile, EndingsOfAllFormatsAreKnown) {
  for (const char* name : {"a.obj", "A.OBJ", "b.ply", "c.glb", "d.Gltf", "e.stl"})
    EXPECT_TRUE(has_mesh_ending(name)) << name;
  for (const char* name : {"a.json", "obj", "", "a.obj.txt"}) EXPECT_FALSE(has_mesh_ending(name)) << name;
}

}  // namespace
}  // namespace toile::internal
