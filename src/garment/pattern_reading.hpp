// garment/pattern_reading.hpp: a pattern file as it stands, even if it cannot be used: the linter's input.
//
// Easily got wrong: in a panel whose edges form no loop, `edges` is in the order of the file, with -1 for missing corners;
// in all others it is in the order of the loop, as usual.
#pragma once
#include "garment/pattern.hpp"
#include "garment/pattern_check.hpp"
#include "io/json.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace toile::internal {

struct PanelSource {  // places of a panel's parts in the file
  const Json* panel = nullptr;
  std::vector<Index> place_of_edge;  // number in the file -> place in Panel::edges
  bool is_loop = true;               // one edge leaves each corner, and all are passed
};

struct PatternReading {
  Pattern pattern;                   // a missing side of a stitch has panel or edge -1
  std::vector<PanelSource> sources;  // [panel]
  const Json* stitches = nullptr;
  bool absolute_curves = false, centred_panels = false;  // "curvature_coords", "normalize_panel_translation"
  JsonPlaces places;                                     // of the folds
};

// `root` must outlive the result.  Throws InputError for files that cannot be read even leniently: missing keys, values of another type,
// words that are not in the format.
PatternReading read_pattern_leniently(const Json& root, std::string_view file);

// The value in the file that a fault is about; `root` for one of the whole pattern.
const Json& json_of_fault(const PatternFault& fault, const Json& root, const Pattern& pattern,
                          std::span<const PanelSource> panels, const Json& stitches);

}  // namespace toile::internal
