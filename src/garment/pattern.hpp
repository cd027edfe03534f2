// garment/pattern.hpp: a sewing pattern: panels of curved edges, where they are placed, and which edges are sewn.
//
// Read from the JSON of GarmentCode and of the older Garment-Pattern-Generator (docs/pattern-format.md).  After reading,
// everything is in metres and y is up.  Edge k of a panel runs from corner `start` to corner `end`; the loop is closed.
//
// Easily got wrong: an edge has a direction, and a stitch pairs the END of one edge with the START of the other,
// because two panels that lie beside each other, both counter-clockwise, pass their common seam in opposite directions.
#pragma once
#include "core/types.hpp"
#include "io/json_places.hpp"
#include "material/edge_finish.hpp"
#include "mesh/cloth_mesh.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

enum class CurveKind { line, quadratic, cubic, circle };

struct PanelEdge {
  Index start = 0, end = 0;  // corners of the panel
  CurveKind kind = CurveKind::line;
  std::array<Vec2, 2> control{Vec2{0, 0}, Vec2{0, 0}};  // quadratic: [0]; cubic: both; absolute panel coordinates, m
  double radius_m = 0;                                  // circle
  bool large_arc = false, sweep = false;                // circle, as in SVG with y up: see docs/pattern-format.md
  std::string label;                                    // "lower_interface" ... or empty
  EdgeFinish finish;                                    // the file's extension "toile"
  bool finish_given = false;                            // also to none
  Index file_number = -1;  // its number in the file, for messages; -1: its place in `edges`
};

struct PanelFold {       // a line across a panel that is folded at rest: of a collar, a pleat, a crease
  PanelEdge line;        // from one corner of the outline to another, inside the panel
  double angle_rad = 0;  // at rest; > 0: a ridge on the panel's outer side, < 0: a valley
};

struct Panel {
  std::string name, label;
  Vec3 translation_m{0, 0, 0};
  Vec3 rotation_deg{0, 0, 0};    // R = Rz Ry Rx
  std::vector<Vec2> corners;     // m
  std::vector<PanelEdge> edges;  // one closed loop, in order; may be clockwise (the normal then points to -z)
  // The file's extension "toile":
  std::string fabric;  // a preset's name (material/fabric.hpp); empty: the garment's
  Interfacing interfacing;
  Vec2 rest_stretch{1, 1};       // b of the warp (up the panel) and of the weft; below 1 it is elastic
  std::vector<PanelFold> folds;  // do not cross each other or the outline

  Mat3 rotation() const;                // exact at multiples of 90 degrees
  Vec3 place(const Vec2& p) const;      // panel plane to world
  Index file_number(Index edge) const;  // the number of edges[edge] in the file, and so in messages
};

struct StitchSide {
  Index panel = 0, edge = 0;  // edge: place in Panel::edges
};

struct Stitch {
  StitchSide a, b;
  bool right_wrong = false;  // pairs start with start instead of end with start
  double angle_rad = 0;      // at rest (extension "toile"); > 0: a ridge on the outer side of a's panel
};

struct Pattern {
  std::string name;           // file name without _specification.json
  std::vector<Panel> panels;  // in the file's panel_order, else as they stand there
  std::vector<Stitch> stitches;
  bool legacy_frame = false;    // a 2021 template: translations are in that tool's own frame, pelvis at y = 0
  double units_in_meter = 100;  // of the file; everything above is in metres already
  bool units_assumed = false;   // the file does not say: 100 was assumed
};

// Finishes the edges for which the file says nothing: an allowance on those that are sewn, a hem on open ones, and a tape on those of them with a label,
// which shall lie on the body at their length as cut: waists, collars, armholes, strapless tops.
void finish_other_edges(Pattern& pattern, const EdgeFinish& finish);

// Points of an edge from start to end, `count` + 1 of them (count >= 1), equally spaced by arc length to 1e-9 of the
// length.  First and last point are the corners to the bit, and the edge reversed gives the same points reversed, to the
// bit.  The edge must be sound (find_faults in pattern_check.hpp).  Throws InputError for count < 1.
std::vector<Vec2> sample_edge(const Panel& panel, const PanelEdge& edge, int count);
double edge_length_m(const Panel& panel, const PanelEdge& edge);

// Throws IoError or InputError (file, line, JSON pointer, expected, got) for every fault: open loop,
// self-crossing outline, unknown curve type, stitch to a missing panel or edge, an edge stitched twice, not finite ...
Pattern load_pattern(const std::string& path);
Pattern parse_pattern(std::string_view text, std::string_view file);
// With the places of its folds in the file, for the mesher's message about one that leaves the panel.
struct PatternFile {
  Pattern pattern;
  JsonPlaces places;
};
PatternFile read_pattern(std::string_view text, std::string_view file);

std::string path_of_fold(const Panel& panel, std::size_t fold);  // of InputError
std::string name_of_fold(const Panel& panel, std::size_t fold);  // in words

}  // namespace toile::internal
