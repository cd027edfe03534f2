// The safe filter: what it corrects, what it refuses, and that a step never ends with cloth through cloth.
#include "step/safe_filter.hpp"

#include "core/parallel.hpp"
#include "support/bodies.hpp"
#include "support/crossings.hpp"
#include "support/run_cloth.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Random;
using test::Sheet;
using test::stack;

struct Filter {
  explicit Filter(const Sheet& sheet)
      : mesh(sheet.mesh),
        x(sheet.x),
        topology(build_topology(mesh.particle_count, mesh.triangles)),
        cloth(x.size(), mesh.triangles, topology),
        tree(x, mesh.triangles),
        inverse_mass(x.size(), 1e3),
        contact_m(x.size(), 2.5e-3) {}
  FilterReport operator()(Vec3s& end, bool truncate) {
    return filter(cloth, tree, x, inverse_mass, contact_m, truncate, end);
  }
  std::size_t impacts(const Vec3s& end) {
    std::vector<Impact> list;
    ImpactWorkspace workspace;
    EXPECT_TRUE(find_impacts(cloth, tree, x, end, contact_m, workspace, list));
    return list.size();
  }
  Vec3 mean_motion(const Vec3s& end) const {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (inverse_mass[i] == 0) continue;
      sum += (end[i] - x[i]) / inverse_mass[i];
      mass += 1 / inverse_mass[i];
    }
    return sum / mass;
  }
  ClothMesh mesh;
  Vec3s x;
  Topology topology;
  ClothTopology cloth;
  TriangleTree tree;
  std::vector<double> inverse_mass, contact_m;
  SafeFilter filter;
};

TEST(SafeFilter, DoesNotTouchWhatDoesNotMeet) {
  Filter filter(stack(0.1, 0.01, 4e-3, 2));
  Random random(1);
  Vec3s end = filter.x;
  for (Vec3& p : end) p += random.vector(5e-4) + Vec3(0.3, 0.2, 0.1);
  const Vec3s asked = end;
  const FilterReport report = filter(end, true);
  EXPECT_EQ(report.impacts, 0);
  EXPECT_EQ(report.corrected, 0);
  EXPECT_EQ(std::memcmp(end.data(), asked.data(), end.size() * sizeof(Vec3)), 0);
}

TEST(SafeFilter, ImpulsesKeepLayersApartAndTheMomentum) {
  Filter filter(stack(0.1, 0.01, 4e-3, 2));
  for (std::size_t i = 0; i < filter.x.size(); ++i) filter.inverse_mass[i] = i % 3 == 0 ? 500 : 1000;
  Vec3s end = filter.x;
  for (std::size_t i = end.size() / 2; i < end.size(); ++i) end[i] += Vec3(1e-3, -6e-3, 0);
  const Vec3 before = filter.mean_motion(end);
  const FilterReport report = filter(end, false);
  EXPECT_GT(report.impacts, 50);
  EXPECT_EQ(report.left, 0);
  EXPECT_EQ(report.truncated, 0);
  EXPECT_EQ(filter.impacts(end), 0U);
  EXPECT_LT((filter.mean_motion(end) - before).norm(), 1e-12) << "an impulse is inner";
  for (std::size_t i = 0; i < end.size(); ++i)
    EXPECT_EQ(filter.filter.moved()[i] != 0,
              i < end.size() / 2 ? end[i] != filter.x[i] : end[i] != filter.x[i] + Vec3(1e-3, -6e-3, 0));
}

TEST(SafeFilter, HeldParticlesAreWallsForImpulses) {
  Filter filter(stack(0.1, 0.01, 4e-3, 2));
  Vec3s end = filter.x;
  for (std::size_t i = 0; i < end.size() / 2; ++i) filter.inverse_mass[i] = 0;
  for (std::size_t i = end.size() / 2; i < end.size(); ++i) end[i].y() -= 6e-3;
  const FilterReport report = filter(end, false);
  EXPECT_EQ(report.left, 0);
  for (std::size_t i = 0; i < end.size() / 2; ++i) EXPECT_EQ(end[i], filter.x[i]);
  EXPECT_EQ(filter.impacts(end), 0U);
}

