// garment/pattern_repair.hpp: edits a pattern file and keeps everything else in it: unknown keys, and the order of all.
//
// Edges and corners are named by their numbers in the file.  Removing or reordering them renumbers the later ones, in stitches and in our
// extension, too.
#pragma once
#include "core/types.hpp"
#include "io/json_value.hpp"

#include <span>
#include <string>
#include <string_view>

namespace toile::internal {

class PatternRepair {
 public:
  PatternRepair(JsonValue& root, bool absolute_curves, bool centred_panels)
      : root_(&root), absolute_curves_(absolute_curves), centred_panels_(centred_panels) {}

  void set_ends(std::string_view panel, Index edge, Index start, Index end);
  // Swaps start and end; the curve keeps its shape.
  void reverse_edge(std::string_view panel, Index edge);
  // order[k] is the number that edge k had.
  void reorder_edges(std::string_view panel, std::span<const Index> order);
  // No stitch may name it.
  void remove_edge(std::string_view panel, Index edge);
  // No edge may name it.
  void remove_corner(std::string_view panel, Index corner);
  // Edges that ended at `corner` end at `other`, and the corner is removed.
  void merge_corner(std::string_view panel, Index corner, Index other);
  void swap_corners(std::string_view panel, Index a, Index b);

  void remove_stitch(Index stitch);
  void turn_stitch(Index stitch);  // toggles "right_wrong"
  void set_side(Index stitch, int side, std::string_view panel, Index edge);

  // Turns a panel by half a turn about the vertical line x = `axis` of its plane, in file units, with the corners as drawn.
  void turn_panel(std::string_view panel, double axis, const Mat3& rotation);
  void shift_panels(const Vec3& shift);  // file units
  void set_units_in_meter(double units);

 private:
  JsonValue& panel(std::string_view name);
  JsonValue& edge(std::string_view panel_name, Index number);
  JsonValue::Array& stitches();
  JsonValue* extension(std::string_view key);
  JsonValue::Array* finished_edges(std::string_view panel);  // of the extension; null: none
  template <class Renumber>
  void renumber_edges(std::string_view panel_name, Renumber&& number);
  template <class Renumber>
  void renumber_corners(std::string_view panel_name, Renumber&& number);

  JsonValue* root_;
  bool absolute_curves_, centred_panels_;
};

}  // namespace toile::internal
