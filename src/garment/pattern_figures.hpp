// garment/pattern_figures.hpp: the body that a pattern was cut for: heights, girths and the arms' angle, from its labels and the places of its
// panels, and how another body differs from it.                                                      docs/howto/measurements.md
//
// GarmentCode hangs a pattern on the body that it is cut for: a waist at its waist, armholes from the tips of its shoulders, sleeves along
// its arms.  A garment that is wider has ease, which is no evidence; one that is narrower is reported.
#pragma once
#include "garment/lint.hpp"
#include "garment/pattern.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// GarmentCode's labels of edges.
namespace edge_label {
inline constexpr std::string_view waist = "lower_interface";  // a waistband, or the lower end of a bodice
inline constexpr std::string_view collars[] = {"left_collar", "right_collar"};
inline constexpr std::string_view armholes[] = {"left_armhole", "right_armhole"};
inline constexpr std::string_view strapless_top = "strapless_top";
}  // namespace edge_label
// A label of a bodice: any of them but the waist.
bool is_of_bodice(std::string_view label);

struct PatternFigures {
  std::optional<double> waist_m;  // top of the open edges with this label: with a bodice its lower end
  std::optional<double>
      waist_girth_m;                 // length of the edges there or below; absent if an elastic panel has one of them
  std::optional<double> shoulder_m;  // height of the armholes' tops
};
PatternFigures pattern_figures(const Pattern& pattern);
// The angle below the horizontal of the arms for which the sleeves are drawn: the mean of all panels labelled "arm", or, in a pattern without
// labels, of those that hang beyond the roots of this body's arms.
std::optional<double> sleeves_down_deg(const Pattern& pattern, const BodyFigures& body);

// Sleeves are turned onto the arms before they are sewn, so a few degrees do not matter; A and T pose differ by 45.
inline constexpr double pose_agrees_deg = 15;

struct Misfit {
  std::string_view code;  // reason::other_body or reason::other_pose
  std::string expected, got;
};
// Evidence that the pattern is cut for another body or pose; empty if either is not known.
std::vector<Misfit> misfits(const Pattern& pattern, const BodyFigures& body);

}  // namespace toile::internal