// An edge that is held at one end, and met there, is opened by its other end only: by a lever of 200 here.
TEST(SafeFilter, NoParticleIsThrownByALongLever) {
  Sheet sheet;
  sheet.x = {{0, 0, 0}, {0.2, 0, 0}, {0.1, 0.1, 0.1}, {1e-3, -0.1, -1e-3}, {1e-3, 0.1, -1e-3}, {1e-3, 0, -0.2}};
  sheet.mesh.particle_count = 6;
  sheet.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  Filter filter(sheet);
  for (const std::size_t i : {0U, 3U, 4U, 5U}) filter.inverse_mass[i] = 0;
  Vec3s end = sheet.x;
  end[0].z() = -2e-3;
  ASSERT_GT(filter.impacts(end), 0u);
  filter(end, false);
  EXPECT_LT((end[1] - sheet.x[1]).norm(), 0.08) << "1.6 mm are missing";
  EXPECT_EQ(end[0], Vec3(0, 0, -2e-3));
}

TEST(SafeFilter, WhatHeldParticlesDoToEachOtherIsLeftForAShorterStepAndThenCutShort) {
  Filter filter(stack(0.06, 0.01, 4e-3, 2));
  filter.inverse_mass.assign(filter.x.size(), 0);
  Vec3s end = filter.x;
  for (std::size_t i = end.size() / 2; i < end.size(); ++i) end[i].y() -= 6e-3;
  Vec3s refused = end;
  EXPECT_GT(filter(refused, false).left, 0);
  EXPECT_EQ(std::memcmp(refused.data(), end.data(), end.size() * sizeof(Vec3)), 0) << "nobody could be moved";
  const FilterReport report = filter(end, true);
  EXPECT_EQ(report.left, 0);
  EXPECT_GT(report.truncated, 0);
  EXPECT_EQ(filter.impacts(end), 0U);
}

// Two layers between two parts of the body: the upper one is carried 6 mm down through the lower one, or nearly onto it.
TEST(SafeFilter, OfWhatIsPinchedTheFreeIsKeptOutAndWhatHasRoomGivesWay) {
  Filter filter(stack(0.06, 0.01, 4e-3, 2));
  const std::size_t all = filter.x.size(), half = all / 2;
  const std::vector<double> masses(all, 1e3);
  std::vector<Pinched> pinched(all, Pinched::without_room);
  const auto run = [&](bool truncate, Vec3s& end) {
    end = filter.x;
    for (std::size_t i = half; i < all; ++i) end[i].y() -= 6e-3;
    return filter.filter(filter.cloth, filter.tree, filter.x, filter.inverse_mass, filter.contact_m, truncate, end,
                         nullptr, masses, pinched);
  };
  Vec3s end;
  filter.inverse_mass.assign(all, 0);
  EXPECT_EQ(run(false, end).impacts, 0) << "without room layers are let be";

  for (std::size_t i = 0; i < half; ++i) {
    pinched[i] = Pinched::no;
    filter.inverse_mass[i] = 1e3;
  }
  EXPECT_GT(run(false, end).impacts, 0) << "what is free is kept out of them";
  EXPECT_EQ(filter.impacts(end), 0U);
  for (std::size_t i = half; i < all; ++i) EXPECT_EQ(end[i], filter.x[i] - Vec3(0, 6e-3, 0)) << "they are walls";

  // Held by the body's surface below, and pinched with room above.
  std::fill(filter.inverse_mass.begin(), filter.inverse_mass.end(), 0);
  std::fill(pinched.begin() + static_cast<std::ptrdiff_t>(half), pinched.end(), Pinched::with_room);
  EXPECT_EQ(run(false, end).left, 0);
  EXPECT_EQ(filter.impacts(end), 0U);
  for (std::size_t i = 0; i < half; ++i) EXPECT_EQ(end[i], filter.x[i]) << "only what has room moves";
}

TEST(SafeFilter, OfACorrectionInAShortStepOnlyWhatStopsAndWhatTheLongestStepWouldGiveIsVelocity) {
  const double h = 1.0 / 60;
  const Vec3 up(0, 1e-3, 0);
  EXPECT_EQ(counted_share(up, Vec3(0, -3, 0), h, h), 1) << "in the longest step all of it";
  EXPECT_EQ(counted_share(Vec3::Zero(), Vec3(0, -3, 0), h / 64, h), 1);
  EXPECT_NEAR(counted_share(up, Vec3::Zero(), h / 64, h), 1.0 / 64, 1e-12) << "1 mm in 1/60 s, not in 0.26 ms";
  EXPECT_NEAR(counted_share(up, Vec3(2, 0, 0), h / 64, h), 1.0 / 64, 1e-12) << "across it";
  EXPECT_NEAR(counted_share(up, Vec3(0, -1, 0), h / 64, h), (1 + 1e-3 / h) / (1e-3 / (h / 64)), 1e-12)
      << "1 m/s against it is stopped";
  EXPECT_EQ(counted_share(up, Vec3(0, -8, 0), h / 64, h), 1) << "as far as the correction goes";
}

