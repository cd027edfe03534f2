// From flat panels to one closed garment: it closes, nothing crosses, and what cannot close is named.
#include "dress/sewing.hpp"

#include "core/parallel.hpp"
#include "garment/garments.hpp"
#include "mesh/check.hpp"
#include "sewing_run.hpp"
#include "support/bare_step.hpp"
#include "support/bodies.hpp"
#include "support/crossings.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

namespace toile::internal {
namespace {

using test::expect_closed_without_crossings;
using test::SewingRun;
using test::widest;

// An upright capsule: a straight post of 24 sides with round ends.
BodySurface capsule(double radius, double half_length) {
  constexpr Index sides = 24, end_rings = 5;
  constexpr double pi = 3.14159265358979323846;
  std::vector<Vec3> x{{0, -half_length - radius, 0}};
  for (const int end : {-1, 1}) {
    for (Index ring = 0; ring < end_rings; ++ring) {
      const Index from_equator = end < 0 ? end_rings - 1 - ring : ring;
      const double latitude = 0.5 * pi * from_equator / end_rings;
      for (Index k = 0; k < sides; ++k) {
        const double angle = 2 * pi * k / sides;
        x.emplace_back(radius * std::cos(latitude) * std::sin(angle), end * (half_length + radius * std::sin(latitude)),
                       radius * std::cos(latitude) * std::cos(angle));
      }
    }
  }
  const auto top = static_cast<Index>(x.size());
  x.emplace_back(0, half_length + radius, 0);
  std::vector<Triangle> triangles;
  for (Index k = 0; k < sides; ++k) {
    const Index next = (k + 1) % sides, last = 1 + (2 * end_rings - 1) * sides;
    triangles.push_back({0, 1 + next, 1 + k});
    for (Index ring = 0; ring + 1 < 2 * end_rings; ++ring) {
      const Index low = 1 + ring * sides, high = low + sides;
      triangles.push_back({low + k, low + next, high + next});
      triangles.push_back({low + k, high + next, high + k});
    }
    triangles.push_back({top, last + k, last + next});
  }
  return BodySurface(std::move(x), triangles);
}

TEST(Sewing, ATubeInTheAirCloses) {
  SewingRun run(test::tube_pattern(0.12, 0.12, 0.1), 0.02);
  run.run(200);
  expect_closed_without_crossings(run);
  EXPECT_GT(run.sewing->closed_share(), 0.98);
  // A closed tube and not a flat bag: nothing pushed it to one side.
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : run.sewing->state().x) mean += p / static_cast<double>(run.garment.x.size());
  EXPECT_LT(mean.norm(), 2e-3) << "no gravity, no outer force";
}

TEST(Sewing, ATubeAroundACapsuleCloses) {
  BodySurface body = capsule(0.025, 0.1);
  ASSERT_NO_THROW(check_closed("capsule", body.positions(), body.triangles()));
  SewingRun run(test::tube_pattern(0.12, 0.12, 0.1), 0.02, &body);
  run.run(200);
  expect_closed_without_crossings(run);
  for (const Vec3& p : run.sewing->state().x) {
    const BodyPoint near = body.nearest(p, 0.05);
    if (near.triangle >= 0) {
      EXPECT_GT(near.gap_m, 0.5 * SewingOptions{}.offset_m);
    }
  }
}

TEST(Sewing, PairsCloseNoFasterThanTheWantedDistanceShrinks) {
  SewingRun run(test::tube_pattern(0.12, 0.12, 0.1), 0.02);
  const double start = widest(run.garment, run.garment.x);
  while (run.sewing->status() == SewingStatus::sewing && run.sewing->time_s() < 0.15) {
    run.sewing->frame();
    const double wanted = start - SewingOptions{}.closing_speed_m_per_s * run.sewing->time_s();
    double narrowest = 1;
    for (const SeamPair& pair : run.garment.pairs) {
      narrowest = std::min(narrowest, (run.sewing->state().x[at(pair.a)] - run.sewing->state().x[at(pair.b)]).norm());
    }
    EXPECT_GT(narrowest, wanted - 0.015) << run.sewing->time_s();
  }
}

TEST(Sewing, TheWeldKeepsMassAndMomentumAndTheMeanOfEveryClass) {
  SewingRun run(test::tube_pattern(0.12, 0.12, 0.1), 0.02);
  ClothState state = run.sewing->state();
  test::Random random(3);
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    state.x[i] += random.vector(0.01);
    state.v[i] = random.vector(1);
  }
  const WeldedMesh welded = weld(run.garment);
  const ClothModel& model = run.sewing->model();
  const ClothModel joined_model = build_model(welded.mesh, {&run.fabric, 1});
  const ClothState joined = weld_state(run.garment, welded, model, state);
  Vec3 momentum = Vec3::Zero(), moment = Vec3::Zero(), joined_momentum = Vec3::Zero(), joined_moment = Vec3::Zero();
  double mass = 0, joined_mass = 0;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    mass += model.mass_kg[i];
    momentum += model.mass_kg[i] * state.v[i];
    moment += model.mass_kg[i] * state.x[i];
  }
  for (std::size_t p = 0; p < joined.x.size(); ++p) {
    joined_mass += joined_model.mass_kg[p];
    joined_momentum += joined_model.mass_kg[p] * joined.v[p];
    joined_moment += joined_model.mass_kg[p] * joined.x[p];
  }
  EXPECT_NEAR(mass / joined_mass, 1, 1e-12);
  EXPECT_GT(momentum.norm(), 1e-5);
  EXPECT_LT((momentum - joined_momentum).norm(), 1e-12 * mass * 100);
  EXPECT_LT((moment - joined_moment).norm(), 1e-12 * mass * 100);
  for (std::size_t i = 0; i < state.x.size(); ++i) {  // what is not sewn is untouched
    if (std::count(run.garment.merged.begin(), run.garment.merged.end(), run.garment.merged[i]) > 1) continue;
    EXPECT_LT((joined.x[at(welded.particle_of[i])] - state.x[i]).norm(), 1e-15);
  }
}

