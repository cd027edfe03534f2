// Layers of cloth in contact: the gap, the momentum, the stiffness, and who passed through whom.
#include "step/contact_rows.hpp"

#include "support/bodies.hpp"
#include "support/run_cloth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Sheet;
using test::stack;

// Two horizontal sheets as one mesh: the lower at y = 0, the upper `gap_m` above it and a quarter of an edge aside, so that its vertices
// lie over faces.  The first half of the particles is the lower sheet.
Vec3 momentum(const ClothModel& model, const Vec3s& v) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < v.size(); ++i) sum += model.mass_kg[i] * v[i];
  return sum;
}

double mean_height(const Vec3s& x, bool upper) {
  const std::size_t half = x.size() / 2;
  double sum = 0;
  for (std::size_t i = 0; i < half; ++i) sum += x[upper ? half + i : i].y();
  return sum / static_cast<double>(half);
}

Fabric frictionless() {
  Fabric fabric;
  fabric.friction = 0;
  return fabric;
}

ModelOptions weightless() {
  ModelOptions options;
  options.gravity_m_per_s2.setZero();
  return options;
}

// Rest on a lower sheet whose particles are all held, under the given weight.  Those of the upper move up and down only: without friction
// it would slide off.
double resting_gap(double edge_m, double gravity) {
  ModelOptions options;
  options.gravity_m_per_s2 = Vec3(0, -gravity, 0);
  ClothRun run(stack(0.12, edge_m, 2.4e-3, 2), frictionless(), options);
  const Index half = run.model.particle_count() / 2;
  for (Index i = 0; i < half; ++i) run.pin(i);
  for (Index i = half; i < 2 * half; ++i) {
    Pin rail;
    rail.particle = i;
    rail.constrained_directions = 2;
    rail.p = Vec3::UnitX();
    rail.q = Vec3::UnitZ();
    run.world.pins.push_back(rail);
  }
  run.run(60);
  EXPECT_LT(run.fastest(), 5e-3);
  return mean_height(run.state.x, true) - mean_height(run.state.x, false);
}

// The rows themselves, one step at a time, with no solver between: the cloth moves as the test says.
struct Rows {
  Rows(const Sheet& sheet, const Fabric& fabric, const ContactRowOptions& options = {})
      : model(build_model(sheet.mesh, {&fabric, 1}, weightless())), rows(model, nullptr, {}, {2.5e-3, 0}, options) {
    state.x = sheet.x;
    still();
    diagonal.resize(sheet.x.size());
    for (std::size_t i = 0; i < diagonal.size(); ++i) diagonal[i] = model.mass_kg[i] * Mat3::Identity();
  }
  void still() { state.v.assign(state.x.size(), Vec3::Zero()); }
  void raise_upper(double by) {
    for (std::size_t i = state.x.size() / 2; i < state.x.size(); ++i) state.x[i].y() += by;
  }
  // One accepted step in which nothing moves, or, as the rows are told when it is accepted, to `end`.
  std::vector<LinearSpring> step(double h, double base_h, const Vec3s* end = nullptr) {
    const Vec3s dv(state.x.size(), Vec3::Zero());
    rows.detect(state, h);
    rows.begin(state, dv, h, base_h, diagonal);
    rows.update(state, dv, dv, h, true);
    std::vector<LinearSpring> springs;
    rows.append_springs(springs);
    if (end != nullptr) state.x = *end;
    rows.accept(state);
    return springs;
  }
  ClothModel model;
  ContactRows rows;
  ClothState state;
  std::vector<Mat3> diagonal;
};

std::map<std::array<Index, 4>, double> stiffness_of(const std::vector<LinearSpring>& springs) {
  std::map<std::array<Index, 4>, double> stiffness;
  for (const LinearSpring& spring : springs) {
    if (spring.stiffness_N_per_m > 0) stiffness[spring.particle] = spring.stiffness_N_per_m;
  }
  return stiffness;
}

