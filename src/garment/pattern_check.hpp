// garment/pattern_check.hpp: checks of a sewing pattern, and its summary.
//
// Works on a Pattern in memory, whatever its source.  The reader (pattern_json.cpp) calls find_faults and adds file, line and
// JSON pointer; `toile check` prints the summary.
//
// Easily got wrong: unequal lengths of two sewn edges are not a mistake, they are how cloth is gathered and eased.
// Only a ratio beyond `max_seam_ratio` is taken for a stitch that names the wrong edge.
#pragma once
#include "garment/pattern.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// The limits, all stated in docs/pattern-format.md.
struct PatternLimits {
  static constexpr double max_seam_ratio = 6;       // longer edge / shorter edge of a stitch: gathers reach 5
  static constexpr double max_panel_m = 10;         // a panel's width and height; above, the unit is doubtful
  static constexpr double min_panel_m = 0.001;      // the larger of both; below, the unit is doubtful
  static constexpr double min_edge_m = 1e-5;        // corners closer than this are duplicates
  static constexpr double max_coordinate_m = 1000;  // of corners, control points and translations
  static constexpr double max_radius_m = 1e9;       // of a circle: nearly straight arcs have huge ones
  static constexpr double eased_ratio = 1.02;       // seams above count as eased
  static constexpr std::size_t max_panel_edges = 1000;
  static constexpr std::size_t max_edges = 5000;  // of the whole pattern
  static constexpr std::size_t max_faults = 100;  // listed by find_faults
};

struct PatternFault {
  enum class Part { pattern, panel, corner, edge, stitch };
  std::string_view code;  // garment/lint_codes.hpp
  Part part = Part::pattern;
  Index panel = -1;  // panel, corner, edge
  Index index = -1;  // the corner, the edge (place in Panel::edges) or the stitch
  int side = -1;     // stitch: 0 or 1 when one side is meant
  std::string expected, got;
  Index other = -1;    // the edge that is crossed, the corner that is repeated, the stitch that sews the edge already
  Vec2 place_m{0, 0};  // where an outline crosses itself, in the panel's plane
};

// The faults, at most max_faults of them, in a fixed order: panel by panel (indices before geometry), then stitches.
// Empty when the pattern is sound.
// A panel with faulty indices or sizes is not examined further, nor are the lengths of its seams.
std::vector<PatternFault> find_faults(const Pattern& pattern);

// `panel "front", edge 3`: the place of a fault in words, with the file's edge numbers.
std::string place_of(const Pattern& pattern, const PatternFault& fault);

// Throws InputError for the first fault: for patterns made in memory.
void check_pattern(const Pattern& pattern);

// Whether the stitch joins two edges of one panel that share a corner, the tip of the dart.
bool is_dart(const Pattern& pattern, const Stitch& stitch);

struct PanelSummary {
  std::string name;
  double outline_m = 0;    // length of the closed outline
  double area_m2 = 0;      // >= 0
  bool clockwise = false;  // the normal points to -z of the panel's own frame
  int edges = 0, stitched_edges = 0;
};

struct PatternSummary {
  std::string name;
  std::vector<PanelSummary> panels;
  int stitches = 0;
  int darts = 0;                                // stitches between two edges of one panel that share a corner
  int eased_stitches = 0;                       // lengths differ by more than 2 %
  double longest_ratio = 1;                     // longer / shorter edge over all stitches
  Index longest_ratio_stitch = -1;              // the first that has it; -1 without stitches
  double seam_m = 0;                            // sum over stitches of the longer edge
  double area_m2 = 0;                           // cloth needed
  Vec3 box_min_m{0, 0, 0}, box_max_m{0, 0, 0};  // of the placed panels, curves included
  bool legacy_frame = false;
  std::vector<std::string> notes;  // sentences for a person: unit assumed, legacy frame, panels sewn to nothing ...
};

// The pattern must be sound.
PatternSummary summarize(const Pattern& pattern);

}  // namespace toile::internal
