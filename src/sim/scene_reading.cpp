#include "sim/scene_reading.hpp"

#include "sim/scene_reader.hpp"

#include <fmt/printf.h>

#include <array>
#include <cmath>
#include <filesystem>

namespace toile::internal::scene_reading {
namespace {

std::string in_words(const Range& range) {
  const std::string least = range.least == 0 && range.above ? "zero" : fmt::sprintf("%g", range.least);
  return fmt::sprintf("%s %s and at most %g", range.above ? "above" : "of at least", least, range.most);
}

std::string quoted(std::span<const std::string_view> names, std::string_view between) {
  std::string list;
  for (const std::string_view name : names) {
    if (!list.empty()) list += between;
    list += '"' + std::string(name) + '"';
  }
  return list;
}

}  // namespace

double number_in(const Json& value, const Range& range) {
  const double x = value.number();
  if (!range.contains(x)) value.fail("a number " + in_words(range), value.describe());
  return x;
}

int whole_in(const Json& value, const Range& range) {
  const double x = value.number();
  if (!range.contains(x) || x != std::floor(x)) value.fail("a whole number " + in_words(range), value.describe());
  return static_cast<int>(x);
}

Vec3 vector_of(const Json& value, const Range& each) {
  if (!value.is_array() || value.array().size() != 3) value.fail("three numbers [x, y, z]", value.describe());
  Vec3 v;
  for (std::size_t k = 0; k < 3; ++k) v[static_cast<Eigen::Index>(k)] = number_in(value.array()[k], each);
  return v;
}

std::size_t one_of(const Json& value, std::span<const std::string_view> names) {
  const std::string& name = value.string();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return i;
  value.fail("one of " + quoted(names, ", ") + "; nearest is \"" +
                 std::string(nearest_name(name, names.data(), names.size())) + '"',
             value.describe());
}

std::string resolve(const std::string& scene_file, const Json& value) {
  const std::string& path = value.string();
  if (path.empty() || path.find('\0') != std::string::npos) value.fail("a path", value.describe());
  const std::filesystem::path given(path);
  if (given.is_absolute()) return given.lexically_normal().string();
  return (std::filesystem::path(scene_file).parent_path() / given).lexically_normal().string();
}

void check_least(const Json& array, std::size_t least, std::string_view element) {
  const std::size_t count = array.array().size();
  if (count >= least) return;
  if (least == 1) array.fail("at least one " + std::string(element), "an empty array");
  array.fail("at least " + std::to_string(least) + " points " + std::string(element), std::to_string(count));
}

void KeyVisitor::check(const Json& object) const {
  object.allow_only(keys_);
  for (const Group& group : groups_) {
    std::size_t given = 0;
    for (const std::string_view key : group.keys)
      if (object.find(key) != nullptr) ++given;
    if (given == 1 || (given == 0 && !group.one_needed)) continue;
    if (given == 0) object.fail("one of " + quoted(group.keys, ", "), "none of them");
    if (group.keys.size() == 2) object.at(group.keys[0]).fail("either " + quoted(group.keys, " or "), "both");
    object.fail("one of " + quoted(group.keys, ", "), std::to_string(given) + " of them");
  }
}

std::string ColumnVisitor::shape() const {
  std::string text = "[";
  for (const std::string_view column : columns_) text += (text.size() > 1 ? ", " : "") + std::string(column);
  return text + ']';
}

std::string ColumnVisitor::words() const {
  static constexpr std::array<std::string_view, 5> counts = {"no", "one", "two", "three", "four"};
  return (only_numbers_ ? std::string(counts.at(count())) + " numbers " : "an array ") + shape();
}

void RowReader::fabric_column(std::string_view, std::string& name) {
  const Json& given = next();
  name = fabric_preset(given.string(), given.where(), given.pointer()).name;
}

void SceneReader::box(const Setting& s, const Range& each, std::optional<std::array<Vec3, 2>>& x) {
  const Json* value = find(s);
  if (value == nullptr) return;
  if (!value->is_array() || value->array().size() != 2)
    value->fail("two corners [[x, y, z], [x, y, z]]", value->describe());
  const Vec3 a = vector_of(value->array()[0], each), b = vector_of(value->array()[1], each);
  x = {a.cwiseMin(b), a.cwiseMax(b)};
}

}  // namespace toile::internal::scene_reading
