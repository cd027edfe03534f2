// garment/pattern_summary.cpp: the figures of a sewing pattern that `toile check` prints.
//
// Areas are those of the outline sampled at about 1 mm (shoelace formula); lengths are arc lengths, not chords.
//
// Easily got wrong: an outline may run clockwise; its signed area is then negative and its area is not.
#include "garment/pattern_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

std::string count_text(int count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace

PatternSummary summarize(const Pattern& pattern) {
  PatternSummary summary;
  summary.name = pattern.name;
  summary.stitches = static_cast<int>(pattern.stitches.size());
  summary.legacy_frame = pattern.legacy_frame;
  summary.box_min_m.setConstant(std::numeric_limits<double>::infinity());
  summary.box_max_m.setConstant(-std::numeric_limits<double>::infinity());

  std::vector<std::vector<double>> lengths(pattern.panels.size());
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    PanelSummary figures;
    figures.name = panel.name;
    figures.edges = static_cast<int>(panel.edges.size());
    const Mat3 rotation = panel.rotation();
    double twice_area = 0;
    for (const PanelEdge& edge : panel.edges) {
      const double length = edge_length_m(panel, edge);
      lengths[p].push_back(length);
      figures.outline_m += length;
      const int pieces =
          edge.kind == CurveKind::line ? 1 : static_cast<int>(std::clamp(std::ceil(1000 * length), 8.0, 4096.0));
      const std::vector<Vec2> points = sample_edge(panel, edge, pieces);
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        twice_area += points[k].x() * points[k + 1].y() - points[k + 1].x() * points[k].y();
        const Vec3 placed = rotation * Vec3{points[k].x(), points[k].y(), 0} + panel.translation_m;
        summary.box_min_m = summary.box_min_m.cwiseMin(placed);
        summary.box_max_m = summary.box_max_m.cwiseMax(placed);
      }
    }
    figures.area_m2 = 0.5 * std::abs(twice_area);
    figures.clockwise = twice_area < 0;
    summary.area_m2 += figures.area_m2;
    summary.panels.push_back(std::move(figures));
  }

  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    const Stitch& stitch = pattern.stitches[s];
    const double a = lengths[at(stitch.a.panel)][at(stitch.a.edge)], b = lengths[at(stitch.b.panel)][at(stitch.b.edge)];
    const double ratio = std::max(a, b) / std::min(a, b);
    summary.seam_m += std::max(a, b);
    ++summary.panels[at(stitch.a.panel)].stitched_edges;
    ++summary.panels[at(stitch.b.panel)].stitched_edges;
    if (ratio > PatternLimits::eased_ratio) ++summary.eased_stitches;
    if (summary.longest_ratio_stitch < 0 || ratio > summary.longest_ratio) {
      summary.longest_ratio = ratio;
      summary.longest_ratio_stitch = static_cast<Index>(s);
    }
    if (is_dart(pattern, stitch)) ++summary.darts;
  }

  if (pattern.units_assumed) summary.notes.push_back("the file names no units_in_meter: 100 (centimetres) assumed");
  if (pattern.legacy_frame) {
    summary.notes.push_back("placed in the frame of the 2021 templates, with the pelvis near y = 0");
  }
  const auto loose = static_cast<int>(std::count_if(summary.panels.begin(), summary.panels.end(),
                                                    [](const PanelSummary& p) { return p.stitched_edges == 0; }));
  if (loose > 0) summary.notes.push_back(count_text(loose, "panel is", "panels are") + " sewn to nothing");
  if (summary.eased_stitches > 0) {
    summary.notes.push_back(count_text(summary.eased_stitches, "seam joins", "seams join") +
                            " edges whose lengths differ by more than 2 % (ease or gathers)");
  }
  return summary;
}

}  // namespace toile::internal
