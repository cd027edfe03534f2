#include "io/mesh_file.hpp"

#include "io/scratch.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

SurfaceMesh parse(const std::string& bytes) { return parse_mesh(bytes, "a.stl"); }
std::string complaint(const std::string& bytes) {
  return message_of<InputError>([&] { parse(bytes); });
}

using Corners = std::array<std::array<float, 3>, 3>;

void put(std::string& bytes, std::uint32_t number) {
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>(number >> (8 * k));
}

std::string binary(const std::vector<Corners>& triangles, std::string header = {}) {
  header.resize(80, ' ');
  put(header, static_cast<std::uint32_t>(triangles.size()));
  for (const Corners& corners : triangles) {
    for (int k = 0; k < 3; ++k) put(header, 0);
    for (const auto& corner : corners)
      for (const float x : corner) put(header, std::bit_cast<std::uint32_t>(x));
    header += std::string(2, '\0');
  }
  return header;
}

const std::vector<Corners> tent = {{{{0, 0, 0}, {1, 0, 0}, {0.5F, 1, 0}}}, {{{1, 0, 0}, {0, 0, 0}, {0.5F, -0.0F, -1}}}};
const std::string facet =
    "facet normal 0 0 nan\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0.5 1e0 0\nendloop\nendfacet\n";

TEST(Stl, CornersAtOnePlaceAreOneVertex) {
  for (const char* header : {"", "solid made by a program that lies"}) {
    const SurfaceMesh mesh = parse(binary(tent, header));
    EXPECT_EQ(mesh.positions, (Vec3s{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 1, 0), Vec3(0.5, 0, -1)}));
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 0, 3}}));
    EXPECT_EQ(mesh.group, (std::vector<Index>{0, 0}));
    EXPECT_EQ(mesh.object, (std::vector<Index>{0, 0}));
  }
}

TEST(Stl, ReadsTextWithSolidsAsGroups) {
  const SurfaceMesh mesh = parse("solid left arm\r\n" + facet + "endsolid left arm\nsolid\nendsolid\nsolid  b \n" +
                                 facet + facet + "endsolid");
  EXPECT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>(3, {0, 1, 2})));
  EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"left arm", "b"}));
  EXPECT_EQ(mesh.group, (std::vector<Index>{0, 1, 1}));
}

TEST(Stl, IsRecognisedByItsContent) {
  EXPECT_EQ(mesh_format_of(binary(tent), "a.obj"), "STL");
  EXPECT_EQ(mesh_format_of("solid x\n" + facet + "endsolid\n", "a.obj"), "STL");
  EXPECT_EQ(mesh_format_of("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", "a.stl"), "OBJ");
  ASSERT_EQ(parse_mesh(binary(tent), "a.obj").notes.size(), 1u);
}

TEST(Stl, NamesWhatIsWrong) {
  EXPECT_EQ(complaint("solid x\nendsolid x\n"), "a.stl:3: mesh: expected at least one facet, got none");
  EXPECT_EQ(complaint("solid x\n" + facet + "facet\nouter loop\nvertex 0 0 inf\n"),
            "a.stl:11: vertex: expected a finite number, got \"inf\"");
  EXPECT_EQ(complaint("solid x\n" + facet), "a.stl:9: facet: expected \"endsolid\", got the end of the file");
  EXPECT_EQ(complaint("solid x\nfacet normal 0 0 1\nouter ring\n"), "a.stl:3: facet: expected \"loop\", got \"ring\"");
  EXPECT_EQ(complaint(binary({})), "a.stl: mesh: expected at least one triangle, got none");
  std::vector<Corners> endless = tent;
  endless[1][2][0] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(complaint(binary(endless)), "a.stl: triangle 1: expected finite coordinates, got infinity or not a number");
}

TEST(Stl, SurvivesAFileCutAnywhereAndAnyFlippedByte) {
  const std::vector<std::string> texts = {binary(tent), "solid x\n" + facet + "endsolid x\n"};
  for (const std::string& good : texts) {
    for (std::size_t cut = 0; cut < good.size(); ++cut) {
      const std::string message = complaint(good.substr(0, cut));
      EXPECT_TRUE(message == "none" || message.starts_with("a.stl")) << message;
    }
    for (std::size_t place = 0; place < good.size(); ++place)
      for (const int byte : {0, 1, 10, 32, 47, 127, 128, 255}) {
        std::string broken = good;
        broken[place] = static_cast<char>(byte);
        const std::string message = complaint(broken);
        EXPECT_TRUE(message == "none" || message.starts_with("a.stl")) << message;
      }
  }
}

}  // namespace
}  // namespace toile::internal
