// A run directory written with the writers of io, audited from its files.
#include "verify/verify.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "io/json_text.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/run_folder.hpp"
#include "support/message_of.hpp"
#include "verify/verdict.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

namespace toile::internal {
namespace {

constexpr int columns = 8, rows = 6, last_frame = 40;
constexpr double spacing = 0.05;

Index particle(int column, int row) { return row * (columns + 1) + column; }

// A sheet of two panels ("front" left of the middle, "back" right of it) that comes to rest 10 mm above a box.
struct RunFiles {
  SurfaceMesh cloth, body;
  std::vector<Vec3s> cloth_frames, body_frames;
  std::string report = R"({"fps": 30, "frames": 41, "body": {"vertices": 8, "triangles": 12}})";
};

RunFiles resting_sheet() {
  RunFiles run;
  run.cloth.group_names = {"front", "back"};
  run.cloth.object_names = {"sheet"};
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) {
      run.cloth.positions.push_back({spacing * c, 0.5, spacing * r});
      run.cloth.texcoords.push_back({spacing * c, -spacing * r});
    }
  for (int panel = 0; panel < 2; ++panel)
    for (int r = 0; r < rows; ++r)
      for (int c = panel * columns / 2; c < (panel + 1) * columns / 2; ++c) {
        const Index i = particle(c, r), right = particle(c + 1, r), down = particle(c, r + 1),
                    across = particle(c + 1, r + 1);
        for (const Triangle& t : {Triangle{i, down, across}, Triangle{i, across, right}}) {
          run.cloth.triangles.push_back(t);
          run.cloth.texcoord.push_back(t);
          run.cloth.group.push_back(panel);
          run.cloth.object.push_back(0);
        }
      }
  const Vec3 low(-1, 0, -1), high(1, 0.49, 1);
  for (int i = 0; i < 8; ++i)
    run.body.positions.push_back(
        {(i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(), (i & 4) != 0 ? high.z() : low.z()});
  run.body.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                        {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  run.body.group.assign(12, 0);
  run.body.group_names = {""};
  run.body.object.assign(12, 0);
  run.body.object_names = {"body"};
  for (int frame = 0; frame <= last_frame; ++frame) {
    Vec3s x = run.cloth.positions;
    const double fall = 0.5 * std::exp(-frame);
    for (Vec3& p : x) p.y() += fall;
    run.cloth_frames.push_back(x);
    run.body_frames.push_back(run.body.positions);
  }
  run.cloth.positions = run.cloth_frames[0];
  return run;
}

class RunDirectory {
 public:
  RunDirectory()
      : path_(std::filesystem::path(testing::TempDir()) /
              ("toile_verify_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~RunDirectory() { std::filesystem::remove_all(path_); }
  std::string path() const { return path_.string(); }
  std::string file(const char* name) const { return (path_ / name).string(); }

  void write(const RunFiles& run) const {
    write_obj(file("cloth.obj"), run.cloth);
    write_cache("cloth.pc2", run.cloth_frames);
    if (!run.body.positions.empty()) {
      write_obj(file("body.obj"), run.body);
      write_cache("body.pc2", run.body_frames);
    }
    seal(run);
  }
  // The report of what is there now.
  void seal(const RunFiles& run) const {
    write_text("report.json",
               sealed(run.report.substr(0, run.report.rfind('}')) + R"(, "files": )" + listed(run) + '}'));
  }
  void write_text(const char* name, const std::string& text) const { std::ofstream(file(name)) << text; }
  void write_cache(const char* name, const std::vector<Vec3s>& frames) const {
    std::filesystem::remove(file(name));
    Pc2Writer writer(file(name), static_cast<Index>(frames.at(0).size()), 0, 1);
    for (const Vec3s& x : frames) writer.append(x);
  }
  // As a run lists its files.
  std::string listed(const RunFiles& run) const {
    JsonText json(0);
    json.begin_object();
    const auto add_obj = [&](const char* name) {
      std::ostringstream bytes;
      bytes << std::ifstream(file(name), std::ios::binary).rdbuf();
      json.key(name);
      json.begin_object();
      json.member("checksum", hex_of(checksum(bytes.str().data(), bytes.str().size())));
      json.end_object();
    };
    const auto add_cache = [&](const char* name) {
      Pc2Reader reader(file(name));
      json.key(name);
      json.begin_object();
      json.member("header_checksum", hex_of(reader.header_checksum()));
      json.key("frame_checksums");
      json.begin_array();
      Vec3s x;
      for (int frame = 0; frame < reader.samples(); ++frame) {
        reader.read(frame, x);
        json.value(hex_of(reader.frame_checksum()));
      }
      json.end_array();
      json.end_object();
    };
    add_obj("cloth.obj");
    add_cache("cloth.pc2");
    if (!run.body.positions.empty()) {
      add_obj("body.obj");
      add_cache("body.pc2");
    }
    json.end_object();
    return json.str();
  }

 private:
  std::filesystem::path path_;
};

using toile::test::message_of;
#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(VerifyDirectory, PassesACleanRun) {
  const RunDirectory directory;
  directory.write(resting_sheet());
  const VerifyReport report = verify_directory(directory.path());
  EXPECT_EQ(report.frames, last_frame + 1);
  EXPECT_TRUE(report.finite);
  EXPECT_TRUE(report.has_body);
  EXPECT_EQ(report.cloth_body_edges.max, 0);
  EXPECT_EQ(report.cloth_cloth_edges.max, 0);
  EXPECT_NEAR(report.gap.min_mm, 10, 1e-3);
  EXPECT_NEAR(report.stretch.max, 0, 1e-5);
  EXPECT_LT(report.still_mm_per_s_p99, 1);
  Limits limits;
  limits.must_be_still = true;
  EXPECT_TRUE(judge(report, limits).pass);
}

TEST(VerifyDirectory, FindsAPlantedBodyCrossingInItsFrameAndTriangle) {
  RunFiles run = resting_sheet();
  // In frame 17 one particle inside the sheet dips 1 mm into the box's top (triangles 6 and 7).
  const Index dipped = particle(3, 2);
  run.cloth_frames[17][static_cast<std::size_t>(dipped)].y() = 0.489;
  const RunDirectory directory;
  directory.write(run);
  const VerifyReport report = verify_directory(directory.path());
  EXPECT_EQ(report.first_body_crossing_frame, 17);
  EXPECT_EQ(report.cloth_body_edges.frames, 1);
  EXPECT_EQ(report.cloth_body_edges.max, 6);  // the edges of an inner particle
  EXPECT_EQ(report.cloth_body_edges.last, 0);
  EXPECT_TRUE(judge(report).pass);  // earlier frames may cross

  const auto crossings =
      find_body_crossings(run.cloth.triangles, run.cloth_frames[17], run.body.triangles, run.body_frames[17]);
  ASSERT_EQ(crossings.size(), 6u);
  for (const Crossing& c : crossings) {
    EXPECT_TRUE(c.edge[0] == dipped || c.edge[1] == dipped);
    EXPECT_TRUE(c.triangle == 6 || c.triangle == 7);
  }
}

TEST(VerifyDirectory, FindsCrossingsOfTheLastFrameAndFailsTheRun) {
  RunFiles run = resting_sheet();
  // The corner is folded under the sheet and up through the next cells.
  run.cloth_frames.back()[static_cast<std::size_t>(particle(0, 0))] = Vec3(1.4 * spacing, 0.52, 1.6 * spacing);
  run.cloth_frames.back()[static_cast<std::size_t>(particle(1, 0))] = Vec3(1.5 * spacing, 0.485, 1.3 * spacing);
  run.cloth_frames[20] = run.cloth_frames.back();
  const RunDirectory directory;
  directory.write(run);
  const VerifyReport report = verify_directory(directory.path());
  EXPECT_EQ(report.first_cloth_crossing_frame, 20);
  EXPECT_EQ(report.cloth_cloth_edges.frames, 2);
  EXPECT_GT(report.cloth_cloth_edges.last, 0);
  EXPECT_GT(report.cloth_body_edges.last, 0);
  EXPECT_EQ(report.cloth_cloth_edges.last, count_edges(report.last_cloth_crossings));
  const Verdict verdict = judge(report);
  EXPECT_FALSE(verdict.pass);
  ASSERT_GE(verdict.reasons.size(), 2u);
  EXPECT_EQ(verdict.reasons[0].code, "cloth_body_intersection");
  EXPECT_EQ(verdict.reasons[1].code, "cloth_self_intersection");
}

TEST(VerifyDirectory, NamesTheFirstFrameThatIsNotFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()})
    for (const char* cache : {"cloth.pc2", "body.pc2"}) {
      RunFiles run = resting_sheet();
      const RunDirectory directory;
      directory.write(run);
      const auto points = cache[0] == 'c' ? run.cloth.positions.size() : run.body.positions.size();
      std::fstream file(directory.file(cache), std::ios::in | std::ios::out | std::ios::binary);
      for (const std::size_t frame : {23, 30}) {
        file.seekp(static_cast<std::streamoff>(32 + 12 * (frame * points + 5) + 4));
        file.write(reinterpret_cast<const char*>(&bad), sizeof bad);
      }
      file.close();
      directory.seal(run);
      const VerifyReport report = verify_directory(directory.path());
      EXPECT_FALSE(report.finite);
      EXPECT_EQ(report.first_bad_frame, 23) << cache;
      const Verdict verdict = judge(report);
      ASSERT_EQ(verdict.reasons.size(), 1u);
      EXPECT_EQ(verdict.reasons[0].code, "not_finite");
      EXPECT_CONTAINS(verdict.reasons[0].detail, "frame 23");
    }
}

TEST(VerifyDirectory, NamesMissingFiles) {
  for (const char* missing : {"report.json", "cloth.obj", "cloth.pc2", "body.obj", "body.pc2"}) {
    const RunDirectory directory;
    directory.write(resting_sheet());
    std::filesystem::remove(directory.file(missing));
    EXPECT_CONTAINS(message_of<IoError>([&] { verify_directory(directory.path()); }), missing);
  }
  EXPECT_THROW(verify_directory("/nowhere/at/all"), IoError);
}

TEST(VerifyDirectory, NamesATruncatedCache) {
  for (const char* cache : {"cloth.pc2", "body.pc2"})
    for (const std::uintmax_t lost : {1u, 12u, 100000u}) {
      const RunDirectory directory;
      directory.write(resting_sheet());
      const auto size = std::filesystem::file_size(directory.file(cache));
      std::filesystem::resize_file(directory.file(cache), size > lost ? size - lost : 10);
      EXPECT_CONTAINS(message_of<InputError>([&] { verify_directory(directory.path()); }), cache);
    }
}

TEST(VerifyDirectory, NamesCountsThatContradictEachOther) {
  const RunDirectory directory;
  RunFiles run = resting_sheet();
  directory.write(run);
  std::vector<Vec3s> frames = run.cloth_frames;
  for (Vec3s& x : frames) x.pop_back();
  directory.write_cache("cloth.pc2", frames);
  std::string message = message_of<InputError>([&] { verify_directory(directory.path()); });
  EXPECT_CONTAINS(message, "cloth.pc2: points: expected 63");
  EXPECT_CONTAINS(message, "got 62");

  directory.write(run);
  frames = run.body_frames;
  frames.pop_back();
  directory.write_cache("body.pc2", frames);
  message = message_of<InputError>([&] { verify_directory(directory.path()); });
  EXPECT_CONTAINS(message, "body.pc2: samples: expected 41");

  directory.write(run);
  frames = run.cloth_frames;
  for (Vec3s& x : frames) std::swap(x[3], x[40]);
  directory.write_cache("cloth.pc2", frames);
  EXPECT_CONTAINS(message_of<InputError>([&] { verify_directory(directory.path()); }), "frame 0, vertex 3");

  run.cloth.texcoord.clear();
  directory.write(run);
  EXPECT_CONTAINS(message_of<InputError>([&] { verify_directory(directory.path()); }), "cloth.obj: triangle 0");
}

TEST(VerifyDirectory, AuditsARunWithoutABody) {
  RunFiles run = resting_sheet();
  run.body = {};
  run.report = R"({"fps": 30, "frames": 41})";
  const RunDirectory directory;
  directory.write(run);
  const VerifyReport report = verify_directory(directory.path());
  EXPECT_FALSE(report.has_body);
  EXPECT_TRUE(judge(report).pass);
  // The report knows of a body: then its files must be there.
  directory.write_text("report.json", R"({"fps": 30, "body": {"vertices": 8}})");
  EXPECT_THROW(verify_directory(directory.path()), IoError);
}

TEST(VerifyDirectory, ReadsWhatTheRunWasMeantToBe) {
  RunFiles run = resting_sheet();
  run.report =
      R"({"fps": 30, "frames": 60, "reasons": ["simulation_timeout", "stretch"], "limits": {"still_mm_per_s": 5},
                   "rest_stretch": {"back": [0.8, 1]}})";
  const RunDirectory directory;
  directory.write(run);
  VerifyReport report = verify_directory(directory.path());
  EXPECT_TRUE(report.must_be_still);
  EXPECT_EQ(report.frames_expected, 60);
  EXPECT_EQ(report.reported_reasons,
            (std::vector<std::string>{"simulation_timeout"}));  // stretch is measured, not believed
  EXPECT_EQ(report.stretch.elastic_triangles, rows * columns);
  EXPECT_NEAR(report.stretch.max, 0.25, 1e-4);
  EXPECT_NEAR(report.stretch.triangle_max, 0, 1e-4);
  const Verdict verdict = judge(report);
  ASSERT_EQ(verdict.reasons.size(), 2u);
  EXPECT_EQ(verdict.reasons[0].code, "unfinished");
  EXPECT_EQ(verdict.reasons[1].code, "simulation_timeout");

