// garment/lint_openings.cpp: is there a way into the garment, and through it for head, hands and feet?
//
// Nothing is an error here: cloth stretches, laces and zips exist.  Girths are those of open edges (boundary.hpp); a slit
// is part of the opening it begins at, so a cuff with one is as wide as it opens.
#include "garment/lint_context.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

// Girths of an adult 1.70 m tall, m, scaled by the height for another body: about the 5th percentiles of women.
constexpr double adult_m = 1.70;
constexpr double head_m = 0.55;  // around the forehead
constexpr double hand_m = 0.20;  // around the knuckles, the thumb laid in
constexpr double foot_m = 0.31;  // around heel and instep
constexpr double hips_m = 0.85;
// How much longer an edge gets when it is pulled over: a knitted neckline about 25 %, an elastic waistband 40 %.
constexpr double knit_stretch = 1.25, elastic_stretch = 1.4;
// Cloth that closes around a trunk has more than this; hats, cuffs and stockings have less.
constexpr double trunk_area_m2 = 0.3;
// An opening lies around the axis of the garment when its middle is this near to it, as a part of its width: a leg's is half a width away.
constexpr double around_axis = 0.25, at_axis = 0.75;

bool has_label(const Pattern& pattern, const Opening& opening, std::string_view label) {
  return std::any_of(opening.edges.begin(), opening.edges.end(),
                     [&](const StitchSide& side) { return pattern.panels[at(side.panel)].label == label; });
}

class OpeningLint {
 public:
  OpeningLint(LintContext& context, Index piece)
      : context_(context),
        boundary_(*context.boundary),
        piece_(boundary_.pieces[at(piece)]),
        wearing_(find_wearing(context.pattern, boundary_, piece)),
        index_(piece),
        scale_(context.body ? context.body->height_m() / adult_m : 1) {}

  void run() {
    const auto largest = std::max_element(boundary_.openings.begin(), boundary_.openings.end(),
                                          [&](const Opening& a, const Opening& b) { return girth(a) < girth(b); });
    if (largest == boundary_.openings.end() || largest->piece != index_) {
      LintProblem& problem = add(reason::no_way_in, nullptr, "an opening", "cloth that is closed all round");
      problem.finding.repair = "refused: which seam is to stay open is not known";
      return;
    }
    if (piece_.area_m2 < trunk_area_m2 * scale_ * scale_) return;
    const double hips =
        context_.body && context_.body->hips_girth_m > 0 ? context_.body->hips_girth_m : hips_m * scale_;
    if (largest->girth_m < hips / elastic_stretch) {
      add(reason::no_way_in, &*largest,
          "an opening of at least " + cm_text(hips / elastic_stretch) + " for the hips, or a slit",
          "none larger than " + cm_text(largest->girth_m));
    } else {
      check_top();
    }
    check_ends(wearing_.hands, reason::no_way_for_hand, hand_m * scale_ / knit_stretch, "a hand");
    check_ends(wearing_.feet, reason::no_way_for_foot, foot_m * scale_ / knit_stretch, "a heel");
    check_closed("arm", reason::no_way_for_hand, "sleeve");
    check_closed("leg", reason::no_way_for_foot, "leg");
  }

 private:
  double girth(const Opening& opening) const { return opening.piece == index_ ? opening.girth_m : -1; }

  LintProblem& add(std::string_view code, const Opening* opening, std::string expected, std::string got) {
    const Index panel = opening == nullptr ? piece_.panels.front() : opening->edges.front().panel;
    std::string place = opening == nullptr
                            ? "the panels sewn to \"" + printable(context_.pattern.panels[at(panel)].name) + '"'
                            : "the opening with " + context_.edge_name(opening->edges.front());
    LintProblem& problem = context_.add(code, Severity::warning, *context_.reading.sources[at(panel)].panel,
                                        std::move(place), std::move(expected), std::move(got));
    if (opening == nullptr) {
      problem.finding.marks = {context_.mark_panel(panel)};
    } else {
      for (const StitchSide& side : opening->edges)
        problem.finding.marks.push_back(context_.mark_edge(side.panel, side.edge));
    }
    problem.finding.repair = "refused: how wide it is meant is not known";
    return problem;
  }

