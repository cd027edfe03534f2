// Constraints in the step: held points, lines and planes, scripted motion; forces, release and friction on a body.  [BW98 5, 5.4]
#include "support/bodies.hpp"
#include "support/run_cloth.hpp"

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Sheet;

constexpr double gravity = 9.81, mu = 0.3;
const double offset = BodyContactOptions{}.offset_m;

double mass(const ClothRun& run) {
  double sum = 0;
  for (const double m : run.model.mass_kg) sum += m;
  return sum;
}
Vec3 mean(const Vec3s& x) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : x) sum += p;
  return sum / static_cast<double>(x.size());
}
Vec3 constraint_force(const ClothRun& run, double h_s) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& e : run.stepper->integrator().constraint_impulse()) sum += e / h_s;
  return sum;
}

TEST(Pins, HoldAPointALineAndAPlaneOnTheirPathsAndLeaveTheRestFree) {
  Fabric pushes;
  pushes.compression_ratio = 1;  // so that the cloth moves what slides
  ClothRun run(test::equilateral_sheet(0.3, 0.3, 0.03), pushes);
  const Vec3 p = Vec3(1, 2, 2) / 3, q = Vec3(2, 1, -2) / 3, free_direction = p.cross(q);
  const std::array<Index, 3> particle = {0, 10, 60};
  const auto path = [&](std::size_t k) {
    const Vec3 start = run.state.x[static_cast<std::size_t>(particle[k])];
    return [start](double t_s) -> Vec3 { return start + Vec3(0.05 * std::sin(3 * t_s), 0.02 * t_s, -0.03 * t_s); };
  };
  for (std::size_t k = 0; k < 3; ++k) {
    Pin pin;
    pin.particle = particle[k];
    pin.constrained_directions = 3 - static_cast<int>(k);
    pin.p = p;
    pin.q = q;
    pin.path = path(k);
    run.world.pins.push_back(pin);
  }
  run.run(40);
  std::array<Vec3, 3> away;
  for (std::size_t k = 0; k < 3; ++k)
    away[k] = run.state.x[static_cast<std::size_t>(particle[k])] - run.world.pins[k].path(run.time_s);
  EXPECT_LT(away[0].norm(), 1e-12);
  EXPECT_LT(std::abs(p.dot(away[1])), 1e-12);
  EXPECT_LT(std::abs(q.dot(away[1])), 1e-12);
  EXPECT_GT(std::abs(free_direction.dot(away[1])), 1e-3);  // it slid along its line
  EXPECT_LT(std::abs(p.dot(away[2])), 1e-12);
  EXPECT_GT((away[2] - p.dot(away[2]) * p).norm(), 1e-3);  // and in its plane
}

TEST(Pins, CarryTheWeightOfAClothAtRest) {
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), Fabric{});
  run.pin(0);
  run.pin(10);
  run.run(150);
  const FrameReport report = run.frame();
  ASSERT_EQ(report.steps, 1);
  EXPECT_LT((constraint_force(run, report.last.h_s) - Vec3(0, mass(run) * gravity, 0)).norm(),
            0.01 * mass(run) * gravity);
}

struct OnSlab {  // a sheet that lies on a level slab; slopes are made by turning gravity
  explicit OnSlab(double friction = mu) : slab(test::tilted_slab(3, 0.2, 0)), run(lying(), Fabric{}) {
    run.world.body = &slab;
    run.step.body.friction = friction;
    run.adaptive.step_max_s = 1.0 / 60;
  }
  static Sheet lying() {
    Sheet sheet = test::equilateral_sheet(0.2, 0.2, 0.02);
    for (Vec3& p : sheet.x) p += Vec3(-0.1, offset, 0.1);
    return sheet;
  }
  void slope(double tangent) {  // downhill is -x
    run.model.gravity_m_per_s2 = gravity * Vec3(-tangent, -1, 0) / std::sqrt(1 + tangent * tangent);
  }
  int count(Touch touch) const {
    int n = 0;
    for (Index i = 0; i < run.model.particle_count(); ++i)
      n += run.stepper->integrator().body_constraints().touch(i) == touch ? 1 : 0;
    return n;
  }
  BodySurface slab;
  ClothRun run;
};

TEST(ConstraintForce, OfAStuckSheetIsItsWeightAndWithinTheCone) {
  OnSlab on;
  on.slope(0.25);
  on.run.run(20);
  EXPECT_EQ(on.count(Touch::sticks), on.run.model.particle_count());
  const Vec3 weight = mass(on.run) * on.run.model.gravity_m_per_s2;
  EXPECT_LT((constraint_force(on.run, 1.0 / 60) + weight).norm(), 1e-3 * weight.norm());
  double normal = 0;
  for (Index i = 0; i < on.run.model.particle_count(); ++i) {
    const double lambda = on.run.stepper->integrator().body_constraints().normal_force_N(i);
    EXPECT_GE(lambda, 0);
    normal += lambda;
  }
  EXPECT_NEAR(normal / -weight.y(), 1, 1e-3);
}

TEST(ConstraintForce, ThatWouldPullLetsGoWithinTheStep) {
  OnSlab on;
  on.run.run(10);
  EXPECT_EQ(on.count(Touch::none), 0);
  on.run.model.gravity_m_per_s2 = Vec3(0, gravity, 0);  // the slab would have to hold it down
  on.run.frame(1.0 / 60);
  EXPECT_EQ(on.count(Touch::none), on.run.model.particle_count());
  for (const Vec3& v : on.run.state.v) EXPECT_LT((v - Vec3(0, gravity / 60, 0)).norm(), 1e-3 * gravity / 60);
}

TEST(Friction, LocksBelowItsStaticConeAndSlipsAboveIt) {
  OnSlab on;
  on.slope(1.01 * mu);  // beyond the kinetic coefficient, within the static one
  on.run.run(3);
  on.slope(0.5 * mu);
  on.run.run(20);
  const Vec3 before = mean(on.run.state.x);
  on.slope(1.01 * mu);
  on.run.run(60);
  EXPECT_LT((mean(on.run.state.x) - before).norm(), 1e-5);
  EXPECT_EQ(on.count(Touch::sticks), on.run.model.particle_count());
  on.slope(1.05 * mu);
  on.run.run(30);
  EXPECT_EQ(on.count(Touch::slides), on.run.model.particle_count());
  const double expected = -gravity * 0.05 * mu / std::sqrt(1 + 1.05 * 1.05 * mu * mu);
  EXPECT_NEAR(mean(on.run.state.v).x() / (expected * 1.0), 1, 0.1);
}

TEST(Friction, OfASlidingSheetIsMuNWhateverItsSpeedAndStopsIt) {
  OnSlab on;
  for (const double speed : {1.5, 0.4}) {
    for (Vec3& v : on.run.state.v) v = Vec3(speed, 0, 0);
    on.run.frame(1.0 / 60);  // it comes out of a stick or of nothing
    const double before = mean(on.run.state.v).x();
    on.run.run(3);
    EXPECT_NEAR((before - mean(on.run.state.v).x()) / (mu * gravity * 0.1), 1, 0.01) << speed << " m/s";
  }
  on.run.run(10);
  EXPECT_LT(on.run.fastest(), 1e-6);
  const Vec3 stopped = mean(on.run.state.x);
  on.run.run(30);
  EXPECT_LT((mean(on.run.state.x) - stopped).norm(), 1e-6);  // nor turned round
}

}  // namespace
}  // namespace toile::internal
