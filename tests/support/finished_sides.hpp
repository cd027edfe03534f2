// tests/support/finished_sides.hpp: hems and tapes on the long sides of a sheet.
#pragma once
#include "support/sheets.hpp"

namespace toile::internal::test {

// The edges of the lower long side (v = 0) of a sheet, and of the upper one if both are asked for.
inline void finish_sides(Sheet& sheet, double height_m, const FinishedEdge& finish, bool both) {
  for (const Triangle& t : sheet.mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = sheet.x[at(t[k])], &b = sheet.x[at(t[(k + 1) % 3])];
      const auto on = [&](double z) { return std::abs(a.z() - z) < 1e-12 && std::abs(b.z() - z) < 1e-12; };
      if (on(0) || (both && on(-height_m)))
        sheet.mesh.finished.push_back({t[k], t[(k + 1) % 3], finish.hem_m, finish.tape_m});
    }
  }
}

}  // namespace toile::internal::test