TEST(SafeFilter, CutZonesAreFreeAfterAnyMotion) {
  int refused = 0, cut = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Random random(seed);
    Filter filter(stack(0.06, 0.01, 3e-3, 4));
    for (double& w : filter.inverse_mass) w = random(0, 1) < 0.1 ? 0 : random(200, 2000);
    const double size = std::pow(10.0, random(-3, -1));
    Vec3s end = filter.x;
    for (Vec3& p : end) p += random.vector(size);
    Vec3s asked = end;
    if (filter(asked, false).left > 0) ++refused;
    const FilterReport report = filter(end, true);
    cut += report.truncated > 0 ? 1 : 0;
    EXPECT_EQ(report.left, 0);
    EXPECT_EQ(filter.impacts(end), 0U) << seed;
    EXPECT_EQ(test::crossings_of(end, filter.mesh.triangles), 0) << seed;
  }
  EXPECT_GT(refused, 3) << "the motions are wild enough to need it";
  EXPECT_EQ(cut, refused);
}

TEST(SafeFilter, AZoneThatIsCutKeepsItsMeanMotion) {
  // Two sheets that fly together at 1 m per step and would pass through each other on the way: nobody is stopped in the world.
  Filter filter(stack(0.06, 0.01, 3e-3, 4));
  Vec3s end = filter.x;
  Random random(9);
  for (Vec3& p : end) p += Vec3(1, 0, 0) + random.vector(0.1);
  const Vec3 before = filter.mean_motion(end);
  const FilterReport report = filter(end, true);
  ASSERT_GT(report.truncated, 0);
  EXPECT_LT((filter.mean_motion(end) - before).norm(), 2e-3);
}

TEST(SafeFilter, WhatWasNearIsNotPushedFartherApartThanAFiftiethOfTheThickness) {
  // The tip of a triangle, nearer than r/4 to a held one, is moved through it.
  Sheet sheet;
  sheet.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  sheet.mesh.particle_count = 6;
  sheet.x = {{0, 0, 0.1}, {0.1, 0, -0.1}, {-0.1, 0, -0.1}, {0, 3e-4, 0}, {0.01, 0.05, 0}, {-0.01, 0.05, 0}};
  Filter filter(sheet);
  for (std::size_t i = 0; i < 3; ++i) filter.inverse_mass[i] = 0;
  Vec3s end = filter.x;
  end[3].y() = -1e-3;
  EXPECT_EQ(filter(end, false).left, 0);
  EXPECT_NEAR(end[3].y(), 3e-4, 1e-9);
  // What is nearly flat gets a fiftieth of r back.
  filter.x[3].y() = 1e-5;
  end = filter.x;
  end[3].y() = -1e-3;
  EXPECT_EQ(filter(end, false).left, 0);
  EXPECT_NEAR(end[3].y(), 2.5e-3 / 50, 1e-9);
  filter.x[3].y() = 4e-3;
  end = filter.x;
  end[3].y() = -1e-3;
  EXPECT_EQ(filter(end, false).left, 0);
  EXPECT_NEAR(end[3].y(), 0.25 * 2.5e-3, 1e-9);
}

