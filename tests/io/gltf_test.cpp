// glTF: what is a surface in it, and what a file may not do.
#include "io/mesh_file.hpp"

#include "io/scratch.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <limits>
#include <string>

namespace toile::internal {
namespace {

using Triangles = std::vector<Triangle>;

SurfaceMesh parse(std::string_view bytes, const std::string& path = "a.glb") { return parse_mesh(bytes, path); }
std::string complaint(std::string_view bytes, const std::string& path = "a.glb") {
  try {
    parse(bytes, path);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

template <class T>
void append(std::string& bytes, std::initializer_list<T> values) {
  for (const T& value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string glb(std::string json, std::string bin) {
  while (json.size() % 4 != 0) json += ' ';
  while (bin.size() % 4 != 0) bin += '\0';
  std::string bytes = "glTF";
  append<std::uint32_t>(
      bytes, {2, static_cast<std::uint32_t>(28 + json.size() + bin.size()), static_cast<std::uint32_t>(json.size())});
  bytes += "JSON" + json;
  append<std::uint32_t>(bytes, {static_cast<std::uint32_t>(bin.size())});
  return bytes + std::string("BIN\0", 4) + bin;
}

std::string base64(const std::string& bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
  }
  return text;
}

// A square of two triangles: positions (48 bytes), uv (32), indices of 2 bytes (12).
std::string square() {
  std::string bin;
  append<float>(bin, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  append<float>(bin, {0, 1, 1, 1, 1, 0, 0, 0.25F});
  append<std::uint16_t>(bin, {0, 1, 2, 0, 2, 3});
  return bin;
}
const std::string views =
    R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":32},{"buffer":0,"byteOffset":80,"byteLength":12}])";
const std::string accessors =
    R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},)"
    R"({"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}])";
const std::string buffer = R"("buffers":[{"byteLength":92}])";
const std::string primitive = R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2})";

std::string json_of(const std::string& rest, const std::string& primitives = primitive,
                    const std::string& data = buffer) {
  return R"({"asset":{"version":"2.0"},"meshes":[{"name":"sheet","primitives":[)" + primitives + "]}]," + views + ',' +
         accessors + ',' + data + ',' + rest + '}';
}
const std::string one_node = R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])";

TEST(Gltf, ReadsPositionsUvAndNames) {
  const SurfaceMesh mesh = parse(glb(json_of(one_node), square()));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  ASSERT_EQ(mesh.positions.size(), 4U);
  EXPECT_EQ(mesh.positions[2], Vec3(1, 1, 0));
  EXPECT_EQ(mesh.texcoords[0], Vec2(0, 0)) << "the second number points down in the file";
  EXPECT_EQ(mesh.texcoords[3], Vec2(0, 0.75));
  EXPECT_EQ(mesh.texcoord[1], (std::array<Index, 3>{0, 2, 3}));
  EXPECT_EQ(mesh.group_names, std::vector<std::string>{"sheet"});
  EXPECT_TRUE(mesh.notes.empty());
}

TEST(Gltf, ReadsTextWithDataInIt) {
  const std::string data =
      R"("buffers":[{"byteLength":92,"uri":"data:application/octet-stream;base64,)" + base64(square()) + "\"}]";
  EXPECT_EQ(parse("\xef\xbb\xbf \n" + json_of(one_node, primitive, data), "a.gltf").triangles.size(), 2U);
  EXPECT_NE(complaint(json_of(one_node, primitive,
                              R"("buffers":[{"byteLength":92,"uri":"data:application/octet-stream;base64,AAAA"}])"))
                .find("a.glb: glTF: expected a file of glTF 2.0, got "),
            std::string::npos);
}

// Turned by a quarter about z, twice as large and moved, below a node that moves too; and mirrored by a matrix, which turns the faces over.
TEST(Gltf, NodesMoveTheirMeshes) {
  const SurfaceMesh mesh = parse(glb(
      json_of(
          R"("scene":1,"scenes":[{"nodes":[]},{"nodes":[0,2]}],"nodes":[{"name":"skirt","translation":[0,0,5],"children":[1]},)"
          R"({"name":"front","mesh":0,"translation":[10,0,0],"rotation":[0,0,0.70710678118654757,0.70710678118654757],"scale":[2,2,2]},)"
          R"({"name":"mirrored","mesh":0,"matrix":[-1,0,0,0,0,1,0,0,0,0,1,0,7,8,9,1]},{"name":"not in the scene","mesh":0}])"),
      square()));
  ASSERT_EQ(mesh.positions.size(), 8U);
  EXPECT_NEAR((mesh.positions[1] - Vec3(10, 2, 5)).norm(), 0, 1e-12);
  EXPECT_EQ(mesh.positions[5], Vec3(6, 8, 9));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}}));
  EXPECT_EQ(mesh.object_names, (std::vector<std::string>{"skirt", "mirrored"}));
  EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"front", "mirrored"}));
}

