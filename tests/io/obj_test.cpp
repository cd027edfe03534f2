#include "io/obj.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "io/file.hpp"
#include "io/scratch.hpp"
#include "mesh/check.hpp"
#include "support/paths.hpp"

namespace toile::internal {
namespace {

using namespace std::string_literals;

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

SurfaceMesh parse(std::string_view text) { return parse_obj(text, "a.obj"); }

std::string complaint(std::string_view text) {
  return message_of<InputError>([&] { parse(text); });
}

using Triangles = std::vector<Triangle>;

TEST(Obj, ReadsPositionsAndFacesInTheirOrder) {
  const SurfaceMesh mesh = parse("# a square\n\n" + square + "f 1 2 3\nf 1 3 4\n");
  ASSERT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.positions[2], Vec3(1, 1, 0));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(mesh.texcoord.empty());
  EXPECT_EQ(mesh.group_names, std::vector<std::string>{""});
  EXPECT_EQ(mesh.object_names, std::vector<std::string>{""});
  EXPECT_EQ(mesh.group, (std::vector<Index>{0, 0}));
}

TEST(Obj, SplitsPolygonsIntoFans) {
  EXPECT_EQ(parse(square + "v 2 2 0\nf 1 2 3 4 5\n").triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Obj, ReadsEveryFormOfACorner) {
  const std::string vertices = square + "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n";
  EXPECT_TRUE(parse(vertices + "f 1//1 2//1 3//1\n").texcoord.empty());
  for (const char* face :
       {"f 1/3 2/2 3/1\n", "f 1/3/1 2/2/1 3/1/1\n", "f -4/-1 -3/-2/-1 -2/-3/-1\n", "f 1/3/ 2/2/ 3/1/\n"}) {
    const SurfaceMesh mesh = parse(vertices + face);
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}})) << face;
    ASSERT_EQ(mesh.texcoord.size(), 1u) << face;
    EXPECT_EQ(mesh.texcoord[0], (std::array<Index, 3>{2, 1, 0})) << face;
  }
  const SurfaceMesh mixed = parse(vertices + "f 1 2 3\nf 1/1 3 4/\n");
  ASSERT_EQ(mixed.texcoord.size(), 2u);
  EXPECT_EQ(mixed.texcoord[0], (std::array<Index, 3>{-1, -1, -1}));
  EXPECT_EQ(mixed.texcoord[1], (std::array<Index, 3>{0, -1, -1}));
}

TEST(Obj, CountsNegativeIndicesFromTheLastVertexSoFar) {
  EXPECT_EQ(parse(square + "f -4 -3 -2\nv 5 5 5\nf -1 1 2\n").triangles, (Triangles{{0, 1, 2}, {4, 0, 1}}));
}