TEST(Sewing, TheWeldKeepsTheThinnestLayerAndNothingThickerThanTheFabric) {
  SewingRun run(test::tube_pattern(0.12, 0.12, 0.1), 0.02);
  const WeldedMesh welded = weld(run.garment);
  std::vector<double> scale(run.garment.x.size(), 1.6);
  const SeamPair& pair = run.garment.pairs.front();
  scale[at(pair.b)] = 0.3;
  const std::vector<double> joined = weld_thickness(welded, scale);
  ASSERT_EQ(joined.size(), at(welded.mesh.particle_count));
  for (std::size_t p = 0; p < joined.size(); ++p)
    EXPECT_EQ(joined[p], p == at(welded.particle_of[at(pair.a)]) ? 0.3 : 1.0);
}

TEST(Sewing, ATubeTooSmallForTheBodyIsBlockedAndItsSeamsAreStretched) {
  BodySurface body = capsule(0.055, 0.2);  // 37 cm around with the offset; the tube has 20
  SewingOptions options;
  options.patience_s = 0.1;
  SewingRun run(test::tube_pattern(0.10, 0.08, 0.14), 0.02, &body, options);
  run.run(300);
  ASSERT_EQ(run.sewing->status(), SewingStatus::blocked);
  const std::vector<SeamGap> gaps = run.sewing->gaps();
  ASSERT_EQ(gaps.size(), 2U);
  EXPECT_GE(gaps[0].gap_m, gaps[1].gap_m);
  EXPECT_NE(gaps[0].seam, gaps[1].seam);
  EXPECT_NEAR(gaps[0].gap_m, run.sewing->widest_gap_m(), 1e-15);
  for (const SeamGap& gap : gaps) {
    EXPECT_GT(gap.gap_m, 5e-3);
    EXPECT_GT(gap.stretch, 0.05) << run.garment.seams[at(gap.seam)].name;
    EXPECT_EQ(gap.where.x() > 0, gap.seam == 0) << "each is named where it is";
  }
  const Vec3s before = run.sewing->state().x;  // once ended, it stays as it is
  run.sewing->frame();
  EXPECT_EQ(std::memcmp(before.data(), run.sewing->state().x.data(), before.size() * sizeof(Vec3)), 0);
}

// What gives way is some particle; why is the cloth beside an open seam.
TEST(Sewing, AStepThatCollapsesOverTautClothIsBlockedAndNotAFault) {
  const GarmentMesh garment = mesh_garment(test::tube_pattern(0.12, 0.12, 0.1), 0.02);
  const Fabric fabric;
  StepOptions step = test::bare_step();
  step.pcg.preconditioner = Preconditioner::diagonal;  // without a coarse space, which would solve so small a garment
  step.pcg.max_iterations = 0;                         // no step is accepted
  for (const bool taut : {false, true}) {
    SewingOptions options;
    if (taut) options.taut = -1;
    Sewing sewing(garment, std::span<const Fabric>(&fabric, 1), nullptr, step, options);
    const FrameReport report = sewing.frame();
    EXPECT_FALSE(report.ok);
    EXPECT_EQ(sewing.status(), taut ? SewingStatus::blocked : SewingStatus::failed);
  }
}

