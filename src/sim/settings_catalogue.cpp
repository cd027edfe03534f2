#include "sim/settings_catalogue.hpp"

#include "io/json_text.hpp"
#include "sim/settings_scene.hpp"

#include <optional>
#include <set>
#include <type_traits>
#include <utility>

namespace toile::internal {
namespace {

using Kind = SettingNode::Kind;

template <class T>
std::string json_of(const T& x) {
  JsonText text(0);
  text.value(x);
  return text.str();
}
std::string json_of(const std::string& x) { return json_of(std::string_view(x)); }

// Visits the members of default objects, whose values are the defaults.
class Catalogue {
 public:
  explicit Catalogue(SettingNode& object) : object_(&object) {}

  template <class Member>
  void number(const Setting& s, const Range& range, const Member& x) {
    SettingNode& node = add(s, Kind::number);
    node.range = range;
    set_default(node, x, range.unit);
  }
  void number(const Setting& s, const Range& range, double x, bool) { number(s, range, x); }
  template <class Member>
  void whole(const Setting& s, const Range& range, const Member& x) {
    SettingNode& node = add(s, Kind::whole);
    node.range = range;
    set_default(node, x, 1);
  }
  void wholes(const Setting& s, const Range& each, const std::vector<int>&) { add(s, Kind::wholes).range = each; }
  template <class Member>
  void flag(const Setting& s, const Member& x) {
    set_default(add(s, Kind::flag), x, 1);
  }
  void text(const Setting& s, const std::string&) { add(s, Kind::text); }
  void text_among(const Setting& s, std::span<const std::string_view> names, const std::string&) {
    add(s, Kind::name).names.assign(names.begin(), names.end());
  }
  void path(const Setting& s, const std::string&) { add(s, Kind::path); }
  template <class E>
  void name(const Setting& s, std::type_identity_t<Names<E>> names, const E& x) {
    SettingNode& node = add(s, Kind::name);
    for (const auto& [word, meant] : names) {
      node.names.emplace_back(word);
      if (meant == x && node.value.empty() && s.otherwise.empty()) node.value = json_of(word);
    }
  }
  void fabric(const Setting& s, const Fabric& x) {
    SettingNode& node = add(s, Kind::fabric);
    for (const Fabric& preset : fabric_presets()) node.names.push_back(preset.name);
    node.value = json_of(x.name);
  }
  void vector(const Setting& s, const Range& each, const Vec3& x) {
    SettingNode& node = add(s, Kind::vector);
    node.range = each;
    if (s.needed || !s.otherwise.empty()) return;
    for (const double component : x) node.value += (node.value.empty() ? "[" : ", ") + json_of(component);
    node.value += ']';
  }
  void box(const Setting& s, const Range& each, const std::optional<std::array<Vec3, 2>>&) {
    add(s, Kind::box).range = each;
  }
  template <class T, class Row>
  void rows(const Setting& s, const Rows& rows, const std::vector<T>&, const Row& row_of) {
    SettingNode& node = add(s, Kind::rows);
    node.least = rows.least;
    Catalogue columns(node);
    T any{};
    row_of(columns, any);
  }
  void column(std::string_view name, const Range& range, double) {
    SettingNode& node = add({name, ""}, Kind::number);
    node.range = range;
    node.is_column = true;
  }
  void fabric_column(std::string_view name, const std::string&) {
    fabric({name, ""}, Fabric{});
    object_->inside.back().value.clear();
    object_->inside.back().is_column = true;
  }

  template <class T>
  void list(const Setting& s, const std::vector<T>&, std::size_t least = 0) {
    T any{};
    add_object(s, Kind::list, any).least = least;
  }
  template <class T>
  void table(const Setting& s, const std::vector<T>&, std::string T::*) {
    T any{};
    add_object(s, Kind::table, any);
  }
  void heights(const Setting& s, const Range& range, const std::vector<LabelHeight>&) {
    add(s, Kind::numbers).range = range;
  }
  template <class T>
  void object(const Setting& s, T& x, const Shorthand& shorthand = {}) {
    if (SettingNode& node = add_object(s, Kind::object, x); shorthand) node.shorthand = shorthand("word");
  }
  template <class T>
  void object(const Setting& s, std::optional<T>&, const Shorthand& shorthand = {}) {
    T any{};
    object(s, any, shorthand);
  }
  template <class Describe>
  void group(const Setting& s, const Describe& describe_members) {
    SettingNode& node = add(s, Kind::object);
    Catalogue inside(node);
    describe_members(inside);
  }
  template <class Choose, class Describe>
  void alternative(std::string_view, bool, const Choose& choose, const Describe& describe_it) {
    choose();
    describe_it(*this);
  }
  void exactly_one(const std::vector<std::string_view>& keys) { object_->groups.push_back({keys, true}); }
  void at_most_one(const std::vector<std::string_view>& keys) { object_->groups.push_back({keys, false}); }

 private:
  SettingNode& add(const Setting& s, Kind kind) {
    object_->inside.push_back({});
    SettingNode& node = object_->inside.back();
    node.setting = s;
    node.kind = kind;
    return node;
  }
  template <class T>
  SettingNode& add_object(const Setting& s, Kind kind, T& x) {
    SettingNode& node = add(s, kind);
    node.shared = shared_name<std::remove_cvref_t<T>>;
    Catalogue inside(node);
    describe(inside, x);
    return node;
  }
  template <class T>
  static void set_default(SettingNode& node, const T& x, double unit) {
    if (node.setting.needed || !node.setting.otherwise.empty()) return;
    if constexpr (std::is_same_v<T, double>) {
      node.value = json_of(x / unit);
    } else {
      node.value = json_of(x);
    }
  }
  template <class T>
  static void set_default(SettingNode& node, const std::optional<T>& x, double unit) {
    if (x) set_default(node, *x, unit);
  }

  SettingNode* object_;
};

}  // namespace

std::string unit_of(std::string_view key) {
  static constexpr std::pair<std::string_view, std::string_view> units[] = {{"_m_per_s2", "m/s2"},
                                                                            {"_m_per_s", "m/s"},
                                                                            {"_kg_per_m3", "kg/m3"},
                                                                            {"_kg_per_m2", "kg/m2"},
                                                                            {"_N_s_per_m", "N s/m"},
                                                                            {"_N_per_m", "N/m"},
                                                                            {"_per_m", "1/m"},
                                                                            {"_N_m", "N m"},
                                                                            {"_N", "N"},
                                                                            {"_Pa", "Pa"},
                                                                            {"_deg", "degrees"},
                                                                            {"_mm", "mm"},
                                                                            {"_cm", "cm"},
                                                                            {"_ms", "ms"},
                                                                            {"_m", "m"},
                                                                            {"_s", "s"}};
  for (const auto& [ending, unit] : units)
    if (key.ends_with(ending)) return std::string(unit);
  if (key == "fps") return "1/s";
  if (key.ends_with("seconds")) return "s";
  return {};
}

SettingNode scene_settings() {
  SettingNode scene;
  Catalogue catalogue(scene);
  Scene fresh;
  describe(catalogue, fresh);
  return scene;
}

std::size_t count_settings(const SettingNode& scene) {
  std::set<std::string_view> counted;
  const auto count = [&](const auto& self, const SettingNode& node) -> std::size_t {
    if (node.is_leaf()) return 1;
    if (!node.shared.empty() && !counted.insert(node.shared).second) return 0;
    std::size_t sum = 0;
    for (const SettingNode& one : node.inside) sum += self(self, one);
    return sum;
  };
  return count(count, scene);
}

}  // namespace toile::internal