TEST(Obj, AllowsAFaceBeforeItsVertices) {
  EXPECT_EQ(parse("vt 0 0\nf 1 2/2 3\n" + square + "vt 1 1\n").triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(complaint("v 0 0 0\n\nf 1 2 5\nv 0 0 0\nv 0 0 0\nv 0 0 0\n"),
            "a.obj:3: face: expected an index in 1..4, got 5");
}

TEST(Obj, ReadsLineEndsOfAllSystems) {
  const std::string text = square + "# comment\nf 1 2 3\nf 1 3 4\n";
  for (const char* line_end : {"\r\n", "\r"}) {
    std::string other;
    for (const char c : text) other += c == '\n' ? std::string(line_end) : std::string(1, c);
    EXPECT_EQ(parse(other).triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(complaint(other + "f 1 2 9"), "a.obj:8: face: expected an index in 1..4, got 9");
  }
  EXPECT_EQ(parse(square + "f 1 2 3").triangles.size(), 1u);  // no line end at the end
}

TEST(Obj, JoinsLinesAtABackslash) {
  const std::string text = "v 0 \\\n 0 0\nv 1 0\\\r\n 0\nv 1 1 0\nf 1 \\\n \\\n2 3\n";
  const SurfaceMesh mesh = parse(text);
  EXPECT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(parse("vn 1 \\\nx y\n" + square + "f 1 2 3").positions.size(), 4u);
  // The line named is the one on which the word stands.
  EXPECT_EQ(complaint(text + "f 1 2\\\n\\\n 77\n"), "a.obj:11: face: expected an index in 1..3, got 77");
}

TEST(Obj, EndsACommentWithItsLine) {
  EXPECT_EQ(parse("# C:\\models\\\n" + square + "f 1 2 3 # 4\nf 1 3 4\n#f 9 9 9").triangles.size(), 2u);
}

TEST(Obj, ReadsNumbersInAllSpellings) {
  const SurfaceMesh mesh = parse("v +1.5 -.25 2.\nv 1e-3 1E+2 -0\nv 1e-400 5e-324 0.1\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions[0], Vec3(1.5, -0.25, 2));
  EXPECT_EQ(mesh.positions[1], Vec3(0.001, 100, 0));
  EXPECT_EQ(mesh.positions[2], Vec3(0, 5e-324, 0.1));
}

TEST(Obj, TakesColoursAndWeightsForGranted) {
  const SurfaceMesh mesh =
      parse("v 1 2 3 1\nv 4 5 6 0.5 0.5 0.5\nv 7 8 9 1 1 1 1\nvt 0.5\nvt 0.5 0.25 0\nf 1/1 2/2 3/2\n");
  EXPECT_EQ(mesh.positions[1], Vec3(4, 5, 6));
  EXPECT_EQ(mesh.texcoords[0], Vec2(0.5, 0));
  EXPECT_EQ(mesh.texcoords[1], Vec2(0.5, 0.25));
}

TEST(Obj, IgnoresWhatHasNoPartInTheSurface) {
  EXPECT_EQ(parse("mtllib a b.mtl\n" + square + "usemtl x\ns off\nvn 0 0 1\nvp 0 0\nl 1 2\np 1\nlod 1\nf 1 2 3\n")
                .triangles.size(),
            1u);
}

TEST(Obj, RefusesWhatOtherFormatsSay) {
  EXPECT_EQ(complaint("facet 1 2 3\n" + square),
            "a.obj:1: keyword: expected v, vt, vn, f, g, o or another keyword of a polygon mesh, got \"facet\"");
  EXPECT_NE(complaint(square + "f 1 2 3\nsurf 0 1 0 1 1 2 3\n").find("a.obj:6: keyword: "), std::string::npos);
  for (const char* text : {"solid x\n", "OFF\n3 1 0\n", "{\"a\": 1}\n",
                           "\x7f"
                           "ELF\1\1",
                           "V 0 0 0\n", "call other.obj\n", "csh rm\n", "curv 0 1 1 2\n", "1 2 3\n"}) {
    EXPECT_NE(complaint(text + square + "f 1 2 3\n").find("a.obj:1: keyword: "), std::string::npos) << text;
  }
}

TEST(Obj, SaysInOneSentenceWhatItSkips) {
  EXPECT_TRUE(parse(square + "f 1 2 3\n").notes.empty());
  const SurfaceMesh mesh = parse(square +
                                 "vt nan nan\nvt 0.5 0.5\nvt\nvt 1 x\nvn nan 0 0\n"
                                 "f 1/2/9 2/7/x 3/-9\nf 1 2\nf 3\nseam 1 2 \\\n3\nl 1 2\nseam 4\nf 1/2 3/3 4/2//\n");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.texcoord[0], (std::array<Index, 3>{1, -1, -1}));
  EXPECT_EQ(mesh.texcoord[1], (std::array<Index, 3>{1, -1, 1}));
  EXPECT_EQ(mesh.texcoords[1], Vec2(0.5, 0.5));
  EXPECT_EQ(
      mesh.notes,
      std::vector<std::string>{
          "a.obj: skipped 2 lines of statements that OBJ does not have (line 13: seam), 2 faces of fewer than three "
          "corners (line 11), 3 texture coordinates that are no numbers (line 5: nan), 2 texture coordinates of "
          "corners that do not exist (line 10: -9)"});
}

TEST(Obj, ForgetsTextureCoordinatesOfWhichNoneExists) {
  const SurfaceMesh mesh = parse(square + "f 1/1/1 2/2/2 3/3/3\n");
  EXPECT_TRUE(mesh.texcoord.empty());
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_NE(mesh.notes[0].find("3 texture coordinates of corners that do not exist (line 5: 1)"), std::string::npos)
      << mesh.notes[0];
}

TEST(Obj, NumbersGroupsAndObjectsInOrderOfTheirFaces) {
  const SurfaceMesh mesh = parse(square +
                                 "f 1 2 3\n"
                                 "o shirt \n"
                                 "g unused\n"
                                 "g front left\r\n"
                                 "f 1 2 3\n"
                                 "g back\n"
                                 "f 1 2 3\n"
                                 "o skirt\n"
                                 "f 1 2 3\n"
                                 "g  front left\n"
                                 "f 1 2 3 4\n"
                                 "g\n"
                                 "f 1 2 3\n");
  EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"", "front left", "back"}));
  EXPECT_EQ(mesh.object_names, (std::vector<std::string>{"", "shirt", "skirt"}));
  EXPECT_EQ(mesh.group, (std::vector<Index>{0, 1, 2, 2, 1, 1, 0}));
  EXPECT_EQ(mesh.object, (std::vector<Index>{0, 1, 1, 2, 2, 2, 2}));
}

