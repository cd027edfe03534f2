// garment/lint.hpp: what is wrong with a sewing pattern, or probably not meant: code, place, expected, got, and what can be mended.
//
// Every fault is found by geometry, in a file that may be too broken to be used.  Faults hide others (an outline that is open has no length),
// so what can be mended is mended in memory and looked at again, until nothing more is found: a pattern's list is whole at once.
//
// What is easily got wrong: an error is what `dress` refuses, and nothing else.  All else are warnings: elastic, slits and other people exist.
#pragma once
#include "garment/lint_codes.hpp"
#include "garment/pattern.hpp"
#include "io/json.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

enum class Severity {
  error,
  warning,
  note
};  // cannot be used; probably not meant; as it stands, but others may stumble
std::string_view to_string(Severity severity);

struct LintMark {  // a place in the drawing
  Index panel = -1;
  Index edge = -1;     // its number in the file; -1: a point alone
  Vec2 at_m{0, 0};     // in the panel's plane
  bool whole = false;  // the panel as a whole; at_m is its middle
};

struct LintFinding {
  std::string_view code;  // garment/lint_codes.hpp
  Severity severity = Severity::error;
  std::string where;    // "p.json:12:5"; the file alone for what showed only after another fault was mended
  std::string pointer;  // into the file
  std::string place;    // panel "front", edge 3, at (12.0, 40.3) cm
  std::vector<LintMark> marks;
  std::string expected, got;
  bool mended = false;
  std::string repair;  // what was done to mend it, or why nothing
};

// A body in numbers, for those who have one (sim/body_figures.hpp).
struct BodyFigures {
  Vec3 low_m{0, 0, 0}, high_m{0, 0, 0};                                       // its box
  Vec3 middle_m{0, 0, 0};                                                     // of the trunk at the waist
  double head_girth_m = 0, waist_girth_m = 0, hips_girth_m = 0, waist_m = 0;  // waist_m: its height; 0: none was found
  // Where the tips of the shoulders and the waist are (y), for those who know them from a tape.
  std::optional<double> shoulder_m, tape_waist_m;
  std::optional<double> arm_down_deg;              // how far the arms hang below the level, the mean of both; 0: a T
  std::optional<std::array<Vec3, 2>> arm_roots_m;  // middles of the left arm and the right one at the armpits
  double height_m() const { return high_m.y() - low_m.y(); }
};

struct LintReport {
  std::vector<LintFinding> findings;  // in a fixed order: panels, seams, the garment; then what showed later
  Pattern drawing;                    // as far as the file could be read: for pattern_svg.hpp
  std::string mended_text;            // the whole file with all that could be mended; empty when nothing was
  bool usable = false;                // no error is left, with what was mended
  bool has_errors() const;            // in the file as it is
};

// `file` is for messages.
LintReport lint_pattern(std::string_view text, std::string_view file, const std::optional<BodyFigures>& body = {});

}  // namespace toile::internal
