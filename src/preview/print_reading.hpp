// preview/print_reading.hpp: the values of a file of looks: colours, sizes, prints.
#pragma once
#include "io/json.hpp"
#include "preview/print.hpp"

#include <string>
#include <vector>

namespace toile::internal {

// "#rrggbb" or three whole numbers [r, g, b] to 255, sRGB: linear, and no brighter than cloth.
Vec3f colour_in(const Json& value);
// Throws InputError at the value unless least <= x <= most; `above`: least < x.
double number_between(const Json& value, double least, double most, bool above = false);

// Pictures are found beside `file`, and added to `files`.
Print print_in(const Json& value, const std::string& file, std::vector<std::string>& files);

}  // namespace toile::internal
