// garment/lint_context.hpp: what the parts of the linter share.
#pragma once
#include "garment/boundary.hpp"
#include "garment/lint.hpp"
#include "garment/pattern_reading.hpp"
#include "garment/pattern_repair.hpp"

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace toile::internal {

struct LintProblem {
  LintFinding finding;
  std::function<void(PatternRepair&)> mend;  // empty: nothing can be done without guessing
};

class LintContext {
 public:
  LintContext(const Json& root, std::string_view file, const std::optional<BodyFigures>& body);

  const Json& root;
  PatternReading reading;
  const Pattern& pattern;
  std::optional<BodyFigures> body;
  std::vector<PatternFault> faults;  // of panels that are loops, and of stitches
  std::vector<char> closed;          // [panel] its edges are a loop
  std::vector<char> wild;            // [panel] numbers beyond what can be measured: nothing but that is said of it
  std::vector<char> sound;           // [panel] and nothing else is wrong with it
  std::vector<std::vector<double>> length_m;  // [panel][edge]; empty where the panel is not closed
  std::set<std::pair<Index, Index>> sewn;     // (panel, edge) that a stitch names
  std::vector<char> fitted;       // [stitch] both sides are there, their panels are sound, and no fault was found yet
  std::vector<char> inner_layer;  // [stitch] of a pleat: sewn to what it is not named with
  std::vector<LintProblem> problems;
  std::optional<Boundary> boundary;  // where all outlines are closed and every seam joins two edges of its own
  bool unit_doubtful = false;        // sizes mean nothing

  // A problem at a value of the file; the caller adds marks, `mend` and what it does.
  LintProblem& add(std::string_view code, Severity severity, const Json& at, std::string place, std::string expected,
                   std::string got);
  LintProblem& add(const PatternFault& fault, Severity severity);

  std::string edge_name(const StitchSide& side) const;  // edge 3 of panel "front"
  LintMark mark_edge(Index panel, Index edge) const;    // edge: its place in Panel::edges
  LintMark mark_panel(Index panel) const;
  double edge_m(const StitchSide& side) const;
};

std::string fixed_text(double value, int digits);  // of any locale
std::string cm_text(double length_m);              // 12.3 cm
std::string point_cm(const Vec2& point_m);         // (12.3, 4.5) cm

// The largest piece of a garment as what it covers: which openings are at its top, at arms, at legs.
struct Wearing {
  Index piece = -1;                        // -1: there is nothing that closes around a trunk
  Index top = -1;                          // the highest opening around the trunk's axis; -1: none
  std::vector<Index> around, hands, feet;  // openings around the axis, for hands, for feet
  bool has_arms = false;
};
Wearing find_wearing(const Pattern& pattern, const Boundary& boundary, Index piece);

// The parts, in the order in which they look.  Each leaves alone what an earlier one has found.
void lint_outlines(LintContext& context);
void lint_flips(LintContext& context);
void lint_seams(LintContext& context);
void lint_size(LintContext& context);
void lint_openings(LintContext& context);

}  // namespace toile::internal