TEST(Sewing, ClothIsAsStiffAsLeatherUntilTheWeldAndNeverSofterThanItsFabric) {
  const Pattern pattern = test::tube_pattern(0.12, 0.12, 0.1);
  const GarmentMesh garment = mesh_garment(pattern, 0.02);
  for (const double bend : {1e-6, 1e-5, 5e-3}) {
    Fabric fabric, stiff;
    fabric.bend_u_N_m = fabric.bend_v_N_m = bend;
    stiff.bend_u_N_m = stiff.bend_v_N_m = std::max(bend, SewingOptions{}.bend_N_m);
    const Sewing sewing(garment, {&fabric, 1}, nullptr, test::bare_step(), SewingOptions{});
    const ClothModel wanted = build_model(garment.mesh, {&stiff, 1});
    ASSERT_EQ(sewing.model().bend.size(), wanted.bend.size());
    for (std::size_t h = 0; h < wanted.bend.size(); ++h)
      EXPECT_EQ(sewing.model().bend[h].kappa_N_m, wanted.bend[h].kappa_N_m) << bend;
  }
}

// Chiffon is sewn with the mass of silk, and nothing else with another than its own.
TEST(Sewing, LightClothIsSewnWithTheMassOfSilk) {
  const Pattern pattern = test::tube_pattern(0.12, 0.12, 0.1);
  const GarmentMesh garment = mesh_garment(pattern, 0.02);
  for (const double density : {0.03, 0.07, 0.3}) {
    Fabric fabric, sewn;
    fabric.density_kg_per_m2 = density;
    sewn.density_kg_per_m2 = std::max(density, 0.07);
    const Sewing sewing(garment, {&fabric, 1}, nullptr, test::bare_step(), SewingOptions{});
    EXPECT_EQ(sewing.model().mass_kg, build_model(garment.mesh, {&sewn, 1}).mass_kg) << density;
  }
}

TEST(Sewing, ThePullDoublesTwiceBeforeASeamIsBlocked) {
  BodySurface body = capsule(0.055, 0.2);
  const auto gap_when_given_up = [&](double too_small) {
    SewingOptions options;
    options.patience_s = 0.1;
    options.too_small = too_small;
    SewingRun run(test::tube_pattern(0.10, 0.08, 0.14), 0.02, &body, options);
    run.run(400);
    EXPECT_EQ(run.sewing->status(), SewingStatus::blocked);
    double sum = 0;  // the tube may slide to one side
    for (const SeamGap& gap : run.sewing->gaps()) sum += gap.gap_m;
    return sum;
  };
  const double once = gap_when_given_up(0), four_times = gap_when_given_up(1e9);
  EXPECT_LT(four_times, 0.6 * once) << "a tube that is stretched is pulled harder only when it may be";
}

TEST(Sewing, AGarmentWithoutSeamsIsClosedAtOnce) {
  Pattern pattern = test::tube_pattern(0.1, 0.1, 0.1);
  pattern.stitches.clear();
  const SewingRun run(pattern, 0.02);
  EXPECT_EQ(run.sewing->status(), SewingStatus::closed);
  EXPECT_EQ(run.sewing->closed_share(), 1);
  EXPECT_TRUE(run.sewing->gaps().empty());
}

TEST(Sewing, GivesTheSameBitsOnAnyNumberOfThreads) {
  Vec3s reference;
  for (const int threads : {1, 2, 5}) {
    Vec3s x;
    with_threads(threads, [&] {
      BodySurface body = capsule(0.03, 0.1);
      SewingRun run(test::tube_pattern(0.12, 0.12, 0.1), 0.015, &body);
      run.run(20);
      x = run.sewing->state().x;
    });
    if (threads == 1) {
      reference = x;
    } else {
      EXPECT_EQ(std::memcmp(reference.data(), x.data(), x.size() * sizeof(Vec3)), 0) << threads;
    }
  }
}

// The right sides are 10 cm apart, the left ones 22.
Pattern skew_tube() {
  Pattern pattern = test::tube_pattern(0.3, 0.12, 0.1);
  pattern.panels[1] = test::back_rectangle(0.1, 0.12, Vec3(0.1, 0, -0.05));
  return pattern;
}

