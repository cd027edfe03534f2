// What two parts of a body pinch: who, where it goes, and when it is free again.
#include "support/bodies.hpp"
#include "support/crossings.hpp"
#include "support/run_cloth.hpp"

#include <algorithm>
#include <functional>

namespace toile::internal {
namespace {

using test::ClothRun;

const double offset = BodyContactOptions{}.offset_m;

// Two slabs of 60 x 60 cm, one below the other: the heights of the lower one's top and of the upper one's bottom.
struct Jaws {
  BodySurface body;
  Vec3s x;

  explicit Jaws(double thickness_m) {
    const BodySurface slab = test::tilted_slab(0.3, thickness_m, 0);
    std::vector<Triangle> triangles(slab.triangles().begin(), slab.triangles().end());
    x.assign(slab.positions().begin(), slab.positions().end());
    for (const auto& [a, b, c] : slab.triangles()) triangles.push_back({a + 8, b + 8, c + 8});
    for (const Vec3& p : slab.positions()) x.push_back(p + Vec3(0, thickness_m, 0));
    body = BodySurface(x, triangles);
  }
  void place(double lower_m, double upper_m, std::span<Vec3> placed) const {
    for (std::size_t i = 0; i < x.size(); ++i) placed[i] = x[i] + Vec3(0, i < 8 ? lower_m : upper_m, 0);
  }
};

struct Between : ClothRun {
  using Height = std::function<double(double t_s)>;
  Between(Jaws& jaws, const Height& lower, const Height& upper)
      : ClothRun(sheet_on(lower(0)), Fabric{}, test::weightless()) {
    world.body = &jaws.body;
    step.flypaper = true;
    world.body_at = [&jaws, lower, upper](double t_s, std::span<Vec3> x) { jaws.place(lower(t_s), upper(t_s), x); };
    adaptive.step_max_s = 1.0 / 60;
  }
  static test::Sheet sheet_on(double height) {
    test::Sheet sheet = test::equilateral_sheet(0.2, 0.2, 0.02);
    for (Vec3& p : sheet.x) p += Vec3(-0.1, height + offset, 0.1);
    return sheet;
  }
};

std::size_t pinched(const ClothRun& run) { return run.stepper->integrator().flypaper().count(); }

TEST(Flypaper, GoesWithTheMeanOfBothSurfacesWhileTheyAreWithinEachOther) {
  // The upper one closes by 5 cm at 0.1 m/s, 2 cm into the lower one, and opens again.
  Jaws jaws(0.1);
  const auto upper = [](double t_s) { return 0.03 - 0.1 * std::min(t_s, std::max(0.0, 1.0 - t_s)); };
  Between run(
      jaws, [](double) { return 0.0; }, upper);
  const std::size_t all = run.state.x.size();
  double fastest = 0;
  for (int frame = 1; frame <= 36; ++frame) {
    run.frame();
    fastest = std::max(fastest, run.fastest());
    const double gap = upper(run.time_s);
    if (gap < 0.5 * offset && frame < 15) {
      EXPECT_EQ(pinched(run), all) << frame;
      for (const Vec3& p : run.state.x) EXPECT_NEAR(p.y(), 0.5 * gap, 0.5 * offset) << frame;
    }
  }
  EXPECT_EQ(pinched(run), 0u);
  EXPECT_LT(fastest, 0.2) << "the upper one's speed, and what a thread in it adds";
  for (const Vec3& p : run.state.x) {
    EXPECT_GT(p.y(), 0.9 * offset);
    EXPECT_LT(p.y(), upper(run.time_s) - 0.9 * offset);
  }
}

// With room between them it keeps its place among the two: near one of them, it is met by neither, and comes out where it was.
TEST(Flypaper, WithRoomItKeepsItsPlaceBetweenTheTwo) {
  Jaws jaws(0.1);
  constexpr int way = 3, frames = 10;  // to one offset between them, a rest, and back
  const auto upper = [](double t_s) {
    const double frame = 60 * t_s, share = std::clamp(std::min(frame, frames - frame) / way, 0.0, 1.0);
    return (3.3 - 2.3 * share) * offset;
  };
  Between run(
      jaws, [](double) { return 0.0; }, upper);
  bool all = false;
  for (int frame = 1; frame <= frames; ++frame) {
    const FrameReport report = run.frame(1.0 / 60);
    EXPECT_EQ(report.corrected, 0) << "the filter has nothing to do";
    const bool pinches = pinched(run) == run.state.x.size();
    all |= pinches;
    for (const Vec3& p : run.state.x) {
      if (pinches) {
        EXPECT_NEAR(p.y() / upper(run.time_s), offset / upper(1.0 / 60), 0.1) << frame;
      }
    }
    for (const Pinched how : run.stepper->integrator().flypaper().pinched()) EXPECT_NE(how, Pinched::without_room);
  }
  EXPECT_TRUE(all);
  EXPECT_EQ(run.stepper->integrator().flypaper().steps_without_room(), 0);
}

// Two slabs that meet along the x axis, each `wall_deg` steep, and a particle over the line.
struct Crease {
  Vec3s x;
  std::vector<Triangle> triangles;

