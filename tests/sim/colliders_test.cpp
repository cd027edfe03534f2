// The colliders of a scene: every kind as a body and as a solid, and many as one.
#include "body/mannequin.hpp"
#include "core/error.hpp"
#include "io/scratch.hpp"
#include "sim/setup.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

namespace toile::internal {
namespace {

LoadedColliders load(const std::string& keys, const std::string& file = "s.json") {
  const SceneFile read = read_scene(R"({"cloth": [{"grid": {}}], )" + keys + "}", file);
  return read.places.complete_errors_of([&] { return load_colliders(read.scene.body, read.scene.solids); });
}

std::string collider_refusal(const std::string& keys) {
  try {
    load(keys);
  } catch (const Error& error) {
    return error.what();
  }
  return "(no error)";
}

struct Box {
  Vec3 low, high;
};
Box box_of(std::span<const Vec3> x) {
  Box box{x[0], x[0]};
  for (const Vec3& p : x) box = {box.low.cwiseMin(p), box.high.cwiseMax(p)};
  return box;
}

TEST(Colliders, AreOneSurfaceThatKnowsWhoseEachVertexIs) {
  const LoadedColliders all = load(
      R"("body": {"cylinder": {"radius_m": 0.1, "height_m": 0.3}}, "solids": [{"sphere": {"radius_m": 0.2}, "friction": 0.7,
         "placement": {"translation_m": [3, 0, 0]}}, {"box": {"size_m": [1, 1, 1]}, "offset_mm": 5}])");
  const JoinedColliders& joined = all.joined;
  ASSERT_EQ(joined.parts.size(), 3U);
  EXPECT_EQ(all.worn_vertices, joined.parts[0].vertices);
  EXPECT_EQ(joined.vertex_collider.size(), joined.surface.positions.size());
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [first, count, moves] = joined.parts[k];
    EXPECT_FALSE(moves);
    for (std::size_t i = first; i < first + count; ++i) EXPECT_EQ(joined.vertex_collider[i], static_cast<Index>(k));
  }
  const auto& sphere = joined.parts[1];
  EXPECT_NEAR(box_of(std::span(joined.surface.positions).subspan(sphere.first_vertex, sphere.vertices)).low.x(), 2.8,
              1e-9);
  EXPECT_FALSE(joined.movement);
}

TEST(Colliders, HaveTheirOwnFrictionAndOffsetOrTheBodys) {
  const Scene scene = parse_scene(
      R"({"cloth": [{"grid": {}}], "body": {"sphere": {"radius_m": 0.1}, "friction": 0.3, "offset_mm": 4},
          "solids": [{"box": {"size_m": [1, 1, 1]}, "friction": 0.7}, {"box": {"size_m": [1, 1, 1]}, "offset_mm": 9}]})",
      "s.json");
  const BodyContactOptions contact = step_options(scene, 0.01).body;
  EXPECT_DOUBLE_EQ(contact.friction_of(0, 0.1), 0.3);
  EXPECT_DOUBLE_EQ(contact.friction_of(1, 0.1), 0.7);
  EXPECT_DOUBLE_EQ(contact.friction_of(2, 0.1), 0.3);
  EXPECT_DOUBLE_EQ(contact.offset_of(0), 4e-3);
  EXPECT_DOUBLE_EQ(contact.offset_of(1), 4e-3);
  EXPECT_DOUBLE_EQ(contact.offset_of(2), 9e-3);
  EXPECT_DOUBLE_EQ(contact.largest_offset_m(), 9e-3);
  EXPECT_DOUBLE_EQ(contact.smallest_offset_m(), 4e-3);
  const Scene alone = parse_scene(
      R"({"cloth": [{"grid": {}}], "solids": [{"box": {"size_m": [1, 1, 1]}}, {"box": {"size_m": [1, 1, 1]}, "friction": 0}]})",
      "s.json");
  const BodyContactOptions without = step_options(alone, 0.01).body;
  EXPECT_DOUBLE_EQ(without.friction_of(0, 0.25), 0.25) << "the cloth's own";
  EXPECT_DOUBLE_EQ(without.friction_of(1, 0.25), 0);
  const BodyContactOptions slippery = contact.slippery(6e-3);
  EXPECT_DOUBLE_EQ(slippery.friction_of(1, 0.5), 0);
  EXPECT_DOUBLE_EQ(slippery.offset_of(1), 6e-3);
  EXPECT_DOUBLE_EQ(slippery.offset_of(2), 9e-3);
}

