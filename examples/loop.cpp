// A loop at 60 Hz around a body that the caller moves: what a game or a plug-in does every frame.
#include <toile/simulation.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  // A closed box of 20 cm, counter-clockwise from outside, whose vertices the caller moves.
  const auto box_at = [](double x_m) {
    std::vector<toile::Point> vertices_m;
    for (int k = 0; k < 8; ++k)
      vertices_m.push_back({x_m + ((k & 1) != 0 ? 0.1 : -0.1), (k & 2) != 0 ? 0.1 : -0.1, (k & 4) != 0 ? 0.1 : -0.1});
    return vertices_m;
  };
  const std::vector<toile::Face> faces{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  toile::Cloth sheet = toile::Cloth::grid({.width_m = 0.4, .height_m = 0.4, .edge_m = 0.04});
  sheet.place({0, 0.11, 0}, {-90, 0, 0});
  toile::Body body = toile::Body::from_arrays(box_at(0), faces);
  body.set_friction(0.6);

  toile::Simulation sim(sheet, body, {.threads = 1});
  for (int frame = 1; frame <= 120; ++frame) {
    const double t_s = frame / 60.0;
    sim.set_body(box_at(0.05 * (1 - std::cos(3 * t_s))));
    if (const toile::StepReport step = sim.advance(1.0 / 60); !step.ok()) {
      std::fprintf(stderr, "frame %d: %s\n", frame, step.explain().c_str());
      return 1;
    }
    // draw(sim.positions_m(), sim.faces());    views into the simulation: no copy, valid until the next call
  }
  const toile::Crossings crossings = sim.crossings();
  std::printf("%.2f s; %d edges cross the body, %d the cloth itself\n", sim.time_s(), crossings.cloth_body_edges,
              crossings.cloth_cloth_edges);
  return crossings.cloth_body_edges + crossings.cloth_cloth_edges;
}
