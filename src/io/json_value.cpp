#include "io/json_value.hpp"

#include "io/json_text.hpp"

#include <algorithm>

namespace toile::internal {
namespace {

constexpr std::size_t line_length = 100;  // characters: a corner, an edge or a stitch is one line

void write(const JsonValue& value, JsonText& text, bool lines);

void write_members(const JsonValue& value, JsonText& text, bool lines) {
  if (const auto* array = std::get_if<JsonValue::Array>(&value.value)) {
    text.begin_array();
    for (const JsonValue& element : *array) write(element, text, lines);
    text.end_array();
  } else if (const auto* object = std::get_if<JsonValue::Object>(&value.value)) {
    text.begin_object();
    for (const auto& [key, member] : *object) {
      text.key(key);
      write(member, text, lines);
    }
    text.end_object();
  } else if (const auto* flag = std::get_if<bool>(&value.value)) {
    text.value(*flag);
  } else if (const double* number = value.number()) {
    text.value(*number);
  } else if (const std::string* string = value.string()) {
    text.value(*string);
  } else {
    text.null();
  }
}

// The value in one line, or nothing where that is too long.
std::string one_line(const JsonValue& value) {
  std::size_t parts = 0;  // a value of many parts is not written twice at every level
  if (const auto* array = std::get_if<JsonValue::Array>(&value.value)) parts = array->size();
  if (const auto* object = std::get_if<JsonValue::Object>(&value.value)) parts = object->size();
  if (parts > line_length / 2) return {};
  JsonText text(0);
  write_members(value, text, false);
  return text.str().size() <= line_length ? text.str() : std::string();
}

void write(const JsonValue& value, JsonText& text, bool lines) {
  const bool nested = value.value.index() >= 4;
  const std::string line = nested && lines ? one_line(value) : std::string();
  if (line.empty()) {
    write_members(value, text, lines);
  } else {
    text.raw(line);
  }
}

}  // namespace

JsonValue::JsonValue(const Json& json) {
  switch (json.type()) {
    case Json::Type::null:
      break;
    case Json::Type::boolean:
      value = json.boolean();
      break;
    case Json::Type::number:
      value = json.number();
      break;
    case Json::Type::string:
      value = json.string();
      break;
    case Json::Type::array: {
      Array elements;
      for (const Json& element : json.array()) elements.emplace_back(element);
      value = std::move(elements);
      break;
    }
    case Json::Type::object: {
      Object members;
      for (const auto& [key, member_json] : json.object()) members.emplace_back(key, JsonValue(member_json));
      value = std::move(members);
      break;
    }
  }
}

JsonValue* JsonValue::find(std::string_view key) {
  Object* members = object();
  if (members == nullptr) return nullptr;
  const auto found = std::find_if(members->begin(), members->end(), [&](const auto& m) { return m.first == key; });
  return found == members->end() ? nullptr : &found->second;
}

JsonValue& JsonValue::member(std::string_view key) {
  if (JsonValue* found = find(key)) return *found;
  if (object() == nullptr) value = Object{};
  object()->emplace_back(std::string(key), JsonValue());
  return object()->back().second;
}

std::string to_text(const JsonValue& value) {
  JsonText text(1);
  write(value, text, true);
  return text.str() + '\n';
}

}  // namespace toile::internal