TEST(Gltf, PrimitivesAreGroupsByTheirMaterials) {
  const SurfaceMesh mesh = parse(glb(
      json_of(
          one_node + R"(,"materials":[{"name":"denim"},{}])",
          R"({"attributes":{"POSITION":0},"indices":2,"material":0},{"attributes":{"POSITION":0},"material":1,"mode":5})"),
      square()));
  EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"denim", "sheet.1"}));
  EXPECT_EQ(mesh.group_material, (std::vector<std::string>{"denim", ""}));
  EXPECT_TRUE(mesh.texcoord.empty());
  EXPECT_EQ(mesh.positions.size(), 4U) << "one accessor is one set of vertices";
}

TEST(Gltf, ReadsStripsAndFans) {
  const auto triangles_of = [](int mode, const std::string& more) {
    return parse(glb(json_of(one_node, R"({"attributes":{"POSITION":0},"mode":)" + std::to_string(mode) + more + '}'),
                     square()))
        .triangles;
  };
  EXPECT_EQ(triangles_of(5, ""), (Triangles{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(triangles_of(6, ""), (Triangles{{1, 2, 0}, {2, 3, 0}}));
  EXPECT_EQ(triangles_of(5, R"(,"indices":2)"), (Triangles{{0, 1, 2}, {1, 0, 2}, {0, 3, 2}}))
      << "without the one that turns back";
  const SurfaceMesh mesh = parse(
      glb(json_of(one_node,
                  primitive + R"(,{"attributes":{"POSITION":0},"mode":1},{"attributes":{"POSITION":0},"mode":0})"),
          square()));
  EXPECT_EQ(mesh.notes, std::vector<std::string>{"a.glb: has points or lines, which are left out"});
  EXPECT_NE(complaint(glb(json_of(one_node, R"({"attributes":{"POSITION":0},"mode":7})"), square()))
                .find("/mode: expected 0 to 6, got 7"),
            std::string::npos);
}

// Quantised positions and uv, 1-byte indices, one vertex replaced by a sparse accessor.
TEST(Gltf, ReadsEveryComponentTypeNormalisedAndSparse) {
  std::string bin;
  append<std::int16_t>(bin, {0, 0, 0, 0, 32767, 0, 0, 0, 32767, 32767, 0, 0, 0, -32768, 0, 0});  // stride 8
  append<std::uint8_t>(bin, {0, 255, 255, 255, 255, 0, 0, 51});
  append<std::uint8_t>(bin, {0, 1, 2, 0, 2, 3, 0, 0});
  append<std::uint8_t>(bin, {2, 0});
  append<std::int16_t>(bin, {16384, 0, -32767});
  const std::string json =
      R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_mesh_quantization"],"meshes":[{"primitives":[)" +
      primitive +
      R"(]}],"nodes":[{"mesh":0}],"buffers":[{"byteLength":56}],"bufferViews":[{"buffer":0,"byteLength":32,"byteStride":8},)"
      R"({"buffer":0,"byteOffset":32,"byteLength":8},{"buffer":0,"byteOffset":40,"byteLength":8},{"buffer":0,"byteOffset":48,"byteLength":8}],)"
      R"("accessors":[{"bufferView":0,"componentType":5122,"normalized":true,"count":4,"type":"VEC3",)"
      R"("sparse":{"count":1,"indices":{"bufferView":3,"componentType":5121},"values":{"bufferView":3,"byteOffset":2}}},)"
      R"({"bufferView":1,"componentType":5121,"normalized":true,"count":4,"type":"VEC2"},{"bufferView":2,"componentType":5121,"count":6,"type":"SCALAR"}]})";
  const SurfaceMesh mesh = parse(glb(json, bin));
  EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.positions[2], Vec3(16384.0 / 32767, 0, -1)) << "replaced";
  EXPECT_EQ(mesh.positions[3], Vec3(0, -1, 0)) << "the smallest is -1 too";
  EXPECT_EQ(mesh.texcoords[3], Vec2(0, 1 - 51.0 / 255));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Gltf, SaysWhatIsNotTaken) {
  const SurfaceMesh mesh = parse(glb(
      json_of(
          R"("nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],)"
          R"("animations":[{"samplers":[{"input":0,"output":0}],"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}])"),
      square()));
  EXPECT_EQ(mesh.notes, std::vector<std::string>{"a.glb: has animations, and is taken as it stands without them"});
}

