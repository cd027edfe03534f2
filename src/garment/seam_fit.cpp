#include "garment/seam_fit.hpp"

#include "garment/pattern_check.hpp"

namespace toile::internal {
std::optional<SeamEnds> seam_ends(const Pattern& pattern, const Stitch& stitch) {
  if (is_dart(pattern, stitch)) return std::nullopt;
  const Panel &panel_a = pattern.panels[at(stitch.a.panel)], &panel_b = pattern.panels[at(stitch.b.panel)];
  const PanelEdge &a = panel_a.edges[at(stitch.a.edge)], &b = panel_b.edges[at(stitch.b.edge)];
  const auto corner = [](const Panel& panel, Index c) { return panel.place(panel.corners[at(c)]); };
  const Vec3 a0 = corner(panel_a, a.start), a1 = corner(panel_a, a.end);
  const Vec3 b0 = corner(panel_b, stitch.right_wrong ? b.start : b.end),
             b1 = corner(panel_b, stitch.right_wrong ? b.end : b.start);
  return SeamEnds{(a0 - b0).norm() + (a1 - b1).norm(), (a0 - b1).norm() + (a1 - b0).norm()};
}

PanelSides panel_sides(const Pattern& pattern) {
  PanelSides sides;
  sides.side.assign(pattern.panels.size(), 0);  // 0: not reached
  std::vector<std::vector<Index>> stitches_of(pattern.panels.size());
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    stitches_of[at(pattern.stitches[s].a.panel)].push_back(static_cast<Index>(s));
    stitches_of[at(pattern.stitches[s].b.panel)].push_back(static_cast<Index>(s));
  }
  std::vector<Index> reached;
  for (std::size_t start = 0; start < sides.side.size(); ++start) {
    if (sides.side[start] != 0) continue;
    sides.side[start] = 1;
    reached.assign(1, static_cast<Index>(start));
    for (std::size_t k = 0; k < reached.size(); ++k) {
      for (const Index s : stitches_of[at(reached[k])]) {
        const Stitch& stitch = pattern.stitches[at(s)];
        const Index here = reached[k], there = stitch.a.panel == here ? stitch.b.panel : stitch.a.panel;
        const int expected = (stitch.right_wrong ? -1 : 1) * sides.side[at(here)];
        if (sides.side[at(there)] == 0) {
          sides.side[at(there)] = expected;
          reached.push_back(there);
        } else if (sides.side[at(there)] != expected && (sides.conflict < 0 || s < sides.conflict)) {
          sides.conflict = s;
        }
      }
    }
  }
  return sides;
}

}  // namespace toile::internal