TEST(SafeFilter, HoweverLongLayersArePressedAFileCanTellThemApart) {
  // Two held triangles, pressed through each other again and again: nobody gives way, and half of the gap would go every time.
  Sheet sheet;
  sheet.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  sheet.mesh.particle_count = 6;
  sheet.x = {{0, 0, 0.1}, {0.1, 0, -0.1}, {-0.1, 0, -0.1}, {0, 3e-4, 0}, {0.01, 0.05, 0}, {-0.01, 0.05, 0}};
  for (Vec3& p : sheet.x) p += Vec3(1.7, 1.3, -2.1);
  Filter filter(sheet);
  std::fill(filter.inverse_mass.begin(), filter.inverse_mass.end(), 0);
  const auto gap = [&] { return filter.x[3].y() - filter.x[0].y(); };
  for (int n = 0; n < 60; ++n) {
    Vec3s end = filter.x;
    for (std::size_t i = 3; i < 6; ++i) end[i] += Vec3(1e-4, -1e-2, 0);
    EXPECT_EQ(filter(end, true).left, 0);
    filter.x = end;
    ASSERT_GT(gap(), 0.9e-6) << n;
    Vec3s written = end;
    for (Vec3& p : written) p = p.cast<float>().cast<double>();
    ASSERT_EQ(test::crossings_of(written, filter.mesh.triangles), 0) << n;
  }
  EXPECT_LT(gap(), 1.1e-6);
  // They do not stick: what parts, parts in one step, and what slides, slides.
  Vec3s end = filter.x;
  for (std::size_t i = 3; i < 6; ++i) end[i] += Vec3(0.03, 0, 0);
  EXPECT_EQ(filter(end, true).truncated, 0);
  end = filter.x;
  for (std::size_t i = 3; i < 6; ++i) end[i] += Vec3(0, 0.01, 0);
  EXPECT_EQ(filter(end, true).truncated, 0);
}

TEST(SafeFilter, AZoneWithHeldParticlesFollowsThem) {
  Filter filter(stack(0.06, 0.01, 3e-3, 4));
  const Vec3 travel(0.02, 0.01, 0);
  Random random(9);
  Vec3s end = filter.x;
  const std::size_t held = end.size() / 4;
  for (std::size_t i = 0; i < end.size(); ++i) {
    if (i < held) filter.inverse_mass[i] = 0;
    end[i] += i < held ? travel : random.vector(0.1);
  }
  ASSERT_GT(filter(end, true).truncated, 0);
  for (std::size_t i = 0; i < held; ++i) EXPECT_LT((end[i] - filter.x[i] - travel).norm(), 1e-12) << i;
}

TEST(SafeFilter, RemembersNothingOfTheLastStep) {
  const Sheet sheet = stack(0.06, 0.01, 3e-3, 4);
  Filter used(sheet), fresh(sheet);
  Random random(9);
  Vec3s first = used.x, second = used.x;
  for (Vec3& p : first) p += random.vector(0.1);
  for (Vec3& p : second) p += random.vector(0.05);
  Vec3s expected = second;
  ASSERT_GT(fresh(expected, true).truncated, 0);
  ASSERT_GT(used(first, true).truncated, 0);
  used(second, true);
  EXPECT_EQ(std::memcmp(second.data(), expected.data(), second.size() * sizeof(Vec3)), 0);
}

TEST(SafeFilter, HeldParticlesThatMoveAlikeEndWhereTheyWereAskedToWhateverTheirZoneDoes) {
  Filter filter(stack(0.06, 0.01, 3e-3, 4));
  const Vec3 asked(1e-3, 2e-3, -1e-3);
  Random random(21);
  Vec3s end = filter.x;
  for (std::size_t i = 0; i < end.size(); ++i) {
    if (i % 5 == 0) filter.inverse_mass[i] = 0;
    end[i] += i % 5 == 0 ? asked : random.vector(0.05);
  }
  ASSERT_GT(filter(end, true).truncated, 0);
  int in_zones = 0;
  for (std::size_t i = 0; i < end.size(); i += 5) {
    in_zones += filter.filter.moved()[i];
    EXPECT_LT((end[i] - filter.x[i] - asked).norm(), 1e-12) << i;
  }
  EXPECT_GT(in_zones, 2);
}

TEST(SafeFilter, OfAnAlterationOnlyWhatWasCarriedOutIsNoVelocity) {
  const Vec3 y(0, 4e-4, 0), v(0.3, 0, -0.1);
  const double h = 0.01;
  EXPECT_LT((velocity_of_motion(h * v + y, y, h) - v).norm(), 1e-12) << "all of it";
  EXPECT_LT((velocity_of_motion(h * v + 0.5 * y, y, h) - v).norm(), 1e-12) << "half of it";
  EXPECT_LT(velocity_of_motion(Vec3::Zero(), y, h).norm(), 1e-15) << "none of it: stopped";
  const Vec3 along(0, 0.2, 0);
  EXPECT_LT((velocity_of_motion(h * along + y, y, h) - along).norm(), 1e-12) << "it moves on beyond y";
  EXPECT_LT((velocity_of_motion(-h * along, y, h) + along).norm(), 1e-12) << "it goes the other way";
  EXPECT_LT((velocity_of_motion(h * v, Vec3::Zero(), h) - v).norm(), 1e-12);
}

