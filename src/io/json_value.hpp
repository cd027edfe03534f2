// io/json_value.hpp: JSON values that can be edited and written again.
//
// Keys keep their order and numbers their bits; unedited values stay as they were.  Places in the file are not kept: for those use
// Json.
#pragma once
#include "io/json.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace toile::internal {

struct JsonValue {
  using Array = std::vector<JsonValue>;
  using Object = std::vector<std::pair<std::string, JsonValue>>;
  std::variant<std::monostate, bool, double, std::string, Array, Object> value;  // monostate: null

  JsonValue() = default;
  JsonValue(double number) : value(number) {}
  JsonValue(std::string text) : value(std::move(text)) {}
  JsonValue(Array array) : value(std::move(array)) {}
  JsonValue(Object object) : value(std::move(object)) {}
  explicit JsonValue(const Json& json);

  // nullptr if this is no object, or has no such key.
  JsonValue* find(std::string_view key);
  // The member, added if it is missing; a value that is no object becomes one.
  JsonValue& member(std::string_view key);
  // nullptr where this is no array or object.
  Array* array() { return std::get_if<Array>(&value); }
  Object* object() { return std::get_if<Object>(&value); }
  const double* number() const { return std::get_if<double>(&value); }
  const std::string* string() const { return std::get_if<std::string>(&value); }
};

// Values that fit into a line of 100 characters are written on one line; ends with a line feed.
std::string to_text(const JsonValue& value);

}  // namespace toile::internal