TEST(Obj, SkipsAByteOrderMark) { EXPECT_EQ(parse("\xef\xbb\xbf" + square + "f 1 2 3").positions.size(), 4u); }

TEST(Obj, NamesTheLineOfABadNumber) {
  EXPECT_EQ(complaint("v 0 0 0\nv 0 nan 0\n"), "a.obj:2: vertex: expected a finite number, got \"nan\"");
  EXPECT_EQ(complaint("v 0 0 0\n\n\nv 0 0\n"), "a.obj:4: vertex: expected 3 numbers, got 2");
  EXPECT_EQ(complaint("v 0,5 0 0\n"),
            "a.obj:1: vertex: expected a finite number with a decimal point, not a comma, got \"0,5\"");
  EXPECT_EQ(complaint("v 1 2 3 4 5 6 7 8 9\n"), "a.obj:1: vertex: expected at most 8 numbers, got \"9\"");
  for (const char* word :
       {"inf", "-inf", "NaN", "nan(1)", "infinity", "1e999", "-1e999", "1,5", "0x10", "1.5f",    "1e",
        "-",   "+",    ".",   "++1",    "+-1",      "--1",   "1e+",    "x",   "1_0",  "\xd9\xa1"}) {
    EXPECT_EQ(complaint("v 0 0 "s + word + "\n").substr(0, 15), "a.obj:1: vertex") << word;
    EXPECT_EQ(complaint("v 0 0 0 "s + word + "\n").substr(0, 15), "a.obj:1: vertex") << word;
  }
  EXPECT_NE(complaint("v 0 0 1"s + std::string(400, '0') + "\n"), "none");
}

TEST(Obj, NamesTheLineOfABadFace) {
  EXPECT_EQ(complaint(square + "f 1 2 0\n"), "a.obj:5: face: expected an index in 1..4, got 0");
  EXPECT_EQ(complaint(square + "f 1 2 -5\n"), "a.obj:5: face: expected an index in 1..4, got -5");
  EXPECT_EQ(complaint(square + "f 1 2 5\n"), "a.obj:5: face: expected an index in 1..4, got 5");
  for (const char* word :
       {"2147483647", "2147483648", "2147483649", "4294967295", "4294967297", "4000000000", "9223372036854775807",
        "9223372036854775808", "-2147483648", "-4294967295", "-9223372036854775808", "18446744073709551617",
        "99999999999999999999999999", "1.0", "1e0", "x", "+1", "0x1", "--1"}) {
    EXPECT_EQ(complaint(square + "f 1 2 " + word + "\n"), "a.obj:5: face: expected an index in 1..4, got "s + word);
    EXPECT_EQ(parse(square + "vt 0 0\nf 1/1 2/1 3/" + word + "\n").texcoord[0][2], -1) << word;
  }
  for (const char* word : {"/", "//", "/1", "//1", "x//1"}) {
    EXPECT_EQ(complaint(square + "vt 0 0\nvt 1 1\nf 1 2 " + word + "\n").substr(0, 13), "a.obj:7: face") << word;
  }
}

