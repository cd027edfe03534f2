// garment/lint.hpp: finds errors in a sewing pattern, and parts that are probably not meant; mends those that it can.
//
// Faults are found by geometry, also in a file that is too broken to be used.  Faults hide others (an open outline has no length), so
// repairs are made in memory and the pattern is checked again, until no new fault is found: one call lists all faults.
//
// Easily got wrong: an error is a fault that `dress` refuses, and nothing else.  All others are warnings: elastic, slits and other bodies exist.
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
};  // cannot be used; probably not meant; usable here, but other programs may refuse it
std::string_view to_string(Severity severity);

struct LintMark {  // a mark in the drawing
  Index panel = -1;
  Index edge = -1;     // its number in the file; -1: a point alone
  Vec2 at_m{0, 0};     // in the panel's plane
  bool whole = false;  // the panel as a whole; at_m is its middle
};

struct LintFinding {
  std::string_view code;  // garment/lint_codes.hpp
  Severity severity = Severity::error;
  std::string where;    // "p.json:12:5"; the file alone for a fault that showed only after another was mended
  std::string pointer;  // into the file
  std::string place;    // panel "front", edge 3, at (12.0, 40.3) cm
  std::vector<LintMark> marks;
  std::string expected, got;
  bool mended = false;
  std::string repair;  // how it was mended, or why not
};

// Measurements of the body, if one is given (sim/body_figures.hpp).
struct BodyFigures {
  Vec3 low_m{0, 0, 0}, high_m{0, 0, 0};                                       // its box
  Vec3 middle_m{0, 0, 0};                                                     // of the trunk at the waist
  double head_girth_m = 0, waist_girth_m = 0, hips_girth_m = 0, waist_m = 0;  // waist_m: its height; 0: not found
  // Heights (y) of the tips of the shoulders and of the waist, if measurements are given.
  std::optional<double> shoulder_m, tape_waist_m;
  std::optional<double> arm_down_deg;              // how far the arms hang below the level, the mean of both; 0: a T
  std::optional<std::array<Vec3, 2>> arm_roots_m;  // middles of the left arm and the right one at the armpits
  double height_m() const { return high_m.y() - low_m.y(); }
};

struct LintReport {
  std::vector<LintFinding> findings;  // in a fixed order: panels, seams, the garment; then those that showed later
  Pattern drawing;                    // the readable part of the file: for pattern_svg.hpp
  std::string mended_text;            // the whole file with all repairs; empty when there are none
  bool usable = false;                // no error is left after the repairs
  bool has_errors() const;            // in the file as it is
};

// `file` is for messages.
LintReport lint_pattern(std::string_view text, std::string_view file, const std::optional<BodyFigures>& body = {});

}  // namespace toile::internal