TEST(ContactRows, AnUpperSheetRestsOnALowerOneBetweenHalfAndAllOfTheThickness) {
  const double r = Fabric{}.thickness_m;
  for (const double gravity : {9.81, 49.0}) {  // its own weight, and five layers'
    const double gap = resting_gap(0.02, gravity);
    EXPECT_GT(gap, 0.5 * r) << gravity;
    EXPECT_LT(gap, r) << gravity;
  }
}

TEST(ContactRows, TheRestingGapDoesNotDependOnTheMesh) {
  const double coarse = resting_gap(0.02, 9.81), fine = resting_gap(0.01, 9.81);
  EXPECT_NEAR(fine / coarse, 1, 0.2);
}

TEST(ContactRows, TwoSheetsThatMeetKeepTheirMomentum) {
  ClothRun run(stack(0.12, 0.02, 5e-3, 2), Fabric{}, weightless());
  for (std::size_t i = run.state.v.size() / 2; i < run.state.v.size(); ++i) run.state.v[i] = Vec3(0.01, -0.1, 0.005);
  const Vec3 before = momentum(run.model, run.state.v);
  double lowest = 1;
  for (int f = 0; f < 10; ++f) {
    run.frame();
    lowest = std::min(lowest, mean_height(run.state.x, true) - mean_height(run.state.x, false));
    EXPECT_LT((momentum(run.model, run.state.v) - before).norm(), 1e-3 * before.norm()) << f;
  }
  EXPECT_GT(lowest, 0) << "the upper one stays above";
  EXPECT_LT(lowest, 3e-3);
  // They met: the lower one, at rest before, now moves down too.
  Vec3 lower = Vec3::Zero();
  for (std::size_t i = 0; i < run.state.v.size() / 2; ++i)
    lower += run.state.v[i] / static_cast<double>(run.state.v.size() / 2);
  EXPECT_LT(lower.y(), -0.02);
}

TEST(ContactRows, AMeetingGivesNoEnergy) {
  ClothRun run(stack(0.12, 0.02, 5e-3, 2), Fabric{}, weightless());
  double before = 0;
  for (std::size_t i = 0; i < run.state.v.size(); ++i) {
    if (i >= run.state.v.size() / 2) run.state.v[i] = Vec3(0, -0.1, 0);
    before += 0.5 * run.model.mass_kg[i] * run.state.v[i].squaredNorm();
  }
  run.run(10);
  double after = 0;
  for (std::size_t i = 0; i < run.state.v.size(); ++i)
    after += 0.5 * run.model.mass_kg[i] * run.state.v[i].squaredNorm();
  EXPECT_LT(after, before);
}

TEST(ContactRows, AStackThatFallsFreelyFeelsNoContact) {
  ClothRun run(stack(0.12, 0.02, 3e-3, 2), Fabric{});
  run.start();
  const double before = mean_height(run.state.x, true) - mean_height(run.state.x, false);
  for (int f = 0; f < 15; ++f) {
    run.frame();
    EXPECT_EQ(run.stepper->integrator().contact_rows().active(), 0) << f;
  }
  EXPECT_GT(run.stepper->integrator().contact_rows().candidates(), 0U) << "near, and yet not touching";
  EXPECT_NEAR(mean_height(run.state.x, true) - mean_height(run.state.x, false), before, 1e-6);
  for (const Vec3& v : run.state.v) EXPECT_NEAR(v.y(), -9.81 * run.time_s, 1e-3);
}

TEST(ContactRows, EveryRowConservesMomentumAndPushesAlongAUnitNormal) {
  Rows rows(stack(0.12, 0.02, 1.5e-3, 2), Fabric{});
  const auto springs = rows.step(1.0 / 60, 1.0 / 60);
  ASSERT_GT(springs.size(), 20U);
  for (const LinearSpring& spring : springs) {
    double sum = 0;
    for (const double w : spring.weight) sum += w;
    EXPECT_NEAR(sum, 0, 1e-12);
    EXPECT_NEAR(spring.direction.norm(), 1, 1e-12);
    if (std::abs(spring.direction.y()) < 0.5) continue;  // friction
    EXPECT_GT(spring.force_N, 0);
    EXPECT_NEAR(spring.force_N, spring.stiffness_N_per_m * 1e-3, 0.05 * spring.force_N)
        << "k (r - g), r = 2.5 mm, g = 1.5 mm";
  }
}

