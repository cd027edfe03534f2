// io/json.hpp: JSON values that keep their place in the file, so that an error can name file, line and pointer.
//
// Values keep their source line and column (both from 1; columns count characters, not bytes) and objects the order of
// their keys.  Errors: a duplicate key, a number beyond double, text that is not UTF-8, a NUL byte, and text beyond
// the limits below.  The getters throw InputError of the form
//   scene.json:14:22: /cloth/0/density_kg_per_m2: expected a finite number > 0, got -0.2
//
// Easily missed: a Json holds no references to its parent.  It may be copied out of it and outlive it, and keeps its
// place.
#pragma once
#include "core/error.hpp"

#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace toile::internal {

// One reference token of a JSON pointer, with its slash.  [RFC 6901]
std::string pointer_step(std::string_view key);

class Json {
 public:
  enum class Type { null, boolean, number, string, array, object };
  using Array = std::vector<Json>;
  using Object = std::vector<std::pair<std::string, Json>>;

  static constexpr std::size_t text_limit = std::size_t{64} << 20;   // bytes
  static constexpr std::size_t string_limit = std::size_t{1} << 20;  // bytes of a key or a string
  static constexpr std::size_t value_limit = 2'000'000;              // values in one text
  static constexpr std::size_t depth_limit = 64;                     // nested arrays and objects

  // `file` is used in messages only.  A UTF-8 byte order mark is skipped.  Throws InputError with line and column.
  static Json parse(std::string_view text, std::string_view file);
  // Throws IoError when the file cannot be read, InputError when it is not JSON.
  static Json load(const std::string& path);

  Type type() const { return static_cast<Type>(value_.index()); }
  bool is_null() const { return type() == Type::null; }
  bool is_boolean() const { return type() == Type::boolean; }
  bool is_object() const { return type() == Type::object; }
  bool is_array() const { return type() == Type::array; }
  bool is_string() const { return type() == Type::string; }
  bool is_number() const { return type() == Type::number; }

  // Where this value stands: "scene.json:14:22", and "/cloth/0/name" (RFC 6901: "~" in a key is "~0", "/" is "~1").
  std::string where() const;
  std::string pointer() const;

  // Typed access; throws InputError when the value is of another type.
  double number() const;      // finite
  long long integer() const;  // a number without fraction between -(2^53 - 1) and 2^53 - 1, so that none was rounded
  bool boolean() const;
  const std::string& string() const;
  const Array& array() const;
  const Object& object() const;

  // Members of an object; throws InputError when the value is none.
  const Json* find(std::string_view key) const;  // nullptr when absent
  const Json& at(std::string_view key) const;    // InputError "missing key" when absent
  // The fallback stands for an absent key only: a null or a value of another type is an error.
  double number_or(std::string_view key, double fallback) const;
  bool boolean_or(std::string_view key, bool fallback) const;
  std::string string_or(std::string_view key, std::string_view fallback) const;

  // Throws InputError for the first key not in `keys`, naming the nearest valid one.
  void allow_only(std::span<const std::string_view> keys) const;
  void allow_only(std::initializer_list<std::string_view> keys) const {
    allow_only(std::span(keys.begin(), keys.size()));
  }

  // An error at this value.
  [[noreturn]] void fail(std::string_view expected, std::string_view got) const;
  // "the string \"abc\"", "-0.2", "an array of 3": the "got" of a message.
  std::string describe() const;

 private:
  friend class JsonBuilder;

  // A place is stored relative to its parent's, so that a long key is stored once and not in every pointer below it.
  // Elements of an array that are neither array nor object share the place of the array; all other values have their
  // own.
  struct Place {
    std::shared_ptr<const std::string> file;
    std::shared_ptr<const Place> around;  // none at the root
    std::string step;                     // a key or an index
  };

  std::variant<std::monostate, bool, double, std::string, Array, Object> value_;  // in the order of Type
  std::shared_ptr<const Place> place_;
  int line_ = 0, column_ = 0;
  int index_ = -1;  // in the array whose place_ this is; -1 when place_ is this value's own
};

}  // namespace toile::internal
