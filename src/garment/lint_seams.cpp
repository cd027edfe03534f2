// garment/lint_seams.cpp: does each stitch name two edges that fit, once, and the right way round?
//
//   cost of a seam = mean distance of its ends as placed + difference of its lengths
//
// A stitch is taken to name the wrong edge if an unsewn edge of equal length would cost much less.
#include "garment/lint_context.hpp"
#include "garment/seam_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

constexpr double same_length = 1.02;   // longer / shorter edge of a seam that is neither eased nor gathered
constexpr double other_length = 1.05;  // of one that does not fit
// The right edge costs less by this share of its length: the distance between front and back is part of both costs.
constexpr double cheaper_by = 0.3;
constexpr double misspelt_ratio =
    1.25;  // longer / shorter edge, where only the panel's name is wrong by at most half of its letters
constexpr double clearly_worse = 1.5;  // cost of the next best choice / of the best
// One of two seams that mirror each other is gathered and the other is not.
constexpr double gathered_from = 1.5, mirrored_ratio = 1.06;
// How far from the mirrored place one of a twin's edges may lie, and the other, which may have another length.
constexpr double mirror_near_m = 0.03, mirror_reach_m = 0.15;
constexpr std::size_t most_turned = 500;  // stitches, each turned in turn: the time goes with the square
constexpr double far_m = 2;               // between ends of a seam: more than a person is tall

// Edit distance between two names.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t corner = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = corner + (a[i - 1] == b[j - 1] ? 0 : 1);
      corner = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
    }
  }
  return row[b.size()];
}

class SeamLint {
 public:
  explicit SeamLint(LintContext& context) : context_(context), pattern_(context.pattern) {}

  void run() {
    for (std::size_t s = 0; s < pattern_.stitches.size(); ++s) check_missing(static_cast<Index>(s));
    const PatternFault* last = nullptr;
    for (const PatternFault& fault : context_.faults) {
      if (fault.part != PatternFault::Part::stitch || fault.code == reason::seam_missing) continue;
      // A stitch given twice is reported for one of its sides.
      if (last != nullptr && last->code == fault.code && last->index == fault.index && last->other == fault.other)
        continue;
      last = &fault;
      explain(fault);
    }
    for (std::size_t s = 0; s < pattern_.stitches.size(); ++s) check_wrong_edge(static_cast<Index>(s), nullptr);
    check_sides();
    for (std::size_t s = 0; s < pattern_.stitches.size(); ++s) check_twist(static_cast<Index>(s));
    find_middles();
    for (std::size_t s = 0; s < pattern_.stitches.size(); ++s) {
      check_far(static_cast<Index>(s));
      check_twin(static_cast<Index>(s));
    }
  }

 private:
  const Stitch& stitch(Index s) const { return pattern_.stitches[at(s)]; }
  const Json& json_of(Index s) const { return context_.reading.stitches->array()[at(s)]; }
  bool closed(Index panel) const { return panel >= 0 && context_.closed[at(panel)]; }

  std::string place_of_stitch(Index s) const {
    std::string place = "stitch " + std::to_string(s);
    for (const StitchSide& side : {stitch(s).a, stitch(s).b}) {
      if (side.edge < 0) continue;
      place += ", " + context_.edge_name(side);
      if (closed(side.panel)) place += " at " + point_cm(context_.mark_edge(side.panel, side.edge).at_m);
    }
    return place;
  }

  LintProblem& add(std::string_view code, Severity severity, Index s, std::string expected, std::string got) {
    LintProblem& problem =
        context_.add(code, severity, json_of(s), place_of_stitch(s), std::move(expected), std::move(got));
    for (const StitchSide& side : {stitch(s).a, stitch(s).b})
      if (side.edge >= 0) problem.finding.marks.push_back(context_.mark_edge(side.panel, side.edge));
    context_.fitted[at(s)] = 0;
    return problem;
  }

  // ---- does an edge fit? ----------------------------------------------------------------------------------------------

  double ratio(const StitchSide& a, const StitchSide& b) const {
    const double la = context_.edge_m(a), lb = context_.edge_m(b);
    return std::min(la, lb) > 0 ? std::max(la, lb) / std::min(la, lb) : std::numeric_limits<double>::infinity();
  }

