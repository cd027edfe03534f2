// A square sheet and a block as arrays, for tests of the library.
#pragma once
#include "toile/cloth.hpp"

#include <vector>

namespace toile::test {

struct Arrays {
  std::vector<Point> vertices_m;
  std::vector<Face> faces;
};

// Level at `height_m`, its middle over the origin, facing up; cells of edge_m.
inline Arrays level_sheet(int cells, double edge_m, double height_m) {
  Arrays sheet;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      sheet.vertices_m.push_back({(i - 0.5 * cells) * edge_m, height_m, (j - 0.5 * cells) * edge_m});
  const int row = cells + 1;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int a = j * row + i, b = a + 1, c = a + row, d = c + 1;
      sheet.faces.push_back({a, c, b});
      sheet.faces.push_back({b, c, d});
    }
  return sheet;
}

// A closed box about `middle`, counter-clockwise from outside.
inline Arrays box(const Point& middle, double half_m) {
  Arrays made;
  for (int k = 0; k < 8; ++k)
    made.vertices_m.push_back({middle[0] + ((k & 1) != 0 ? half_m : -half_m),
                               middle[1] + ((k & 2) != 0 ? half_m : -half_m),
                               middle[2] + ((k & 4) != 0 ? half_m : -half_m)});
  made.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return made;
}

}  // namespace toile::test
