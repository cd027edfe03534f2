// tests/validation/drape_run.hpp: the drape test of the textile laboratory, run.                          tests/validation/drape.hpp
//
// The disc of cloth starts level, and its weight comes on over five seconds: dropped, it breaks into more folds than it needs and
// keeps them.
#pragma once
#include "validation/drape.hpp"

#include <vector>

namespace toile::internal::test {

struct Drape {
  double percent;  // drape coefficient
  int folds;
  std::vector<Vec3> rim;
};

inline Drape drape(const Fabric& fabric, double edge_m, std::uint64_t seed = 1, const CusickSizes& sizes = {}) {
  const Disc disc = cusick_disc(edge_m, sizes);
  ClothRun run(disc.sheet, fabric);
  run.step.rows.cloth_cloth = false;  // the folds of these fabrics do not meet
  Random random(seed);                // a perfectly flat disc could not choose where to fold
  for (Vec3& p : run.state.x) p.y() += 1e-4 * random(-1, 1);
  for (const Index i : disc.held) {
    run.state.x[static_cast<std::size_t>(i)].y() = 0;
    run.pin(i);
  }
  constexpr int ramp_frames = 150, most_frames = 900;
  double before = 1;
  for (int f = 1; f <= most_frames; ++f) {
    run.model.gravity_m_per_s2 = Vec3(0, -9.81 * std::min(1.0, static_cast<double>(f) / ramp_frames), 0);
    if (!run.frame().ok) break;
    if (f <= ramp_frames || f % 30 != 0) continue;
    const double now = drape_coefficient(disc, run.state.x, sizes);
    if (std::abs(now - before) < 2e-4 && run.fastest() < 2e-3) {
      Drape found{100 * now, fold_count(disc, run.state.x), {}};
      for (const Index i : disc.rim) found.rim.push_back(run.state.x[static_cast<std::size_t>(i)]);
      return found;
    }
    before = now;
  }
  ADD_FAILURE() << fabric.name << " does not come to rest";
  return {100 * before, fold_count(disc, run.state.x), {}};
}

}  // namespace toile::internal::test
