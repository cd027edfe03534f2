// tests/dress/sewing_run.hpp: a small pattern that is being sewn, and what has to hold once it is closed.
#pragma once
#include "dress/sewing.hpp"
#include "support/bare_step.hpp"
#include "support/crossings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <span>

namespace toile::internal::test {

struct SewingRun {
  SewingRun(const Pattern& pattern, double resolution, BodySurface* body = nullptr, const SewingOptions& options = {})
      : garment(mesh_garment(pattern, resolution)) {
    sewing.emplace(garment, std::span<const Fabric>(&fabric, 1), body, bare_step(), options);
  }
  void run(int most_frames) {
    for (int f = 0; f < most_frames && sewing->status() == SewingStatus::sewing; ++f) {
      const FrameReport report = sewing->frame();
      EXPECT_TRUE(report.ok) << report.diagnosis;
    }
  }
  Fabric fabric;
  GarmentMesh garment;
  std::optional<Sewing> sewing;
};

inline double widest(const GarmentMesh& garment, const Vec3s& x) {
  double gap = 0;
  for (const SeamPair& pair : garment.pairs) gap = std::max(gap, (x[at(pair.a)] - x[at(pair.b)]).norm());
  return gap;
}

inline void expect_closed_without_crossings(const SewingRun& run) {
  const Sewing& sewing = *run.sewing;
  ASSERT_EQ(sewing.status(), SewingStatus::closed);
  EXPECT_LT(widest(run.garment, sewing.state().x), 1e-12) << "every class has been moved to where it will be welded";
  EXPECT_NEAR(sewing.widest_gap_m(), widest(run.garment, sewing.state().x), 1e-15);
  const WeldedMesh welded = weld(run.garment);
  const ClothState joined = weld_state(run.garment, welded, sewing.model(), sewing.state());
  EXPECT_EQ(crossings_of(joined.x, welded.mesh.triangles), 0);
}

}  // namespace toile::internal::test