TEST(ContactRows, TheStiffnessIsThatOfTheMassInOneFrame) {
  // Without elasticity k = m_eff / h^2 of the frame's step, whatever part of it is tried.
  const double h = 1.0 / 60;
  Rows whole(stack(0.12, 0.02, 1.5e-3, 2), Fabric{}), half(stack(0.12, 0.02, 1.5e-3, 2), Fabric{});
  const auto a = whole.step(h, h), b = half.step(h / 2, h);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    double inverse = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      if (a[k].particle[j] >= 0) inverse += a[k].weight[j] * a[k].weight[j] / whole.model.mass_kg[at(a[k].particle[j])];
    }
    EXPECT_NEAR(a[k].stiffness_N_per_m * inverse * h * h, 1, 1e-9);
    EXPECT_NEAR(a[k].stiffness_N_per_m / b[k].stiffness_N_per_m, 1, 1e-9);
  }
}

TEST(ContactRows, TheStiffnessNeverShrinksWhileTheContactLives) {
  Rows rows(stack(0.12, 0.02, 2.2e-3, 2), frictionless());
  auto last = stiffness_of(rows.step(1.0 / 60, 1.0 / 60));
  ASSERT_GT(last.size(), 20U);
  const auto first = last;
  int grown = 0;
  for (const double raise :
       {-1.0e-3, -0.5e-3, 0.0, 0.5e-3, 1.0e-3, 0.1e-3, 0.1e-3, 0.05e-3}) {  // pressed, held, and let up again
    rows.raise_upper(raise);
    const auto now = stiffness_of(rows.step(1.0 / 60, raise > 0 ? 1.0 / 30 : 1.0 / 60));
    int common = 0;
    for (const auto& [particles, k] : now) {
      const auto found = last.find(particles);
      if (found == last.end()) continue;
      ++common;
      EXPECT_GE(k, found->second * (1 - 1e-12)) << raise;
      grown += k > 1.01 * found->second ? 1 : 0;
    }
    EXPECT_GT(common, 20) << raise;
    last = now;
  }
  EXPECT_GT(grown, 20) << "a load of more than a tenth of r stiffens it";
  // A contact that ended and comes again starts as the first one did.
  rows.raise_upper(5e-3);
  EXPECT_TRUE(rows.step(1.0 / 60, 1.0 / 60).empty());
  rows.raise_upper(-5.25e-3);
  for (const auto& [particles, k] : stiffness_of(rows.step(1.0 / 60, 1.0 / 60))) {
    const auto found = first.find(particles);
    if (found != first.end()) {
      EXPECT_NEAR(k / found->second, 1, 0.01);
    }
  }
}

std::ptrdiff_t rows_of_edges(const std::vector<LinearSpring>& springs) {
  return std::count_if(springs.begin(), springs.end(), [](const LinearSpring& s) { return s.weight[1] > 0; });
}

// Two sheets with bumps of up to `height_m`, the upper one `aside_m` farther.
Sheet bumpy(double height_m, double aside_m) {
  Sheet sheet = stack(0.12, 0.02, 2e-3, 2);
  for (std::size_t i = 0; i < sheet.x.size(); ++i) {
    sheet.x[i].y() += height_m * std::sin(12.9898 * static_cast<double>(i));
    if (i >= sheet.x.size() / 2) sheet.x[i].x() += aside_m;
  }
  return sheet;
}

