// garment/lint_context.hpp: data shared by the parts of the linter.
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
  std::vector<PatternFault> faults;           // of panels that are loops, and of stitches
  std::vector<char> closed;                   // [panel] its edges are a loop
  std::vector<char> wild;                     // [panel] numbers too large to be measured: nothing else is reported
  std::vector<char> sound;                    // [panel] closed and without any fault
  std::vector<std::vector<double>> length_m;  // [panel][edge]; empty where the panel is not closed
  std::set<std::pair<Index, Index>> sewn;     // (panel, edge) that a stitch names
  std::vector<char> fitted;       // [stitch] both sides are there, their panels are sound, and no fault was found yet
  std::vector<char> inner_layer;  // [stitch] of a pleat: sewn to another edge than it names
  std::vector<LintProblem> problems;
  std::optional<Boundary> boundary;  // where all outlines are closed and every seam joins two edges of its own
  bool unit_doubtful = false;        // sizes mean nothing

  // Adds a problem at a value of the file; the caller adds marks, `mend` and its description.
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

// The roles of the openings of a garment's largest piece: top, arms, legs.
struct Wearing {
  Index piece = -1;                        // -1: no piece closes around a trunk
  Index top = -1;                          // the highest opening around the trunk's axis; -1: none
  std::vector<Index> around, hands, feet;  // openings around the axis, for hands, for feet
  bool has_arms = false;
};
Wearing find_wearing(const Pattern& pattern, const Boundary& boundary, Index piece);

// The parts, in the order in which they run.  Each ignores faults that an earlier one has found.
void lint_outlines(LintContext& context);
void lint_flips(LintContext& context);
void lint_seams(LintContext& context);
void lint_size(LintContext& context);
void lint_openings(LintContext& context);

}  // namespace toile::internal
