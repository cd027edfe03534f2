// sim/scene_reading.cpp: see the header.
#include "sim/scene_reading.hpp"

#include <fmt/printf.h>

#include <filesystem>
#include <utility>
#include <vector>

namespace toile::scene_reading {

double number_in(const Json& value, double low, double high, bool open) {
  const double x = value.number();
  if (x > high || x < low || (open && x == low))
    value.fail(fmt::sprintf("a number %s %g and at most %g", open ? "above" : "of at least", low, high),
               value.describe());
  return x;
}

Vec3 vector_of(const Json& value, double most) {
  if (!value.is_array() || value.array().size() != 3) value.fail("three numbers [x, y, z]", value.describe());
  Vec3 v;
  for (std::size_t k = 0; k < 3; ++k) v[static_cast<Eigen::Index>(k)] = number_in(value.array()[k], -most, most);
  return v;
}

std::size_t one_of(const Json& value, std::span<const std::string_view> names) {
  const std::string& name = value.string();
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return i;
    list += (i == 0 ? "\"" : ", \"") + std::string(names[i]) + '"';
  }
  value.fail("one of " + list + "; nearest is \"" + std::string(nearest_name(name, names.data(), names.size())) + '"',
             value.describe());
}

std::string resolve(const std::string& scene_file, const Json& value) {
  const std::string& path = value.string();
  if (path.empty() || path.find('\0') != std::string::npos) value.fail("a path", value.describe());
  const std::filesystem::path given(path);
  if (given.is_absolute()) return given.lexically_normal().string();
  return (std::filesystem::path(scene_file).parent_path() / given).lexically_normal().string();
}

void read_placement(const Json& value, Vec3& translation_m, Vec3& rotation_deg) {
  const Json* placement = value.find("placement");
  if (placement == nullptr) return;
  placement->allow_only({"translation_m", "rotation_deg"});
  if (const Json* t = placement->find("translation_m")) translation_m = vector_of(*t);
  if (const Json* r = placement->find("rotation_deg")) rotation_deg = vector_of(*r);
}

RigidPath read_moves(const Json& moves, const Vec3& centre) {
  std::vector<RigidKey> keys;
  for (const Json& key : moves.array()) {
    key.allow_only({"t_s", "shift_m", "rotation_deg", "scale"});
    RigidKey next = keys.empty() ? RigidKey{} : keys.back();
    next.t_s = number_in(key.at("t_s"), 0, most_seconds);
    if (!keys.empty() && !(next.t_s > keys.back().t_s))
      key.at("t_s").fail("times that ascend", "a time not after the one before");
    if (const Json* shift = key.find("shift_m")) next.shift_m = vector_of(*shift);
    if (const Json* rotation = key.find("rotation_deg")) next.rotation_deg = vector_of(*rotation, 1e6);
    read_number(key, "scale", next.scale, 1, 0.01, 100);
    keys.push_back(next);
  }
  if (keys.empty()) moves.fail("at least one {\"t_s\": ...}", "an empty array");
  return {std::move(keys), centre};
}

}  // namespace toile::scene_reading
