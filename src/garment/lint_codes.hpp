// garment/lint_codes.hpp: the codes of faults in a sewing pattern; a code never changes its meaning.           docs/reason-codes.md#patterns
#pragma once
#include <string_view>

namespace toile::internal {

namespace reason {
// The outline of a panel.
inline constexpr std::string_view unreadable = "unreadable";
inline constexpr std::string_view edge_ends = "edge_ends";
inline constexpr std::string_view edge_twice = "edge_twice";
inline constexpr std::string_view loop_reversed = "loop_reversed";
inline constexpr std::string_view loop_order = "loop_order";
inline constexpr std::string_view loop_open = "loop_open";
inline constexpr std::string_view loop_several = "loop_several";
inline constexpr std::string_view corner_twice = "corner_twice";
inline constexpr std::string_view corner_unused = "corner_unused";
inline constexpr std::string_view outline_crosses = "outline_crosses";
inline constexpr std::string_view curve_impossible = "curve_impossible";
inline constexpr std::string_view beyond_limits = "beyond_limits";
inline constexpr std::string_view cannot_mesh = "cannot_mesh";
// Panels and seams.
inline constexpr std::string_view panel_flipped = "panel_flipped";
inline constexpr std::string_view panel_far = "panel_far";
inline constexpr std::string_view seam_missing = "seam_missing";
inline constexpr std::string_view seam_twice = "seam_twice";
inline constexpr std::string_view seam_to_itself = "seam_to_itself";
inline constexpr std::string_view seam_wrong_edge = "seam_wrong_edge";
inline constexpr std::string_view seam_twisted = "seam_twisted";
inline constexpr std::string_view seam_unequal = "seam_unequal";
// The garment and its wearer.
inline constexpr std::string_view unit_doubtful = "unit_doubtful";
inline constexpr std::string_view other_body = "other_body";
inline constexpr std::string_view other_pose = "other_pose";
inline constexpr std::string_view off_body = "off_body";
inline constexpr std::string_view no_way_in = "no_way_in";
inline constexpr std::string_view no_way_for_head = "no_way_for_head";
inline constexpr std::string_view no_way_for_hand = "no_way_for_hand";
inline constexpr std::string_view no_way_for_foot = "no_way_for_foot";
}  // namespace reason

}  // namespace toile::internal