TEST(Gltf, SaysPlaceExpectedAndGot) {
  const auto of = [](const std::string& from, const std::string& to) {
    std::string json = json_of(one_node);
    const std::size_t place = json.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    json.replace(place, from.size(), to);
    return complaint(glb(json, square()));
  };
  EXPECT_EQ(of(R"("count":6)", R"("count":7)"),
            "a.glb: /accessors/2: expected 7 elements of 2 bytes in bufferViews/2, which has 12 bytes, got fewer");
  EXPECT_EQ(of(R"("componentType":5123)", R"("componentType":5126)"),
            "a.glb: /accessors/2: expected 6 elements of 4 bytes in bufferViews/2, which has 12 bytes, got fewer");
  EXPECT_EQ(of(R"("POSITION":0)", R"("POSITION":9)"), "a.glb: /accessors/9: expected a number below 3, got 9");
  EXPECT_EQ(of(R"("POSITION":0)", R"("POSITION":2)"), "a.glb: /accessors/2/type: expected VEC3, got SCALAR");
  EXPECT_EQ(of(R"("byteOffset":80,"byteLength":12)", R"("byteOffset":84,"byteLength":12)"),
            "a.glb: /bufferViews/2: expected bytes of a buffer of 92, got 12 from 84 on");
  EXPECT_EQ(of(R"("mesh":0)", R"("mesh":3)"), "a.glb: /nodes/0/mesh: expected a number below 1, got 3");
  EXPECT_EQ(of(R"("nodes":[0])", R"("nodes":[4])"), "a.glb: /scenes: expected a node below 1, got 4");
  EXPECT_EQ(of(R"({"mesh":0})", R"({"mesh":0,"children":[0]})"),
            "a.glb: /nodes/0: expected a node that hangs in one place, got two");
  EXPECT_EQ(of(R"("mesh":0)", R"("mesh":0,"matrix":[1,2])"), "a.glb: /nodes/0/matrix: expected 16 numbers, got 2");
  EXPECT_EQ(of(R"("2.0")", R"("1.0")"), "a.glb: /asset/version: expected 2.x, got \"1.0\"");
  EXPECT_EQ(
      of(R"("asset")", R"("extensionsRequired":["KHR_draco_mesh_compression"],"asset")"),
      "a.glb: /extensionsRequired: expected none but of materials, textures, lights and KHR_mesh_quantization, got "
      "KHR_draco_mesh_compression");
  EXPECT_EQ(of(R"("indices":2)", R"("indices":2,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0}})"),
            "a.glb: /meshes/0/primitives/0: expected data that are not compressed, got KHR_draco_mesh_compression");
  EXPECT_EQ(of(R"("byteLength":48)", R"("byteLength":48,"extensions":{"EXT_meshopt_compression":{"buffer":0}})"),
            "a.glb: /bufferViews/0: expected data that are not compressed, got EXT_meshopt_compression");
  std::string bin = square();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bin.data() + 16, &nan, sizeof nan);
  EXPECT_EQ(complaint(glb(json_of(one_node), bin)),
            "a.glb: /accessors/0, element 1: expected finite numbers, got not a number");
  bin = square();
  bin[80] = 4;
  EXPECT_EQ(complaint(glb(json_of(one_node), bin)),
            "a.glb: /meshes/0/primitives/0/indices: expected indices below 4, got 4");
  EXPECT_NE(complaint("{\"asset\": {\"version\": \"2.0\"}", "a.gltf").find("a.gltf: glTF: expected JSON, got "),
            std::string::npos);
  EXPECT_EQ(complaint("glTF1234"), "a.glb: header: expected 20 bytes, got 8");
  EXPECT_EQ(complaint(glb(json_of(R"("nodes":[{}])"), square())),
            "a.glb: scene: expected at least one mesh with triangles, got none");
}

