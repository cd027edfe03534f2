// Cloth deep within the body: what comes out, where to, and what stays.
#include "support/bodies.hpp"
#include "support/run_cloth.hpp"

#include <algorithm>
#include <vector>

namespace toile::internal {
namespace {

using test::ClothRun;

BodySurface two_spheres(const Vec3& one, const Vec3& two, double radius_m) {
  const BodySurface first = test::sphere(one, radius_m, 4), second = test::sphere(two, radius_m, 4);
  Vec3s x(first.positions().begin(), first.positions().end());
  std::vector<Triangle> triangles(first.triangles().begin(), first.triangles().end());
  const auto n = static_cast<Index>(x.size());
  for (const auto& [a, b, c] : second.triangles()) triangles.push_back({a + n, b + n, c + n});
  x.insert(x.end(), second.positions().begin(), second.positions().end());
  return {x, triangles};
}

// A weightless sheet of 20 cm, its middle at the height y.
struct SheetAt : ClothRun {
  SheetAt(BodySurface& body, double y) : ClothRun(sheet_at(y), Fabric{}, test::weightless()) {
    world.body = &body;
    adaptive.step_max_s = 1.0 / 60;
  }
  static test::Sheet sheet_at(double y) {
    test::Sheet sheet = test::equilateral_sheet(0.2, 0.2, 0.02);
    for (Vec3& p : sheet.x) p += Vec3(-0.1, y, 0.1);
    return sheet;
  }
};

double least_gap(const ClothRun& run, const BodySurface& body) {
  double least = 1e9;
  for (const Vec3& p : run.state.x) least = std::min(least, body.nearest(p, 1).gap_m);
  return least;
}

bool is_through(const ClothRun& run, const BodySurface& body) {
  const Topology topology = build_topology(run.model.mesh.particle_count, run.model.mesh.triangles);
  const ClothTopology cloth(run.state.x.size(), run.model.mesh.triangles, topology);
  TriangleTree tree(run.state.x, run.model.mesh.triangles);
  BodyImpactWorkspace workspace;
  std::vector<char> marked;
  return mark_through_body(cloth, tree, run.state.x, body, workspace, marked);
}

TEST(PenetrationRecovery, ASheetFiveCentimetresWithinABallIsOutOfItInASecond) {
  BodySurface body = test::sphere(Vec3(0, 0, 0), 0.3, 4);
  SheetAt run(body, 0.25);
  ASSERT_LT(least_gap(run, body), -0.04);
  double fastest = 0;
  for (int frame = 0; frame < 30; ++frame) {
    run.frame();
    for (const Vec3& v : run.state.v) fastest = std::max(fastest, v.norm());
  }
  EXPECT_GT(least_gap(run, body), 1e-3);
  EXPECT_LT(fastest, 2) << "drawn, not thrown";
  EXPECT_FALSE(is_through(run, body));
  for (const Vec3& p : run.state.x) EXPECT_GT(p.y(), 0.2) << "the short way";
}

TEST(PenetrationRecovery, ItGoesWithTheBodyWhileItComesOut) {
  BodySurface body = test::sphere(Vec3(0, 0, 0), 0.3, 4);
  const Vec3s start(body.positions().begin(), body.positions().end());
  SheetAt run(body, 0.25);
  run.world.body_at = [start](double t_s, std::span<Vec3> x) {
    for (std::size_t i = 0; i < start.size(); ++i) x[i] = start[i] + Vec3(0, 1.5 * t_s, 0);
  };
  for (int frame = 0; frame < 30; ++frame) run.frame();
  EXPECT_GT(least_gap(run, body), 1e-3);
}

TEST(PenetrationRecovery, WhereTwoPartsAreWithinEachOtherThereIsNoWayOutUntilTheyPart) {
  // The balls overlap by 20 cm, the sheet is in the middle of it.
  BodySurface body = two_spheres(Vec3(0, -0.2, 0), Vec3(0, 0.2, 0), 0.3);
  const Vec3s start(body.positions().begin(), body.positions().end());
  SheetAt run(body, 0);
  const Vec3s before = run.state.x;
  for (int frame = 0; frame < 15; ++frame) run.frame();
  double farthest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (std::hypot(before[i].x(), before[i].z()) < 0.07)
      farthest = std::max(farthest, (run.state.x[i] - before[i]).norm());
  }
  EXPECT_LT(farthest, 0.01) << "in 0.5 s";
  const std::size_t half = start.size() / 2;
  const double from_s = run.time_s;
  run.world.body_at = [start, half, from_s](double t_s, std::span<Vec3> x) {
    const double up = 0.5 * std::clamp(t_s - from_s, 0.0, 1.0);
    for (std::size_t i = 0; i < start.size(); ++i) x[i] = start[i] + Vec3(0, i < half ? 0 : up, 0);
  };
  for (int frame = 0; frame < 75; ++frame) run.frame();
  EXPECT_GT(least_gap(run, body), 1e-3);
  EXPECT_FALSE(is_through(run, body));
}

}  // namespace
}  // namespace toile::internal
