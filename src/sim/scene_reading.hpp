// sim/scene_reading.hpp: what the readers of a scene's objects share.  Every refusal names file, line and JSON pointer.
#pragma once
#include "io/json.hpp"
#include "sim/scene.hpp"

#include <span>
#include <string>
#include <string_view>

namespace toile::scene_reading {

inline constexpr double most_seconds = 3600, most_fps = 1000;

// A number in low <= x <= high (or low < x when `open`), in words that name the range.
double number_in(const Json& value, double low, double high, bool open = false);

template <class T>
void read_number(const Json& object, std::string_view key, T& to, double scale, double low, double high,
                 bool open = false) {
  if (const Json* value = object.find(key)) to = scale * number_in(*value, low, high, open);
}

// [x, y, z], each of at most `most`.
Vec3 vector_of(const Json& value, double most = 1e4);

// The place of `name` among `names`; an error that names the nearest otherwise.
std::size_t one_of(const Json& value, std::span<const std::string_view> names);

// A path that starts at the folder of the scene.
std::string resolve(const std::string& scene_file, const Json& value);

// translation_m and rotation_deg of a "placement", if there is one.
void read_placement(const Json& value, Vec3& translation_m, Vec3& rotation_deg);
// "moves": [{"t_s", "shift_m", "rotation_deg", "scale"}, ...], ascending; what a key leaves out is as in the one before.
RigidPath read_moves(const Json& moves, const Vec3& centre);

SceneCloth read_cloth(const Json& value, const std::string& file);
SceneBody read_body(const Json& value, const std::string& file);
SceneSolid read_solid(const Json& value, const std::string& file);

}  // namespace toile::scene_reading
