// Cloth that starts tangled: a few of the fifty starts here, all of them in the suite UntangleLong (label `long`).
#include "dress/untangle.hpp"

#include "assembly/elements.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "dress/model_as_it_is.hpp"
#include "support/crossings.hpp"
#include "support/tangled_starts.hpp"
#include "verify/crossings.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace toile::internal {
namespace {

using test::TangledStart;

int crossings_of(const TangledStart& start, const Vec3s& x) {
  std::size_t count = find_cloth_crossings(start.triangles, x).size();
  if (!start.body.triangles.empty())
    count += find_body_crossings(start.triangles, x, start.body.triangles, start.body.positions).size();
  return static_cast<int>(count);
}

UntangleReport untangled(const TangledStart& start, Vec3s& x, const UntangleOptions& options = {}) {
  x = start.x;
  return untangle(start.triangles, x, start.body.triangles, start.body.positions, options);
}

void expect_resolved(int kind, int seed, double most_edge_change = 0.02) {
  const TangledStart start = test::tangled_start(kind, seed);
  SCOPED_TRACE(start.name);
  ASSERT_GT(crossings_of(start, start.x), 10) << "the start is no test";
  Vec3s x;
  const UntangleReport report = untangled(start, x);
  EXPECT_TRUE(report.resolved);
  EXPECT_EQ(crossings_of(start, x), 0);
  EXPECT_TRUE(report.left.empty());
  EXPECT_EQ(report.inside, 0);
  EXPECT_LT(report.edge_change_max, most_edge_change) << "it keeps its shape";
}

TEST(ModelAsItIs, ACrumpledSheetIsAtRest) {
  TangledStart start;
  test::Random random(3);
  test::add_crumpled_sheet(start, random, test::tangled_edge_m);
  const ClothModel model = model_as_it_is(start.triangles, start.x, fabric_preset("cotton", "", ""));
  Elements elements(model);
  elements.evaluate(model, {start.x, Vec3s(start.x.size(), Vec3::Zero())});
  Vec3s force(start.x.size());
  elements.forces(force);
  for (const Vec3& f : force) EXPECT_LT(f.norm(), 1e-9);
}

TEST(Untangle, TwoSheetsThatCross) { expect_resolved(0, 0); }
TEST(Untangle, ACornerThroughASheet) { expect_resolved(1, 0); }
TEST(Untangle, ASheetThroughASphere) { expect_resolved(2, 0); }
TEST(Untangle, AFoldedSheetThroughItself) { expect_resolved(3, 0); }
TEST(Untangle, ALayerDentedThroughAnother) { expect_resolved(4, 0); }
TEST(Untangle, ASleeveThatOverlapsAnArm) { expect_resolved(6, 0); }
TEST(Untangle, ATubeThroughASheetLeavesByItsShorterEnd) {
  const TangledStart start = test::tangled_start(7, 0);
  Vec3s x;
  const UntangleReport report = untangled(start, x);
  EXPECT_TRUE(report.resolved);
  // The sheet is not torn by the tube: none of its particles goes farther than the tube's end was.
  EXPECT_LT(report.largest_move, 0.12);
  // The disc that the tube cuts out of the sheet is smaller than the tube's end; pinching it would have cost more.
  EXPECT_LT(report.iterations, 25);
}
TEST(Untangle, TwoSheetsSlottedIntoEachOther) { expect_resolved(8, 0); }
TEST(Untangle, ASleeveInTheMannequinsArm) { expect_resolved(9, 3); }

TEST(Untangle, AgreesWithThePlainCount) {
  const TangledStart start = test::tangled_start(1, 1);
  Vec3s x;
  ASSERT_TRUE(untangled(start, x).resolved);
  EXPECT_GT(test::crossings_of(start.x, start.triangles), 0);
  EXPECT_EQ(test::crossings_of(x, start.triangles), 0);
}

TEST(Untangle, LeavesClothThatCrossesNothingWhereItIs) {
  TangledStart start;
  test::add_sheet(start, 0.2, 0.2, [](const Vec3& p) { return p; });
  test::add_sheet(start, 0.2, 0.2, [](const Vec3& p) { return Vec3(p + Vec3(0, 1e-4, 0)); });  // near, not through
  Vec3s x;
  const UntangleReport report = untangled(start, x);
  EXPECT_TRUE(report.resolved);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(x, start.x);
}

TEST(Untangle, DoesNotDependOnTheUnit) {
  TangledStart metres = test::tangled_start(1, 2), other = metres;
  for (Vec3& p : other.x) p *= 128;
  Vec3s x, y;
  const UntangleReport a = untangled(metres, x), b = untangled(other, y);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(128 * a.largest_move, b.largest_move);
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_EQ(128 * x[i], y[i]);
}

TEST(Untangle, HasTheSameBitsOnAnyNumberOfThreads) {
  const TangledStart start = test::tangled_start(6, 1);
  Vec3s one, two;
  with_threads(1, [&] { untangled(start, one); });
  with_threads(2, [&] { untangled(start, two); });
  EXPECT_EQ(one, two);
}

// Stopped at any trial, what comes back has at most the crossings that came in, and never more for being given longer.
TEST(Untangle, NeverReturnsMoreCrossingsForMoreTrials) {
  const TangledStart start = test::tangled_start(3, 3);
  int before = crossings_of(start, start.x);
  for (const int trials : {1, 3, 10, 30}) {
    UntangleOptions options;
    options.most_iterations = trials;
    Vec3s x;
    const UntangleReport report = untangled(start, x, options);
    const int now = crossings_of(start, x);
    EXPECT_LE(now, before);
    EXPECT_EQ(now, report.cloth_crossings);
    EXPECT_EQ(now == 0, report.resolved);
    before = now;
  }
}

// A sheet under one that is pushed down beside a contour, where contact is off: it must not be passed through.
TEST(Untangle, MakesNoContourWithAThirdLayer) {
  TangledStart start;
  test::Random random(5);
  test::add_sheet(start, 0.3, 0.3, [](const Vec3& p) { return p; });
  const std::size_t lying_triangles = start.triangles.size();
  test::add_sheet(start, 0.3, 0.3, [](const Vec3& p) { return Vec3(p.x(), p.z() + 0.09, 0.001 - p.y()); });
  const std::size_t standing_triangles = start.triangles.size();
  test::add_sheet(start, 0.2, 0.08, [](const Vec3& p) { return Vec3(p + Vec3(0, -0.0015, 0.052)); });
  for (Vec3& p : start.x) p += random.vector(3e-4);

  // The lying sheet and the one below it alone.
  std::vector<Triangle> pair(start.triangles.begin(),
                             start.triangles.begin() + static_cast<std::ptrdiff_t>(lying_triangles));
  pair.insert(pair.end(), start.triangles.begin() + static_cast<std::ptrdiff_t>(standing_triangles),
              start.triangles.end());
  ASSERT_TRUE(find_cloth_crossings(pair, start.x).empty());
  ASSERT_GT(crossings_of(start, start.x), 10);
  for (const int trials : {1, 2, 4, 8}) {
    UntangleOptions options;
    options.most_iterations = trials;
    Vec3s x;
    untangled(start, x, options);
    EXPECT_TRUE(find_cloth_crossings(pair, x).empty()) << "after " << trials;
  }
  Vec3s x;
  EXPECT_TRUE(untangled(start, x).resolved);
}

TEST(Untangle, SaysWhatIsLeft) {
  const TangledStart start = test::tangled_start(0, 1);
  UntangleOptions options;
  options.most_iterations = 1;
  Vec3s x;
  const UntangleReport report = untangled(start, x, options);
  EXPECT_FALSE(report.resolved);
  ASSERT_EQ(report.left.size(), 1u);
  EXPECT_FALSE(report.left[0].closed);
  EXPECT_FALSE(report.left[0].with_body);
  EXPECT_GT(report.left[0].length, 0.25);
  EXPECT_LT(report.left[0].position.norm(), 0.1);
  ASSERT_FALSE(report.left[0].triangles.empty());
  for (const auto& [a, b] : report.left[0].triangles) EXPECT_LT(a, b);
}

TEST(Untangle, GivesUpWhatDoesNotBecomeLess) {
  const TangledStart start = test::tangled_start(0, 1);
  UntangleOptions options;
  options.most_in_vain = 7;
  for (Index i = 0; i < static_cast<Index>(start.x.size()); ++i) options.held.push_back(i);
  Vec3s x;
  EXPECT_EQ(untangled(start, x, options).iterations, 7);
  options.held.clear();
  EXPECT_TRUE(untangled(start, x, options).resolved) << "while it does, it goes on";
}

TEST(Untangle, RefusesWhatIsNoSurface) {
  Vec3s x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> bad = {{0, 1, 5}};
  EXPECT_THROW(untangle(bad, x, {}, {}), InputError);
}

// All fifty.  The table goes to stdout; docs/untangle.md quotes it.
TEST(UntangleLong, FiftyStarts) {
  int resolved = 0, told = 0;
  for (int kind = 0; kind < test::tangled_kinds; ++kind)
    for (int seed = 0; seed < test::seeds_per_kind; ++seed) {
      const TangledStart start = test::tangled_start(kind, seed);
      const int before = crossings_of(start, start.x);
      EXPECT_GT(before, 0) << start.name;
      Vec3s x;
      const UntangleReport report = untangled(start, x);
      const int after = crossings_of(start, x);
      std::printf("%-55s %5zu particles, %4d crossings -> %3d, %3d trials, moved %.3f m, edges %.1f %%\n",
                  start.name.c_str(), x.size(), before, after, report.iterations, report.largest_move,
                  100 * report.edge_change_max);
      EXPECT_LE(after, before) << start.name;
      EXPECT_EQ(report.resolved, after == 0) << start.name;
      resolved += after == 0 ? 1 : 0;
      told += after > 0 && !report.left.empty() ? 1 : 0;
    }
  std::printf("%d resolved, %d told\n", resolved, told);
  EXPECT_EQ(resolved + told, test::tangled_kinds * test::seeds_per_kind);
  EXPECT_GE(resolved, 48);
}

}  // namespace
}  // namespace toile::internal