TEST(Colliders, OfTheirOwnClothLiesCloserOnSkinThanOnRims) {
  const auto offsets = [](const std::string& rest, double edge_m) {
    return step_options(parse_scene(R"({"cloth": [{"grid": {}}], )" + rest + "}", "s.json"), edge_m).body;
  };
  const std::string solids = R"("solids": [{"box": {"size_m": [1, 1, 1]}}, {"mannequin": "man"}])";
  const BodyContactOptions person = offsets(R"("body": {"mannequin": "woman"}, )" + solids, 0.02);
  EXPECT_DOUBLE_EQ(person.offset_of(0), 1.5e-3);
  EXPECT_DOUBLE_EQ(person.offset_of(1), 2.5e-3);
  EXPECT_DOUBLE_EQ(person.offset_of(2), 1.5e-3);
  const BodyContactOptions coarse = offsets(R"("body": {"mesh": "b.obj"}, )" + solids, 0.024);
  EXPECT_NEAR(coarse.offset_of(0), 0.024 * 0.024 / (8 * 0.034), 1e-12);
  const BodyContactOptions said = offsets(R"("body": {"mannequin": "woman", "offset_mm": 3}, )" + solids, 0.02);
  for (const Index k : {0, 1, 2}) EXPECT_DOUBLE_EQ(said.offset_of(k), 3e-3) << "the body's is that of all";
}

// A second person, who walks beside the first and is carried away meanwhile.
TEST(Colliders, APersonMayStandBesideTheBodyAndMove) {
  const LoadedColliders all = load(
      R"("body": {"mannequin": "woman"}, "solids": [{"mannequin": "man", "motion": "walk",
         "placement": {"translation_m": [1, 0, 0], "rotation_deg": [0, 90, 0]}, "moves": [{"t_s": 0}, {"t_s": 2, "shift_m": [0, 0, 4]}]}])");
  const Mannequin man = make_mannequin(MannequinKind::man);
  const auto& beside = all.joined.parts.at(1);
  ASSERT_EQ(beside.vertices, man.positions.size());
  EXPECT_TRUE(beside.moves);
  EXPECT_FALSE(all.joined.parts[0].moves);
  ASSERT_TRUE(all.joined.movement);
  EXPECT_EQ(all.joined.movement->name, "walk");
  const Vec3s& standing = all.joined.surface.positions;
  const Vec3& p = man.positions[7];
  EXPECT_NEAR((standing[beside.first_vertex + 7] - Vec3(1 + p.z(), p.y(), -p.x())).norm(), 0, 1e-9);
  const auto at_s = [&](double t_s) {
    Vec3s x;
    all.joined.movement->at(t_s, standing, x);
    return x;
  };
  const Vec3s start = at_s(0), end = at_s(2);
  for (std::size_t i = 0; i < beside.first_vertex; ++i) EXPECT_EQ(end[i], standing[i]);
  for (std::size_t i = beside.first_vertex; i < start.size(); ++i) EXPECT_LT((start[i] - standing[i]).norm(), 1e-9);
  const std::size_t head =
      beside.first_vertex +
      static_cast<std::size_t>(std::max_element(man.positions.begin(), man.positions.end(),
                                                [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); }) -
                               man.positions.begin());
  EXPECT_NEAR(end[head].z() - start[head].z(), 4, 0.3);
}

TEST(Colliders, OfAFileAreTheWholeOfItInItsUnit) {
  const Scratch scratch;
  std::string text;
  for (const char* far :
       {"", "0"})  // the second is ten times as large, and elsewhere: of a body one alone would be kept
    for (const char* corner :
         {"0 0 1", "100 0 1", "0 100 1", "100 100 1", "0 0 100", "100 0 100", "0 100 100", "100 100 100"}) {
      text.append("v ").append(corner).append(far).append("\n");
    }
  for (int first = 0; first < 16; first += 8)
    for (const auto& face :
         {std::array{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}}) {
      text.append("f");
      for (const int corner : face) text.append(" ").append(std::to_string(corner + first));
      text.append("\n");
    }
  scratch.put("boxes.obj", text);
  const LoadedColliders in_cm = load(R"("solids": [{"mesh": "boxes.obj", "unit": "cm"}])", scratch / "s.json");
  EXPECT_EQ(in_cm.joined.surface.positions.size(), 16U);
  EXPECT_NEAR(box_of(in_cm.joined.surface.positions).high.x(), 1, 1e-12);
  const LoadedColliders in_m = load(R"("solids": [{"mesh": "boxes.obj"}])", scratch / "s.json");
  EXPECT_NEAR(box_of(in_m.joined.surface.positions).high.x(), 100, 1e-9);
}

// A quarter of a pipe, open along all four sides, of triangles that look outwards but for one, in cm; `more`: lines that follow.
std::string pipe_obj(const std::string& more = "") {
  constexpr int cells = 8;
  std::string text;
  for (int i = 0; i <= cells; ++i)
    for (const int z : {0, 50}) {
      const double phi = 0.5 * std::numbers::pi * i / cells;
      text += "v " + std::to_string(30 * std::cos(phi)) + ' ' + std::to_string(30 * std::sin(phi)) + ' ' +
              std::to_string(z) + '\n';
    }
  for (int i = 0; i < cells; ++i) {
    const int a = 2 * i + 1;
    const auto face = [&](int p, int q, int r) {
      text += "f " + std::to_string(p) + ' ' + std::to_string(q) + ' ' + std::to_string(r) + '\n';
    };
    i == 0 ? face(a, a + 3, a + 2) : face(a, a + 2, a + 3);  // the first is flipped
    face(a, a + 3, a + 1);
  }
  return text + more;
}

