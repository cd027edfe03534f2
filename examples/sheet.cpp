// A sheet from arrays, held by two corners, that a hand pulls.
#include <toile/simulation.hpp>

#include <cstdio>
#include <vector>

int main() {
  // 20 x 20 cells of 2 cm, level at a height of 1 m.
  std::vector<toile::Point> vertices_m;
  std::vector<toile::Face> faces;
  for (int j = 0; j <= 20; ++j)
    for (int i = 0; i <= 20; ++i) vertices_m.push_back({0.02 * i, 1, 0.02 * j});
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 20; ++i) {
      const int a = 21 * j + i;
      faces.push_back({a, a + 21, a + 1});
      faces.push_back({a + 1, a + 21, a + 22});
    }
  toile::Cloth cloth = toile::Cloth::from_arrays({.vertices_m = vertices_m, .faces = faces});
  cloth.set_fabric(toile::fabric("silk"));

  toile::Simulation sim(cloth);
  sim.pin(std::vector<std::int32_t>{0, 20});
  const int hand = sim.grab({.face = 799});
  for (int frame = 1; frame <= 60; ++frame) {
    const double t_s = frame / 60.0;
    sim.drag(hand, {0.4, 1 - 0.2 * t_s, 0.4 + 0.2 * t_s});
    if (const toile::StepReport step = sim.advance(1.0 / 60); !step.ok()) {
      std::fprintf(stderr, "%s\n", step.explain().c_str());
      return 1;
    }
  }
  sim.let_go(hand);
  const toile::Point& corner = sim.positions_m()[440];
  std::printf("after %.2f s the free corner is at (%.3f, %.3f, %.3f) m\n", sim.time_s(), corner[0], corner[1],
              corner[2]);
}