TEST(Obj, RefusesAnEmptyMesh) {
  EXPECT_EQ(complaint(""), "a.obj:1: mesh: expected at least one vertex, got none");
  EXPECT_EQ(complaint("\n# nothing\n"), "a.obj:2: mesh: expected at least one vertex, got none");
  EXPECT_EQ(complaint(square), "a.obj:4: mesh: expected at least one face, got none");
}

TEST(Obj, KeepsControlCharactersOutOfMessages) {
  const std::string message = complaint("\x1b[31mred\x07 1\n");
  EXPECT_NE(message.find("\"?[31mred?\""), std::string::npos) << message;
}

TEST(Obj, SurvivesAFileCutAnywhere) {
  const std::string text =
      "mtllib x\no a\n" + square + "vt 0 0\nvt 1 0.5\ng b\nf 1/1 2/2 3/1\nf -4//1 -2//1 \\\n-1//1\n";
  ASSERT_EQ(complaint(text), "none");
  for (std::size_t cut = 0; cut < text.size(); ++cut) {
    const std::string message = complaint(std::string_view(text).substr(0, cut));
    EXPECT_TRUE(message == "none" || message.substr(0, 6) == "a.obj:") << message;
    EXPECT_TRUE(message != "none" || cut > text.find("f 1/1 2/2 3")) << cut;
  }
}

TEST(Obj, SurvivesAnyFlippedByte) {
  const std::string text = "v 0 -1.5e2 0\nv 1 0 0\nv 1 1 0\nvt 1 0\ng b\nf 1/1 2//7 \\\n-1\n";
  ASSERT_EQ(complaint(text), "none");
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (int byte = 0; byte < 256; ++byte) {
      std::string broken = text;
      broken[at] = static_cast<char>(byte);
      try {
        const SurfaceMesh mesh = parse(broken);
        for (const Vec3& x : mesh.positions) ASSERT_TRUE(x.allFinite());
        for (const Triangle& triangle : mesh.triangles) {
          for (const Index i : triangle) ASSERT_TRUE(i >= 0 && static_cast<std::size_t>(i) < mesh.positions.size());
        }
      } catch (const InputError& error) {
        ASSERT_EQ(std::string(error.what()).substr(0, 6), "a.obj:");
      }
    }
  }
}

