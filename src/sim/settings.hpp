// sim/settings.hpp: the description of every key of a scene, once.                           docs/scenes.md#settings
//
// `describe(v, object)` lists the keys of an object, each with its member and its allowed values, to a visitor.  Everything
// about a key follows from this list:
//
//   SceneReader      JSON -> members, and every refusal      sim/scene_reader.hpp
//   SettingsHash     members -> input_hash                   sim/scene_hash.cpp
//   Catalogue        -> a tree of plain data                 sim/settings_catalogue.hpp: JSON schema, documentation
//
// A key has the unit in its name, `width_m`, and a member is in SI: `Range::unit` is the SI value of one unit of the key.
// The default is the member's in a default object; `Setting::otherwise` says it in words where it is no value.
//
// Easily got wrong: a condition between two keys (an end after a beginning) is no part of a description; the object's
// `settle` checks it (sim/scene_settle.hpp), once all keys are read.
#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace toile::internal {

struct Setting {
  std::string_view key;
  std::string_view meaning;         // one line, Markdown
  std::string_view otherwise = {};  // the default in words; empty: the member's own value
  bool needed = false;
  bool may_be_null = false;  // null is the same as not given
  bool in_result = true;     // false: it changes neither the result nor the hash

  constexpr Setting needs() const {
    Setting s = *this;
    s.needed = true;
    return s;
  }
  constexpr Setting or_null() const {
    Setting s = *this;
    s.may_be_null = true;
    return s;
  }
  constexpr Setting without_effect() const {
    Setting s = *this;
    s.in_result = false;
    return s;
  }
};

// The range of a number as in the file.
struct Range {
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  double unit = 1;     // SI per unit of the key
  bool above = false;  // `least` itself is too small
  constexpr bool contains(double x) const { return x <= most && x >= least && !(above && x == least); }
};

inline constexpr double most_seconds = 3600, most_fps = 1000;
inline constexpr double farthest_m = 1e4;  // from the origin
inline constexpr Range anywhere{-farthest_m, farthest_m}, within_a_run{0, most_seconds};
inline constexpr Range any_angle{-1e6, 1e6};  // degrees: turns are counted, 720 are two

// The number of rows of an array of arrays.
struct Rows {
  std::size_t least = 1;
  bool ascending = false;  // by the first column
};

template <class E>
using Names = std::span<const std::pair<std::string_view, E>>;

// The key that a string stands for where an object is expected: "silk" for {"base": "silk"}.  Empty: a string is an error.
using Shorthand = std::function<std::string_view(const std::string& text)>;

// An object that occurs in several places of a scene has a name, and one description: "fabric".
template <class T>
inline constexpr std::string_view shared_name = {};

// "m" of "width_m", "m/s2" of "gravity_m_per_s2", "" of "friction".
std::string unit_of(std::string_view key);

}  // namespace toile::internal
