// PLY as other programs write it, and as nobody should.
#include "io/mesh_file.hpp"

#include "io/scratch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace toile::internal {
namespace {

using Triangles = std::vector<Triangle>;

SurfaceMesh parse(std::string_view bytes) { return parse_mesh(bytes, "a.ply"); }
std::string complaint(std::string_view bytes) {
  return message_of<InputError>([&] { parse(bytes); });
}

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\n" + elements + "end_header\n";
}
const std::string xyz = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string list = "property list uchar int vertex_indices\n";
const std::string corners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

template <class T>
void append(std::string& bytes, T value, bool big) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big) std::reverse(raw, raw + sizeof value);
  bytes.append(raw, sizeof value);
}

TEST(Ply, ReadsTextAndSplitsPolygonsIntoFans) {
  const SurfaceMesh mesh = parse(header("ascii", xyz + "element face 2\n" + list) + corners + "4 0 1 2 3\n3 0 1 2\n");
  ASSERT_EQ(mesh.positions.size(), 4U);
  EXPECT_EQ(mesh.positions[2], Vec3(1, 1, 0));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  EXPECT_TRUE(mesh.texcoord.empty());
  EXPECT_EQ(mesh.group_names, std::vector<std::string>{""});
}

TEST(Ply, EveryLineEndIsTaken) {
  const std::string text = header("ascii", xyz + "element face 1\n" + list) + corners + "3 0 1 2\n";
  for (const char* end : {"\r\n", "\r"}) {
    std::string other;
    for (const char c : text) other += c == '\n' ? std::string(end) : std::string(1, c);
    EXPECT_EQ(parse(other).triangles, (Triangles{{0, 1, 2}})) << static_cast<int>(end[1]);
  }
}

// Properties in another order, of other types, others between them, the vertices behind the faces, an element that nobody knows.
TEST(Ply, ReadsBinaryOfBothByteOrdersInAnyOrderOfProperties) {
  for (const bool big : {false, true}) {
    std::string bytes =
        header(big ? "binary_big_endian" : "binary_little_endian",
               "element face 2\nproperty list uint8 float weights\nproperty list ushort uint32 vertex_index\n"
               "property uchar red\n"
               "element camera 1\nproperty list int double lens\nproperty short id\n"
               "element vertex 4\nproperty double z\nproperty uchar quality\nproperty short y\nproperty float x\n"
               "property float texture_u\nproperty float texture_v\n");
    for (const int last : {2, 3}) {
      append<std::uint8_t>(bytes, 2, big);
      append<float>(bytes, 7, big);
      append<float>(bytes, 8, big);
      append<std::uint16_t>(bytes, last == 2 ? 3 : 4, big);
      for (std::uint32_t i = 0; i <= static_cast<std::uint32_t>(last); ++i) append(bytes, i, big);
      append<std::uint8_t>(bytes, 255, big);
    }
    append<std::int32_t>(bytes, 1, big);
    append<double>(bytes, 35, big);
    append<std::int16_t>(bytes, 4, big);
    for (int i = 0; i < 4; ++i) {
      append<double>(bytes, 0.1 * i, big);
      append<std::uint8_t>(bytes, 1, big);
      append<std::int16_t>(bytes, static_cast<std::int16_t>(-300 * i), big);
      append<float>(bytes, 0.5F * static_cast<float>(i), big);
      append<float>(bytes, 0.25F * static_cast<float>(i), big);
      append<float>(bytes, 2, big);
    }
    const SurfaceMesh mesh = parse(bytes);
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
    ASSERT_EQ(mesh.positions.size(), 4U);
    EXPECT_EQ(mesh.positions[3], Vec3(1.5, -900, 0.1 * 3));
    EXPECT_EQ(mesh.texcoords[3], Vec2(0.75, 2));
    EXPECT_EQ(mesh.texcoord[2], (std::array<Index, 3>{0, 2, 3}));
  }
}

TEST(Ply, ReadsAUvPerCornerAndPanels) {
  const SurfaceMesh mesh =
      parse("ply\nformat ascii 1.0\ncomment panel 3 left sleeve\ncomment garment 0 shirt\n" + xyz + "element face 3\n" +
            list + "property list uchar float texcoord\nproperty int panel\nproperty uchar garment\nend_header\n" +
            corners + "3 0 1 2 6 0 0 1 0 1 1 3 0\n3 0 2 3 6 9 9 8 8 7 7 1 0\n3 0 1 2 0 3 0\n");
  EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"left sleeve", "panel 1"}));
  EXPECT_EQ(mesh.group, (std::vector<Index>{0, 1, 0}));
  EXPECT_EQ(mesh.object_names, std::vector<std::string>{"shirt"});
  ASSERT_EQ(mesh.texcoords.size(), 6U);
  EXPECT_EQ(mesh.texcoord[1], (std::array<Index, 3>{3, 4, 5}));
  EXPECT_EQ(mesh.texcoords[4], Vec2(8, 8));
  EXPECT_EQ(mesh.texcoord[2], (std::array<Index, 3>{-1, -1, -1}));
}

