// sim/scene_reader.hpp: fills a scene's objects from JSON, by their descriptions (sim/settings.hpp).
//
// Every refusal names file, line and JSON pointer.  An object's keys are checked first, so that a misspelt one is reported as
// such and not as a missing one; then the values in the order of the description; then values against each other (`settle`).
#pragma once
#include "sim/scene_reading.hpp"
#include "sim/scene_settle.hpp"
#include "sim/settings.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace toile::internal::scene_reading {

// The keys of an object, and which of them exclude each other.
class KeyVisitor {
 public:
  template <class... Any>
  void number(const Setting& s, const Range&, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void whole(const Setting& s, const Range&, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void wholes(const Setting& s, const Range&, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void flag(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void text(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void text_among(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void path(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void name(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void fabric(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void vector(const Setting& s, const Range&, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void box(const Setting& s, const Range&, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void rows(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void list(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void table(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void heights(const Setting& s, const Range&, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void object(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void group(const Setting& s, const Any&...) {
    keys_.push_back(s.key);
  }
  template <class... Any>
  void alternative(std::string_view key, const Any&...) {
    keys_.push_back(key);
  }
  void exactly_one(const std::vector<std::string_view>& keys) { groups_.push_back({keys, true}); }
  void at_most_one(const std::vector<std::string_view>& keys) { groups_.push_back({keys, false}); }

  // Throws for a key that the object does not know, and for keys that exclude each other.
  void check(const Json& object) const;

 private:
  struct Group {
    std::vector<std::string_view> keys;
    bool one_needed;
  };
  std::vector<std::string_view> keys_;
  std::vector<Group> groups_;
};

// The columns of a row, in words: "three numbers [x, y, z]".
class ColumnVisitor {
 public:
  void column(std::string_view name, const Range&, double) { columns_.push_back(name); }
  void fabric_column(std::string_view name, const std::string&) {
    columns_.push_back(name);
    only_numbers_ = false;
  }
  std::size_t count() const { return columns_.size(); }
  std::string shape() const;  // "[x, y, z]"
  std::string words() const;  // "three numbers [x, y, z]"

 private:
  std::vector<std::string_view> columns_;
  bool only_numbers_ = true;
};

class RowReader {
 public:
  explicit RowReader(const Json& row) : row_(&row) {}
  void column(std::string_view, const Range& range, double& x) { x = number_in(next(), range); }
  void fabric_column(std::string_view, std::string& name);

 private:
  const Json& next() { return row_->array()[column_++]; }
  const Json* row_;
  std::size_t column_ = 0;
};

class SceneReader {
 public:
  struct Source {
    const std::string& file;  // the scene's: paths are relative to its folder
    JsonPlaces& places;       // of its objects
  };
  SceneReader(const Json& value, const Source& source) : value_(&value), source_(source) {}

  template <class T>
  static void read(const Json& value, const Source& source, T& object, const Shorthand& shorthand = {}) {
    SceneReader reader(value, source);
    if (shorthand && !value.is_object()) {
      if (!value.is_string()) value.fail("a string or an object", value.describe());
      reader.only_key_ = shorthand(value.string());
    } else {
      KeyVisitor keys;
      describe(keys, object);
      keys.check(value);
    }
    describe(reader, object);
    settle(value, object);
    source.places.add(value);
  }

  template <class Member>  // double, or one that may be absent
  void number(const Setting& s, const Range& range, Member& x) {
    if (const Json* value = find(s)) x = range.unit * number_in(*value, range);
  }
  void number(const Setting& s, const Range& range, double& x, bool& given) {
    given = find(s) != nullptr;
    number(s, range, x);
  }
  template <class Member>
  void whole(const Setting& s, const Range& range, Member& x) {
    if (const Json* value = find(s)) x = whole_in(*value, range);
  }
  void wholes(const Setting& s, const Range& each, std::vector<int>& x) {
    if (const Json* value = find(s))
      for (const Json& one : value->array()) x.push_back(whole_in(one, each));
  }
  template <class Member>
  void flag(const Setting& s, Member& x) {
    if (const Json* value = find(s)) x = value->boolean();
  }
  void text(const Setting& s, std::string& x) {
    if (const Json* value = find(s)) x = value->string();
  }
  void text_among(const Setting& s, std::span<const std::string_view> names, std::string& x) {
    if (const Json* value = find(s)) x = names[one_of(*value, names)];
  }
  void path(const Setting& s, std::string& x) {
    if (const Json* value = find(s)) x = resolve(source_.file, *value);
  }
  template <class E>
  void name(const Setting& s, std::type_identity_t<Names<E>> names, E& x) {
    const Json* value = find(s);
    if (value == nullptr) return;
    std::vector<std::string_view> words;
    for (const auto& [word, meant] : names) words.push_back(word);
    x = names[one_of(*value, words)].second;
  }
  void fabric(const Setting& s, Fabric& x) {
    if (const Json* value = find(s)) x = fabric_preset(value->string(), value->where(), value->pointer());
  }
  void vector(const Setting& s, const Range& each, Vec3& x) {
    if (const Json* value = find(s)) x = vector_of(*value, each);
  }
  void box(const Setting& s, const Range& each, std::optional<std::array<Vec3, 2>>& x);
  template <class T, class Row>
  void rows(const Setting& s, const Rows& rows, std::vector<T>& x, const Row& row_of) {
    const Json* value = find(s);
    if (value == nullptr) return;
    ColumnVisitor columns;
    T any{};
    row_of(columns, any);
    for (const Json& row : value->array()) {
      if (!row.is_array() || row.array().size() != columns.count()) row.fail(columns.words(), row.describe());
      T next{};
      RowReader reader(row);
      row_of(reader, next);
      if (rows.ascending && !x.empty() && !(row.array()[0].number() > value->array()[x.size() - 1].array()[0].number()))
        row.fail("times that ascend", "a time not after the one before");
      x.push_back(next);
    }
    check_least(*value, rows.least, columns.shape());
  }
  template <class T>
  void list(const Setting& s, std::vector<T>& x, std::size_t least = 0) {
    const Json* value = find(s);
    if (value == nullptr) return;
    for (const Json& one : value->array()) {
      T next = goes_on_from_the_last<T> && !x.empty() ? x.back() : T{};
      read(one, source_, next);
      x.push_back(std::move(next));
    }
    check_least(*value, least, "element");
  }
  template <class T>
  void table(const Setting& s, std::vector<T>& x, std::string T::*name) {
    const Json* value = find(s);
    if (value == nullptr) return;
    for (const auto& [key, one] : value->object()) {
      T next;
      next.*name = key;
      read(one, source_, next);
      x.push_back(std::move(next));
    }
  }
  void heights(const Setting& s, const Range& range, std::vector<LabelHeight>& x) {
    if (const Json* value = find(s))
      for (const auto& [label, height] : value->object()) x.push_back({label, number_in(height, range)});
  }
  template <class T>
  void object(const Setting& s, T& x, const Shorthand& shorthand = {}) {
    if (const Json* value = find(s)) read(*value, source_, x, shorthand);
  }
  template <class T>
  void object(const Setting& s, std::optional<T>& x, const Shorthand& shorthand = {}) {
    if (const Json* value = find(s)) read(*value, source_, x.emplace(), shorthand);
  }
  template <class Describe>
  void group(const Setting& s, const Describe& describe_members) {
    const Json* value = find(s);
    if (value == nullptr) return;
    KeyVisitor keys;
    describe_members(keys);
    keys.check(*value);
    SceneReader reader(*value, source_);
    describe_members(reader);
  }
  template <class Choose, class Describe>
  void alternative(std::string_view key, bool, const Choose& choose, const Describe& describe_it) {
    if (!has(key)) return;
    choose();
    describe_it(*this);
  }
  void exactly_one(const std::vector<std::string_view>&) {}
  void at_most_one(const std::vector<std::string_view>&) {}

 private:
  template <class T>
  static constexpr bool goes_on_from_the_last = std::is_same_v<T, RigidKey>;

  bool has(std::string_view key) const { return only_key_.empty() ? value_->find(key) != nullptr : key == only_key_; }
  // The value given for a key; nullptr where its default holds.  Throws for a missing key without default.
  const Json* find(const Setting& s) const {
    if (!only_key_.empty()) return s.key == only_key_ ? value_ : nullptr;
    const Json* value = s.needed ? &value_->at(s.key) : value_->find(s.key);
    return value != nullptr && s.may_be_null && value->is_null() ? nullptr : value;
  }
  const Json* value_;
  Source source_;
  std::string_view only_key_;  // the object is written as the value of this key
};

}  // namespace toile::internal::scene_reading