TEST(SafeFilter, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Sheet sheet = stack(0.3, 0.01, 3e-3, 3);
  std::vector<Vec3s> ends;
  for (const int threads : {1, 2, 5}) {
    with_threads(threads, [&] {
      Filter filter(sheet);
      Random random(4);
      Vec3s end = filter.x;
      for (Vec3& p : end) p += random.vector(4e-3);
      EXPECT_GT(filter(end, true).impacts, 100);
      ends.push_back(end);
    });
  }
  for (const Vec3s& end : ends) EXPECT_EQ(std::memcmp(end.data(), ends[0].data(), end.size() * sizeof(Vec3)), 0);
}

// ---------------------------------------------------------------------------------------------------------------------
// In the step.

// An upper sheet flies at a pinned lower one; returns the largest number of crossings of any frame.
int crossings_of_a_hit(double speed_m_per_s, double frame_s, FrameReport& total) {
  const Sheet sheet = stack(0.15, 0.015, 0.03, 2);
  ClothRun run(sheet, Fabric{});
  const Index half = run.model.particle_count() / 2;
  for (Index i = 0; i < half; ++i) {
    const Vec3& p = sheet.x[at(i)];
    if (p.x() < 1e-6 || p.x() > 0.15 - 1e-6) run.pin(i);
  }
  for (Index i = half; i < 2 * half; ++i) run.state.v[at(i)] = Vec3(0, -speed_m_per_s, 0);
  int worst = 0;
  for (int f = 0; f < 12; ++f) {
    const FrameReport report = run.frame(frame_s);
    total.rejected += report.rejected;
    total.corrected += report.corrected;
    worst = std::max(worst, test::crossings_of(run.state.x, sheet.mesh.triangles));
  }
  EXPECT_GT(test::crossings_of(sheet.x, sheet.mesh.triangles), -1);
  return worst;
}

TEST(SafeFilter, ASheetThatHitsAnotherNeverPassesItAtAnySpeed) {
  // From 17 mm a step on, two sheets 3 cm apart have never seen each other before they would have passed.
  for (const double speed : {0.5, 2.0, 10.0}) {
    FrameReport total;
    EXPECT_EQ(crossings_of_a_hit(speed, 1.0 / 30, total), 0) << speed << " m/s";
    EXPECT_GT(total.rejected + total.corrected, 0) << speed << " m/s: it was the filter that held them";
  }
}

TEST(SafeFilter, TheVelocityAfterAStepIsThatOfTheMotion) {
  const Sheet sheet = stack(0.1, 0.01, 0.02, 2);
  ModelOptions weightless;
  weightless.gravity_m_per_s2.setZero();
  ClothRun run(sheet, Fabric{}, weightless);
  const Index half = run.model.particle_count() / 2;
  for (Index i = half; i < 2 * half; ++i) run.state.v[at(i)] = Vec3(0, -5, 0);
  run.start();
  ImplicitEuler& euler = run.stepper->integrator();
  const double h = 1.0 / 120;
  euler.prepare(run.state, 0, h, h);
  ClothState candidate;
  const StepReport report = euler.attempt(run.state, 0, h, {1e9, false}, candidate);
  ASSERT_TRUE(report) << report.explain();
  ASSERT_GT(report.filter.corrected, half);
  for (std::size_t i = 0; i < candidate.x.size(); ++i)
    EXPECT_LT((h * candidate.v[i] - (candidate.x[i] - run.state.x[i])).norm(), 1e-12) << i;
}

