// A sheet on a smooth ball and a rough table that is lifted towards it.
#include <toile/simulation.hpp>

#include <cstdio>
#include <vector>

int main() {
  const std::vector<toile::BodyKey> up{{.t_s = 0}, {.t_s = 1, .shift_m = {0, 0.1, 0}}};
  toile::Body table = toile::Body::box({1, 0.1, 1});
  table.place({0, -0.4, 0}).set_moves(up).set_friction(0.8);
  toile::Body ball = toile::Body::sphere(0.15);
  ball.set_friction(0.1).set_offset(0.004);

  toile::Cloth sheet = toile::Cloth::grid({.width_m = 0.5, .height_m = 0.5, .edge_m = 0.025});
  sheet.place({0, 0.165, 0}, {-90, 0, 0});
  const std::vector<toile::Cloth> cloths{sheet};
  const std::vector<toile::Body> solids{table, ball};
  toile::Simulation sim(cloths, toile::Body::none(), solids);

  for (int frame = 0; frame < 60; ++frame)
    if (const toile::StepReport step = sim.advance(1.0 / 30); !step.ok()) {
      std::printf("%s\n", step.explain().c_str());
      return 1;
    }
  std::printf("%d edges pass through a solid; the table's first corner is at %.3f m\n",
              sim.crossings().cloth_body_edges, sim.collider_positions_m(0)[0][1]);
  return sim.crossings().cloth_body_edges == 0 ? 0 : 1;
}
