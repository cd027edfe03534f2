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
inline constexpr std::array<Point, 12> points = {{{0.0100, {20.6, 0.2}, {20.6, 0.2}},
                                                  {0.0115, {25.2, 0.7}, {24.9, 0.4}},
                                                  {0.0130, {32.0, 0.7}, {31.2, 1.1}},
                                                  {0.0145, {38.5, 1.0}, {36.5, 1.6}},
                                                  {0.0160, {46.0, 1.0}, {42.3, 2.6}},
                                                  {0.0180, {55.6, 1.1}, {49.5, 2.3}},
                                                  {0.0200, {63.8, 1.3}, {56.6, 2.3}},
                                                  {0.0225, {69.0, 3.4}, {63.8, 2.9}},
                                                  {0.0250, {74.3, 2.5}, {69.4, 1.7}},
                                                  {0.0300, {85.4, 1.4}, {82.1, 1.5}},
                                                  {0.0350, {91.1, 0.4}, {89.7, 0.0}},
                                                  {0.0400, {95.0, 0.2}, {94.2, 0.5}}}};
constexpr double filament_below = 0.022;  // of compression_ratio: the geometric mean of both

const MonotoneCurve& percent_of_bending_length(double compression_ratio);  // in metres

// Standard uncertainty of the curve, in points: the scatter, and no less than 1.5, for what a disc in a laboratory has and ours has not.
double uncertainty_points(double bending_length_m, double compression_ratio);
constexpr double least_uncertainty_points = 1.5;

}  // namespace toile::internal::drape_curve