TEST(Gltf, NestingAndNumbersAreBounded) {
  EXPECT_EQ(
      complaint(glb(
          R"({"asset":{"version":"2.0","extras":)" + std::string(100'000, '[') + std::string(100'000, ']') + "}}", "")),
      "a.glb:1: glTF: expected arrays and objects at most 64 deep, got more");
  const std::string zeros =
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"componentType":5126,"count":19000000,"type":"VEC3"}]})";
  EXPECT_EQ(complaint(zeros),
            "a.glb: /accessors/0/count: expected no more than the file has bytes, as it has no data, got 19000000");
}

TEST(Gltf, FilesComeFromItsOwnFolderAlone) {
  const Scratch scratch;
  scratch.put("in/data/a b.bin", square());
  scratch.put("secret.bin", square());
  std::filesystem::create_symlink(scratch / "secret.bin", scratch / "in/link.bin");
  const auto with = [&](const std::string& uri) {
    return scratch.put("in/a.gltf",
                       json_of(one_node, primitive, R"("buffers":[{"byteLength":92,"uri":")" + uri + "\"}]"));
  };
  std::size_t seen = 0;
  const std::string path = with("data/a%20b.bin");
  EXPECT_EQ(load_mesh(path, [&](std::string_view bytes) { seen += bytes.size(); }).triangles.size(), 2U);
  EXPECT_EQ(seen, std::filesystem::file_size(path) + 92) << "an input hash knows them";
  EXPECT_EQ(files_of_mesh(path).size(), 2U);
  for (const std::string& uri :
       {std::string("../secret.bin"), scratch / "secret.bin", std::string("data/../../secret.bin"),
        std::string("link.bin"), std::string("file:///etc/passwd"), std::string("http://a/b.bin"),
        std::string("..\\\\secret.bin"), std::string("%2e%2e/secret.bin"), std::string("/dev/zero")}) {
    const std::string message = message_of<InputError>([&] { load_mesh(with(uri)); });
    EXPECT_NE(message.find("expected one in the folder of this file, or below it, got "), std::string::npos)
        << uri << ": " << message;
    EXPECT_EQ(files_of_mesh(with(uri)).size(), 1U) << uri;
  }
  EXPECT_NE(message_of<IoError>([&] { load_mesh(with("none.bin")); }), "none");
}

TEST(Gltf, SurvivesAFileCutAnywhere) {
  const std::string text = json_of(
      one_node, primitive,
      R"("buffers":[{"byteLength":92,"uri":"data:application/octet-stream;base64,)" + base64(square()) + "\"}]");
  for (const std::string& whole : {glb(json_of(one_node), square()), text}) {
    ASSERT_EQ(complaint(whole), "none");
    for (std::size_t cut = 1; cut < whole.size(); ++cut) {
      const std::string message = complaint(std::string_view(whole).substr(0, cut));
      EXPECT_TRUE(message.starts_with("a.glb")) << cut << message;
    }
  }
}

TEST(Gltf, SurvivesAnyFlippedByte) {
  const std::string whole = glb(json_of(one_node), square());
  for (std::size_t place = 4; place < whole.size(); ++place) {
    for (const char byte : std::string("\0\1\"-9[},\x7f\xff", 10)) {
      std::string broken = whole;
      broken[place] = byte;
      const std::string message = complaint(broken);
      EXPECT_TRUE(message == "none" || message.starts_with("a.glb"))
          << place << ' ' << static_cast<int>(byte) << ": " << message;
    }
  }
}

// Files of others, whole and cut: what they hold is known from other programs (trimesh).
TEST(Gltf, ReadsFilesOfOthers) {
  const std::filesystem::path folder(test::shared_path("gltf"));
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs " << folder;
  const SurfaceMesh fox = load_mesh((folder / "Fox.glb").string());
  EXPECT_EQ(fox.triangles.size(), 576U);
  EXPECT_EQ(fox.notes.size(), 1U) << "animations";
  const AnimatedMesh animated = load_animated((folder / "Fox.glb").string());
  EXPECT_EQ(animated.clips.size(), 3U);
  EXPECT_EQ(chosen_clip(animated.clips, "Run", "").name, "Run");
  EXPECT_EQ(animated.surface.positions, fox.positions);
  const SurfaceMesh toy = load_mesh((folder / "kenney_platformer_character.glb").string());
  EXPECT_GT(toy.triangles.size(), 100U);
  EXPECT_GT(toy.group_names.size(), 1U);
}

}  // namespace
}  // namespace toile::internal
