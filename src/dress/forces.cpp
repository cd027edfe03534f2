#include "dress/forces.hpp"

#include "assembly/air.hpp"
#include "assembly/pressure.hpp"
#include "dress/keyed.hpp"

#include <algorithm>

namespace toile::internal {
namespace {

// After a weld it is ramped up like elastic.
std::unique_ptr<Force> pressure_of(const OutfitRun& run) {
  const auto now = [&run](double t_s, std::span<double> panel_Pa) {
    for (const auto& [panel, own] : run.events().panels)
      panel_Pa[at(panel)] =
          run.grown() * (own.pressure_path.empty() ? own.pressure_Pa : along(own.pressure_path, &PressureKey::Pa, t_s));
  };
  return std::make_unique<Pressure>(now, run.model().mesh.panel_names.size());
}

bool is_inflated(const TimedPanel& of) { return of.own.pressure_Pa != 0 || !of.own.pressure_path.empty(); }

}  // namespace

std::vector<std::unique_ptr<Force>> forces_of(const OutfitRun& run) {
  std::vector<std::unique_ptr<Force>> forces;
  forces.push_back(std::make_unique<Air>(run.options().air, [&run](double) { return run.wind_m_per_s(); }));
  forces.push_back(pressure_of(run));
  return forces;
}

bool may_lift(const OutfitRun& run) {
  const std::vector<TimedPanel>& panels = run.events().panels;
  return (run.options().air.density_kg_per_m3 > 0 && (!run.wind_m_per_s().isZero(0) || !run.events().wind.empty())) ||
         std::any_of(panels.begin(), panels.end(), is_inflated);
}

}  // namespace toile::internal
