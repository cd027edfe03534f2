// garment/lint_flips.cpp: panels whose normal points the wrong way.
//
// The panels that a panel is sewn to lie behind it: the garment closes around a body, and the panel's right side faces away from it.
//
//   out = sum over seams  length (m' - m) . n / sum over seams  length |(m' - m) . n|     m, m': middles of its edge and of the other's, n: its normal
//
// is -1 for a front whose back hangs behind it, positive for one that faces inward.  That alone is weak
// evidence: collars fall over, ruffles lie flat.  So a panel counts as flipped only if its seams would also fit clearly better turned:
//
//   the outline the other way round     ends of seams are paired the other way
//   half a turn about its vertical      left and right change places
//
// Of 638 panels of 85 patterns that are good, 51 have out > 0.25 (collars that fall over), and seams that get at most 1.02 times nearer by it.
#include "core/disjoint_sets.hpp"
#include "garment/lint_context.hpp"
#include "garment/seam_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

constexpr double inward = 0.25;          // a panel with a larger `out` faces inward
constexpr double clearly_nearer = 1.15;  // seams as placed / seams turned
constexpr int least_seams = 2;           // to other panels: one seam alone does not determine how a panel lies

struct Fit {
  int seams = 0, twisted = 0;
  double as_placed_m = 0, other_way_m = 0;
  std::array<double, 2> turned_m{0, 0};  // about x = 0, and about the middle of the panel
  double middle_x = 0;
  double toward = 0, distance = 0;  // sums of `out`
};

Vec3 normal_of(const Panel& panel) {
  double twice_area = 0;
  for (const PanelEdge& edge : panel.edges) {
    const std::vector<Vec2> p = sample_edge(panel, edge, edge.kind == CurveKind::line ? 1 : 8);
    for (std::size_t k = 0; k + 1 < p.size(); ++k) twice_area += p[k].x() * p[k + 1].y() - p[k + 1].x() * p[k].y();
  }
  return (twice_area < 0 ? -1.0 : 1.0) * panel.rotation().col(2);
}

void add_seam(Fit& fit, const LintContext& context, const Stitch& stitch, const StitchSide& mine,
              const StitchSide& theirs, const Vec3& normal) {
  const Pattern& pattern = context.pattern;
  const Panel &panel = pattern.panels[at(mine.panel)], &other = pattern.panels[at(theirs.panel)];
  const PanelEdge &edge = panel.edges[at(mine.edge)], &partner = other.edges[at(theirs.edge)];
  const Vec2 p0 = panel.corners[at(edge.start)], p1 = panel.corners[at(edge.end)];
  const Vec3 b0 = other.place(other.corners[at(stitch.right_wrong ? partner.start : partner.end)]);
  const Vec3 b1 = other.place(other.corners[at(stitch.right_wrong ? partner.end : partner.start)]);
  const Vec3 a0 = panel.place(p0), a1 = panel.place(p1);
  const double as_placed = (a0 - b0).norm() + (a1 - b1).norm(), other_way = (a0 - b1).norm() + (a1 - b0).norm();
  ++fit.seams;
  if (as_placed > other_way) ++fit.twisted;
  fit.as_placed_m += as_placed;
  fit.other_way_m += other_way;
  for (std::size_t k = 0; k < 2; ++k) {
    const double twice_axis = k == 0 ? 0 : 2 * fit.middle_x;
    const auto turned = [&](const Vec2& p) { return panel.place({twice_axis - p.x(), p.y()}); };
    fit.turned_m[k] += (turned(p0) - b0).norm() + (turned(p1) - b1).norm();
  }
  const Vec3 apart = other.place(sample_edge(other, partner, 2)[1]) - panel.place(sample_edge(panel, edge, 2)[1]);
  fit.toward += context.edge_m(mine) * apart.dot(normal);
  fit.distance += context.edge_m(mine) * std::abs(apart.dot(normal));
}

