// garment/pattern_figures.hpp: for whom a pattern was cut: heights, girths and the arms' angle, read from its labels and from where its panels
// hang, and what of it another body has otherwise.                                                    docs/howto/measurements.md
//
// GarmentCode hangs a pattern on the body that it is cut for: a waist at its waist, armholes from the tips of its shoulders, sleeves along
// its arms.  What is wide is ease and says nothing; what is narrow is told.
#pragma once
#include "garment/lint.hpp"
#include "garment/pattern.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// Labels of edges, as GarmentCode gives them.
namespace edge_label {
inline constexpr std::string_view waist = "lower_interface";  // a waistband, or the lower end of a bodice
inline constexpr std::string_view collars[] = {"left_collar", "right_collar"};
inline constexpr std::string_view armholes[] = {"left_armhole", "right_armhole"};
inline constexpr std::string_view strapless_top = "strapless_top";
}  // namespace edge_label
// Of a bodice: all of them but the waist.
bool is_of_bodice(std::string_view label);

struct PatternFigures {
  std::optional<double>
      waist_m;  // top of the edges that belong there and that nothing is sewn to: with a bodice they are its lower end
  std::optional<double>
      waist_girth_m;  // length of the edges that belong there or below; absent where an elastic panel has one
  std::optional<double> shoulder_m;  // height of the armholes' tops
};
PatternFigures pattern_figures(const Pattern& pattern);
// How far the arms hang below the level for which the sleeves are drawn, the mean of all their panels, which are those labelled "arm"; of a pattern without labels those that hang
// beyond the roots of this body's arms.
std::optional<double> sleeves_down_deg(const Pattern& pattern, const BodyFigures& body);

// Sleeves are turned onto the arms before they are sewn, so a few degrees are nothing; between an A and a T lie 45.
inline constexpr double pose_agrees_deg = 15;

struct Misfit {
  std::string_view code;  // reason::other_body or reason::other_pose
  std::string expected, got;
};
// What says that the pattern is cut for another body, or another pose; nothing where either is not known.
std::vector<Misfit> misfits(const Pattern& pattern, const BodyFigures& body);

}  // namespace toile::internal
