// Moving bodies: samples interpolated and led in without a jump, files checked before the run, mannequins evaluated.
#include "body/body_motion.hpp"

#include "body/body_samples.hpp"
#include "body/mannequins.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "io/mdd.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

namespace toile::internal {
namespace {

namespace fs = std::filesystem;

// A folder of its own for each test, gone afterwards.
class Folder {
 public:
  Folder()
      : path_(fs::temp_directory_path() / "toile_body_motion" /
              testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

// A box of 1.6 m with the corners in an odd order, and a small box beside it that is not part of the body.
SurfaceMesh figure() {
  SurfaceMesh mesh;
  const auto box = [&](const Vec3& low, const Vec3& high) {
    const Index first = static_cast<Index>(mesh.positions.size());
    for (int c = 0; c < 8; ++c)
      mesh.positions.emplace_back(c & 1 ? high.x() : low.x(), c & 2 ? high.y() : low.y(), c & 4 ? high.z() : low.z());
    constexpr Triangle faces[12] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    for (const Triangle& t : faces) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  };
  box(Vec3(1, 0, 0), Vec3(1.05, 0.05, 0.05));  // comes first, so that indices shift
  box(Vec3(0, 0, 0), Vec3(0.3, 1.6, 0.2));
  return mesh;
}

CollisionBody figure_body() { return make_collision_body(figure(), "figure.obj", LengthUnit::automatic); }

SurfaceMesh moved(SurfaceMesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.positions) p += by;
  return mesh;
}

using Path = std::function<Vec3(int)>;  // shift of a frame

void write_pc2(const std::string& file, const std::vector<Vec3>& rest, int frames, const Path& path) {
  std::filesystem::remove(file);
  Pc2Writer writer(file, static_cast<Index>(rest.size()), 0, 1);
  for (int f = 0; f < frames; ++f) {
    std::vector<Vec3> x = rest;
    for (Vec3& p : x) p += path(f);
    writer.append(x);
  }
}

void write_objs(const Folder& folder, int first, int frames, const Path& path) {
  for (int f = 0; f < frames; ++f) {
    char name[32];
    std::snprintf(name, sizeof name, "walk_%04d.obj", first + f);
    write_obj(folder / name, moved(figure(), path(f)));
  }
}

Vec3 along_z(int f) { return {0, 0, 0.02 * f}; }

std::vector<Vec3> positions_at(const BodyMotion& motion, double t) {
  std::vector<Vec3> x(motion.vertex_count());
  motion.positions(t, x);
  return x;
}

std::string complaint(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

testing::AssertionResult says(const std::string& text, std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    if (text.find(part) == std::string::npos)
      return testing::AssertionFailure() << "'" << part << "' is not in '" << text << "'";
  return testing::AssertionSuccess();
}

TEST(BodyMotion, GoesExactlyThroughSamplesAndStraightBetweenThoseOfAnEvenPath) {
  const Folder folder;
  write_pc2(folder / "walk.pc2", figure().positions, 6, along_z);
  const BodyMotion motion = BodyMotion::from_pc2(folder / "walk.pc2", figure_body(), {});
  const CollisionBody body = figure_body();
  ASSERT_EQ(motion.vertex_count(), 8U);  // the small box is not part of it
  EXPECT_EQ(motion.lead_in_s(), 0);      // the first sample is the drape pose
  EXPECT_NEAR(motion.duration_s(), 5 / 30.0, 1e-12);
  for (const double frame : {0.0, 1.0, 2.4, 3.0, 4.9, 5.0, 7.0}) {
    const auto x = positions_at(motion, frame / 30);
    for (std::size_t i = 0; i < 8; ++i)
      EXPECT_LT((x[i] - body.positions[i] - Vec3(0, 0, 0.02 * std::min(frame, 5.0))).norm(), 1e-6) << frame;
  }
}

TEST(BodyMotion, HasContinuousVelocityThroughSamplesOfACrookedPath) {
  const Folder folder;
  const auto crooked = [](int f) { return Vec3(0.02 * f, 0.0, 0.05 * ((f * 7) % 4)); };
  write_pc2(folder / "walk.pc2", figure().positions, 9, crooked);
  const BodyMotion motion = BodyMotion::from_pc2(folder / "walk.pc2", figure_body(), {});
  const double h = 1e-5;
  for (int f = 1; f < 8; ++f) {
    const double t = f / 30.0;
    const Vec3 before = (positions_at(motion, t)[3] - positions_at(motion, t - h)[3]) / h,
               after = (positions_at(motion, t + h)[3] - positions_at(motion, t)[3]) / h;
    EXPECT_LT((after - before).norm(), 0.02) << f;
    const Vec3 slope = (crooked(f + 1) - crooked(f - 1)) * 15;
    EXPECT_LT((after - slope).norm(), 0.02) << f;
  }
  // One-sided at the ends.
  EXPECT_LT(((positions_at(motion, h)[0] - positions_at(motion, 0)[0]) / h - 30 * (crooked(1) - crooked(0))).norm(),
            0.02);
  EXPECT_LT(
      ((positions_at(motion, 8 / 30.0)[0] - positions_at(motion, 8 / 30.0 - h)[0]) / h - 30 * (crooked(8) - crooked(7)))
          .norm(),
      0.02);
}

TEST(BodyMotion, LeadsInFromTheDrapePoseAtRestAndMeetsTheSamplesOnTime) {
  const Folder folder;
  const auto elsewhere = [](int f) { return Vec3(0.4, 0.1, 0.03 * f); };
  write_pc2(folder / "walk.pc2", figure().positions, 40, elsewhere);
  SampleOptions options;
  options.lead_in_s = 0.8;
  const BodyMotion motion = BodyMotion::from_pc2(folder / "walk.pc2", figure_body(), options);
  const CollisionBody body = figure_body();
  EXPECT_EQ(motion.lead_in_s(), 0.8);
  EXPECT_NEAR(motion.duration_s(), 0.8 + 39 / 30.0, 1e-12);
  EXPECT_EQ(positions_at(motion, 0)[5], body.positions[5]);
  EXPECT_EQ(positions_at(motion, -1)[5], body.positions[5]);
  for (const int f : {5, 6, 20, 39})
    EXPECT_LT((positions_at(motion, 0.8 + f / 30.0)[5] - body.positions[5] - elsewhere(f)).norm(), 1e-6) << f;
  // At rest first, then no jump of velocity anywhere until the end: accelerations stay near those of the blend.
  const double h = 1e-3;
  EXPECT_LT((positions_at(motion, h)[5] - positions_at(motion, 0)[5]).norm() / h, 1e-3);
  double hardest = 0;
  for (double t = h; t < motion.duration_s() - 2 * h; t += h)
    hardest = std::max(
        hardest,
        (positions_at(motion, t + h)[5] - 2 * positions_at(motion, t)[5] + positions_at(motion, t - h)[5]).norm() /
            (h * h));
  EXPECT_LT(hardest, 15);
}

TEST(BodyMotion, ReadsNumberedObjFilesFromAFolderAndByPattern) {
  const Folder folder;
  write_objs(folder, 8, 5, along_z);  // 0008 ... 0012: sorted by number
  const CollisionBody body = figure_body();
  for (const std::string& path : {folder.path(), folder / "walk_%04d.obj", folder / "walk_%d.obj"}) {
    const BodyMotion motion = BodyMotion::from_files(path, body, {});
    EXPECT_NEAR(motion.duration_s(), 4 / 30.0, 1e-12) << path;
    EXPECT_EQ(std::vector<Triangle>(motion.triangles().begin(), motion.triangles().end()), body.triangles);
    EXPECT_LT((positions_at(motion, 3 / 30.0)[2] - body.positions[2] - along_z(3)).norm(), 1e-6) << path;
  }
}

TEST(BodyMotion, SortsByNumberNotByName) {
  const Folder folder;
  for (int f = 9; f <= 11; ++f) write_obj(folder / (std::to_string(f) + ".obj"), figure());
  const auto files = numbered_files(folder.path());
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0].number, 9);
  EXPECT_EQ(files[2].number, 11);
}

TEST(BodyMotion, NamesTheFrameThatIsMissingOrThereTwice) {
  const Folder folder;
  write_objs(folder, 1, 5, along_z);
  fs::remove(folder / "walk_0003.obj");
  EXPECT_TRUE(says(complaint([&] { BodyMotion::from_files(folder.path(), figure_body(), {}); }),
                   {"walk_0004.obj", "expected frame number 3, got 4"}));
  write_objs(folder, 1, 5, along_z);
  write_obj(folder / "walk_4.obj", figure());
  EXPECT_TRUE(says(complaint([&] { BodyMotion::from_files(folder.path(), figure_body(), {}); }),
                   {"expected frame number 5, got 4 twice"}));
  EXPECT_EQ(complaint([&] { BodyMotion::from_files(folder / "walk_%04d.obj", figure_body(), {}); }), "");
  write_obj(folder / "body.obj", figure());
  EXPECT_TRUE(says(complaint([&] { BodyMotion::from_files(folder.path(), figure_body(), {}); }),
                   {"body.obj", "expected a number in the name of every frame"}));
}

TEST(BodyMotion, RefusesAPathThatNamesNoFrames) {
  const Folder folder;
  EXPECT_TRUE(
      says(complaint([&] { BodyMotion::from_files(folder.path(), figure_body(), {}); }), {"numbered files of meshes"}));
  EXPECT_TRUE(says(complaint([&] { BodyMotion::from_files(folder / "a.obj", figure_body(), {}); }), {"%04d"}));
  EXPECT_TRUE(says(complaint([&] { BodyMotion::from_files(folder / "a%s.obj", figure_body(), {}); }), {"%04d"}));
  EXPECT_THROW(BodyMotion::from_files(folder / "none.pc2", figure_body(), {}), IoError);
  EXPECT_THROW(BodyMotion::from_files(folder / "no/such/%d.obj", figure_body(), {}), IoError);
}

TEST(BodyMotion, RefusesAnotherVertexCountOrOtherTriangles) {
  const Folder folder;
  write_objs(folder, 0, 3, along_z);
  SurfaceMesh fewer = figure();
  fewer.positions.pop_back();
  fewer.triangles.resize(12);
  write_obj(folder / "walk_0001.obj", fewer);
  EXPECT_TRUE(says(complaint([&] { BodyMotion::from_files(folder.path(), figure_body(), {}); }),
                   {"walk_0001.obj: frame 1: expected 16 vertices", "or 8 of the body alone, got 15"}));
  SurfaceMesh other = figure();
  std::swap(other.triangles[14][1], other.triangles[14][2]);
  write_obj(folder / "walk_0001.obj", other);
  EXPECT_TRUE(says(complaint([&] { BodyMotion::from_files(folder.path(), figure_body(), {}); }),
                   {"walk_0001.obj: frame 1, triangle 14: expected vertices 12 13 15", "got 12 15 13"}));
  other = figure();
  other.triangles.pop_back();
  write_obj(folder / "walk_0001.obj", other);
  EXPECT_TRUE(says(complaint([&] { BodyMotion::from_files(folder.path(), figure_body(), {}); }),
                   {"frame 1: expected 24 triangles", "got 23"}));
}

TEST(BodyMotion, RefusesNumbersThatAreNotFiniteAndVerticesThatJump) {
  const Folder folder;
  std::vector<Vec3> x = figure().positions;
  const auto write = [&](const Vec3& of_vertex_9) {
    std::filesystem::remove(folder / "walk.pc2");
    Pc2Writer writer(folder / "walk.pc2", 16, 0, 1);
    writer.append(x);
    std::vector<Vec3> next = x;
    next[9] += of_vertex_9;
    writer.append(next);
  };
  const auto read = [&] { BodyMotion::from_pc2(folder / "walk.pc2", figure_body(), {}); };
  write(Vec3(0, 0.0 / 0.0, 0));
  EXPECT_TRUE(says(complaint(read), {"walk.pc2: frame 1, vertex 9: expected finite"}));
  write(Vec3(0, 0, 0.70));
  EXPECT_TRUE(says(complaint(read), {"frame 1, vertex 9: expected at most 0.667 m", "20 m/s", "got 0.7 m"}));
  write(Vec3(0, 0, 0.65));
  EXPECT_EQ(complaint(read), "");
}

TEST(BodyMotion, ConvertsUnitsAndSuspectsAForgottenOne) {
  const Folder folder;
  std::vector<Vec3> cm = figure().positions;
  for (Vec3& p : cm) p *= 100;
  write_pc2(folder / "walk.pc2", cm, 3, [](int f) { return Vec3(2.0 * f, 0, 0); });
  EXPECT_TRUE(says(complaint([&] { BodyMotion::from_pc2(folder / "walk.pc2", figure_body(), {}); }),
                   {"frame 0: expected a height near the body's 1.6 m", "unit", "got 160 m"}));
  SampleOptions options;
  options.unit = LengthUnit::cm;
  const BodyMotion motion = BodyMotion::from_pc2(folder / "walk.pc2", figure_body(), options);
  EXPECT_LT((positions_at(motion, 1 / 15.0)[0] - figure_body().positions[0] - Vec3(0.04, 0, 0)).norm(), 1e-6);
}

TEST(BodyMotion, ReadsMdd) {
  const Folder folder;
  MddWriter writer(folder / "walk.mdd", 16, 3, 30);
  for (int f = 0; f < 3; ++f) writer.append(moved(figure(), along_z(f)).positions);
  writer.commit();
  const BodyMotion motion = BodyMotion::from_files(folder / "walk.mdd", figure_body(), {});
  EXPECT_LT((positions_at(motion, 1 / 30.0)[4] - figure_body().positions[4] - along_z(1)).norm(), 1e-6);
}

TEST(BodyMotion, ABodyMayBeCarriedFasterThanItsLimbsMove) {
  const Folder folder;
  const auto read = [&](double metres_per_frame) {
    write_pc2(folder / "car.pc2", figure().positions, 4, [&](int f) { return Vec3(metres_per_frame * f, 0, 0); });
    return complaint([&] { BodyMotion::from_pc2(folder / "car.pc2", figure_body(), {}); });
  };
  EXPECT_EQ(read(25 / 30.0), "");
  EXPECT_TRUE(says(read(101 / 30.0), {"car.pc2: frame 1: expected a body at most 3.33 m", "100 m/s", "got 3.37 m"}));
}

TEST(BodyMotion, TurnsSamplesWithOtherAxesThanTheBody) {
  const Folder folder;
  std::vector<Vec3> z_up;
  for (const Vec3& p : figure().positions) z_up.emplace_back(p.x(), -p.z(), p.y());
  write_pc2(folder / "z_up.pc2", z_up, 3, [](int f) { return Vec3(0, 0, 0.01 * f); });
  const BodyMotion motion = BodyMotion::from_pc2(folder / "z_up.pc2", figure_body(), {});
  EXPECT_LT((positions_at(motion, 2 / 30.0)[4] - figure_body().positions[4] - Vec3(0, 0.02, 0)).norm(), 1e-6);
  ASSERT_EQ(motion.notes().size(), 1u);
  EXPECT_TRUE(says(motion.notes()[0], {"z_up.pc2: z is up in it", "(x, z, -y)"}));
  // And those of a file that is turned itself: the whole file as it is, or upright already, as Toile writes it.
  SurfaceMesh lying = figure();
  lying.positions = z_up;
  const CollisionBody body = make_collision_body(lying, "lying.obj", LengthUnit::automatic);
  EXPECT_LT((body.positions[4] - figure_body().positions[4]).norm(), 1e-12);
  EXPECT_TRUE(BodyMotion::from_pc2(folder / "z_up.pc2", body, {}).notes().empty());
  write_pc2(folder / "upright.pc2", body.positions, 3, along_z);
  const BodyMotion upright = BodyMotion::from_pc2(folder / "upright.pc2", body, {});
  EXPECT_LT((positions_at(upright, 1 / 30.0)[4] - body.positions[4] - along_z(1)).norm(), 1e-6);
  EXPECT_EQ(upright.notes().size(), 1u);
}

TEST(BodyMotion, RefusesSamplesWhoseFirstDoesNotFitTheEdges) {
  const Folder folder;
  std::vector<Vec3> x = figure().positions;
  std::swap(x[9], x[14]);  // another order
  write_pc2(folder / "other.pc2", x, 2, along_z);
  EXPECT_TRUE(says(complaint([&] { BodyMotion::from_pc2(folder / "other.pc2", figure_body(), {}); }),
                   {"other.pc2: frame 0, edge ", "a length near the body's", "in another order?"}));
  std::vector<Vec3> bent = figure().positions;  // another pose
  for (Vec3& p : bent) p.x() += 0.3 * p.y();
  write_pc2(folder / "bent.pc2", bent, 2, along_z);
  EXPECT_EQ(complaint([&] { BodyMotion::from_pc2(folder / "bent.pc2", figure_body(), {}); }), "");
}

TEST(BodyMotion, TakesSamplesOfTheBodyAlone) {
  const Folder folder;
  write_pc2(folder / "walk.pc2", figure_body().positions, 3, along_z);
  const BodyMotion motion = BodyMotion::from_pc2(folder / "walk.pc2", figure_body(), {});
  EXPECT_LT((positions_at(motion, 1 / 30.0)[4] - figure_body().positions[4] - along_z(1)).norm(), 1e-6);
}

TEST(BodyMotion, RefusesOptionsOutOfRange) {
  const Folder folder;
  write_pc2(folder / "walk.pc2", figure().positions, 3, along_z);
  const auto with = [&](auto change) {
    SampleOptions options;
    change(options);
    return complaint([&] { BodyMotion::from_pc2(folder / "walk.pc2", figure_body(), options); });
  };
  EXPECT_TRUE(says(with([](SampleOptions& o) { o.rate_hz = 0; }), {"samples per second"}));
  EXPECT_TRUE(says(with([](SampleOptions& o) { o.lead_in_s = -1; }), {"lead-in"}));
  EXPECT_TRUE(says(with([](SampleOptions& o) { o.fastest_m_s = 0.0 / 0.0; }), {"fastest"}));
}

TEST(BodyMotion, HashesWhatDecidesThePositions) {
  const Folder folder;
  const auto hash = [&](const Path& path, double rate) {
    write_pc2(folder / "walk.pc2", figure().positions, 3, path);
    SampleOptions options;
    options.rate_hz = rate;
    Hash h;
    BodyMotion::from_pc2(folder / "walk.pc2", figure_body(), options).add_to(h);
    return h.value();
  };
  EXPECT_EQ(hash(along_z, 30), hash(along_z, 30));
  EXPECT_NE(hash(along_z, 30), hash(along_z, 25));
  EXPECT_NE(hash(along_z, 30), hash([](int f) { return Vec3(0, 0, 0.021 * f); }, 30));
  const Mannequin& m = test::mannequin_of(MannequinKind::dancer);
  const auto named = [&](const char* name, double lead_in) {
    Motion motion = Motion::named(name, MannequinKind::dancer);
    motion.set_lead_in_s(lead_in);
    Hash h;
    BodyMotion::of_mannequin(m, motion).add_to(h);
    return h.value();
  };
  EXPECT_NE(named("walk", 1), named("dance", 1));
  EXPECT_NE(named("walk", 1), named("walk", 0.9));
}

TEST(BodyMotion, OfAMannequinIsItsMotion) {
  const Mannequin& m = test::mannequin_of(MannequinKind::dancer);
  const Motion walk = Motion::named("walk", MannequinKind::dancer);
  const BodyMotion motion = BodyMotion::of_mannequin(m, walk);
  EXPECT_TRUE(std::isinf(motion.duration_s()));
  EXPECT_EQ(motion.triangles().size(), m.triangles.size());
  const auto start = positions_at(motion, 0);
  for (std::size_t i = 0; i < start.size(); ++i) ASSERT_EQ(start[i], m.positions[i]);
  std::vector<Vec3> expected(m.positions.size());
  SkinnedBody(m).positions(walk.at(1.37), expected);
  EXPECT_EQ(positions_at(motion, 1.37), expected);
  EXPECT_TRUE(says(complaint([&] { BodyMotion::of_mannequin(m, Motion::named("walk", MannequinKind::man)); }),
                   {"one for the man"}));
  std::vector<Vec3> few(3);
  EXPECT_THROW(motion.positions(0, few), InputError);
}

// What a simulator would do with a recorded walk: as samples it stays within a millimetre of the motion itself.
TEST(BodyMotion, AWalkSampledAt60HzIsTheWalk) {
  const Folder folder;
  const Mannequin& m = test::mannequin_of(MannequinKind::dancer);
  const BodyMotion walk = BodyMotion::of_mannequin(m, Motion::named("walk", MannequinKind::dancer));
  std::filesystem::remove(folder / "walk.pc2");
  Pc2Writer writer(folder / "walk.pc2", static_cast<Index>(m.positions.size()), 0, 1);
  for (int f = 0; f <= 120; ++f) writer.append(positions_at(walk, f / 60.0));

  SampleOptions options;
  options.rate_hz = 60;
  const BodyMotion sampled = BodyMotion::from_pc2(folder / "walk.pc2", from_mannequin(m), options);
  EXPECT_EQ(sampled.lead_in_s(), 0);
  double apart = 0;
  for (const double t : {0.4123, 0.9, 1.3777, 1.7}) {
    const auto x = positions_at(sampled, t), y = positions_at(walk, t);
    for (std::size_t i = 0; i < x.size(); ++i) apart = std::max(apart, (x[i] - y[i]).norm());
  }
  EXPECT_LT(apart, 1e-3);
}

TEST(BodyMotion, IsTheSameOnOneThreadAndOnMany) {
  const Folder folder;
  write_objs(folder, 0, 5, [](int f) { return Vec3(0.1 * (f % 2), 0, 0.03 * f); });
  const BodyMotion motion = BodyMotion::from_files(folder.path(), figure_body(), {});
  const auto many = positions_at(motion, 0.071);
  with_threads(1, [&] { EXPECT_EQ(positions_at(motion, 0.071), many); });
}

// A real body: MakeHuman's base mesh with its helpers, in decimetres, as a sequence of its own file.
TEST(BodyMotion, SelectsTheBodyOfMakeHumansBaseMeshFromEachSample) {
  const std::string file = test::shared_path("bodies/makehuman/base.obj");
  if (!fs::exists(file)) GTEST_SKIP() << "needs " << file;
  const SurfaceMesh mesh = load_obj(file);
  const CollisionBody body = make_collision_body(mesh, file, LengthUnit::dm);
  const Folder folder;
  write_pc2(folder / "base.pc2", mesh.positions, 3, [](int f) { return Vec3(0, 0, 0.5 * f); });
  SampleOptions options;
  options.unit = LengthUnit::dm;
  const BodyMotion motion = BodyMotion::from_pc2(folder / "base.pc2", body, options);
  const auto x = positions_at(motion, 1 / 30.0);
  ASSERT_EQ(x.size(), 13380U);
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_LT((x[i] - body.positions[i] - Vec3(0, 0, 0.05)).norm(), 1e-5);
}

}  // namespace
}  // namespace toile::internal
