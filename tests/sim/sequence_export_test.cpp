// All frames of a run in one file.
#include "core/error.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/mdd.hpp"
#include "io/mesh_file.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "io/sequence_writer.hpp"
#include "sim/export_run.hpp"
#include "sim/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

// Two sheets over a ball, six frames.
class SequenceExport : public testing::Test {
 protected:
  void SetUp() override {
    const std::string path = scratch.put("scene.json", R"({
      "cloth": [{"name": "under", "grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.1}},
                {"name": "over", "grid": {"width_m": 0.3, "height_m": 0.2, "edge_m": 0.1},
                 "placement": {"translation_m": [0, 0.1, 0]}}],
      "solids": [{"sphere": {"radius_m": 0.1}, "edge_m": 0.05, "placement": {"translation_m": [0, -1, 0]},
                  "moves": [{"t_s": 0}, {"t_s": 1, "shift_m": [0.3, 0, 0]}]}],
      "time": {"seconds": 0.2, "fps": 25}})");
    RunOptions options;
    options.directory = folder;
    simulate(parse_scene(read_file(path), path), options);
    Pc2Reader reader(scratch / "run/cloth.pc2");
    for (int f = 0; f < reader.samples(); ++f) reader.read(f, frames.emplace_back());
    ASSERT_GE(frames.size(), 5u);
    ASSERT_NE(frames[0], frames[2]);
  }
  std::vector<std::string> write(const std::string& file, const std::string& of = "cloth", bool all = false) {
    ExportOptions options;
    options.out = scratch / file;
    options.of = of;
    options.all = all;
    return export_run(folder, options).files;
  }

  const Scratch scratch;
  const std::string folder = scratch / "run";
  std::vector<Vec3s> frames;
};

// Blocks of the text between `key` and the end of its braces: the values behind the time codes.
std::vector<std::string> samples_of(const std::string& text, const std::string& key) {
  const std::size_t begin = text.find(key + ".timeSamples = {");
  EXPECT_NE(begin, std::string::npos) << key;
  std::vector<std::string> samples;
  std::size_t line = text.find('\n', begin) + 1;
  while (text.substr(line, 9) != "        }") {
    const std::size_t end = text.find('\n', line);
    samples.push_back(text.substr(text.find(": ", line) + 2, end - text.find(": ", line) - 3));
    line = end + 1;
  }
  return samples;
}

Vec3s tuples(const std::string& text) {
  Vec3s values;
  const char* at = text.c_str();
  while ((at = std::strchr(at, '(')) != nullptr) {
    char* end = nullptr;
    Vec3 v;
    for (Eigen::Index k = 0; k < 3; ++k) {
      v[k] = static_cast<double>(std::strtof(at + 1, &end));
      at = end;
    }
    values.push_back(v);
  }
  return values;
}

TEST_F(SequenceExport, PointCachesHoldEveryFrameToTheBit) {
  EXPECT_EQ(write("a.pc2"), std::vector<std::string>{scratch / "a.pc2"});
  write("a.mdd");
  Pc2Reader pc2(scratch / "a.pc2");
  const MddReader mdd(scratch / "a.mdd");
  ASSERT_EQ(at(pc2.samples()), frames.size());
  ASSERT_EQ(at(mdd.samples()), frames.size());
  Vec3s x;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    pc2.read(static_cast<int>(f), x);
    EXPECT_EQ(x, frames[f]);
    mdd.read(static_cast<int>(f), x);
    EXPECT_EQ(x, frames[f]);
    EXPECT_NEAR(mdd.time_s(static_cast<int>(f)), static_cast<double>(f) / 25, 1e-7);
  }
}

