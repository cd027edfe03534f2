// What a cloth remembers of its bends: a sheet that is rolled up and unrolled follows the loop of its fabric, on any triangles and in any direction.
#include "assembly/bend_memory.hpp"

#include "assembly/elements.hpp"
#include "core/parallel.hpp"
#include "core/state_archive.hpp"
#include "support/fabrics.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace toile::internal {
namespace {

Fabric rubbing() {
  Fabric fabric;
  fabric.bend_u_N_m = 2e-5;
  fabric.bend_v_N_m = 0.8e-5;
  fabric.bend_friction_N = 3e-5;
  fabric.bend_friction_curvature_per_m = 1;
  fabric.bend_damping_s = 0;
  fabric.stretch_u_N_per_m = fabric.stretch_v_N_per_m = 1e-9;  // chords are shorter than arcs
  fabric.shear_N_per_m = 0;
  return fabric;
}

test::Sheet irregular(double move) {
  constexpr double edge = 0.02, size = 0.16;
  test::Sheet sheet = test::equilateral_sheet(size, size, edge);
  test::Random random(3);
  double least_z = 0;
  for (const Vec3& p : sheet.x) least_z = std::min(least_z, p.z());
  std::vector<Vec2> shift;
  for (const Vec3& p : sheet.x) {
    const bool inside = p.x() > 1e-9 && p.x() < size - 1e-9 && p.z() < -1e-9 && p.z() > least_z + 1e-9;
    shift.push_back(inside ? Vec2(move * edge * random(-1, 1), move * edge * random(-1, 1)) : Vec2(0, 0));
  }
  for (std::size_t i = 0; i < shift.size(); ++i) sheet.x[i] += Vec3(shift[i].x(), 0, -shift[i].y());
  for (std::size_t t = 0; t < sheet.mesh.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) sheet.mesh.uv[t][c] += shift[at(sheet.mesh.triangles[t][c])];
  return sheet;
}

// A sheet in y = 0 rolled up by `curvature` across the direction at `angle` from the warp (x).
Vec3s rolled_up(const Vec3s& flat, double curvature, double angle) {
  const Vec3 along(std::cos(angle), 0, -std::sin(angle));
  Vec3s x;
  for (const Vec3& p : flat) {
    const double s = along.dot(p);
    if (curvature == 0) {
      x.push_back(p);
    } else {
      x.push_back(p - s * along + std::sin(curvature * s) / curvature * along +
                  Vec3(0, (1 - std::cos(curvature * s)) / curvature, 0));
    }
  }
  return x;
}

struct Rolling {
  Rolling(const test::Sheet& sheet, const Fabric& fabric, double direction)
      : flat(sheet.x), model(build_model(sheet.mesh, {&fabric, 1})), elements(model), angle(direction) {
    for (std::size_t t = 0; t < model.mesh.triangles.size(); ++t) {
      const std::array<Vec2, 3>& uv = model.mesh.uv[t];
      area += 0.5 * std::abs((uv[1] - uv[0]).x() * (uv[2] - uv[0]).y() - (uv[1] - uv[0]).y() * (uv[2] - uv[0]).x());
    }
  }
  // The moment per width at `curvature`: the work of all forces on rolling it up further, over its area.
  double to(double curvature) {
    const double from = now, steps = std::ceil(std::abs(curvature - from) / 0.05);
    for (double k = 1; k <= steps; ++k)
      elements.follow_bends(model, rolled_up(flat, now = from + (curvature - from) * k / steps, angle), 1e-6);
    const ClothState state{rolled_up(flat, now, angle), Vec3s(flat.size(), Vec3::Zero())};
    elements.evaluate(model, state);
    Vec3s f(flat.size());
    elements.forces(f);
    const Vec3s more = rolled_up(flat, now + 1e-5, angle), less = rolled_up(flat, now - 1e-5, angle);
    double work = 0;
    for (std::size_t i = 0; i < f.size(); ++i) work -= f[i].dot(more[i] - less[i]);
    return work / 2e-5 / area;
  }
  Vec3s flat;
  ClothModel model;
  Elements elements;
  double angle, now = 0, area = 0;
};

TEST(BendMemory, ASheetFollowsTheLoopOfItsFabricInAnyDirection) {
  const Fabric fabric = rubbing();
  const double pi = 3.14159265358979323846;
  for (const double move : {0.0, 0.25}) {
    for (const double angle : {0.0, pi / 6, pi / 4, pi / 2}) {
      SCOPED_TRACE(testing::Message() << "moved by " << move << ", " << angle);
      Rolling sheet(irregular(move), fabric, angle);
      Fabric elastic = fabric;
      elastic.bend_friction_N = 0;
      Rolling without(irregular(move), elastic, angle);
      const double per_curvature = without.to(4) / 4, stiffening = friction_stiffening(fabric);
      EXPECT_NEAR(sheet.to(0.2), 0.2 * stiffening * per_curvature, 0.01 * sheet.to(0.2));
      const double friction = (stiffening - 1) * per_curvature * fabric.bend_friction_curvature_per_m;
      const double up = sheet.to(4);
      EXPECT_NEAR(up, 4 * per_curvature + friction, 0.02 * up);
      sheet.to(8);
      const double down = sheet.to(4);
      EXPECT_NEAR(up - down, 2 * friction, 0.06 * friction);
    }
  }
}

// With what is remembered, forces are still minus the gradient of the energy.
TEST(BendMemory, ForcesAreTheGradientOfTheEnergy) {
  Fabric fabric = rubbing();
  fabric.bend_set = 0.3;
  Rolling sheet(irregular(0.25), fabric, 0.4);
  sheet.to(5);
  sheet.to(2);
  ASSERT_GT(sheet.elements.bend_memory()->of(7).slipped.norm(), 0.1);
  Vec3s x = rolled_up(sheet.flat, 1.5, 1.0);
  const Vec3s v(x.size(), Vec3::Zero());
  const auto energy = [&] {
    sheet.elements.evaluate(sheet.model, {x, v});
    return sheet.elements.energy_J();
  };
  energy();
  Vec3s f(x.size());
  sheet.elements.forces(f);
  double largest = 0;
  for (const Vec3& force : f) largest = std::max(largest, force.norm());
  for (std::size_t i = 3; i < x.size(); i += 7) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double way = 1e-6, here = x[i][axis];
      x[i][axis] = here + way;
      const double more = energy();
      x[i][axis] = here - way;
      const double less = energy();
      x[i][axis] = here;
      EXPECT_NEAR(-(more - less) / (2 * way), f[i][axis], 1e-3 * largest);
    }
  }
}

