// material/drape_curve.hpp: Cusick's drape coefficient of a cloth, by its bending length.       docs/theory/fabrics.md#drape-and-bending
//
//   c = (D / (w g))^(1/3)           DC(c), percent, of a disc of 30 cm on one of 18 cm
//
// Two curves of this engine's own, for cloth of staple yarns and of filaments, whose compression_ratio is 0.1 and 0.005; the test
// DrapeCurveLong.ComesAgainFromTheEngine makes them.
#pragma once
#include "material/monotone_curve.hpp"

#include <array>

namespace toile::internal::drape_curve {

// The mean of eight discs, and their scatter: cloths of other weight, shear and stretch, other starts, another mesh.  Of filaments three.
struct Drape {
  double percent, scatter;
};
struct Point {
  double bending_length_m;
  Drape staple, filament;
};
inline constexpr std::array<Point, 12> points = {{{0.0100, {24.5, 2.1}, {20.9, 0.4}},
                                                  {0.0115, {29.6, 2.0}, {25.2, 0.8}},
                                                  {0.0130, {34.4, 1.8}, {31.2, 1.2}},
                                                  {0.0145, {40.8, 2.0}, {36.5, 1.6}},
                                                  {0.0160, {48.4, 1.6}, {42.3, 2.6}},
                                                  {0.0180, {57.7, 1.5}, {49.5, 2.3}},
                                                  {0.0200, {65.7, 1.7}, {56.6, 2.3}},
                                                  {0.0225, {70.8, 4.8}, {63.8, 2.9}},
                                                  {0.0250, {75.4, 3.4}, {69.4, 1.7}},
                                                  {0.0300, {85.5, 1.3}, {82.1, 1.5}},
                                                  {0.0350, {91.2, 0.6}, {89.7, 0.0}},
                                                  {0.0400, {95.0, 0.2}, {94.2, 0.5}}}};
constexpr double filament_below = 0.022;  // of compression_ratio: the geometric mean of both

const MonotoneCurve& percent_of_bending_length(double compression_ratio);  // in metres

// Standard uncertainty of the curve, in points: the scatter, and no less than 1.5, for what a disc in a laboratory has and ours has not.
double uncertainty_points(double bending_length_m, double compression_ratio);
constexpr double least_uncertainty_points = 1.5;

}  // namespace toile::internal::drape_curve
