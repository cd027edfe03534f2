// A square of silk, held at two corners, for half a second: arrays in, arrays out, nothing written.
#include <toile/simulation.hpp>

#include <algorithm>
#include <cstdio>

int main() {
  toile::Cloth cloth = toile::Cloth::grid({.width_m = 0.5, .height_m = 0.5, .edge_m = 0.05});
  cloth.set_fabric(toile::fabric("silk")).place({0, 1, 0}, {80, 0, 0});
  toile::Simulation simulation(cloth);

  // The two corners that are farthest back.
  const auto points = simulation.positions_m();
  const auto is_corner = [&](const toile::Point& p, double side) {
    return std::all_of(points.begin(), points.end(),
                       [&](const toile::Point& q) { return side * q[0] - q[2] <= side * p[0] - p[2] + 1e-9; });
  };
  std::vector<std::int32_t> corners;
  for (const double side : {-1.0, 1.0})
    for (std::size_t i = 0; i < points.size(); ++i)
      if (is_corner(points[i], side)) corners.push_back(static_cast<std::int32_t>(i));
  simulation.pin(corners);

  for (int frame = 0; frame < 15; ++frame) {
    const toile::StepReport step = simulation.advance(1.0 / 30);
    if (!step.ok()) {
      std::puts(step.explain().c_str());
      return 1;
    }
  }
  double lowest_m = 1;
  for (const toile::Point& p : simulation.positions_m()) lowest_m = std::min(lowest_m, p[1]);
  std::printf("%zu points, %zu of them held; after %.2f s the lowest is at %.3f m; state %s\n",
              simulation.positions_m().size(), corners.size(), simulation.time_s(), lowest_m,
              simulation.state_hash().c_str());
}
