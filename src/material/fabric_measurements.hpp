// material/fabric_measurements.hpp: what a textile laboratory says of a cloth, in SI.                  docs/howto/fit-fabric.md
//
// Readings are empty where there are none.
#pragma once
#include "material/readings.hpp"

#include <array>
#include <string>
#include <vector>

namespace toile::internal {

struct ThreadMeasurements {
  Readings cantilever_m;                                    // bending length
  Readings fast_bending_m, fast_bending_N_m;                // bending length; rigidity
  std::array<Readings, 3> fast_extension;                   // at laboratory::fast_loads_N_per_m
  Readings kes_bending_N_m, kes_hysteresis_N;               // B; 2HB
  Readings kes_extension, kes_linearity, kes_work_N_per_m;  // EMT; with it LT or WT
  std::vector<std::array<double, 2>> curve;                 // strain, force per width; both ascend from above zero
};

struct FabricMeasurements {
  std::string name, base = "cotton";
  Readings weight_kg_per_m2, thickness_m, friction;
  Readings drape;  // Cusick's coefficient of a disc of 30 cm on one of 18 cm, 0 to 1
  ThreadMeasurements warp, weft;
  Readings bias_cantilever_m;
  Readings fast_bias_extension;  // at the first of the loads
  Readings kes_shear_N_per_m, kes_shear_hysteresis_N_per_m;
  std::array<double, 2> chord_N_per_m = {10, 50};  // force per width that garments carry
};

}  // namespace toile::internal
