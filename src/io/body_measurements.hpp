// io/body_measurements.hpp: the measurements of a body, from the YAML file that GarmentCode keeps beside each of its bodies.
//                                                                                      docs/howto/measurements.md
//   body:
//     height: 171.99          centimetres and degrees, always
//     waist_line: 36.8913     ...
//
// Other keys are ignored.  Heights are above the floor.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace toile::internal {

struct BodyMeasurements {
  double height_m = 0;                                         // the only one that is required
  std::optional<double> head_m;                                // crown to neck base
  std::optional<double> waist_line_m, hips_line_m, armscye_m;  // neck base to waist, waist to hips, neck base to armpit
  std::optional<double> shoulder_width_m, shoulder_slope_rad;  // from tip to tip; below the level
  std::optional<double> bust_girth_m, waist_girth_m, hips_girth_m;
  std::optional<double> arm_down_rad;  // how far the arms hang below the level in the pose of the mesh; 0: a T
  std::string file;                    // for error messages

  // Heights of landmarks; nothing where a measurement for it is missing.
  std::optional<double> neck_m() const;      // base of the neck
  std::optional<double> shoulder_m() const;  // tips of the shoulders
  std::optional<double> armpit_m() const;
  std::optional<double> waist_m() const;
};

// Whether the text has the key `body`: a YAML file beside a mesh may be about something else.
// Throws InputError when it is no YAML.
bool holds_measurements(std::string_view text, std::string_view file);

// Throws InputError naming file, line, key, expected and got: no YAML, no `body`, no height, a key twice, a value that is no number or not
// possible for a person, or a height above the crown or below the floor.
BodyMeasurements parse_measurements(std::string_view text, std::string_view file);

}  // namespace toile::internal