  explicit Crease(double wall_deg) : x(at(wall_deg)) {
    const BodySurface slab = test::tilted_slab(0.3, 0.1, 0);
    triangles.assign(slab.triangles().begin(), slab.triangles().end());
    for (const auto& [a, b, c] : slab.triangles()) triangles.push_back({a + 8, b + 8, c + 8});
  }
  static Vec3s at(double wall_deg) {
    const double angle = wall_deg * 3.14159265358979323846 / 180;
    Vec3s x;
    const BodySurface slab = test::tilted_slab(0.3, 0.1, 0);
    for (const double side : {1.0, -1.0}) {
      for (const Vec3& p : slab.positions()) {
        const double z = p.z() - 0.3 * side, c = std::cos(angle), s = side * std::sin(angle);
        x.emplace_back(p.x(), c * p.y() - s * z, s * p.y() + c * z);
      }
    }
    return x;
  }
  Vec3s moved(const Vec3& one, const Vec3& two) const {
    Vec3s end = x;
    for (std::size_t i = 0; i < end.size(); ++i) end[i] += i < 8 ? one : two;
    return end;
  }
};

bool detects(Flypaper& flypaper, BodySurface& body, std::span<const Vec3> start, std::span<const Vec3> end,
             const Vec3& particle) {
  body.set_motion(start, end);
  const std::vector<BodyPoint> nearest{body.nearest(particle, 0.1)};
  flypaper.detect({{particle}, {Vec3::Zero()}}, nearest);
  return flypaper.any();
}

const Vec3 across(0, 0, 0.2 * offset);

// Going up, along the sum of its normals, both faces come towards the place where the particle was, and neither nearer to the other.
TEST(Flypaper, APlaceThatMovesAsOneClosesNowhere) {
  const Crease crease(65);
  BodySurface body(crease.x, crease.triangles);
  const auto pinches = [&](const Vec3& one, const Vec3& two) {
    Flypaper flypaper(&body, 1, {offset, {}});
    return detects(flypaper, body, crease.x, crease.moved(one, two), Vec3(0, 2 * offset, 0));
  };
  const Vec3 up(0, 0.2 * offset, 0);
  EXPECT_FALSE(pinches(up, up));
  EXPECT_FALSE(pinches(across, across));
  EXPECT_FALSE(pinches(-across, across));
  EXPECT_TRUE(pinches(across, -across));
}

TEST(Flypaper, ACreaseThatHasOpenedLetsGo) {
  const Crease crease(65);
  const Vec3s open = Crease::at(40);
  BodySurface body(crease.x, crease.triangles);
  Flypaper flypaper(&body, 1, {offset, {}});
  const Vec3 particle(0, 1.4 * offset, 0);
  ASSERT_TRUE(detects(flypaper, body, crease.x, crease.moved(across, -across), particle));
  EXPECT_TRUE(detects(flypaper, body, crease.x, crease.x, particle)) << "as long as it is narrow";
  EXPECT_FALSE(detects(flypaper, body, open, open, particle));
}

TEST(Flypaper, ThinThingsAreNotTwoSurfaces) {  // 2 mm, less than two offsets: a plate that lifts the sheet
  Jaws jaws(0.002);
  const auto lower = [](double t_s) { return 0.05 * t_s; };
  Between run(jaws, lower, [](double) { return 1.0; });
  for (int frame = 0; frame < 15; ++frame) {
    run.frame();
    EXPECT_EQ(pinched(run), 0u) << frame;
  }
  for (const Vec3& p : run.state.x) EXPECT_NEAR(p.y(), lower(run.time_s) + offset, 0.1 * offset);
}

TEST(Flypaper, ANarrowPlaceThatDoesNotCloseIsNoPinch) {
  Jaws jaws(0.1);
  Between still(
      jaws, [](double) { return 0.0; }, [](double) { return 1.5 * offset; });
  still.run(5);
  EXPECT_EQ(pinched(still), 0u);
  Between moving(
      jaws, [](double t_s) { return 0.3 * t_s; }, [](double t_s) { return 1.5 * offset + 0.3 * t_s; });
  moving.run(5);
  EXPECT_EQ(pinched(moving), 0u);
}

TEST(Flypaper, LayersThatArePinchedTogetherPartAgain) {
  Jaws jaws(0.1);
  const auto upper = [](double t_s) { return 0.04 - 0.1 * std::min(t_s, std::max(0.0, 1.0 - t_s)); };
  test::Sheet layers = test::stack(0.2, 0.02, 3e-3, 3);
  for (Vec3& p : layers.x) p += Vec3(-0.1, offset, 0.1);
  ModelOptions options;
  options.gravity_m_per_s2.setZero();
  ClothRun run(layers, Fabric{}, options);
  run.world.body = &jaws.body;
  run.step.flypaper = true;
  run.world.body_at = [&](double t_s, std::span<Vec3> x) { jaws.place(0, upper(t_s), x); };
  run.adaptive.step_max_s = 1.0 / 60;
  bool all = false;
  double fastest = 0;
  for (int frame = 0; frame < 45; ++frame) {
    run.frame();
    all |= pinched(run) == run.state.x.size();
    fastest = std::max(fastest, run.fastest());
  }
  EXPECT_TRUE(all);
  EXPECT_EQ(pinched(run), 0u);
  EXPECT_LT(fastest, 0.5);
  EXPECT_EQ(test::crossings_of(run.state.x, run.model.mesh.triangles), 0);
  const std::size_t one = run.state.x.size() / 3;
  for (std::size_t i = 0; i < one; ++i) {
    EXPECT_GT(run.state.x[one + i].y(), run.state.x[i].y()) << "in their order";
    EXPECT_GT(run.state.x[2 * one + i].y(), run.state.x[one + i].y());
  }
}

TEST(NearestOpposite, IsTheNearestOfTheFacesThatLookBackFromAbove) {
  const BodySurface room =
      test::sphere(Vec3::Zero(), 0.2, 3);  // seen from outside, and from within by faces that look out: none
  Jaws jaws(0.1);
  jaws.place(0, 0.03, jaws.x);
  jaws.body.set_motion(jaws.x, jaws.x);
  EXPECT_GE(jaws.body.nearest_opposite({0.33, 0.01, 0}, Vec3(0, 1, 0), 0.1).triangle, 0) << "56 degrees aside";
  EXPECT_LT(jaws.body.nearest_opposite({0.34, 0.01, 0}, Vec3(0, 1, 0), 0.1).triangle, 0) << "63 degrees aside";
  test::Random random(8);
  for (int n = 0; n < 100; ++n) {
    const double z = random(-0.2, 0.2), y = random(0.0, 0.03), x = random(-0.2, 0.2);
    const Vec3 p(x, y, z);
    const BodyPoint above = jaws.body.nearest_opposite(p, Vec3(0, 1, 0), 0.05);
    ASSERT_GE(above.triangle, 0) << n;
    EXPECT_NEAR(above.gap_m, 0.03 - p.y(), 1e-12) << "the upper one's bottom, from below";
    EXPECT_NEAR(above.normal.y(), -1, 1e-12);
    EXPECT_LT(jaws.body.nearest_opposite(p, Vec3(0, 1, 0), 0.9 * (0.03 - p.y())).triangle, 0) << "beyond its reach";
    EXPECT_NEAR(jaws.body.nearest_opposite(p, Vec3(0, -1, 0), 0.05).gap_m, p.y(), 1e-12);
    EXPECT_LT(jaws.body.nearest_opposite(p, Vec3(1, 0, 0), 0.05).triangle, 0) << "nothing looks back along the two";
    EXPECT_LT(room.nearest_opposite(0.5 * p, Vec3(0, 1, 0), 1).triangle, 0) << "faces that look away";
  }
}

TEST(NearestFacing, IsTheNearestOfTheFacesThatLookThatWay) {
  const BodySurface ball = test::sphere(Vec3(0.1, 0, 0), 0.2, 3);
  test::Random random(5);
  int found = 0;
  for (int n = 0; n < 300; ++n) {
    const Vec3 p = Vec3(0.1, 0, 0) + random.vector(0.3), direction = random.vector(1);
    const double reach = random(0.02, 0.5);
    double best = reach;
    for (std::size_t t = 0; t < ball.triangles().size(); ++t) {
      if (ball.face_normal(static_cast<Index>(t)).dot(direction.normalized()) <= 0.5) continue;
      const auto& [a, b, c] = ball.triangles()[t];
      const auto x = [&](Index i) -> const Vec3& { return ball.positions()[static_cast<std::size_t>(i)]; };
      best = std::min(best, std::sqrt(closest_vertex_triangle(p, x(a), x(b), x(c)).distance2));
    }
    const BodyPoint point = ball.nearest_facing(p, direction, reach);
    if (best == reach) {
      EXPECT_EQ(point.triangle, -1) << n;
      continue;
    }
    ++found;
    ASSERT_GE(point.triangle, 0) << n;
    EXPECT_NEAR((p - ball.position(point.triangle, point.barycentric)).norm(), best, 1e-12) << n;
    EXPECT_EQ(point.normal, ball.face_normal(point.triangle));
    EXPECT_NEAR(point.gap_m, point.normal.dot(p - ball.position(point.triangle, point.barycentric)), 1e-12);
  }
  EXPECT_GT(found, 100);
}

}  // namespace
}  // namespace toile::internal