TEST(ContactRows, AtRestEdgesThatActStayThoughTheirFoldsLieFlat) {
  const double h = 1.0 / 60;
  for (const bool slides : {false, true}) {
    Rows rows(bumpy(0.6e-3, 0), frictionless());
    const Sheet flattened = bumpy(0.3e-3, slides ? 0.5e-3 : 0);
    ASSERT_GT(rows_of_edges(rows.step(h, h, &flattened.x)), 20);
    const auto inner_and_hem = rows_of_edges(rows.step(h, h)),
               as_new = rows_of_edges(Rows(flattened, frictionless()).step(h, h));
    if (slides) {
      EXPECT_EQ(inner_and_hem, as_new);
    } else {
      EXPECT_GT(inner_and_hem, as_new + 10);
    }
  }
}

// The vertex of a sheet that creeps comes to another face, or to the edge between two: a softer row would let it sink, and back it goes.
TEST(ContactRows, AtRestTheNextPairOfAVertexIsNoSofter) {
  const double h = 1.0 / 60;
  int changes = 0;
  for (const double way : {0.05e-3, 0.5e-3}) {  // per step; r is 2.5 mm
    Rows rows(stack(0.12, 0.02, 2.2e-3, 2), frictionless());
    rows.raise_upper(-1e-3);
    rows.step(h, h);  // loaded: now they grow
    std::map<std::array<Index, 4>, double> last;
    int softer = 0;
    for (double gone = 0; gone < 2e-2; gone += way) {
      Vec3s end = rows.state.x;
      for (std::size_t i = end.size() / 2; i < end.size(); ++i) end[i].x() += way;
      std::vector<LinearSpring> springs = rows.step(h, h, &end);
      std::erase_if(springs, [](const LinearSpring& s) { return s.weight[1] > 0; });  // of two edges
      const auto now = stiffness_of(springs);
      for (const auto& [particles, k] : now) {
        if (last.count(particles) > 0) continue;
        for (const auto& [before, stiffness] : last) {
          if (before[0] != particles[0] || now.count(before) > 0) continue;
          changes += way < 0.1e-3 ? 1 : 0;
          softer += k < stiffness * (1 - 1e-9) ? 1 : 0;
        }
      }
      last = now;
    }
    if (way < 0.1e-3) {
      EXPECT_EQ(softer, 0);
    } else {
      EXPECT_GT(softer, 0) << "what slides takes each pair as it is";
    }
  }
  EXPECT_GT(changes, 10);
}

TEST(ContactRows, AThicknessScaleThinsTheLayersItNames) {
  Rows rows(stack(0.12, 0.02, 1.5e-3, 2), frictionless());
  rows.rows.set_thickness_scale(std::vector<double>(rows.state.x.size(), 0.5));  // r = 1.25 mm: not touching
  EXPECT_TRUE(rows.step(1.0 / 60, 1.0 / 60).empty());
  rows.rows.set_thickness_scale({});
  EXPECT_FALSE(rows.step(1.0 / 60, 1.0 / 60).empty());
}

Fabric thick(double thickness_m) {
  Fabric fabric = frictionless();
  fabric.thickness_m = thickness_m;
  return fabric;
}

TEST(ContactRows, LayersMeetAtTheirThicknessWhateverTheMesh) {
  for (const double edge_m : {2e-3, 1e-2}) {
    for (const double r : {1e-3, 2.5e-3, 1e-2}) {
      Rows apart(stack(0.03, edge_m, 1.1 * r, 2), thick(r)), near(stack(0.03, edge_m, 0.9 * r, 2), thick(r));
      EXPECT_TRUE(apart.step(1.0 / 60, 1.0 / 60).empty()) << edge_m << " " << r;
      EXPECT_FALSE(near.step(1.0 / 60, 1.0 / 60).empty()) << edge_m << " " << r;
    }
  }
}

TEST(ContactRows, NeighboursKeepTheirRestDistanceHoweverThickTheCloth) {
  // A sheet, 10 mm thick, folded so sharply that its halves are 4 mm apart: what is near the fold is near along the cloth, and only
  // what is farther away repels each other.
  Sheet sheet = stack(0.12, 5e-3, 1, 1);
  const Vec3s flat = sheet.x;
  for (Vec3& p : sheet.x)
    if (p.x() > 0.06) p = Vec3(0.12 - p.x(), 4e-3, p.z());
  Rows rows(sheet, thick(1e-2));
  const std::vector<LinearSpring> springs = rows.step(1.0 / 60, 1.0 / 60);
  EXPECT_GT(springs.size(), 100U);
  for (const LinearSpring& spring : springs) {
    double least = 1, most = 0;
    for (const Index i : spring.particle) {
      if (i < 0) continue;
      least = std::min(least, flat[at(i)].x());
      most = std::max(most, flat[at(i)].x());
    }
    EXPECT_GT(most - least, 0.015) << "along the cloth";
  }
}