TEST(Obj, ReadsAPolygonOfManyCorners) {
  std::string text = square + "f";
  for (int i = 0; i < 100'000; ++i) text += " 1 2 3";
  EXPECT_EQ(parse(text).triangles.size(), 299'998u);
}

// A mesh in which everything occurs: several objects and groups, corners without texture coordinate.
SurfaceMesh rich_mesh() {
  SurfaceMesh mesh;
  std::mt19937_64 random(7);
  for (int i = 0; i < 50; ++i) {
    Vec3 x;
    for (double& coordinate : x) coordinate = std::ldexp(static_cast<double>(random() >> 11) * 0x1p-52 - 1, i - 25);
    mesh.positions.push_back(x);
    mesh.texcoords.push_back(x.head<2>() * 0.1);
  }
  for (Index t = 0; t < 48; ++t) {
    mesh.triangles.push_back({t, t + 1, t + 2});
    mesh.texcoord.push_back({t, t % 3 == 0 ? -1 : t + 1, 49 - t});
    mesh.group.push_back(t / 8 % 3);
    mesh.object.push_back(t / 24);
  }
  mesh.group_names = {"front", "back left", ""};
  mesh.object_names = {"shirt", "skirt"};
  return mesh;
}

TEST(WriteObj, IsReadBackTheSame) {
  const Scratch scratch;
  const SurfaceMesh mesh = rich_mesh();
  write_obj(scratch / "a.obj", mesh);
  const SurfaceMesh back = load_obj(scratch / "a.obj");
  ASSERT_EQ(back.positions.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_EQ(back.positions[i].cast<float>(), mesh.positions[i].cast<float>());
    EXPECT_EQ(back.texcoords[i].cast<float>(), mesh.texcoords[i].cast<float>());
  }
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(back.texcoord, mesh.texcoord);
  EXPECT_EQ(back.group_names, mesh.group_names);
  EXPECT_EQ(back.object_names, mesh.object_names);
  EXPECT_EQ(back.group, mesh.group);
  EXPECT_EQ(back.object, mesh.object);
  // And from there on to the byte.
  write_obj(scratch / "b.obj", back);
  EXPECT_EQ(scratch.get("a.obj"), scratch.get("b.obj"));
}

TEST(WriteObj, ReadsBackEveryFloat) {
  const Scratch scratch;
  SurfaceMesh mesh;
  std::mt19937_64 random(8);
  while (mesh.positions.size() < 30'000) {
    Vec3 x;
    for (double& coordinate : x) {
      float value;
      do {
        const auto bits = static_cast<std::uint32_t>(random() >> 32);
        std::memcpy(&value, &bits, sizeof value);
      } while (!std::isfinite(value));
      coordinate = value;
    }
    mesh.positions.push_back(x);
  }
  mesh.triangles = {{0, 1, 2}};
  write_obj(scratch / "a.obj", mesh);
  const SurfaceMesh back = load_obj(scratch / "a.obj");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    ASSERT_EQ(back.positions[i].cast<float>(), mesh.positions[i].cast<float>()) << i;
  }
}

TEST(WriteObj, AgreesWithTheFloatsOfACache) {
  // 1 + 2^-24 is half way between two floats; nine digits of the double would be read as the wrong one.
  const Scratch scratch;
  SurfaceMesh mesh;
  mesh.positions = {Vec3(1 + 0x1p-24 + 0x1p-50, 1 + 0x3p-24 - 0x1p-50, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  mesh.triangles = {{0, 1, 2}};
  write_obj(scratch / "a.obj", mesh);
  EXPECT_EQ(load_obj(scratch / "a.obj").positions[0].cast<float>(), mesh.positions[0].cast<float>());
}

TEST(WriteObj, LooksAsDocumented) {
  const Scratch scratch;
  SurfaceMesh mesh;
  mesh.positions = {Vec3(0.1, -2, 1e-7), Vec3(1, 0, 0), Vec3(0, 1e10, 0)};
  mesh.texcoords = {Vec2(0, 0.5)};
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}};
  mesh.texcoord = {{0, -1, 0}, {-1, -1, -1}};
  mesh.group = {0, 1};
  mesh.group_names = {"front", "back"};
  mesh.object = {0, 0};
  mesh.object_names = {"shirt"};
  write_obj(scratch / "a.obj", mesh);
  EXPECT_EQ(scratch.get("a.obj"),
            "o shirt\nv 0.100000001 -2 1.00000001e-07\nv 1 0 0\nv 0 1e+10 0\nvt 0 0.5\n"
            "g front\nf 1/1 2 3/1\ng back\nf 3 2 1\n");
}

TEST(WriteObj, WritesTheSameBytesInTheLocaleOfADecimalComma) {
  const Scratch scratch;
  write_obj(scratch / "a.obj", rich_mesh());
  std::string expected;
  SurfaceMesh back;
  {
    const CommaLocale comma;
    write_obj(scratch / "b.obj", rich_mesh());
    back = load_obj(scratch / "a.obj");
  }
  EXPECT_EQ(scratch.get("a.obj"), scratch.get("b.obj"));
  EXPECT_EQ(back.positions[3], load_obj(scratch / "a.obj").positions[3]);
}

TEST(WriteObj, WritesEachObjectAndEachGroupInItOnce) {
  const Scratch scratch;
  SurfaceMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  mesh.triangles = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}};
  mesh.object = {1, 0, 1, 1, 0};
  mesh.group = {0, 0, 1, 0, 0};
  mesh.object_names = {"A", "B"};
  mesh.group_names = {"g0", "g1"};
  write_obj(scratch / "a.obj", mesh);
  EXPECT_EQ(scratch.get("a.obj"),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
            "o B\ng g0\nf 1 2 3\nf 1 3 2\ng g1\nf 3 1 2\no A\ng g0\nf 2 3 1\nf 3 2 1\n");
}