TEST(Ply, SaysLineExpectedAndGot) {
  const std::string face = "element face 1\n" + list, good = header("ascii", xyz + face) + corners;
  EXPECT_EQ(complaint(good + "3 0 1 4\n"), "a.ply: face 0: expected corners in 0..3, got 4");
  EXPECT_EQ(complaint(good + "3 0 1 -1\n"), "a.ply:15: face 0: expected corners from 0, got -1");
  EXPECT_EQ(complaint(good + "3 0 1 1.5\n"), "a.ply:15: face 0: expected a whole number, got \"1.5\"");
  EXPECT_EQ(complaint(good + "2 0 1\n"), "a.ply:15: face 0: expected at least 3 corners, got 2");
  EXPECT_EQ(complaint(good + "3 0 1\n"), "a.ply:16: face 0: expected a number, got the end of the file");
  EXPECT_EQ(complaint(header("ascii", xyz + face) + "0 0 0\n1 nan 0\n1 1 0\n0 1 0\n3 0 1 2\n"),
            "a.ply:12: vertex 1: expected a finite number, got not a number");
  EXPECT_EQ(complaint(header("ascii", xyz + face) + "0 0 0\n1 x 0\n1 1 0\n0 1 0\n3 0 1 2\n"),
            "a.ply:12: vertex 1: expected a number, got \"x\"");
  EXPECT_EQ(complaint("ply\nformat binary 1.0\n"),
            "a.ply:2: format: expected ascii, binary_little_endian or binary_big_endian, got \"binary\"");
  EXPECT_EQ(complaint("ply\nelement vertex -3\n"), "a.ply:2: element vertex: expected a number of them, got \"-3\"");
  EXPECT_EQ(complaint("ply\nelement vertex 3\nproperty half x\n"),
            "a.ply:3: property: expected a type: char, uchar, short, ushort, int, uint, float or double, got \"half\"");
  EXPECT_EQ(complaint("ply\nformat ascii 1.0\n"), "a.ply:2: header: expected \"end_header\", got the end of the file");
  EXPECT_EQ(complaint(header("ascii", "element vertex 1\nproperty float x\nproperty float y\n") + "1 2\n"),
            "a.ply:4: element vertex: expected a property \"z\", got none");
  EXPECT_EQ(complaint(header("ascii", xyz) + corners), "a.ply: mesh: expected at least one face, got none");
  EXPECT_EQ(complaint("w 0 0 0\n"), "a.ply:1: header: expected \"ply\", got \"w 0 0 0\"") << "by its name";
}

TEST(Ply, TakesNoMemoryForWhatTheFileCannotHold) {
  EXPECT_EQ(
      complaint(header("ascii",
                       "element vertex 18446744073709551615\nproperty float x\nproperty float y\nproperty float z\n")),
      "a.ply:4: element vertex: expected no more than the rest of the file can hold, got 18446744073709551615");
  EXPECT_EQ(complaint(header("binary_little_endian", "element camera 900000000\nproperty double x\n") + "1234567"),
            "a.ply:4: element camera: expected no more than the rest of the file can hold, got 900000000");
  std::string bytes = header("binary_little_endian", "element face 1\nproperty list uint int vertex_indices\n");
  const std::size_t at_list = bytes.size();
  append<std::uint32_t>(bytes, 4'000'000'000U, false);
  EXPECT_EQ(complaint(bytes), "a.ply: face 0 at byte " + std::to_string(at_list) +
                                  ": expected a list that the rest of the file can hold, got 4000000000 numbers");
}

// Whole and broken files in all three forms.
std::vector<std::string> small_files() {
  std::vector<std::string> files;
  files.push_back("ply\nformat ascii 1.0\ncomment panel 0 a\n" + xyz + "element face 2\n" + list +
                  "property list uchar float texcoord\nproperty int panel\nend_header\n" + corners +
                  "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 0 0\n");
  for (const bool big : {false, true}) {
    std::string bytes = header(big ? "binary_big_endian" : "binary_little_endian",
                               xyz + "property float s\nproperty float t\nelement face 1\n" + list +
                                   "element edge 1\nproperty list uchar int e\n");
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 5; ++k) append(bytes, static_cast<float>(i * k % 3), big);
    append<std::uint8_t>(bytes, 4, big);
    for (std::int32_t i = 0; i < 4; ++i) append(bytes, i, big);
    append<std::uint8_t>(bytes, 1, big);
    append<std::int32_t>(bytes, 5, big);
    files.push_back(bytes);
  }
  return files;
}

TEST(Ply, SurvivesAFileCutAnywhere) {
  for (const std::string& whole : small_files()) {
    ASSERT_EQ(complaint(whole), "none");
    for (std::size_t cut = 0; cut < whole.size(); ++cut) {
      const std::string message = complaint(std::string_view(whole).substr(0, cut));
      EXPECT_TRUE(message.starts_with("a.ply") || (message == "none" && cut + 2 > whole.size())) << cut << message;
    }
  }
}

TEST(Ply, SurvivesAnyFlippedByte) {
  for (const std::string& whole : small_files()) {
    for (std::size_t place = 0; place < whole.size(); ++place) {
      for (int byte = 0; byte < 256; byte += 5) {
        std::string broken = whole;
        broken[place] = static_cast<char>(byte);
        try {
          const SurfaceMesh mesh = parse(broken);
          for (const Vec3& x : mesh.positions) ASSERT_TRUE(x.allFinite());
          for (const Triangle& t : mesh.triangles)
            for (const Index i : t) ASSERT_LT(at(i), mesh.positions.size());
          for (const auto& t : mesh.texcoord)
            for (const Index i : t) ASSERT_TRUE(i == -1 || at(i) < mesh.texcoords.size());
        } catch (const InputError& error) {
          ASSERT_TRUE(std::string(error.what()).starts_with("a.ply")) << error.what();
        }
      }
    }
  }
}

}  // namespace
}  // namespace toile::internal