TEST(ContactRows, AnOpenSeamMakesNeighbours) {
  // Two halves of a sheet, 10 mm thick, side by side: what a seam will join is as near as along the cloth.
  Sheet halves = stack(0.06, 0.01, 1, 2);
  const std::size_t half = halves.x.size() / 2;
  std::vector<Index> merged(halves.x.size());
  for (std::size_t i = 0; i < merged.size(); ++i) merged[i] = static_cast<Index>(i);
  double left = 1, right = -1;
  for (std::size_t i = 0; i < half; ++i)
    left = std::min(left, halves.x[i].x()), right = std::max(right, halves.x[i].x());
  for (std::size_t i = half; i < 2 * half; ++i)
    halves.x[i] += Vec3(right - left + 1e-4, -1, 0) - (halves.x[half] - halves.x[0]) + Vec3(0, 1, 0);
  for (std::size_t i = 0; i < half; ++i)
    for (std::size_t j = half; j < 2 * half; ++j)
      if ((halves.x[i] - halves.x[j]).norm() < 2e-4) merged[j] = static_cast<Index>(i);
  const Fabric fabric = thick(1e-2);
  const ClothModel model = build_model(halves.mesh, {&fabric, 1}, weightless());
  const auto active_rows = [&](std::span<const Index> seams) {
    ContactRows rows(model, nullptr, seams, {2.5e-3, 0}, {});
    const ClothState state{halves.x, Vec3s(halves.x.size(), Vec3::Zero())};
    const Vec3s dv(halves.x.size(), Vec3::Zero());
    const std::vector<Mat3> diagonal(halves.x.size(), Mat3::Identity());
    rows.detect(state, 1.0 / 60);
    rows.begin(state, dv, 1.0 / 60, 1.0 / 60, diagonal);
    return rows.active();
  };
  EXPECT_GT(active_rows({}), 3) << "two edges that are not sewn repel each other";
  EXPECT_EQ(active_rows(merged), 0);
}

TEST(ContactRows, ARowThatOpensIsDroppedInsteadOfPulling) {
  Rows rows(stack(0.12, 0.02, 1.5e-3, 2), frictionless());
  ASSERT_GT(rows.step(1.0 / 60, 1.0 / 60).size(), 20U);
  const Vec3s zero(rows.state.x.size(), Vec3::Zero());
  Vec3s apart = zero;
  for (std::size_t i = apart.size() / 2; i < apart.size(); ++i) apart[i].y() = 1;  // m/s
  rows.rows.detect(rows.state, 1.0 / 60);
  rows.rows.begin(rows.state, zero, 1.0 / 60, 1.0 / 60, rows.diagonal);
  EXPECT_GT(rows.rows.active(), 20);
  const ContactRows::Change change = rows.rows.update(rows.state, apart, zero, 1.0 / 60, true);
  EXPECT_GT(change.dropped, 20);
  EXPECT_EQ(change.active, 0);
  std::vector<LinearSpring> springs;
  rows.rows.append_springs(springs);
  EXPECT_TRUE(springs.empty());
}

