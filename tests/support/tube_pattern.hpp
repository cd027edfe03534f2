// tests/support/tube_pattern.hpp: two rectangles that face each other, sewn at both sides: a tube.
#pragma once
#include <fmt/printf.h>

#include <string>

namespace toile::internal::test {

// Rectangles of `width_cm` by `height_cm` in z = +-`z_cm`, their lower edges in y = `y_cm`.
inline std::string tube_pattern_text(int width_cm = 50, int height_cm = 20, int z_cm = 25, int y_cm = 0) {
  const int x = width_cm / 2, h = height_cm;
  return fmt::sprintf(R"({"pattern": {"panels": {
    "front": {"translation": [0, %d, %d], "rotation": [0, 0, 0], "vertices": [[-%d, 0], [%d, 0], [%d, %d], [-%d, %d]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]},
    "back": {"translation": [0, %d, -%d], "rotation": [0, 0, 0], "vertices": [[-%d, 0], [-%d, %d], [%d, %d], [%d, 0]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]}},
    "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}], [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 0}]]},
    "properties": {"units_in_meter": 100}})",
                      y_cm, z_cm, x, x, x, h, x, h, y_cm, z_cm, x, x, h, x, h, x);
}

}  // namespace toile::internal::test
