// sim/settings_schema.cpp: the JSON schema of a scene, for editors.              [JSON Schema, draft 2020-12]
#include "io/json_text.hpp"
#include "sim/settings_catalogue.hpp"

#include <limits>
#include <map>
#include <utility>

namespace toile::internal {
namespace {

using Kind = SettingNode::Kind;

// Replaces links by their text: an editor shows plain text.
std::string plain(std::string_view markdown) {
  std::string text;
  for (std::size_t at = 0; at < markdown.size(); ++at) {
    const std::size_t middle = markdown[at] == '[' ? markdown.find("](", at) : std::string_view::npos;
    const std::size_t end = middle == std::string_view::npos ? middle : markdown.find(')', middle);
    if (end == std::string_view::npos) {
      text += markdown[at];
      continue;
    }
    text += markdown.substr(at + 1, middle - at - 1);
    at = end;
  }
  return text;
}

class Schema {
 public:
  std::string of(const SettingNode& scene) {
    json_.begin_object();
    json_.member("$schema", "https://json-schema.org/draft/2020-12/schema");
    json_.member("title", "Toile scene");
    json_.member("description", "Made from the description of the settings: make settings");
    members_of(scene);
    json_.key("$defs");
    json_.begin_object();
    while (!waiting_.empty()) {  // a shared object may hold another one
      const auto [name, node] = *waiting_.begin();
      waiting_.erase(waiting_.begin());
      json_.key(name);
      json_.begin_object();
      members_of(*node);
      json_.end_object();
    }
    json_.end_object();
    json_.end_object();
    return json_.str() + '\n';
  }

 private:
  void limits(const Range& range) {
    if (range.least > -std::numeric_limits<double>::infinity())
      json_.member(range.above ? "exclusiveMinimum" : "minimum", range.least);
    if (range.most < std::numeric_limits<double>::infinity()) json_.member("maximum", range.most);
  }
  void number(const Range& range, const char* type = "number") {
    json_.member("type", type);
    limits(range);
  }
  void array(std::size_t least, std::size_t most = 0) {
    json_.member("type", "array");
    if (least > 0) json_.member("minItems", least);
    if (most > 0) json_.member("maxItems", most);
  }
  void vector(const Range& each) {
    array(3, 3);
    json_.key("items");
    json_.begin_object();
    number(each);
    json_.end_object();
  }
  void text(const SettingNode& node) {
    json_.member("type", "string");
    if (node.kind == Kind::path) json_.member("minLength", 1);
  }
  void names(const SettingNode& node) {
    json_.key("enum");
    json_.begin_array();
    for (const std::string& name : node.names) json_.value(name);
    json_.end_array();
  }

  // An object's type and keys.
  void members_of(const SettingNode& node) {
    json_.member("type", "object");
    std::vector<std::string_view> needed;
    json_.key("properties");
    json_.begin_object();
    for (const SettingNode& one : node.inside) {
      if (one.setting.needed) needed.push_back(one.setting.key);
      json_.key(one.setting.key);
      json_.begin_object();
      json_.member("description", plain(one.setting.meaning));
      value_of(one);
      json_.end_object();
    }
    json_.end_object();
    if (!needed.empty()) keys("required", needed);
    json_.member("additionalProperties", false);
    if (node.groups.empty()) return;
    json_.key("allOf");
    json_.begin_array();
    for (const SettingNode::Group& group : node.groups) {
      json_.begin_object();
      exclusive(group);
      json_.end_object();
    }
    json_.end_array();
  }
  void keys(std::string_view name, const std::vector<std::string_view>& words) {
    json_.key(name);
    json_.begin_array();
    for (const std::string_view word : words) json_.value(word);
    json_.end_array();
  }
  void exclusive(const SettingNode::Group& group) {
    json_.key("oneOf");
    json_.begin_array();
    for (const std::string_view key : group.keys) {
      json_.begin_object();
      keys("required", {key});
      json_.end_object();
    }
    if (!group.one_needed) {  // none of them is allowed, too
      json_.begin_object();
      json_.key("not");
      json_.begin_object();
      json_.key("anyOf");
      json_.begin_array();
      for (const std::string_view key : group.keys) {
        json_.begin_object();
        keys("required", {key});
        json_.end_object();
      }
      json_.end_array();
      json_.end_object();
      json_.end_object();
    }
    json_.end_array();
  }

  void object(const SettingNode& node) {
    if (node.shared.empty()) return members_of(node);
    json_.member("$ref", "#/$defs/" + std::string(node.shared));
    if (known_.emplace(node.shared, &node).second) waiting_.emplace(node.shared, &node);
  }
  void in_braces(std::string_view key, const auto& write) {
    json_.key(key);
    json_.begin_object();
    write();
    json_.end_object();
  }
  const SettingNode& inside(const SettingNode& node, std::string_view key) const {
    for (const SettingNode& one : node.inside)
      if (one.setting.key == key) return one;
    return node.inside.front();
  }

  void value_of(const SettingNode& node) {
    switch (node.kind) {
      case Kind::number:
        number(node.range);
        break;
      case Kind::whole:
        number(node.range, "integer");
        break;
      case Kind::flag:
        json_.member("type", "boolean");
        break;
      case Kind::text:
      case Kind::path:
        text(node);
        break;
      case Kind::name:
      case Kind::fabric:
        names(node);
        break;
      case Kind::vector:
        vector(node.range);
        break;
      case Kind::box:
        array(2, 2);
        in_braces("items", [&] { vector(node.range); });
        break;
      case Kind::wholes:
        array(0);
        in_braces("items", [&] { number(node.range, "integer"); });
        break;
      case Kind::rows:
        array(node.least);
        in_braces("items", [&] {
          array(node.inside.size(), node.inside.size());
          json_.key("prefixItems");
          json_.begin_array();
          for (const SettingNode& column : node.inside) {
            json_.begin_object();
            json_.member("title", column.setting.key);
            value_of(column);
            json_.end_object();
          }
          json_.end_array();
        });
        break;
      case Kind::numbers:
        json_.member("type", "object");
        in_braces("additionalProperties", [&] { number(node.range); });
        break;
      case Kind::object:
        one_of_its_forms(node);
        break;
      case Kind::list:
        array(node.least);
        in_braces("items", [&] { object(node); });
        break;
      case Kind::table:
        json_.member("type", "object");
        in_braces("additionalProperties", [&] { object(node); });
        break;
    }
    if (node.value.empty() || node.is_column) return;
    json_.key("default");
    json_.raw(node.value);
  }

  // An object, or a string for one of its keys, or null.
  void one_of_its_forms(const SettingNode& node) {
    if (node.shorthand.empty() && !node.setting.may_be_null) return object(node);
    json_.key("oneOf");
    json_.begin_array();
    if (node.setting.may_be_null) {
      json_.begin_object();
      json_.member("type", "null");
      json_.end_object();
    }
    if (!node.shorthand.empty()) {
      const SettingNode& key = inside(node, node.shorthand);
      json_.begin_object();
      if (key.kind == Kind::fabric) {
        names(key);
      } else {
        text(key);
      }
      json_.end_object();
    }
    json_.begin_object();
    object(node);
    json_.end_object();
    json_.end_array();
  }

  JsonText json_{1};
  std::map<std::string_view, const SettingNode*> known_, waiting_;
};

}  // namespace

std::string scene_schema(const SettingNode& scene) { return Schema().of(scene); }

}  // namespace toile::internal