TEST(Sewing, AllPairsCloseInProportion) {
  SewingOptions options;
  options.patience_s = 0;  // nothing escalates before the wanted distance is zero, however impatient
  SewingRun run(skew_tube(), 0.02, nullptr, options);
  const double start = widest(run.garment, run.garment.x);
  EXPECT_NEAR(start, std::sqrt(0.05), 1e-6);
  run.run(13);  // about half the time
  const double gone = options.closing_speed_m_per_s * run.sewing->time_s() / start;
  EXPECT_NEAR(gone, 0.5, 0.03);
  for (const SeamPair& pair : run.garment.pairs) {
    const auto distance = [&](const Vec3s& x) { return (x[at(pair.a)] - x[at(pair.b)]).norm(); };
    EXPECT_NEAR(distance(run.sewing->state().x), (1 - gone) * distance(run.garment.x), 0.02);
  }
  for (const double scale : run.sewing->thickness_scale()) EXPECT_EQ(scale, options.thickness_scale);
}

TEST(Sewing, AWideGapIsNotWeldedBeforeItHasStoppedClosing) {
  SewingOptions options;
  options.weld_share = 3;  // 6 cm
  SewingRun run(test::tube_pattern(0.12, 0.12, 0.1), 0.02, nullptr, options);
  run.run(200);
  ASSERT_EQ(run.sewing->status(), SewingStatus::closed);
  EXPECT_GE(run.sewing->time_s(), 0.1 / options.closing_speed_m_per_s);
}

TEST(Sewing, ASheetBetweenTheSeamsStopsTheWeldAndIsNotPassed) {
  Pattern pattern = test::tube_pattern(0.12, 0.12, 0.1);
  pattern.panels.push_back(test::front_rectangle(0.3, 0.2, Vec3::Zero()));
  pattern.panels.back().name = "between";
  SewingOptions options;
  options.patience_s = 0.05;
  options.weld_share = 2;  // what is near enough is tried
  SewingRun run(pattern, 0.02, nullptr, options);
  run.run(200);
  EXPECT_EQ(run.sewing->status(), SewingStatus::blocked);
  ASSERT_TRUE(run.sewing->weld_obstacle());
  EXPECT_EQ(test::crossings_of(run.sewing->state().x, run.garment.mesh.triangles), 0);
  double thinnest = 9, thickest = 0;  // beside the open seams and nowhere else
  for (const double scale : run.sewing->thickness_scale()) {
    thinnest = std::min(thinnest, scale);
    thickest = std::max(thickest, scale);
  }
  EXPECT_LT(thinnest, 1.2 * options.thickness_scale * std::pow(0.95, 9));
  EXPECT_EQ(thickest, options.thickness_scale);
}

TEST(Sewing, AFoldBetweenTheSeamsIsLetThroughAndNothingLarger) {
  Pattern pattern = test::tube_pattern(0.12, 0.12, 0.1);
  pattern.panels.push_back(
      test::front_rectangle(0.3, 0.04, Vec3::Zero()));  // as a fold would, between both sides of both seams
  pattern.panels.back().name = "fold";
  SewingOptions options;
  options.patience_s = 0.05;
  for (const bool small_enough : {true, false}) {
    options.largest_fold_m = small_enough ? 0.1 : 0;
    SewingRun run(pattern, 0.02, nullptr, options);
    run.run(200);
    EXPECT_EQ(run.sewing->status(), small_enough ? SewingStatus::closed : SewingStatus::blocked);
    EXPECT_EQ(run.sewing->weld_obstacle().has_value(), !small_enough);
    const auto of_fold = [&](Index i) { return run.garment.x[at(i)].z() == 0; };
    const auto& triangles = run.garment.mesh.triangles;
    std::vector<Triangle> tube;  // its seams, of which each side is next to the other, may cross there
    std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(tube),
                 [&](const Triangle& t) { return !of_fold(t[0]); });
    const Vec3s& x = run.sewing->state().x;
    EXPECT_EQ(test::crossings_of(x, triangles) > test::crossings_of(x, tube), small_enough);
    int unguarded = 0;
    for (std::size_t i = 0; i < run.garment.x.size(); ++i) {
      if (run.sewing->thickness_scale()[i] > 0) continue;
      unguarded += of_fold(static_cast<Index>(i)) ? 1 : 0;
      EXPECT_NEAR(std::abs(run.garment.x[i].x()), 0.06, 0.04) << "where the seams are";
    }
    EXPECT_EQ(unguarded > 0, small_enough);
  }
}

TEST(Sewing, ThinnedLayersComeBackToTheFabricsThicknessAndNoFurther) {
  std::vector<double> scale{0, 0.05, 0.5, 0.95, 1};
  grow_thickness(scale);
  EXPECT_NEAR(scale[0], 0.11, 1e-15);
  EXPECT_NEAR(scale[1], 0.11, 1e-15);
  EXPECT_NEAR(scale[2], 0.55, 1e-15);
  EXPECT_EQ(scale[3], 1);
  EXPECT_EQ(scale[4], 1);
}

}  // namespace
}  // namespace toile::internal
