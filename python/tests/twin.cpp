// The scene of test_same_bits.py by the C++ library; prints its hash.
#include <toile/simulation.hpp>

#include <cstdio>

int main() {
  toile::Cloth cloth = toile::Cloth::grid({.width_m = 0.32, .height_m = 0.32, .edge_m = 0.04});
  cloth.set_fabric(toile::fabric("wool")).place({0.01, 0.02, 0}, {-90, 0, 0});
  toile::Body body = toile::Body::cylinder({.radius_m = 0.08, .height_m = 0.2, .top_m = {0, 0, 0}});
  body.set_friction(0.2);
  toile::Simulation sim(cloth, body);
  const std::int32_t corner = 0;
  sim.pin({&corner, 1});
  toile::Simulation::Grip grip;
  grip.face = 7;
  grip.barycentric = {0.25, 0.25, 0.5};
  const int hand = sim.grab(grip);
  for (int k = 0; k < 6; ++k) {
    sim.drag(hand, {0.1, 0.05 + 0.01 * k, 0.1});
    if (!sim.advance(1.0 / 30).ok()) return 1;
  }
  std::puts(sim.state_hash().c_str());
}
