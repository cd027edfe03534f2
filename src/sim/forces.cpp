#include "sim/forces.hpp"

#include "assembly/air.hpp"

namespace toile::internal {

std::vector<std::unique_ptr<Force>> forces_of(const OutfitRun& run) {
  std::vector<std::unique_ptr<Force>> forces;
  forces.push_back(std::make_unique<Air>(run.scene().air, [&run](double) { return run.wind_m_per_s(); }));
  return forces;
}

bool may_lift(const Scene& scene) {
  return scene.air.density_kg_per_m3 > 0 && (!scene.air.wind_m_per_s.isZero(0) || !scene.wind_path.empty());
}

}  // namespace toile::internal