// Nothing but the filter acts on two layers 2 cm apart of which one flies at 5 m/s: what it gives the one that stands is a
// correction of as much in however short a step.
TEST(SafeFilter, InAShortStepACorrectionGivesTheVelocityThatItHadGivenInTheLongest) {
  ModelOptions weightless;
  weightless.gravity_m_per_s2.setZero();
  ClothRun run(stack(0.1, 0.01, 0.02, 2), Fabric{}, weightless);
  const Index half = run.model.particle_count() / 2;
  for (Index i = half; i < 2 * half; ++i) run.state.v[at(i)] = Vec3(0, -5, 0);
  run.start();
  ImplicitEuler& euler = run.stepper->integrator();
  const double h = 1.0 / 120, base_h = 16 * h;
  euler.prepare(run.state, 0, h, base_h);
  ClothState candidate;
  const StepReport report = euler.attempt(run.state, 0, h, {1e9, false}, candidate);
  ASSERT_TRUE(report) << report.explain();
  ASSERT_GT(report.filter.corrected, half);
  double fastest = 0;
  for (Index i = 0; i < half; ++i) {
    const Vec3 correction = candidate.x[at(i)] - run.state.x[at(i)];
    EXPECT_LT((candidate.v[at(i)] - correction / base_h).norm(), 1e-6) << i;
    fastest = std::max(fastest, correction.norm() / h);
  }
  EXPECT_GT(fastest, 0.5) << "all of it would be that fast";
}

TEST(SafeFilter, ACorrectedParticleHasTheVelocityOfItsMotion) {
  // Frictionless rails: the upper sheet may only fall.  What stops it is the filter, and its speed goes with it.
  const Sheet sheet = stack(0.1, 0.01, 0.02, 2);
  ModelOptions weightless;
  weightless.gravity_m_per_s2.setZero();
  ClothRun run(sheet, Fabric{}, weightless);
  const Index half = run.model.particle_count() / 2;
  for (Index i = 0; i < half; ++i) run.pin(i);
  for (Index i = half; i < 2 * half; ++i) run.state.v[at(i)] = Vec3(0, -5, 0);
  run.run(10);
  for (Index i = half; i < 2 * half; ++i) {
    EXPECT_GT(run.state.x[at(i)].y(), 0) << "above the lower sheet";
    EXPECT_GT(run.state.v[at(i)].y(), -0.05) << "and no longer falling";
  }
}

TEST(SafeFilter, AnAlterationThatIsCutShortThrowsNobodyBack) {
  // The lower sheet lies too near a slab and would be lifted; the upper one is led down through it.  Both are held, so that only
  // cutting short helps, and no particle may leave with more speed than it moved.
  BodySurface slab = test::tilted_slab(1, 0.2, 0);
  Sheet sheet = stack(0.06, 0.01, 4e-3, 2);
  for (Vec3& p : sheet.x) p += Vec3(0, 2e-3, 0);
  ClothRun run(sheet, Fabric{});
  run.world.body = &slab;
  const double h = 1e-3;
  const Index half = run.model.particle_count() / 2;
  for (Index i = half; i < 2 * half; ++i) {
    Pin pin;
    pin.particle = i;
    pin.path = [p = sheet.x[at(i)], h](double t_s) { return Vec3(p - (t_s / h) * Vec3(0, 6e-3, 0)); };
    run.world.pins.push_back(pin);
  }
  run.start();
  ImplicitEuler& euler = run.stepper->integrator();
  euler.prepare(run.state, 0, h, h);
  ClothState candidate;
  EXPECT_EQ(euler.attempt(run.state, 0, h, {1e9, false}, candidate).status, StepStatus::passed_through);
  const StepReport report = euler.attempt(run.state, 0, h, {1e9, true}, candidate);
  ASSERT_TRUE(report) << report.explain();
  ASSERT_GT(report.touching, half / 2);
  ASSERT_GT(report.filter.truncated, half);
  for (std::size_t i = 0; i < candidate.x.size(); ++i) {
    const Vec3 moved = candidate.x[i] - run.state.x[i];
    EXPECT_LT(h * candidate.v[i].norm(), moved.norm() + 1e-9) << i;
  }
}

// Sixty layers turned upside down in one step: every one passes through every other.
TEST(SafeFilter, GivesUpWhereThereIsTooMuchToCorrect) {
  Filter filter(test::stack(0.3, 0.02, 3e-3, 60));
  Vec3s end = filter.x;
  for (Vec3& p : end) p.y() = 0.177 - p.y();
  const FilterReport report = filter(end, false);
  EXPECT_TRUE(report.hopeless);
  EXPECT_GT(report.left, 0);
  EXPECT_LT(report.left, 200'000) << "of some millions, no more are kept";
  EXPECT_EQ(report.rounds, 0);
  Vec3s cut = end;
  EXPECT_TRUE(filter(cut, true).hopeless) << "nor is it cut short: the caller takes a shorter step";
}

}  // namespace
}  // namespace toile::internal