  void check_top() {
    const Opening* top = wearing_.top < 0 ? nullptr : &boundary_.openings[at(wearing_.top)];
    if (top == nullptr || top->high_m.y() < piece_.middle_m.y()) {
      LintProblem& problem = add(wearing_.has_arms ? reason::no_way_for_head : reason::no_way_in, nullptr,
                                 "an opening in its upper half", "none: it is closed at its top");
      problem.finding.repair = "refused: which seam is to stay open is not known";
      return;
    }
    const double head =
        (context_.body && context_.body->head_girth_m > 0 ? context_.body->head_girth_m : head_m * scale_) /
        knit_stretch;
    if (top->girth_m < head)
      add(reason::no_way_for_head, top, "an opening of at least " + cm_text(head) + " for a head, or a slit",
          cm_text(top->girth_m));
  }

  void check_ends(const std::vector<Index>& ends, std::string_view code, double least_m, const char* what) {
    for (const Index one : ends) {
      const Opening& end = boundary_.openings[at(one)];
      if (end.girth_m >= least_m) continue;
      const bool left = end.middle_m.x() > piece_.middle_m.x();
      if (std::any_of(ends.begin(), ends.end(), [&](Index other) {  // a hole beside the way out
            const Opening& o = boundary_.openings[at(other)];
            return other != one && (o.middle_m.x() > piece_.middle_m.x()) == left && o.girth_m >= least_m;
          }))
        continue;
      add(code, &end, "an opening of at least " + cm_text(least_m) + " for " + what + ", or a slit",
          cm_text(end.girth_m));
    }
  }

  // Sleeves and trouser legs without an open edge, in patterns with labelled panels.
  void check_closed(std::string_view label, std::string_view code, const char* what) {
    for (const bool left : {true, false}) {
      Index closed = -1;  // the one farthest out
      double farthest = 0;
      bool open = false;
      const auto middle_on_side = [&](Index p) {  // 0: of another kind, or not on this side
        const Panel& panel = context_.pattern.panels[at(p)];
        if (panel.label != label) return 0.0;
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Vec2& corner : panel.corners) {
          low = std::min(low, panel.place(corner).x() - piece_.middle_m.x());
          high = std::max(high, panel.place(corner).x() - piece_.middle_m.x());
        }
        const double middle = 0.5 * (low + high);
        const bool beside = std::abs(middle) > around_axis * (high - low) && (middle > 0) == left;
        return beside ? std::abs(middle) : 0.0;
      };
      for (const Index p : piece_.panels) {
        const double middle = middle_on_side(p);
        if (middle <= farthest) continue;
        farthest = middle;
        closed = p;
      }
      for (const Opening& opening : boundary_.openings)
        for (const StitchSide& side : opening.edges) open = open || middle_on_side(side.panel) > 0;
      if (closed < 0 || open) continue;
      LintProblem& problem =
          add(code, nullptr, std::string("an opening at the end of the ").append(what),
              std::string("none: the ").append(left ? "left " : "right ").append(what) + " is closed");
      problem.finding.marks = {context_.mark_panel(closed)};
      problem.finding.place = "panel \"" + printable(context_.pattern.panels[at(closed)].name) + '"';
      problem.finding.repair = "refused: which seam is to stay open is not known";
    }
  }

  LintContext& context_;
  const Boundary& boundary_;
  const GarmentPiece& piece_;
  const Wearing wearing_;
  const Index index_;
  const double scale_;
};

}  // namespace

