// The scene of test_same_bits.py by the C++ library: `twin` writes the state in the middle into twin.state and prints the hash of the end; `twin STATE`
// goes on from the state that Python left there.
#include <toile/simulation.hpp>

#include <cstdio>

namespace {

bool pull(toile::Simulation& sim, int hand, int first, int end) {
  for (int k = first; k < end; ++k) {
    sim.drag(hand, {0.1, 0.05 + 0.01 * k, 0.1});
    if (!sim.advance(1.0 / 30).ok()) return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  toile::Cloth cloth = toile::Cloth::grid({.width_m = 0.32, .height_m = 0.32, .edge_m = 0.04});
  cloth.set_fabric(toile::fabric("wool")).place({0.01, 0.02, 0}, {-90, 0, 0});
  toile::Body body = toile::Body::cylinder({.radius_m = 0.08, .height_m = 0.2, .top_m = {0, 0, 0}});
  body.set_friction(0.2);
  toile::Simulation sim(cloth, body);
  if (argc > 1) {
    sim.set_state(toile::State::load(argv[1]));
    if (!pull(sim, 0, 3, 6)) return 1;
    std::puts(sim.state_hash().c_str());
    return 0;
  }
  const std::int32_t corner = 0;
  sim.pin({&corner, 1});
  toile::Simulation::Grip grip;
  grip.face = 7;
  grip.barycentric = {0.25, 0.25, 0.5};
  const int hand = sim.grab(grip);
  if (!pull(sim, hand, 0, 3)) return 1;
  sim.state().save("twin.state");
  if (!pull(sim, hand, 3, 6)) return 1;
  std::puts(sim.state_hash().c_str());
}