  double cost(const StitchSide& a, const StitchSide& b, bool right_wrong) const {
    Stitch tried;
    tried.a = a;
    tried.b = b;
    tried.right_wrong = right_wrong;
    const auto ends = seam_ends(pattern_, tried);
    const double apart = ends ? 0.5 * ends->as_sewn_m : 0;
    return apart + std::abs(context_.edge_m(a) - context_.edge_m(b));
  }

  // The only unsewn edge of a panel that fits the other side of a stitch; -1: none, or several.
  Index fitting_edge(Index panel, const StitchSide& partner, bool right_wrong, double below_cost) const {
    if (!closed(panel) || partner.edge < 0 || !closed(partner.panel)) return -1;
    Index found = -1;
    double best = below_cost, next = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < pattern_.panels[at(panel)].edges.size(); ++e) {
      const StitchSide tried{panel, static_cast<Index>(e)};
      if (context_.sewn.contains({panel, tried.edge}) || (panel == partner.panel && tried.edge == partner.edge))
        continue;
      if (ratio(tried, partner) > same_length) continue;
      const double costs = cost(tried, partner, right_wrong);
      if (costs < best) {
        next = found >= 0 ? best : next;
        best = costs;
        found = tried.edge;
      } else {
        next = std::min(next, costs);
      }
    }
    return next > clearly_worse * best ? found : -1;
  }

  void mend_side(LintProblem& problem, Index s, int side, Index panel, Index edge) const {
    const Panel& named = pattern_.panels[at(panel)];
    const Index number = named.file_number(edge);
    problem.finding.repair = "sewn to edge " + std::to_string(number) + " of panel \"" + printable(named.name) +
                             "\", the only one free that fits";
    problem.finding.marks.push_back(context_.mark_edge(panel, edge));
    problem.mend = [s, side, name = named.name, number](PatternRepair& repair) {
      repair.set_side(s, side, name, number);
    };
  }

  // ---- stitches that name a missing edge, or one that is sewn already ---------------------------------------------------

  void check_missing(Index s) {
    for (int k = 0; k < 2; ++k) {
      const StitchSide &side = k == 0 ? stitch(s).a : stitch(s).b, &partner = k == 0 ? stitch(s).b : stitch(s).a;
      if (side.edge >= 0) continue;
      const Json& json = json_of(s).array()[at(k)];
      if (side.panel < 0) {
        const std::string& name = json.at("panel").string();
        std::vector<std::string_view> names;
        for (const Panel& panel : pattern_.panels) names.push_back(panel.name);
        const std::string_view nearest =
            nearest_name(std::string_view(name).substr(0, 100), names.data(), names.size());
        LintProblem& problem = context_.add(
            reason::seam_missing, Severity::error, json.at("panel"), place_of_stitch(s), "the name of a panel",
            '"' + printable(name) + '"' + (nearest.empty() ? "" : "; did you mean \"" + printable(nearest) + "\"?"));
        if (partner.edge >= 0) problem.finding.marks = {context_.mark_edge(partner.panel, partner.edge)};
        if (!nearest.empty()) mend_name(problem, s, k, partner, nearest, json);
        continue;
      }
      LintProblem& problem =
          context_.add(reason::seam_missing, Severity::error, json.at("edge"), place_of_stitch(s),
                       "an edge of panel \"" + printable(pattern_.panels[at(side.panel)].name) + "\", 0 to " +
                           std::to_string(static_cast<long long>(pattern_.panels[at(side.panel)].edges.size()) - 1),
                       json.at("edge").describe());
      if (partner.edge >= 0) problem.finding.marks = {context_.mark_edge(partner.panel, partner.edge)};
      const Index edge =
          fitting_edge(side.panel, partner, stitch(s).right_wrong, std::numeric_limits<double>::infinity());
      if (edge >= 0) {
        mend_side(problem, s, k, side.panel, edge);
      } else {
        problem.finding.repair = "refused: not exactly one edge of the panel is free and fits";
      }
    }
  }

  // A name that is misspelt: the nearest one is meant where the edge of that number is free and as long as the other.
  void mend_name(LintProblem& problem, Index s, int k, const StitchSide& partner, std::string_view nearest,
                 const Json& json) const {
    problem.finding.repair = "refused: no edge of that number that fits is free there";
    const auto found = std::find_if(pattern_.panels.begin(), pattern_.panels.end(),
                                    [&](const Panel& panel) { return panel.name == nearest; });
    const auto panel = static_cast<Index>(found - pattern_.panels.begin());
    const Json* number = json.find("edge");
    if (number == nullptr || !number->is_number() || !closed(panel)) return;
    const std::vector<Index>& place = context_.reading.sources[at(panel)].place_of_edge;
    const double value = number->number();
    if (!(value >= 0 && value < static_cast<double>(place.size()) && value == std::floor(value))) return;
    const StitchSide meant{panel, place[static_cast<std::size_t>(value)]};
    if (context_.sewn.contains({meant.panel, meant.edge}) || partner.edge < 0 || !closed(partner.panel) ||
        partner.panel == panel || ratio(meant, partner) > misspelt_ratio ||
        2 * edit_distance(std::string_view(json.at("panel").string()).substr(0, 100), nearest) > nearest.size())
      return;
    problem.finding.repair = "the panel is \"" + printable(nearest) + '"';
    problem.mend = [s, k, name = std::string(nearest), e = static_cast<Index>(value)](PatternRepair& repair) {
      repair.set_side(s, k, name, e);
    };
  }

  void explain(const PatternFault& fault) {
    if (fault.code == reason::seam_unequal && check_wrong_edge(fault.index, &fault)) return;
    LintProblem& problem = context_.add(fault, Severity::error);
    problem.finding.place = place_of_stitch(fault.index);
    if (fault.code == reason::seam_twice) mend_twice(fault, problem);
    if (fault.code == reason::seam_unequal)
      problem.finding.repair = "refused: which of the two lengths is meant is not known";
    if (fault.code == reason::seam_twisted) {
      problem.finding.repair = "\"right_wrong\" is taken away";
      problem.mend = [s = fault.index](PatternRepair& repair) { repair.turn_stitch(s); };
    }
  }

  void mend_twice(const PatternFault& fault, LintProblem& problem) {
    const Stitch &later = stitch(fault.index), &earlier = stitch(fault.other);
    const auto same = [](const StitchSide& x, const StitchSide& y) { return x.panel == y.panel && x.edge == y.edge; };
    if ((same(later.a, earlier.a) && same(later.b, earlier.b)) ||
        (same(later.a, earlier.b) && same(later.b, earlier.a))) {
      problem.finding.repair = "stitch " + std::to_string(fault.index) + " is taken out: stitch " +
                               std::to_string(fault.other) + " does the same";
      problem.mend = [s = fault.index](PatternRepair& repair) { repair.remove_stitch(s); };
      return;
    }
    problem.finding.repair = "refused: which of the two stitches is meant is not known";
    const StitchSide& edge = fault.side == 0 ? later.a : later.b;
    const bool is_a = same(earlier.a, edge);
    const StitchSide &of_later = fault.side == 0 ? later.b : later.a, &of_earlier = is_a ? earlier.b : earlier.a;
    if (!closed(edge.panel) || !closed(of_later.panel) || !closed(of_earlier.panel)) return;
    if (of_later.edge < 0 || of_earlier.edge < 0) return;
    const double cost_later = cost(edge, of_later, later.right_wrong);
    const double cost_earlier = cost(edge, of_earlier, earlier.right_wrong);
    if (std::max(cost_later, cost_earlier) < clearly_worse * std::min(cost_later, cost_earlier)) return;
    const bool later_wrong = cost_later > cost_earlier;
    const Index wrong = later_wrong ? fault.index : fault.other;
    const Index free = fitting_edge(edge.panel, later_wrong ? of_later : of_earlier, stitch(wrong).right_wrong,
                                    std::max(cost_later, cost_earlier));
    if (free >= 0) mend_side(problem, wrong, later_wrong ? fault.side : (is_a ? 0 : 1), edge.panel, free);
    if (problem.mend) context_.fitted[at(wrong)] = 0;
  }

  // Whether a free edge of one of the panels fits clearly better.  `fault`: of the seam as it is.
  bool check_wrong_edge(Index s, const PatternFault* fault) {
    if (fault == nullptr && !context_.fitted[at(s)]) return false;
    const Stitch sewn = stitch(s);
    if (!closed(sewn.a.panel) || !closed(sewn.b.panel) || ratio(sewn.a, sewn.b) < other_length) return false;
    const double as_named = cost(sewn.a, sewn.b, sewn.right_wrong);
    int found_side = -1;
    bool either = false;
    Index found = -1;
    for (int k = 0; k < 2; ++k) {
      const StitchSide &side = k == 0 ? sewn.a : sewn.b, &partner = k == 0 ? sewn.b : sewn.a;
      const Index edge =
          fitting_edge(side.panel, partner, sewn.right_wrong, as_named - cheaper_by * context_.edge_m(partner));
      if (edge < 0) continue;
      either = found_side >= 0;
      found_side = k;
      found = edge;
    }
    if (found_side < 0) return false;
    const StitchSide& side = found_side == 0 ? sewn.a : sewn.b;
    LintProblem& problem = add(reason::seam_wrong_edge, fault != nullptr ? Severity::error : Severity::warning, s,
                               "edges that lie near each other, as long as each other",
                               context_.edge_name(side) + ", though " + context_.edge_name({side.panel, found}) +
                                   " fits and is sewn to nothing");
    if (either) {
      problem.finding.repair = "refused: on either panel another edge that fits is free";
    } else {
      mend_side(problem, s, found_side, side.panel, found);
    }
    return true;
  }

  // ---- twisted ----------------------------------------------------------------------------------------------------------

  bool is_looked_at(std::size_t s) const {
    const Stitch& one = pattern_.stitches[s];
    return one.a.edge >= 0 && one.b.edge >= 0 && !context_.inner_layer[s];
  }

  // The pattern with the stitches that can be checked, `turned` among them reversed.
  PanelSides sides_with(Index turned) const {
    Pattern sewn;
    sewn.panels.resize(pattern_.panels.size());
    for (std::size_t s = 0; s < pattern_.stitches.size(); ++s) {
      const Stitch& one = pattern_.stitches[s];
      if (!is_looked_at(s)) continue;
      sewn.stitches.push_back(one);
      if (static_cast<Index>(s) == turned) sewn.stitches.back().right_wrong = !one.right_wrong;
    }
    return panel_sides(sewn);
  }

  // A one-sided surface: of the stitches whose reversal makes it two-sided, one whose ends come nearer.
  void check_sides() {
    const PanelSides sides = sides_with(-1);
    if (sides.conflict < 0) return;
    Index conflict = -1;  // its number among all stitches
    for (Index s = 0, k = -1; at(s) < pattern_.stitches.size() && conflict < 0; ++s)
      if (is_looked_at(at(s)) && ++k == sides.conflict) conflict = s;
    Index best = -1;
    double best_gain = 1, next_gain = 0;  // other way / as sewn
    const std::size_t tried = pattern_.stitches.size() <= most_turned ? pattern_.stitches.size() : 0;
    for (std::size_t k = 0; k < tried; ++k) {
      const auto s = static_cast<Index>(k);
      if (!context_.fitted[k]) continue;
      const auto ends = seam_ends(pattern_, stitch(s));
      if (!ends || ends->as_sewn_m <= ends->other_way_m || sides_with(s).conflict >= 0) continue;
      const double gain = ends->as_sewn_m / std::max(ends->other_way_m, 1e-6);
      if (gain > best_gain) {
        next_gain = best >= 0 ? best_gain : 0;
        best_gain = gain;
        best = s;
      } else {
        next_gain = std::max(next_gain, gain);
      }
    }
    const bool sure = best >= 0 && best_gain > clearly_worse * next_gain;
    const Index s = sure ? best : conflict;
    if (!context_.fitted[at(s)]) return;  // reported already
    LintProblem& problem = add(reason::seam_twisted, Severity::error, s, "seams that give the garment one right side",
                               "following the other seams, its two panels face opposite ways");
    if (sure) {
      mend_twist(problem, s);
    } else {
      problem.finding.repair = "refused: not exactly one seam could be turned";
    }
  }

  void mend_twist(LintProblem& problem, Index s) const {
    problem.finding.repair = stitch(s).right_wrong ? "\"right_wrong\" is taken away" : "\"right_wrong\" is added";
    problem.mend = [s](PatternRepair& repair) { repair.turn_stitch(s); };
  }

  void check_twist(Index s) {
    if (!context_.fitted[at(s)]) return;
    const auto ends = seam_ends(pattern_, stitch(s));
    if (!ends || !ends->twisted()) return;
    LintProblem& problem =
        add(reason::seam_twisted, Severity::error, s, "matching ends near each other where the panels are placed",
            "ends " + cm_text(0.5 * ends->as_sewn_m) + " apart, and " + cm_text(0.5 * ends->other_way_m) +
                " the other way round");
    if (sides_with(s).conflict < 0) {
      mend_twist(problem, s);
    } else {
      problem.finding.repair =
          "refused: turned, its panels would face opposite ways; a panel beside it may be placed wrong";
    }
  }

  // ---- far, and unlike its mirror image ------------------------------------------------------------------------------------

  void check_far(Index s) {
    if (!context_.fitted[at(s)]) return;
    const auto ends = seam_ends(pattern_, stitch(s));
    if (!ends || 0.5 * ends->as_sewn_m < far_m) return;
    const double size = std::max(context_.edge_m(stitch(s).a), context_.edge_m(stitch(s).b));
    if (0.5 * ends->as_sewn_m < 4 * size) return;  // not far for seams as long as these
    LintProblem& problem = add(reason::panel_far, Severity::warning, s, "panels placed beside what they are sewn to",
                               "ends " + cm_text(0.5 * ends->as_sewn_m) + " apart");
    problem.finding.repair = "refused: where the panel belongs is not known";
  }

  // [stitch] middles of both sides, as placed; zeros for stitches that cannot be checked.
  void find_middles() {
    for (std::size_t s = 0; s < pattern_.stitches.size(); ++s) {
      middles_.emplace_back(Vec3::Zero(), Vec3::Zero());
      if (!context_.fitted[s]) continue;
      const auto middle = [&](const StitchSide& side) {
        const Panel& panel = pattern_.panels[at(side.panel)];
        return panel.place(sample_edge(panel, panel.edges[at(side.edge)], 2)[1]);
      };
      middles_.back() = {middle(pattern_.stitches[s].a), middle(pattern_.stitches[s].b)};
    }
  }

  void check_twin(Index s) {
    if (!context_.fitted[at(s)] || is_dart(pattern_, stitch(s))) return;
    const double own = ratio(stitch(s).a, stitch(s).b);
    if (own < gathered_from) return;
    const auto& [a, b] = middles_[at(s)];
    const Vec3 mirrored_a(-a.x(), a.y(), a.z()), mirrored_b(-b.x(), b.y(), b.z());
    Index twin = -1;
    double nearest = mirror_reach_m;
    for (std::size_t k = 0; k < pattern_.stitches.size(); ++k) {
      const auto t = static_cast<Index>(k);
      if (t == s || !context_.fitted[k] || is_dart(pattern_, stitch(t))) continue;
      const auto [c, d] = middles_[k];
      const auto mismatch = [&](const Vec3& first, const Vec3& second) {
        const double x = (mirrored_a - first).norm(), y = (mirrored_b - second).norm();
        return std::min(x, y) < mirror_near_m ? std::max(x, y) : mirror_reach_m;
      };
      const double apart = std::min(mismatch(c, d), mismatch(d, c));
      if (apart >= nearest) continue;
      nearest = apart;
      twin = t;
    }
    if (twin < 0 || ratio(stitch(twin).a, stitch(twin).b) > mirrored_ratio) return;
    const Stitch sewn = stitch(s);
    const std::string ratio_cm = cm_text(context_.edge_m(sewn.a)) + " and " + cm_text(context_.edge_m(sewn.b));
    LintProblem& problem = add(
        reason::seam_unequal, Severity::warning, s,
        "edges as long as each other, as those of stitch " + std::to_string(twin) + " on the other side are", ratio_cm);
    problem.finding.repair = "refused: which of the two lengths is meant is not known";
  }

  LintContext& context_;
  const Pattern& pattern_;
  std::vector<std::pair<Vec3, Vec3>> middles_;
};

}  // namespace

void lint_seams(LintContext& context) { SeamLint(context).run(); }

}  // namespace toile::internal