Wearing find_wearing(const Pattern& pattern, const Boundary& boundary, Index piece) {
  Wearing wearing;
  wearing.piece = piece;
  // Three estimates of the axis, each of which may be wrong: the frame's, the middle of the cloth (with a skirt that is drawn beside), and
  // the median of the panels (with one sleeve).
  const GarmentPiece& mine = boundary.pieces[at(piece)];
  std::vector<double> middles;
  for (const Index p : mine.panels) {
    const Panel& panel = pattern.panels[at(p)];
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec2& corner : panel.corners) {
      low = std::min(low, panel.place(corner).x());
      high = std::max(high, panel.place(corner).x());
    }
    middles.push_back(0.5 * (low + high));
  }
  std::sort(middles.begin(), middles.end());
  const double median = 0.5 * (middles[middles.size() / 2] + middles[(middles.size() - 1) / 2]);
  Index highest = -1;
  for (std::size_t k = 0; k < boundary.openings.size(); ++k)
    if (boundary.openings[k].piece == piece &&
        (highest < 0 || boundary.openings[k].middle_m.y() > boundary.openings[at(highest)].middle_m.y()))
      highest = static_cast<Index>(k);
  std::vector<Index> beside;
  for (std::size_t k = 0; k < boundary.openings.size(); ++k) {
    const Opening& opening = boundary.openings[k];
    if (opening.piece != piece) continue;
    const double width = opening.high_m.x() - opening.low_m.x();
    const double aside = std::min({std::abs(opening.middle_m.x()), std::abs(opening.middle_m.x() - mine.middle_m.x()),
                                   std::abs(opening.middle_m.x() - median)});
    // Half of a neckline begins at the axis, as a leg does, but it is the highest opening.
    const bool around = aside <= around_axis * width || (static_cast<Index>(k) == highest && aside <= at_axis * width);
    (around ? wearing.around : beside).push_back(static_cast<Index>(k));
    if (!around) continue;
    if (wearing.top < 0 || opening.middle_m.y() > boundary.openings[at(wearing.top)].middle_m.y())
      wearing.top = static_cast<Index>(k);
  }
  // From below: without a hem, the lowest two are legs.
  std::sort(beside.begin(), beside.end(), [&](Index a, Index b) {
    const double ya = boundary.openings[at(a)].middle_m.y(), yb = boundary.openings[at(b)].middle_m.y();
    return ya != yb ? ya < yb : a < b;
  });
  std::size_t legs = 0;
  for (const Index k : beside) {
    const Opening& opening = boundary.openings[at(k)];
    const bool arm = has_label(pattern, opening, "arm"), leg = has_label(pattern, opening, "leg");
    const bool foot = leg || (!arm && wearing.around.size() < 2 && legs < 2);
    if (foot) ++legs;
    (foot ? wearing.feet : wearing.hands).push_back(k);
  }
  wearing.has_arms = !wearing.hands.empty() ||
                     std::any_of(boundary.pieces[at(piece)].panels.begin(), boundary.pieces[at(piece)].panels.end(),
                                 [&](Index p) { return pattern.panels[at(p)].label == "arm"; });
  return wearing;
}

void lint_openings(LintContext& context) {
  if (!context.boundary || context.unit_doubtful) return;
  for (std::size_t p = 0; p < context.boundary->pieces.size(); ++p) {
    const std::vector<Index>& panels = context.boundary->pieces[p].panels;
    // A garment with wrong seams opens in the wrong places.
    const bool wrong = std::any_of(context.problems.begin(), context.problems.end(), [&](const LintProblem& problem) {
      const LintFinding& finding = problem.finding;
      if (finding.severity != Severity::error && finding.code != reason::panel_flipped &&
          finding.code != reason::seam_wrong_edge && finding.code != reason::panel_far)
        return false;
      return std::any_of(finding.marks.begin(), finding.marks.end(), [&](const LintMark& mark) {
        return std::find(panels.begin(), panels.end(), mark.panel) != panels.end();
      });
    });
    if (!wrong) OpeningLint(context, static_cast<Index>(p)).run();
  }
}

}  // namespace toile::internal