std::vector<Fit> fits_of(const LintContext& context) {
  const Pattern& pattern = context.pattern;
  std::vector<Fit> fits(pattern.panels.size());
  std::vector<Vec3> normal(fits.size(), Vec3::Zero());
  Pattern sewn;  // the stitches that can be checked, for the sides of panels
  sewn.panels.resize(fits.size());
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s)
    if (context.fitted[s]) sewn.stitches.push_back(pattern.stitches[s]);
  const PanelSides sides = panel_sides(sewn);
  for (std::size_t p = 0; p < fits.size(); ++p) {
    if (!context.sound[p]) continue;
    const Panel& panel = pattern.panels[p];
    normal[p] = sides.side[p] * normal_of(panel);
    const auto [left, right] = std::minmax_element(panel.corners.begin(), panel.corners.end(),
                                                   [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); });
    fits[p].middle_x = 0.5 * (left->x() + right->x());
  }
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    const Stitch& stitch = pattern.stitches[s];
    if (!context.fitted[s] || stitch.a.panel == stitch.b.panel) continue;
    add_seam(fits[at(stitch.a.panel)], context, stitch, stitch.a, stitch.b, normal[at(stitch.a.panel)]);
    add_seam(fits[at(stitch.b.panel)], context, stitch, stitch.b, stitch.a, normal[at(stitch.b.panel)]);
  }
  // In every component of sewn panels the first panel defines the right side; most panels face outward.
  DisjointSets sets(fits.size());
  for (const Stitch& stitch : sewn.stitches) sets.join(stitch.a.panel, stitch.b.panel);
  const std::vector<Index> piece = sets.representatives();
  std::vector<double> toward(fits.size(), 0);
  for (std::size_t p = 0; p < fits.size(); ++p) toward[at(piece[p])] += fits[p].toward;
  for (std::size_t p = 0; p < fits.size(); ++p)
    if (toward[at(piece[p])] > 0) fits[p].toward *= -1;
  return fits;
}

void explain(LintContext& context, Index index, const Fit& fit) {
  const Panel& panel = context.pattern.panels[at(index)];
  const std::size_t axis = fit.turned_m[1] < fit.turned_m[0] * (1 - 1e-9) ? 1 : 0;
  const double turned = fit.turned_m[axis], best = std::min(turned, fit.other_way_m);
  bool refused = false;  // a seam is twisted so much that `dress` refuses it
  for (std::size_t s = 0; s < context.fitted.size(); ++s) {
    const Stitch& stitch = context.pattern.stitches[s];
    if (!context.fitted[s] || (stitch.a.panel != index && stitch.b.panel != index)) continue;
    if (const auto ends = seam_ends(context.pattern, stitch); ends && ends->twisted()) refused = true;
    context.fitted[s] = 0;  // explained by this
  }
  LintProblem& problem = context.add(
      reason::panel_flipped, refused ? Severity::error : Severity::warning, *context.reading.sources[at(index)].panel,
      "panel \"" + printable(panel.name) + "\"", "a right side that looks away from the body, as its neighbours' do",
      "one that looks inward; turned, the ends of its seams are " + cm_text(0.5 * best / fit.seams) +
          " apart instead of " + cm_text(0.5 * fit.as_placed_m / fit.seams));
  problem.finding.marks = {context.mark_panel(index)};
  if (std::max(turned, fit.other_way_m) < clearly_nearer * best) {
    problem.finding.repair = "refused: its outline may run the wrong way round, or it may hang the wrong way round";
    return;
  }
  if (fit.other_way_m < turned) {
    problem.finding.repair = "its outline is turned round";
    std::vector<Index> numbers, order;
    for (const PanelEdge& edge : panel.edges) numbers.push_back(edge.file_number);
    order.push_back(numbers.front());
    order.insert(order.end(), numbers.rbegin(), numbers.rend() - 1);
    problem.mend = [name = panel.name, numbers, order](PatternRepair& repair) {
      for (const Index number : numbers) repair.reverse_edge(name, number);
      repair.reorder_edges(name, order);
    };
    return;
  }
  problem.finding.repair = "turned by half a turn about its vertical";
  problem.mend = [name = panel.name, rotation = panel.rotation(), units = context.pattern.units_in_meter,
                  x = axis == 0 ? 0.0 : fit.middle_x](PatternRepair& repair) {
    repair.turn_panel(name, x * units, rotation);
  };
}

}  // namespace

void lint_flips(LintContext& context) {
  const std::vector<Fit> fits = fits_of(context);
  for (std::size_t p = 0; p < fits.size(); ++p) {
    const Fit& fit = fits[p];
    if (fit.seams < least_seams || !(fit.toward > inward * fit.distance)) continue;
    const double best = std::min({fit.other_way_m, fit.turned_m[0], fit.turned_m[1]});
    if (fit.as_placed_m > clearly_nearer * best) explain(context, static_cast<Index>(p), fit);
  }
}

}  // namespace toile::internal