TEST(WriteObj, LetsNoNameBreakOutOfItsLine) {
  const Scratch scratch;
  SurfaceMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  mesh.triangles = {{0, 1, 2}};
  mesh.object = mesh.group = {0};
  mesh.object_names = {"a\nv 9 9 9\r"};
  mesh.group_names = {"b\\"};
  write_obj(scratch / "a.obj", mesh);
  const SurfaceMesh back = load_obj(scratch / "a.obj");
  EXPECT_EQ(back.positions.size(), 3u);
  EXPECT_EQ(back.object_names[0], "a_v 9 9 9_");
  EXPECT_EQ(back.group_names[0], "b_");
}

TEST(WriteObj, RefusesWhatCannotBeWritten) {
  const Scratch scratch;
  const auto message = [&](const SurfaceMesh& mesh) {
    return message_of<InputError>([&] { write_obj(scratch / "a.obj", mesh); }).substr((scratch / "a.obj").size());
  };
  SurfaceMesh mesh = rich_mesh();
  mesh.positions[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message(mesh), ": vertex 3: expected a number that a float can hold, got nan");
  mesh = rich_mesh();
  mesh.positions[3].y() = 1e39;
  EXPECT_NE(message(mesh).find(": vertex 3: "), std::string::npos);
  mesh = rich_mesh();
  mesh.triangles[5][1] = 50;
  EXPECT_EQ(message(mesh), ": triangle 5: expected a vertex below 50, got 50");
  mesh = rich_mesh();
  mesh.texcoord[5][1] = -2;
  EXPECT_EQ(message(mesh), ": triangle 5: expected a texture coordinate below 50, got -2");
  mesh = rich_mesh();
  mesh.group[6] = 3;
  EXPECT_EQ(message(mesh), ": triangle 6: expected a group below 3, got 3");
  mesh = rich_mesh();
  mesh.object.pop_back();
  EXPECT_EQ(message(mesh), ": object: expected 48 entries, got 47");
  EXPECT_EQ(scratch.file_count(), 0u);
}

TEST(WriteObj, NamesThePathThatCannotBeWritten) {
  const Scratch scratch;
  EXPECT_EQ(message_of<IoError>([&] { write_obj(scratch / "none/a.obj", rich_mesh()); }),
            scratch / "none/a.obj" + ": cannot create: No such file or directory");
}

std::string shared(const char* file) { return test::shared_path("bodies/") + file; }

TEST(ObjOfOthers, TheMeanBodyIsClosed) {
  const std::string path = shared("garmentcode/mean_all.obj");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const SurfaceMesh body = load_obj(path);
  EXPECT_EQ(body.positions.size(), 23752u);
  EXPECT_EQ(body.triangles.size(), 47500u);
  check_closed(path, body.positions, body.triangles);
}

TEST(ObjOfOthers, TheMeanBodyInTPoseHasTheSameTriangles) {
  const std::string path = shared("garmentcode/mean_all_tpose.obj");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const SurfaceMesh body = load_obj(path);
  EXPECT_EQ(body.positions.size(), 23752u);
  EXPECT_EQ(body.triangles.size(), 47500u);
  EXPECT_EQ(body.object_names.size(), 1u);
}

TEST(ObjOfOthers, TheMakehumanBaseKeepsGroupsAndTextureCoordinates) {
  const std::string path = shared("makehuman/base.obj");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const SurfaceMesh body = load_obj(path);
  EXPECT_EQ(body.positions.size(), 19158u);
  EXPECT_EQ(body.texcoords.size(), 21334u);
  EXPECT_EQ(body.triangles.size(), 2u * 18486u);  // all quads
  EXPECT_EQ(body.group_names.size(), 139u);       // of 172 `g` lines, some repeated or without faces
  EXPECT_EQ(body.texcoord.size(), body.triangles.size());
}

}  // namespace
}  // namespace toile::internal