TEST(BendMemory, IsKeptInAStateAndTheSameOnAnyNumberOfThreads) {
  const Fabric fabric = rubbing();
  double moment[3];
  std::size_t n = 0;
  for (const int threads : {1, 2, 5})
    with_threads(threads, [&] {
      Rolling sheet(irregular(0.25), fabric, 0.4);
      sheet.to(5);
      moment[n++] = sheet.to(3);
    });
  EXPECT_EQ(moment[0], moment[1]);
  EXPECT_EQ(moment[0], moment[2]);

  Rolling first(irregular(0.25), fabric, 0.4), second(irregular(0.25), fabric, 0.4);
  first.to(5);
  StateWriter writer;
  writer(first.elements);
  const std::string bytes = writer.take();
  StateReader reader(bytes, "state");
  reader(second.elements);
  reader.end();
  second.now = 5;
  EXPECT_EQ(first.to(5), second.to(5));
  EXPECT_EQ(first.to(3), second.to(3));
}

TEST(BendMemory, ThereIsNoneWhereNoFabricNeedsIt) {
  const Fabric fabric = test::elastic_cotton();
  const ClothModel model = build_model(irregular(0).mesh, {&fabric, 1});
  EXPECT_EQ(Elements(model).bend_memory(), nullptr);
}

}  // namespace
}  // namespace toile::internal
