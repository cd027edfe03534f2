// sim/scene_reading.hpp: single values of a scene.  Every refusal names file, line and JSON pointer.
#pragma once
#include "io/json.hpp"
#include "sim/scene.hpp"
#include "sim/settings.hpp"

#include <span>
#include <string>
#include <string_view>

namespace toile::internal::scene_reading {

// As in the file: the caller converts units.
double number_in(const Json& value, const Range& range);
int whole_in(const Json& value, const Range& range);

// [x, y, z]
Vec3 vector_of(const Json& value, const Range& each);

// The index of `name` in `names`; otherwise throws an error that names the nearest.
std::size_t one_of(const Json& value, std::span<const std::string_view> names);

// A path relative to the folder of the scene.
std::string resolve(const std::string& scene_file, const Json& value);

// Throws for an array of fewer elements.
void check_least(const Json& array, std::size_t least, std::string_view element);

}  // namespace toile::internal::scene_reading