TEST_F(SequenceExport, UsdHasAMeshPerGarmentWhosePointsMove) {
  write("a.usda", "both");
  const std::string text = read_file(scratch / "a.usda");
  for (const char* part : {"#usda 1.0\n", "timeCodesPerSecond = 25\n", "metersPerUnit = 1\n", "upAxis = \"Y\"\n",
                           "def Mesh \"under\"", "def Mesh \"over\"", "def Mesh \"body\"", "def GeomSubset"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_NE(text.find("endTimeCode = " + std::to_string(frames.size() - 1)), std::string::npos);
  const std::string over = text.substr(text.find("def Mesh \"over\""));
  const std::size_t under = 9;
  const auto points = samples_of(over, "points"), velocities = samples_of(over, "velocities");
  ASSERT_EQ(points.size(), frames.size());
  ASSERT_EQ(velocities.size(), frames.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Vec3s x = tuples(points[f]), v = tuples(velocities[f]);
    ASSERT_EQ(x.size() + under, frames[f].size());
    ASSERT_EQ(v.size(), x.size());
    const std::size_t from = std::min(f, frames.size() - 2);
    for (const Vec3& p : x) EXPECT_EQ(std::count(frames[f].begin() + under, frames[f].end(), p), 1);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto place = std::find(frames[f].begin() + under, frames[f].end(), x[i]) - frames[f].begin();
      const auto p = static_cast<std::size_t>(place);
      EXPECT_LT((v[i] - 25 * (frames[from + 1][p] - frames[from][p])).norm(), 1e-4);
    }
  }
  EXPECT_EQ(text, (write("b.usda", "both"), read_file(scratch / "b.usda")));
}

TEST_F(SequenceExport, GltfMovesByMorphTargets) {
  write("a.glb", "cloth", true);
  const std::string bytes = read_file(scratch / "a.glb");
  const auto number = [&](std::size_t from) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + from, 4);
    return value;
  };
  const std::size_t json_size = number(12), data = 20 + json_size + 8;
  const Json json = Json::parse(bytes.substr(20, json_size), "a.glb");
  const auto index = [](const Json& value) { return static_cast<std::size_t>(value.integer()); };
  const auto floats = [&](std::size_t accessor) {
    const Json& view = json.at("bufferViews").array()[index(json.at("accessors").array()[accessor].at("bufferView"))];
    const std::size_t offset = index(view.at("byteOffset"));
    std::vector<float> values(index(view.at("byteLength")) / 4);
    std::memcpy(values.data(), bytes.data() + data + offset, 4 * values.size());
    return values;
  };
  const Json& sampler = json.at("animations").array()[0].at("samplers").array()[0];
  const std::vector<float> times = floats(index(sampler.at("input"))), weights = floats(index(sampler.at("output")));
  ASSERT_EQ(times.size(), frames.size());
  ASSERT_EQ(weights.size(), frames.size() * (frames.size() - 1));
  EXPECT_EQ(json.at("animations").array()[0].at("channels").array().size(), 2u);
  for (const Json& mesh : json.at("meshes").array()) {
    const Json& primitive = mesh.at("primitives").array()[0];
    const std::vector<float> base = floats(index(primitive.at("attributes").at("POSITION")));
    for (std::size_t f = 0; f < frames.size(); ++f) {
      EXPECT_FLOAT_EQ(times[f], static_cast<float>(f) / 25);
      std::vector<float> x = base;
      for (std::size_t k = 0; k + 1 < frames.size(); ++k) {
        const std::vector<float> target = floats(index(primitive.at("targets").array()[k].at("POSITION")));
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += weights[f * (frames.size() - 1) + k] * target[i];
      }
      for (std::size_t i = 0; i < x.size(); i += 3)
        EXPECT_TRUE(std::any_of(frames[f].begin(), frames[f].end(), [&](const Vec3& p) {
          return (p - Vec3(static_cast<double>(x[i]), static_cast<double>(x[i + 1]), static_cast<double>(x[i + 2])))
                     .norm() < 1e-6;
        }));
    }
  }
  EXPECT_EQ(load_mesh(scratch / "a.glb").triangles.size(), load_mesh(folder + "/cloth.obj").triangles.size());
}

TEST_F(SequenceExport, RefusesWhatCannotBeMeantAndLeavesNothingHalfWritten) {
  const auto complaint = [&](auto&& change) {
    ExportOptions options;
    options.out = scratch / "a.usda";
    change(options);
    try {
      export_run(folder, options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_NE(
      complaint([&](ExportOptions& o) { o.out = scratch / "a.mdd", o.of = "both"; }).find("are for usda, not mdd"),
      std::string::npos);
  EXPECT_NE(complaint([](ExportOptions& o) { o.to = "mdd"; }).find("expected a file that ends in .mdd"),
            std::string::npos);
  EXPECT_NE(complaint([](ExportOptions& o) { o.frame = 99; }).find("frame: expected 0 to "), std::string::npos);
  EXPECT_NE(complaint([&](ExportOptions& o) { o.out = folder + "/cloth.pc2"; }).find("is a file of the run"),
            std::string::npos);
  ExportOptions stopped;
  for (const char* file : {"s.usda", "s.pc2", "s.mdd", "s.glb"}) {
    stopped.out = scratch / file;
    stopped.all = true;
    int polled = 0;
    EXPECT_TRUE(export_run(folder, stopped, [&] { return ++polled < 3; }).files.empty());
    EXPECT_FALSE(std::filesystem::exists(stopped.out));
  }
  ExportOptions one;
  one.out = scratch / "one.pc2";
  one.frame = 2;
  export_run(folder, one);
  Pc2Reader reader(scratch / "one.pc2");
  Vec3s x;
  reader.read(0, x);
  EXPECT_EQ(reader.samples(), 1);
  EXPECT_EQ(x, frames[2]);
}

}  // namespace
}  // namespace toile::internal