TEST(Colliders, AnOpenSheetIsASolidBehindItsFaces) {
  const Scratch scratch;
  scratch.put("pipe.obj", pipe_obj());
  const LoadedColliders all = load(R"("solids": [{"mesh": "pipe.obj", "unit": "cm"}])", scratch / "s.json");
  ASSERT_EQ(all.joined.surface.positions.size(), 36U);
  double volume = 0, nearest = 1, farthest = 0;
  for (const auto& [a, b, c] : all.joined.surface.triangles) {
    const auto& x = all.joined.surface.positions;
    volume += x[at(a)].dot(x[at(b)].cross(x[at(c)])) / 6;
  }
  for (const Vec3& p : all.joined.surface.positions) {
    nearest = std::min(nearest, p.head<2>().norm());
    farthest = std::max(farthest, p.head<2>().norm());
  }
  EXPECT_NEAR(farthest, 0.3, 1e-6);
  EXPECT_NEAR(nearest, 0.29, 1e-4);
  EXPECT_NEAR(volume, 0.25 * std::numbers::pi * (0.3 * 0.3 - 0.29 * 0.29) * 0.5, 4e-5);
  std::string said;
  for (const std::string& note : all.warnings) said += note + '\n';
  EXPECT_NE(said.find("(16 triangles) is open, with 1 hole (1.94 m round at"), std::string::npos) << said;
  EXPECT_NE(said.find("1 triangles are turned"), std::string::npos) << said;
}

TEST(Colliders, AnOpenSheetThatIsNoSurfaceIsRefused) {
  const Scratch scratch;
  scratch.put("fin.obj", pipe_obj("v 60 60 0\nf 3 4 19\n"));  // a third triangle at an edge
  scratch.put("pipe.obj", pipe_obj());
  const std::string refusal =
      collider_refusal(R"("solids": [{"mesh": ")" + (scratch / "fin.obj") + R"(", "unit": "cm"}])");
  EXPECT_NE(refusal.find("three triangles or more at edge"), std::string::npos) << refusal;
  const std::string body = collider_refusal(R"("body": {"mesh": ")" + (scratch / "pipe.obj") + R"(", "unit": "cm"})");
  EXPECT_NE(
      body.find("with 1 hole (1.94 m round at (0.19, 0.19, 0.25) m); such a sheet may be one of a scene's `solids`"),
      std::string::npos)
      << body;
}

TEST(Colliders, ACapsuleIsEverywhereItsRadiusFromItsAxis) {
  const LoadedColliders all = load(
      R"("solids": [{"capsule": {"radius_m": 0.1, "from_m": [1, 0, 0], "to_m": [2, 0.5, -0.5]}, "edge_m": 0.01}])");
  const Vec3 from(1, 0, 0), way(1, 0.5, -0.5);
  double volume = 0;
  for (const auto& [a, b, c] : all.joined.surface.triangles) {
    const auto& x = all.joined.surface.positions;
    volume += x[at(a)].dot(x[at(b)].cross(x[at(c)])) / 6;
  }
  for (const Vec3& p : all.joined.surface.positions) {
    const double along = std::clamp((p - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
    EXPECT_NEAR((p - from - along * way).norm(), 0.1, 1e-12);
  }
  const double pi = std::numbers::pi, whole = pi * 0.01 * way.norm() + 4.0 / 3 * pi * 0.001;
  EXPECT_NEAR(volume / whole, 1, 0.01) << "and from outside";
  EXPECT_NE(collider_refusal(R"("solids": [{"capsule": {"radius_m": 0.1, "from_m": [1, 0, 0], "to_m": [1, 0, 0]}}])")
                .find("/solids/0: to_m: expected another place"),
            std::string::npos);
}

TEST(Colliders, RefuseWhatDoesNotGoTogether) {
  EXPECT_NE(collider_refusal(R"("solids": [{"box": {"size_m": [1, 1, 1]}, "motion": "walk"}])")
                .find("a mannequin or a mesh beside it"),
            std::string::npos);
  EXPECT_NE(collider_refusal(R"("solids": [{"box": {"size_m": [1, 1, 1]}, "unit": "m"}])").find("\"mesh\" beside it"),
            std::string::npos);
  EXPECT_NE(collider_refusal(R"("solids": [{"friction": 1}])").find("one of"), std::string::npos);
  EXPECT_NE(
      collider_refusal(R"("solids": [{"box": {"size_m": [1, 1, 1]}, "sphere": {"radius_m": 1}}])").find("2 of them"),
      std::string::npos);
  EXPECT_NE(collider_refusal(R"("body": {"sphere": {"radius_m": 1}, "placement": {}})").find("placement"),
            std::string::npos)
      << "what is worn stands where it is made";
  EXPECT_NE(collider_refusal(R"("solids": [{"mesh": "a.obj", "measurements": "a.yaml"}])").find("measurements"),
            std::string::npos);
}

}  // namespace
}  // namespace toile::internal
