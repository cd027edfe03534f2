// Which way a person stands and faces is seen from the surface alone, and nothing is said of what has no such way.
#include "body/upright.hpp"

#include "body/mannequins.hpp"
#include "body/solid_shapes.hpp"
#include "io/obj.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace toile::internal {
namespace {

Mat3 columns(const Vec3& x, const Vec3& y, const Vec3& z) {
  Mat3 rotation;
  rotation << x, y, z;
  return rotation;
}

// How the file's axes lie, and a word of the note.
struct Way {
  Mat3 in_file;
  const char* word;
};
const Way ways[] = {
    {columns(Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)), "z is up"},
    {columns(Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)), "on its head"},
    {columns(Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)), "faces -z"},
    {columns(Vec3(0, 0, -1), Vec3(0, 1, 0), Vec3(1, 0, 0)), "faces +x"},
    {columns(Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(-1, 0, 0)), "faces -x"},
};

TEST(Upright, SeesHowAPersonLiesInItsFile) {
  for (const MannequinKind kind : {MannequinKind::woman, MannequinKind::man}) {
    const Mannequin& person = test::mannequin_of(kind);
    EXPECT_TRUE(upright(person.positions, person.triangles, UpAxis::automatic).notes.empty());
    for (const auto& [in_file, word] : ways) {
      Vec3s x;
      for (const Vec3& p : person.positions) x.push_back(100 * (in_file * p) + Vec3(7, -30, 20));
      const Turned turned = upright(x, person.triangles, UpAxis::automatic);
      EXPECT_EQ(turned.rotation * in_file, Mat3(Mat3::Identity())) << word;
      ASSERT_EQ(turned.notes.size(), 1u) << word;
      EXPECT_NE(turned.notes[0].find(word), std::string::npos) << turned.notes[0];
    }
  }
}

TEST(Upright, SeesZUpAndAFaceTogether) {
  const Mannequin& person = test::mannequin_of(MannequinKind::woman);
  const Mat3 in_file = ways[0].in_file * ways[2].in_file;  // z up, facing +y
  Vec3s x;
  for (const Vec3& p : person.positions) x.push_back(in_file * p);
  const Turned turned = upright(x, person.triangles, UpAxis::automatic);
  EXPECT_EQ(turned.rotation * in_file, Mat3(Mat3::Identity()));
  EXPECT_EQ(turned.notes.size(), 2u);
}

TEST(Upright, DoesWhatItIsToldAndNoMore) {
  const Mannequin& person = test::mannequin_of(MannequinKind::woman);
  for (const auto& [in_file, word] : ways) {
    Vec3s x;
    for (const Vec3& p : person.positions) x.push_back(in_file * p);
    EXPECT_EQ(upright(x, person.triangles, UpAxis::y).rotation, Mat3(Mat3::Identity())) << word;
    const Turned turned = upright(x, person.triangles, UpAxis::z);
    EXPECT_EQ(turned.rotation, z_up_to_y_up()) << word;
    EXPECT_TRUE(turned.notes.empty());
  }
  EXPECT_EQ(z_up_to_y_up() * Vec3(1, 2, 3), Vec3(1, 3, -2));
}

TEST(Upright, SuspectsADummyWithoutLegsThatStandsOnItsHead) {
  const std::vector<Vec2> outline = {Vec2(0, 0),      Vec2(0.12, 0.01), Vec2(0.13, 0.5),
                                     Vec2(0.2, 0.9),  Vec2(0.15, 1.1),  Vec2(0.18, 1.35),
                                     Vec2(0.07, 1.5), Vec2(0.1, 1.6),   Vec2(0, 1.7)};
  SolidMesh dummy = revolved(outline, 0.05);
  EXPECT_TRUE(upright(dummy.positions, dummy.triangles, UpAxis::automatic).notes.empty());
  for (Vec3& p : dummy.positions) p = Vec3(-p.x(), -p.y(), p.z());
  const Turned turned = upright(dummy.positions, dummy.triangles, UpAxis::automatic);
  EXPECT_TRUE(turned.rotation.isIdentity(0));
  ASSERT_EQ(turned.notes.size(), 1u);
  EXPECT_NE(turned.notes[0].find("may stand on its head"), std::string::npos);
}

TEST(Upright, SaysNothingOfWhatHasNoWay) {
  const SolidMesh round = ball(0.8, 0.1), chest = block(Vec3(0.5, 0.6, 0.9)),
                  pillar = rounded_cylinder(0.2, 1.7, Vec3(0, 1.7, 0));
  for (const SolidMesh* solid : {&round, &chest, &pillar})
    EXPECT_TRUE(upright(solid->positions, solid->triangles, UpAxis::automatic).notes.empty());
}

TEST(Upright, SaysNothingOfGarmentCodesBodies) {
  const std::filesystem::path folder(test::shared_path("bodies/garmentcode"));
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs " << folder;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".obj") continue;
    const SurfaceMesh mesh = load_obj(entry.path().string());
    EXPECT_TRUE(upright(mesh.positions, mesh.triangles, UpAxis::automatic).notes.empty()) << entry.path();
  }
}

}  // namespace
}  // namespace toile::internal