TEST(ContactRows, FrictionActsAlongBothTangentsOfEveryLoadedRow) {
  Rows rows(stack(0.12, 0.02, 1.5e-3, 2), Fabric{});
  const auto springs = rows.step(1.0 / 60, 1.0 / 60);  // friction takes its size from the load of the pass before
  ASSERT_GT(springs.size(), 60U);
  ASSERT_EQ(springs.size() % 3, 0U);
  for (std::size_t k = 0; k < springs.size(); k += 3) {
    const LinearSpring &push = springs[k], &s = springs[k + 1], &t = springs[k + 2];
    EXPECT_GT(push.stiffness_N_per_m, 0);
    EXPECT_NEAR(s.direction.dot(push.direction), 0, 1e-12);
    EXPECT_NEAR(t.direction.dot(push.direction), 0, 1e-12);
    EXPECT_NEAR(s.direction.dot(t.direction), 0, 1e-12);
    for (const LinearSpring* bristle : {&s, &t}) {  // nothing has moved: all stick, none is stretched
      EXPECT_EQ(bristle->particle, push.particle);
      EXPECT_EQ(bristle->stiffness_N_per_m, push.stiffness_N_per_m);
      EXPECT_NEAR(bristle->force_N, 0, 1e-12);
    }
  }
}

TEST(ContactRows, ARowOfTheBodyKnowsHowFarTheBodyMoves) {
  // The upper tip of an octahedron, half a millimetre below a face of the sheet, rises by 2 mm.
  Sheet sheet = test::equilateral_sheet(0.12, 0.12, 0.02);
  const Triangle& face = sheet.mesh.triangles[sheet.mesh.triangles.size() / 2];
  const Vec3 middle = (sheet.x[at(face[0])] + sheet.x[at(face[1])] + sheet.x[at(face[2])]) / 3;
  BodySurface body = test::sphere(middle - Vec3(0, 0.03 + 0.5e-3, 0), 0.03, 0);
  const std::vector<Vec3> start(body.positions().begin(), body.positions().end());
  std::vector<Vec3> end = start;
  for (Vec3& p : end) p.y() += 2e-3;
  body.set_motion(start, end);
  const Fabric fabric;
  const ClothModel model = build_model(sheet.mesh, {&fabric, 1}, weightless());
  ContactRows rows(model, &body, {}, {2.5e-3, 0}, {});
  const ClothState state{sheet.x, Vec3s(sheet.x.size(), Vec3::Zero())};
  std::vector<Mat3> diagonal;
  for (const double mass : model.mass_kg) diagonal.push_back(mass * Mat3::Identity());
  rows.detect(state, 1.0 / 60);
  rows.begin(state, state.v, 1.0 / 60, 1.0 / 60, diagonal);
  std::vector<LinearSpring> springs;
  rows.append_springs(springs);
  ASSERT_FALSE(springs.empty());
  for (const LinearSpring& spring : springs) {
    EXPECT_NEAR(spring.direction.y(), 1, 1e-9);
    EXPECT_NEAR(spring.body_displacement_m, 2e-3, 1e-12);
  }
}

TEST(ContactRows, WhatIsPressedNearlyFlatHardensUntilItBearsTheLoad) {
  Rows rows(stack(0.12, 0.02, 2e-3, 2), frictionless());
  const double h = 1.0 / 60, r = rows.model.thickness_m[0];
  const auto first = stiffness_of(rows.step(h, h));
  const auto grown_after = [&](double gap_m, int steps) {  // the most of all rows
    rows.raise_upper(gap_m - rows.state.x.back().y());
    std::map<std::array<Index, 4>, double> last;
    for (int n = 0; n < steps; ++n) last = stiffness_of(rows.step(h, h));
    double most = 0;
    for (const auto& [particles, k] : last)
      if (const auto found = first.find(particles); found != first.end()) most = std::max(most, k / found->second);
    return most;
  };
  EXPECT_NEAR(grown_after(0.05 * r, 6), 10, 1e-6);
  EXPECT_NEAR(grown_after(0.01 * r, 1), 20, 1e-6) << "it doubles";
  EXPECT_NEAR(grown_after(0.01 * r, 1), 40, 1e-6);
  EXPECT_NEAR(grown_after(0.03 * r, 2), 40, 1e-6) << "what is not flat keeps what it has";
  EXPECT_NEAR(grown_after(0.01 * r, 8), 1000, 1e-6) << "at most";
}

}  // namespace
}  // namespace toile::internal