  directory.write_text("report.json", R"({"fps": 30, "rest_stretch": {"sleeve": [0.8, 1]}})");
  EXPECT_CONTAINS(message_of<InputError>([&] { verify_directory(directory.path()); }), "/rest_stretch/sleeve");
  directory.write_text("report.json", R"({"fps": 30, "rest_stretch": {"back": [0.8, 0]}})");
  EXPECT_THROW(verify_directory(directory.path()), InputError);
  directory.write_text("report.json", R"({"fps": 0})");
  EXPECT_CONTAINS(message_of<InputError>([&] { verify_directory(directory.path()); }), "/fps");
  directory.write_text("report.json", R"({"frames": 41})");
  EXPECT_THROW(verify_directory(directory.path()), InputError);
  directory.write_text("report.json", "{");
  EXPECT_THROW(verify_directory(directory.path()), InputError);
}

TEST(RunAudit, TakesTheLargestSpeedOfTheLastSecondOnly) {
  RunDescription description;
  description.mesh.particle_count = 3;
  description.mesh.triangles = {{0, 1, 2}};
  description.mesh.uv = {{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}};
  description.mesh.panel = {0};
  description.fps = 10;
  RunAudit audit(description);
  Vec3s x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  // Steps in mm per frame: the jump of 50 lies more than a second before the end, that of 2 within it.
  for (const double step : {0.0, 50.0, 0.1, 2.0, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}) {
    for (Vec3& p : x) p.z() += 1e-3 * step;
    audit.add(x, {});
  }
  EXPECT_NEAR(audit.report().still_mm_per_s_p99, 20, 1e-9);
  EXPECT_THROW(audit.add(Vec3s(2), {}), InputError);
  EXPECT_THROW(audit.add(x, x), InputError);
}

}  // namespace
}  // namespace toile::internal
