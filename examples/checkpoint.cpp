// A state is kept, and gone on with to the same bits: here, and in a simulation that was made anew.
#include <toile/simulation.hpp>

#include <cstdio>

toile::Simulation make() {
  toile::Cloth sheet = toile::Cloth::grid({.width_m = 0.5, .height_m = 0.5, .edge_m = 0.04});
  sheet.place({0, 0.05, 0}, {-90, 0, 0});
  return toile::Simulation(sheet, toile::Body::cylinder({.radius_m = 0.1, .height_m = 0.3}));
}

std::string after_a_second(toile::Simulation& sim) {
  for (int frame = 0; frame < 30; ++frame) sim.advance(1.0 / 30);
  return sim.state_hash();
}

int main() {
  toile::Simulation sim = make();
  after_a_second(sim);
  const toile::State state = sim.state();
  state.save("falling.state");
  const std::string first = after_a_second(sim);

  sim.set_state(state);
  const std::string again = after_a_second(sim);

  toile::Simulation other = make();
  other.set_state(toile::State::load("falling.state"));
  const std::string elsewhere = after_a_second(other);

  std::printf("%s %s %s\n", first.c_str(), again.c_str(), elsewhere.c_str());
  return first == again && first == elsewhere ? 0 : 1;
}
