// tests/support/fabrics.hpp: fabrics for tests against closed forms.
#pragma once
#include "material/fabric.hpp"

namespace toile::internal::test {

// As stiff in compression as in tension: orders of accuracy, modes and momenta are stated for an energy without a kink.
inline Fabric linear_cotton() {
  Fabric fabric;
  fabric.compression_ratio = 1;
  return fabric;
}

}  // namespace toile::internal::test
