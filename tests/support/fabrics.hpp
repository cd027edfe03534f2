// tests/support/fabrics.hpp: fabrics for tests against closed forms.
#pragma once
#include "material/fabric.hpp"

namespace toile::internal::test {

// Without friction in bending, which closed forms do not have; as rigid as cotton shows itself on a cantilever.
inline Fabric elastic_cotton() {
  Fabric fabric;
  fabric.bend_u_N_m = fabric.bend_v_N_m = 1.25e-5;
  fabric.bend_friction_N = 0;
  return fabric;
}

// As stiff in compression as in tension: orders of accuracy, modes and momenta are stated for an energy without a kink.
inline Fabric linear_cotton() {
  Fabric fabric = elastic_cotton();
  fabric.compression_ratio = 1;
  return fabric;
}

}  // namespace toile::internal::test
