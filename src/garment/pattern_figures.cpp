#include "garment/pattern_figures.hpp"

#include "core/elementary.hpp"
#include "garment/lint_context.hpp"
#include "garment/placement.hpp"
#include "garment/sleeves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

// Of 60 random patterns on their own bodies, waists hang 0 to 1.0 cm above the waist and armholes 0.2 to 1.1 cm above the tips of the shoulders;
// on another of those three bodies, which differ by 6 to 13 cm in height, 3 cm or more off.
constexpr double height_agrees_m = 0.025;
// Cloth is cut to the waist or wider: 0.97 of it is the least of those 60.
constexpr double waist_agrees = 0.93;

template <class Labels>
bool is_among(std::string_view label, const Labels& labels) {
  return std::find(std::begin(labels), std::end(labels), label) != std::end(labels);
}

// [panel][edge] whether a stitch names it.
std::vector<std::vector<char>> sewn_edges(const Pattern& pattern) {
  std::vector<std::vector<char>> sewn;
  for (const Panel& panel : pattern.panels) sewn.emplace_back(panel.edges.size(), char{0});
  for (const Stitch& stitch : pattern.stitches)
    for (const StitchSide& side : {stitch.a, stitch.b}) sewn[at(side.panel)][at(side.edge)] = 1;
  return sewn;
}

// The ends of a line along the arm in the frontal plane: middles of edges, weighted by their length.
struct Middle {
  Vec2 sum{0, 0};
  double length_m = 0;
  void add(const Panel& panel, const PanelEdge& edge) {
    constexpr int pieces = 8;
    const double length = edge_length_m(panel, edge);
    Vec2 mean{0, 0};
    for (const Vec2& p : sample_edge(panel, edge, pieces)) {
      const Vec3 placed = panel.place(p);
      mean += Vec2(placed.x(), placed.y()) / (pieces + 1);
    }
    sum += length * mean;
    length_m += length;
  }
  Vec2 point() const { return sum / length_m; }
};

// The angle of a direction in the frontal plane below the horizontal, on this side of the body's middle.
double below_level_deg(const Vec2& direction, int side) {
  return -ieee_atan2(direction.y(), side * direction.x()) * 180 / std::numbers::pi;
}

// A sleeve is drawn along an axis of its panel, and the panel is turned onto the arm.  The line from armhole to hem only selects the axis: a cap that is
// higher on one side, or flares, turn it by up to 45 degrees.  A panel that is not turned may be drawn slanted, or for arms that are level.
constexpr double turned_deg = 1, slanted_deg = 30, highest_deg = -20, lowest_deg = 90;

double arm_angle_deg(const Panel& panel, int side, double hem_deg) {
  const Mat3 rotation = panel.rotation();
  const double axis_deg = below_level_deg(Vec2(rotation(0, 0), rotation(1, 0)), side);
  double nearest_deg = hem_deg;
  bool found = false, turned = false;
  for (int quarter = -4; quarter <= 4; ++quarter) {
    const double one_deg = axis_deg + 90 * quarter;
    turned = turned || (one_deg > turned_deg && one_deg < 90 - turned_deg);
    if (one_deg < highest_deg || one_deg > lowest_deg + 1e-9) continue;
    if (found && std::abs(one_deg - hem_deg) >= std::abs(nearest_deg - hem_deg)) continue;
    nearest_deg = one_deg;
    found = true;
  }
  return turned || std::abs(nearest_deg - hem_deg) < slanted_deg ? nearest_deg : hem_deg;
}

// [panel] 1: left sleeve, -1: right sleeve, 0: neither.
std::vector<int> sleeve_sides(const Pattern& pattern, const BodyFigures& body) {
  const bool labelled = std::any_of(pattern.panels.begin(), pattern.panels.end(),
                                    [](const Panel& panel) { return !panel.label.empty(); });
  std::vector<int> sides;
  for (const Panel& panel : pattern.panels) {
    Vec3 middle = Vec3::Zero();
    for (const Vec2& corner : panel.corners) middle += panel.place(corner) / static_cast<double>(panel.corners.size());
    const int side = middle.x() > body.middle_m.x() ? 1 : -1;
    bool is_sleeve = panel.label == "arm";
    if (!labelled && body.arm_roots_m) {
      const Vec3& root = (*body.arm_roots_m)[side > 0 ? 0 : 1];
      const double raised = pattern.legacy_frame ? body.low_m.y() + legacy_origin * body.height_m() : 0;
      is_sleeve = side * (middle.x() - root.x()) > 0 &&
                  std::abs(middle.y() + raised - root.y()) < near_an_arm * body.height_m();
    }
    sides.push_back(is_sleeve ? side : 0);
  }
  return sides;
}

}  // namespace

