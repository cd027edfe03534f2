// sim/settings_catalogue.hpp: the descriptions of all settings (sim/settings.hpp) as a tree of plain data; JSON schema and documentation.
#pragma once
#include "sim/settings.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct SettingNode {
  enum class Kind {
    number,
    whole,
    flag,
    text,
    path,
    name,     // one of `names`
    fabric,   // one of the presets' names
    vector,   // three numbers in `range`
    box,      // two corners
    wholes,   // an array of whole numbers
    rows,     // an array of arrays, of which `inside` are the columns
    numbers,  // an object of numbers, by names that the user chooses
    object,   // of the keys `inside`
    list,     // an array of such objects
    table     // an object of such objects, by names that the user chooses
  };
  Setting setting;
  Kind kind = Kind::object;
  Range range;
  std::vector<std::string> names;
  std::string value;           // the default, as JSON; empty: see Setting::otherwise
  std::size_t least = 0;       // least number of elements of an array
  std::string_view shared;     // the name of an object that occurs in several places
  bool is_column = false;      // of rows: it has a name and no key
  std::string_view shorthand;  // the key whose value may replace the object as a string; empty: none
  std::vector<SettingNode> inside;
  struct Group {
    std::vector<std::string_view> keys;
    bool one_needed;  // false: at most one
  };
  std::vector<Group> groups;  // keys inside that exclude each other

  bool is_leaf() const { return kind != Kind::object && kind != Kind::list && kind != Kind::table; }
};

// The scene itself: an object without a key.
SettingNode scene_settings();

// Calls visit(path, node) for every key below `node`, in order: "cloth[].grid.width_m", "cloth[].panels{}.fabric".
template <class Visit>
void for_each_setting(const SettingNode& node, const std::string& path, const Visit& visit) {
  for (const SettingNode& one : node.inside) {
    const std::string here = (path.empty() ? "" : path + '.') + std::string(one.setting.key);
    visit(here, one);
    if (!one.is_leaf())
      for_each_setting(one,
                       here + (one.kind == SettingNode::Kind::list    ? "[]"
                               : one.kind == SettingNode::Kind::table ? "{}"
                                                                      : ""),
                       visit);
  }
}

// The number of keys that hold a value; those of a shared object count once.
std::size_t count_settings(const SettingNode& scene);

// docs/scene.schema.json
std::string scene_schema(const SettingNode& scene);
// The part of docs/scenes.md between these two lines.
inline constexpr std::string_view settings_begin = "<!-- settings: made by `make settings` -->",
                                  settings_end = "<!-- settings: end -->";
std::string settings_table(const SettingNode& scene);

}  // namespace toile::internal
