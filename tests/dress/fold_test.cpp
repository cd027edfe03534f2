// Folds from the pattern file to the hinges: which edges, which sign, and cloth that comes to rest folded.
#include "assembly/cloth_model.hpp"
#include "core/error.hpp"
#include "dress/sewing.hpp"
#include "garment/garments.hpp"
#include "material/bend.hpp"
#include "step/adaptive_step.hpp"
#include "support/bare_step.hpp"
#include "support/fabrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace toile::internal {
namespace {

constexpr double half_turn = 3.14159265358979323846;

// A rectangle that faces +z, with a corner in the middle of its left and right sides and a fold between the two.
Panel folded_panel(double width, double height, double angle_rad, bool clockwise = false) {
  const double w = width / 2, h = height / 2;
  std::vector<Vec2> corners{{-w, -h}, {w, -h}, {w, 0}, {w, h}, {-w, h}, {-w, 0}};
  if (clockwise) std::reverse(corners.begin(), corners.end());
  Panel panel = test::straight_panel("leaf", corners, Vec3(0, 0, clockwise ? -0.1 : 0.1));
  PanelFold fold;
  fold.line.start = clockwise ? 0 : 2;
  fold.line.end = clockwise ? 3 : 5;
  fold.angle_rad = angle_rad;
  panel.folds.push_back(fold);
  return panel;
}

Pattern pattern_of(std::vector<Panel> panels) {
  Pattern pattern;
  pattern.name = "folds";
  pattern.panels = std::move(panels);
  return pattern;
}

// The hinges with a rest angle.
std::vector<std::size_t> bent_hinges(const ClothModel& model) {
  std::vector<std::size_t> bent;
  for (std::size_t h = 0; h < model.bend.size(); ++h)
    if (model.bend[h].theta_0 != 0) bent.push_back(h);
  return bent;
}

double angle_at(const ClothModel& model, std::size_t hinge, const Vec3s& x) {
  std::array<Vec3, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = x[at(model.topology.hinges[hinge].particle[k])];
  return hinge_angle(corners);
}

TEST(Fold, BendsTheHingesOnItsLineAndNoOthers) {
  const GarmentMesh garment = mesh_garment(pattern_of({folded_panel(0.2, 0.1, 1)}), 0.02);
  ASSERT_EQ(garment.mesh.folds.size(), 10U);
  const Fabric fabric;
  ClothModel model = build_model(garment.mesh, {&fabric, 1});
  const std::vector<std::size_t> bent = bent_hinges(model);
  ASSERT_EQ(bent.size(), 10U);
  for (const std::size_t h : bent) {
    EXPECT_EQ(model.bend[h].theta_0, 1);
    for (const std::size_t end : {0U, 1U}) EXPECT_EQ(garment.x[at(model.topology.hinges[h].particle[end])].y(), 0);
  }
  set_folds(model, 0.25);
  for (const std::size_t h : bent) EXPECT_EQ(model.bend[h].theta_0, 0.25);
  set_folds(model, 0);
  EXPECT_TRUE(bent_hinges(model).empty());
}

// Turns what lies above y = 0 about the x axis, away from the side that the panel faces.
Vec3s ridge(const GarmentMesh& garment, double angle, bool faces_back) {
  Vec3s x = garment.x;
  for (Vec3& p : x) {
    const double z0 = faces_back ? -0.1 : 0.1, y = p.y();
    if (y > 0) p = Vec3(p.x(), y * std::cos(angle), z0 + (faces_back ? 1 : -1) * y * std::sin(angle));
  }
  return x;
}

TEST(Fold, APositiveAngleIsARidgeOnThePanelsOuterSide) {
  for (const bool clockwise : {false, true}) {
    const GarmentMesh garment = mesh_garment(pattern_of({folded_panel(0.2, 0.1, 0.7, clockwise)}), 0.02);
    const Fabric fabric;
    const ClothModel model = build_model(garment.mesh, {&fabric, 1});
    const Vec3s x = ridge(garment, 0.7, clockwise);
    for (const std::size_t h : bent_hinges(model)) {
      EXPECT_NEAR(angle_at(model, h, x), 0.7, 1e-9) << clockwise;
      EXPECT_NEAR(model.bend[h].theta_0, 0.7, 1e-12);
    }
  }
}

TEST(Fold, OfAPanelThatIsTurnedOverChangesSides) {
  Panel flat = test::front_rectangle(0.2, 0.1, Vec3(0, 0.11, 0.1));
  Pattern pattern = pattern_of({flat, folded_panel(0.2, 0.1, 0.7)});
  pattern.stitches = {test::stitch(0, 0, 1, 3)};
  const GarmentMesh as_drawn = mesh_garment(pattern, 0.02);
  for (const FoldedEdge& fold : as_drawn.mesh.folds) EXPECT_EQ(fold.angle_rad, 0.7);
  pattern.panels[1].translation_m = Vec3(0, 0.1, 0.12);  // before the other, sewn bottom to bottom
  pattern.stitches = {test::stitch(0, 0, 1, 0, true)};
  const GarmentMesh turned = mesh_garment(pattern, 0.02);
  ASSERT_EQ(turned.mesh.folds.size(), 10U);
  for (const FoldedEdge& fold : turned.mesh.folds) EXPECT_EQ(fold.angle_rad, -0.7);
}

// Two panels one above the other, the seam between them pressed.
Pattern pressed(double angle_rad) {
  Pattern pattern =
      pattern_of({test::front_rectangle(0.2, 0.1, Vec3(0, 0, 0)), test::front_rectangle(0.2, 0.1, Vec3(0, 0.11, 0))});
  pattern.stitches = {test::stitch(0, 2, 1, 0)};
  pattern.stitches[0].angle_rad = angle_rad;
  return pattern;
}

TEST(Fold, OnASeamActsFromTheWeldOn) {
  Pattern upper_first = pressed(-1);  // its particles are renumbered by the weld
  std::swap(upper_first.stitches[0].a, upper_first.stitches[0].b);
  for (const Pattern& pattern : {pressed(-1), upper_first}) {
    const GarmentMesh garment = mesh_garment(pattern, 0.02);
    const Fabric fabric;
    EXPECT_TRUE(bent_hinges(build_model(garment.mesh, {&fabric, 1})).empty());
    const ClothModel welded = build_model(weld(garment).mesh, {&fabric, 1});
    const std::vector<std::size_t> bent = bent_hinges(welded);
    ASSERT_EQ(bent.size(), 10U);
    for (const std::size_t h : bent) {
      EXPECT_EQ(welded.bend[h].theta_0, -1);
      const Hinge& hinge = welded.topology.hinges[h];
      EXPECT_NE(welded.mesh.panel[at(hinge.triangle[0])], welded.mesh.panel[at(hinge.triangle[1])]);
    }
  }
}

TEST(Fold, PanelsAreSewnFlat) {
  Pattern pattern = pressed(-1);
  pattern.panels.push_back(folded_panel(0.2, 0.1, 1));
  const GarmentMesh garment = mesh_garment(pattern, 0.02);
  const Fabric fabric;
  const Sewing sewing(garment, {&fabric, 1}, nullptr, test::bare_step(), SewingOptions{});
  EXPECT_TRUE(bent_hinges(sewing.model()).empty());
}

TEST(Fold, ClothFoldsItselfToTheAngleAndRestsThere) {
  for (const double degrees : {60.0, -100.0}) {
    const GarmentMesh garment = mesh_garment(pattern_of({folded_panel(0.12, 0.06, degrees * half_turn / 180)}), 0.015);
    for (const bool rubs : {false, true}) {
      const Fabric fabric = rubs ? Fabric{} : test::elastic_cotton();
      ModelOptions options;
      options.gravity_m_per_s2.setZero();
      options.drag_per_s = 5;
      ClothModel model = build_model(garment.mesh, {&fabric, 1}, options);
      ClothState state{garment.x, Vec3s(garment.x.size(), Vec3::Zero())};
      StepWorld world;
      AdaptiveStep stepper(model, world, test::bare_step(), AdaptiveOptions{});
      for (int frame = 0; frame < 60; ++frame) {
        set_folds(model, std::min(1.0, frame / 20.0));
        const FrameReport report = stepper.advance(state, frame / 30.0, 1 / 30.0);
        ASSERT_TRUE(report.ok) << report.diagnosis;
      }
      double fastest = 0;
      for (const Vec3& v : state.v) fastest = std::max(fastest, v.norm());
      EXPECT_LT(fastest, 5e-3);
      for (const std::size_t h : bent_hinges(model))
        EXPECT_NEAR(angle_at(model, h, state.x) * 180 / half_turn, degrees, rubs ? 0.12 * std::abs(degrees) : 3);
    }
  }
}

TEST(Fold, ThatCannotBeMeshedIsNamedWithItsPanel) {
  Panel panel = folded_panel(0.2, 0.1, 1);
  panel.folds.push_back(panel.folds.front());
  try {
    mesh_garment(pattern_of({panel}), 0.02);
    FAIL() << "the same fold twice";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("panel leaf"), std::string::npos) << what;
    EXPECT_NE(what.find("folds: expected lines"), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace toile::internal
