// Reading a body out of a file: its unit, which part it is, and what is refused.
#include "body/collision_body.hpp"

#include "body/mannequins.hpp"
#include "core/error.hpp"
#include "io/obj.hpp"
#include "mesh/check.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

namespace toile::internal {
namespace {

// Adds a closed box with corners low and high to a group; `faces` of its 12 triangles.
void add_box(SurfaceMesh& mesh, const Vec3& low, const Vec3& high, const std::string& group, std::size_t faces = 12) {
  const Index first = static_cast<Index>(mesh.positions.size());
  for (int c = 0; c < 8; ++c)
    mesh.positions.emplace_back(c & 1 ? high.x() : low.x(), c & 2 ? high.y() : low.y(), c & 4 ? high.z() : low.z());
  constexpr Triangle box[12] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  mesh.group_names.push_back(group);
  for (std::size_t i = 0; i < faces; ++i) {
    mesh.triangles.push_back({first + box[i][0], first + box[i][1], first + box[i][2]});
    mesh.group.push_back(static_cast<Index>(mesh.group_names.size()) - 1);
  }
}

SurfaceMesh box_of_height(double height) {
  SurfaceMesh mesh;
  add_box(mesh, Vec3::Zero(), Vec3(0.2 * height, height, 0.1 * height), "");
  return mesh;
}

std::string all_notes(const CollisionBody& body) {
  std::string text;
  for (const std::string& note : body.notes) text += note + '\n';
  return text;
}

std::string complaint(const SurfaceMesh& mesh, LengthUnit unit) {
  try {
    make_collision_body(mesh, "models/figure.obj", unit);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(CollisionBody, TakesMetresAndItsNameFromTheFile) {
  const CollisionBody body = make_collision_body(box_of_height(1.7), "models/figure.obj", LengthUnit::automatic);
  EXPECT_EQ(body.name, "figure");
  EXPECT_DOUBLE_EQ(body.height_m, 1.7);
  EXPECT_EQ(body.positions.size(), 8U);
  EXPECT_EQ(body.triangles.size(), 12U);
}

TEST(CollisionBody, ConvertsTheUnitThatIsAskedFor) {
  EXPECT_NEAR(make_collision_body(box_of_height(17), "f.obj", LengthUnit::dm).height_m, 1.7, 1e-12);
  EXPECT_NEAR(make_collision_body(box_of_height(170), "f.obj", LengthUnit::cm).height_m, 1.7, 1e-12);
  EXPECT_NEAR(make_collision_body(box_of_height(0.3), "doll.obj", LengthUnit::m).height_m, 0.3, 1e-12);
}

TEST(CollisionBody, AsksForTheUnitInsteadOfGuessingIt) {
  const std::string cm = complaint(box_of_height(171.99), LengthUnit::automatic);
  EXPECT_NE(cm.find("figure.obj: body height: expected 0.5 to 2.5 m"), std::string::npos) << cm;
  EXPECT_NE(cm.find("--body-unit cm if the body is 1.72 m tall"), std::string::npos) << cm;
  EXPECT_NE(cm.find("got 172 m"), std::string::npos) << cm;
  const std::string dm = complaint(box_of_height(16.5), LengthUnit::automatic);
  EXPECT_NE(dm.find("--body-unit dm if the body is 1.65 m tall"), std::string::npos) << dm;
  EXPECT_NE(complaint(box_of_height(1720), LengthUnit::automatic).find("--body-unit mm if the body is 1.72 m tall"),
            std::string::npos);
  const std::string inches = complaint(box_of_height(66.93), LengthUnit::automatic);
  EXPECT_NE(inches.find("--body-unit in if the body is 1.70 m tall, or cm if the body is 0.67 m tall"),
            std::string::npos)
      << inches;
  for (const double height : {0.3, 3.0, 17200.0}) {
    const std::string none = complaint(box_of_height(height), LengthUnit::automatic);
    EXPECT_NE(none.find("no unit of m, dm, cm, mm, in fits"), std::string::npos) << height << ": " << none;
    EXPECT_NE(none.find("--body-unit"), std::string::npos) << none;
  }
}

TEST(CollisionBody, KeepsTheGroupCalledBodyEvenWhenAnotherIsLarger) {
  SurfaceMesh mesh;
  add_box(mesh, Vec3(-1, 0, -1), Vec3(1, 1.2, 1), "helper-skirt");
  add_box(mesh, Vec3::Zero(), Vec3(0.3, 1.7, 0.2), "Body");
  const CollisionBody body = make_collision_body(mesh, "f.obj", LengthUnit::automatic);
  EXPECT_EQ(body.positions.size(), 8U);
  EXPECT_EQ(body.triangles.size(), 12U);
  EXPECT_DOUBLE_EQ(body.height_m, 1.7);
  EXPECT_NE(all_notes(body).find("f.obj: helper-skirt (8 vertices, 4706 % of the volume of the body) left out"),
            std::string::npos)
      << all_notes(body);
}

TEST(CollisionBody, DoesNotFollowTheNameOfAPart) {
  SurfaceMesh mesh;
  add_box(mesh, Vec3(0, 0.9, 0), Vec3(0.4, 1.7, 0.2), "body");
  add_box(mesh, Vec3(0, 0, 0), Vec3(0.4, 0.85, 0.2), "legs");
  const CollisionBody body = make_collision_body(mesh, "f.obj", LengthUnit::automatic);
  EXPECT_EQ(body.positions.size(), 16U);
  EXPECT_DOUBLE_EQ(body.height_m, 1.7);
  EXPECT_NE(all_notes(body).find("the name is not followed"), std::string::npos) << all_notes(body);
}

TEST(CollisionBody, WithoutSuchANameKeepsTheLargeClosedPartsOnly) {
  SurfaceMesh mesh;
  add_box(mesh, Vec3(-0.3, 0.4, -0.3), Vec3(0.7, 1.5, 0.5), "cloak", 10);
  add_box(mesh, Vec3::Zero(), Vec3(0.4, 1.4, 0.2), "trunk");
  add_box(mesh, Vec3(0.05, 1.45, 0), Vec3(0.25, 1.7, 0.25), "head");
  add_box(mesh, Vec3(0.1, 1.6, 0.26), Vec3(0.12, 1.62, 0.28), "eye");
  const CollisionBody body = make_collision_body(mesh, "f.obj", LengthUnit::automatic);
  EXPECT_EQ(body.triangles.size(), 24U);
  EXPECT_EQ(body.positions.size(), 16U);
  EXPECT_DOUBLE_EQ(body.height_m, 1.7);
  EXPECT_NE(all_notes(body).find("cloak (8 vertices) is open: left out"), std::string::npos) << all_notes(body);
  EXPECT_NE(all_notes(body).find("1 smaller or open parts of 8 vertices (eye) left out"), std::string::npos);
}

TEST(CollisionBody, RefusesABodyWhoseLargestPartWouldBeLeftOut) {
  SurfaceMesh mesh;
  add_box(mesh, Vec3(0, 0, 0), Vec3(0.4, 1.4, 0.2), "trunk", 10);
  add_box(mesh, Vec3(0.05, 1.45, 0), Vec3(0.25, 1.7, 0.25), "head");
  const std::string why = complaint(mesh, LengthUnit::automatic);
  EXPECT_NE(why.find("trunk (10 triangles) with 1 hole (3.2 m round at (0.40, 0.70, 0.10) m)"), std::string::npos)
      << why;
}

TEST(CollisionBody, LeavesOutWhatLiesInsideTheRest) {
  SurfaceMesh mesh;
  add_box(mesh, Vec3(0, 0, 0), Vec3(0.4, 1.7, 0.2), "skin");
  add_box(mesh, Vec3(0.01, 0.01, 0.01), Vec3(0.39, 1.69, 0.19), "inner wall");
  for (std::size_t t = 12; t < 24; ++t) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  const CollisionBody body = make_collision_body(mesh, "f.obj", LengthUnit::automatic);
  EXPECT_EQ(body.positions.size(), 8U);
  EXPECT_NE(all_notes(body).find("inner wall (8 vertices) lies inside the body: left out"), std::string::npos);
}

TEST(CollisionBody, MendsAndSaysInOneSentenceWhatWasDone) {
  const Mannequin& woman = test::mannequin_of(MannequinKind::woman);
  SurfaceMesh mesh;
  mesh.positions = woman.positions;
  mesh.triangles = woman.triangles;
  const CollisionBody good = make_collision_body(mesh, "f.obj", LengthUnit::automatic);
  EXPECT_TRUE(good.notes.empty());
  std::swap(mesh.triangles[70][1], mesh.triangles[70][2]);
  mesh.triangles.push_back(mesh.triangles[5]);
  mesh.triangles.push_back({7, 7, 9});
  const CollisionBody mended = make_collision_body(mesh, "f.obj", LengthUnit::automatic);
  EXPECT_EQ(mended.triangles, good.triangles);
  EXPECT_EQ(mended.positions, good.positions);
  EXPECT_EQ(all_notes(mended),
            "f.obj: mended: 1 triangles with a corner twice are gone; 1 triangles that were there before are gone; 1 "
            "triangles are turned to face outwards\n");
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  std::swap(mesh.triangles[70][1], mesh.triangles[70][2]);
  mesh.triangles.resize(mesh.triangles.size() - 2);
  const CollisionBody turned = make_collision_body(mesh, "f.obj", LengthUnit::automatic);
  EXPECT_EQ(all_notes(turned), "f.obj: mended: all triangles are turned: it was inside out\n");
  EXPECT_EQ(turned.triangles, good.triangles);
}

TEST(CollisionBody, IsMendedBesideALargeFloorThatIsLeftOut) {
  const Mannequin& woman = test::mannequin_of(MannequinKind::woman);
  SurfaceMesh mesh;
  for (const Triangle& t : woman.triangles) {  // a soup
    const auto first = static_cast<Index>(mesh.positions.size());
    for (const Index i : t) mesh.positions.push_back(woman.positions[at(i)]);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.object.push_back(0);
  }
  std::swap(mesh.triangles[9][1], mesh.triangles[9][2]);
  const auto floor = static_cast<Index>(mesh.positions.size());
  for (const double x : {-100.0, 100.0})
    for (const double z : {-100.0, 100.0}) mesh.positions.emplace_back(x, 0, z);
  mesh.triangles.push_back({floor, floor + 1, floor + 2});
  mesh.triangles.push_back({floor + 2, floor + 1, floor + 3});
  mesh.object.insert(mesh.object.end(), {1, 1});
  mesh.object_names = {"person", "floor"};
  const CollisionBody body = make_collision_body(mesh, "f.obj", LengthUnit::automatic);
  EXPECT_EQ(body.positions.size(), woman.positions.size());
  EXPECT_EQ(body.triangles.size(), woman.triangles.size());
  EXPECT_NEAR(body.height_m, woman.measurements_m.height, 0.01);
  EXPECT_NE(all_notes(body).find("floor (4 vertices) is open: left out"), std::string::npos) << all_notes(body);
}

TEST(CollisionBody, CapsTheNeckOfABodyWithoutAHead) {
  const Mannequin& woman = test::mannequin_of(MannequinKind::woman);
  SurfaceMesh mesh;
  mesh.positions = woman.positions;
  const double neck = 0.86 * woman.measurements_m.height;
  for (const Triangle& t : woman.triangles)
    if (std::all_of(t.begin(), t.end(), [&](Index i) { return mesh.positions[at(i)].y() < neck; }))
      mesh.triangles.push_back(t);
  const CollisionBody body = make_collision_body(mesh, "bust.obj", LengthUnit::automatic);
  EXPECT_NE(all_notes(body).find("1 hole (0.3"), std::string::npos) << all_notes(body);
  EXPECT_NE(all_notes(body).find("m round at (0.00, 1.4"), std::string::npos) << all_notes(body);
  EXPECT_NO_THROW(check_closed("", body.positions, body.triangles));
  EXPECT_LT(body.height_m, neck);
  for (std::size_t i = 0; i < body.positions.size(); ++i)
    ASSERT_EQ(body.positions[i], mesh.positions[at(body.source_vertex[i])]);
}

TEST(CollisionBody, RefusesWhatIsNotAClosedBody) {
  EXPECT_NE(complaint(SurfaceMesh{}, LengthUnit::automatic).find("expected a closed surface"), std::string::npos);
  SurfaceMesh endless = box_of_height(1.7);
  endless.positions[3].x() = 1.0 / 0.0;
  EXPECT_NE(complaint(endless, LengthUnit::automatic).find("vertex 3: expected finite"), std::string::npos);
  SurfaceMesh nothing = box_of_height(1.7);
  for (Triangle& t : nothing.triangles) t[1] = t[0];
  EXPECT_NE(complaint(nothing, LengthUnit::automatic)
                .find("figure.obj: body: expected a closed surface, got triangles with a corner twice"),
            std::string::npos);
  SurfaceMesh dangling = box_of_height(1.7);
  dangling.triangles[4][1] = 99;
  EXPECT_NE(complaint(dangling, LengthUnit::automatic).find("triangle 4"), std::string::npos);
}

TEST(CollisionBody, IsMadeFromTheMannequinToo) {
  const Mannequin& m = test::mannequin_of(MannequinKind::woman);
  const CollisionBody body = from_mannequin(m);
  EXPECT_EQ(body.positions.size(), m.positions.size());
  EXPECT_EQ(body.triangles, m.triangles);
  EXPECT_NEAR(body.height_m, 1.72, 0.005);
  EXPECT_EQ(body.name, "mannequin");
  EXPECT_EQ(body.source_vertex_count, m.positions.size());
  EXPECT_EQ(body.source_vertex.back(), static_cast<Index>(m.positions.size()) - 1);
}

TEST(CollisionBody, ReadsTheBodyOfMakeHumansBaseMesh) {
  const std::string file = test::shared_path("bodies/makehuman/base.obj");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
  const SurfaceMesh mesh = load_obj(file);
  const CollisionBody body = make_collision_body(mesh, file, LengthUnit::dm);
  EXPECT_EQ(body.positions.size(), 13380U);
  EXPECT_EQ(body.triangles.size(), 26756U);
  ASSERT_EQ(body.source_vertex.size(), body.positions.size());
  EXPECT_EQ(body.source_vertex_count, mesh.positions.size());
  for (std::size_t i = 0; i < body.positions.size(); ++i)
    ASSERT_EQ(body.positions[i], Vec3(0.1 * mesh.positions[static_cast<std::size_t>(body.source_vertex[i])]));
  EXPECT_EQ(body.source_triangles, mesh.triangles);
  EXPECT_GT(body.height_m, 1.5);
  EXPECT_LT(body.height_m, 1.9);
  EXPECT_NE(complaint(mesh, LengthUnit::automatic).find("--body-unit dm"), std::string::npos);
}

TEST(CollisionBody, ReadsTheBodyOfGarmentCode) {
  const std::string file = test::shared_path("bodies/garmentcode/mean_all.obj");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
  const CollisionBody body = make_collision_body(load_obj(file), file, LengthUnit::automatic);
  EXPECT_EQ(body.positions.size(), 23752U);
  EXPECT_EQ(body.triangles.size(), 47500U);
  EXPECT_NEAR(body.height_m, 1.7199, 0.01);
}

}  // namespace
}  // namespace toile::internal