bool is_of_bodice(std::string_view label) {
  return label == edge_label::strapless_top || is_among(label, edge_label::collars) ||
         is_among(label, edge_label::armholes);
}

PatternFigures pattern_figures(const Pattern& pattern) {
  PatternFigures figures;
  const std::vector<std::vector<char>> sewn = sewn_edges(pattern);
  const auto raise = [](std::optional<double>& height, double y) { height = std::max(height.value_or(y), y); };
  double girth_m = 0;
  bool elastic = false;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    for (std::size_t e = 0; e < panel.edges.size(); ++e) {
      const PanelEdge& edge = panel.edges[e];
      const bool waist = edge.label == edge_label::waist;
      for (const Index corner : {edge.start, edge.end}) {
        const double y = panel.place(panel.corners[at(corner)]).y();
        if (waist && sewn[p][e] == 0) raise(figures.waist_m, y);
        if (is_among(edge.label, edge_label::armholes)) raise(figures.shoulder_m, y);
      }
      if (!waist) continue;
      girth_m += edge_length_m(panel, edge);
      elastic = elastic || panel.rest_stretch != Vec2(1, 1);
    }
  }
  if (girth_m > 0 && !elastic) figures.waist_girth_m = girth_m;
  return figures;
}

std::optional<double> sleeves_down_deg(const Pattern& pattern, const BodyFigures& body) {
  const std::vector<int> side_of = sleeve_sides(pattern, body);
  const std::vector<std::vector<char>> sewn = sewn_edges(pattern);
  std::vector<std::vector<char>> armhole;
  for (const Panel& panel : pattern.panels) armhole.emplace_back(panel.edges.size(), char{0});
  for (const Stitch& stitch : pattern.stitches)
    for (const auto& [here, there] : {std::pair{stitch.a, stitch.b}, std::pair{stitch.b, stitch.a}})
      if (side_of[at(there.panel)] == 0) armhole[at(here.panel)][at(here.edge)] = 1;
  double sum = 0;
  int count = 0;
  for (const int side : {1, -1}) {
    Middle root, hem;
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
      if (side_of[p] != side) continue;
      const Panel& panel = pattern.panels[p];
      for (std::size_t e = 0; e < panel.edges.size(); ++e) {
        if (armhole[p][e] != 0) root.add(panel, panel.edges[e]);
        if (sewn[p][e] == 0) hem.add(panel, panel.edges[e]);
      }
    }
    if (root.length_m == 0 || hem.length_m == 0) continue;
    const Vec2 along = hem.point() - root.point();
    if (along.norm() == 0) continue;
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
      if (side_of[p] != side) continue;
      sum += arm_angle_deg(pattern.panels[p], side, below_level_deg(along, side));
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

std::vector<Misfit> misfits(const Pattern& pattern, const BodyFigures& body) {
  const PatternFigures cut = pattern_figures(pattern);
  std::vector<Misfit> found;
  const auto height = [&](const std::optional<double>& drawn_m, const std::optional<double>& body_m, const char* what) {
    if (!drawn_m || !body_m) return;
    const double there_m = *body_m - body.low_m.y();
    if (std::abs(*drawn_m - there_m) > height_agrees_m)
      found.push_back({reason::other_body, std::string("a body with its ") + what + " at about " + cm_text(*drawn_m),
                       cm_text(there_m) + " above its feet"});
  };
  height(cut.waist_m, body.tape_waist_m, "waist");
  height(cut.shoulder_m, body.shoulder_m, "shoulders");
  if (cut.waist_girth_m && body.waist_girth_m > 0 && *cut.waist_girth_m < waist_agrees * body.waist_girth_m)
    found.push_back({reason::other_body, "a waist of at most " + cm_text(*cut.waist_girth_m / waist_agrees),
                     cm_text(body.waist_girth_m)});
  const std::optional<double> sleeves_deg = sleeves_down_deg(pattern, body);
  if (sleeves_deg && body.arm_down_deg && std::abs(*sleeves_deg - *body.arm_down_deg) > pose_agrees_deg)
    found.push_back({reason::other_pose,
                     "arms " + fixed_text(*sleeves_deg, 0) + " degrees below the level, as the sleeves are drawn",
                     "arms " + fixed_text(*body.arm_down_deg, 0) + " degrees below it"});
  return found;
}

}  // namespace toile::internal
