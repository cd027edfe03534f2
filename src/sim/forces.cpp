#include "sim/forces.hpp"

#include "assembly/air.hpp"
#include "assembly/pressure.hpp"
#include "sim/keyed.hpp"

#include <algorithm>

namespace toile::internal {
namespace {

// After a weld it grows as the pull of elastic does.
std::unique_ptr<Force> pressure_of(const OutfitRun& run) {
  const auto now = [&run](double t_s, std::span<double> panel_Pa) {
    for (const auto& [panel, own] : run.events().panels)
      panel_Pa[at(panel)] =
          run.grown() * (own.pressure_path.empty() ? own.pressure_Pa : along(own.pressure_path, &PressureKey::Pa, t_s));
  };
  return std::make_unique<Pressure>(now, run.model().mesh.panel_names.size());
}

bool is_inflated(const SceneCloth& cloth) {
  return std::any_of(cloth.panels.begin(), cloth.panels.end(),
                     [](const ScenePanel& panel) { return panel.pressure_Pa != 0 || !panel.pressure_path.empty(); });
}

}  // namespace

std::vector<std::unique_ptr<Force>> forces_of(const OutfitRun& run) {
  std::vector<std::unique_ptr<Force>> forces;
  forces.push_back(std::make_unique<Air>(run.scene().air, [&run](double) { return run.wind_m_per_s(); }));
  forces.push_back(pressure_of(run));
  return forces;
}

bool may_lift(const Scene& scene) {
  return (scene.air.density_kg_per_m3 > 0 && (!scene.air.wind_m_per_s.isZero(0) || !scene.wind_path.empty())) ||
         std::any_of(scene.cloth.begin(), scene.cloth.end(), is_inflated);
}

}  // namespace toile::internal
