// sim/settings_docs.cpp: the tables of docs/scenes.md.
#include "sim/settings_catalogue.hpp"

#include <fmt/printf.h>

#include <cmath>
#include <set>

namespace toile::internal {
namespace {

using Kind = SettingNode::Kind;

std::string joined(const std::vector<std::string>& words, std::string_view quote) {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : ", ") + std::string(quote) + word + std::string(quote);
  return text;
}

std::string in_words(const Range& range) {
  const bool low = std::isfinite(range.least), high = std::isfinite(range.most);
  if (!low && !high) return {};
  if (low && high && range.least == -range.most) return fmt::sprintf("up to ±%g", range.most);
  if (!high) return fmt::sprintf(range.above ? "above %g" : "from %g", range.least);
  return fmt::sprintf(range.above ? "above %g, to %g" : "%g to %g", range.least, range.most);
}

std::string columns(const SettingNode& rows) {
  std::vector<std::string> names;
  for (const SettingNode& column : rows.inside) names.emplace_back(column.setting.key);
  return "[[" + joined(names, "") + "], ...]";
}

// Consecutive columns of the same range are named together: "t_s 0 to 3600; x, y, z up to ±10000".
std::string ranges(const SettingNode& rows) {
  std::string text, last;
  for (const SettingNode& column : rows.inside) {
    const std::string here = in_words(column.range);
    if (here.empty()) continue;
    if (!last.empty()) text += here == last ? "" : ' ' + last;
    text += (text.empty() ? "" : here == last ? ", " : "; ") + std::string(column.setting.key);
    last = here;
  }
  return last.empty() ? text : text + ' ' + last;
}

std::string values(const SettingNode& node) {
  switch (node.kind) {
    case Kind::number:
      return in_words(node.range);
    case Kind::whole:
      return "whole, " + in_words(node.range);
    case Kind::flag:
      return "true, false";
    case Kind::text:
      return "text";
    case Kind::path:
      return "path";
    case Kind::name:
    case Kind::fabric:
      return joined(node.names, "\"");
    case Kind::vector:
      return "[x, y, z], each " + in_words(node.range);
    case Kind::box:
      return "[[x, y, z], [x, y, z]], each " + in_words(node.range);
    case Kind::wholes:
      return "[whole, ...], each " + in_words(node.range);
    case Kind::rows:
      return columns(node) + ": " + ranges(node);
    case Kind::numbers:
      return "{label: number}, each " + in_words(node.range);
    case Kind::object:
      return node.shorthand.empty() ? "object" : "text, or object";
    case Kind::list:
      return "array of objects";
    case Kind::table:
      return "{name: object}";
  }
  return {};
}

std::string row(const std::string& path, const SettingNode& node) {
  std::string keys = "| `" + path + "` | " + std::string(node.setting.meaning);
  if (!node.shared.empty()) keys += ": [`" + std::string(node.shared) + "`](#" + std::string(node.shared) + "-keys)";
  if (!node.setting.in_result) keys += " (not in `input_hash`)";
  const std::string otherwise = node.setting.needed               ? "needed"
                                : !node.setting.otherwise.empty() ? std::string(node.setting.otherwise)
                                : node.value.empty()              ? ""
                                                                  : node.value;
  return keys + " | " + values(node) + " | " + unit_of(node.setting.key) + " | " + otherwise + " |\n";
}

constexpr std::string_view head = "| key | meaning | values | unit | default |\n|---|---|---|---|---|\n";

// The keys of one object; those of objects with a name of their own follow in a table of that name.
void append(const SettingNode& object, const std::string& path, std::vector<const SettingNode*>& shared,
            std::string& text) {
  for (const SettingNode& one : object.inside) {
    const std::string here = path + std::string(one.setting.key);
    text += row(here, one);
    if (one.is_leaf()) continue;
    if (!one.shared.empty()) {
      shared.push_back(&one);
      continue;
    }
    append(one, here + (one.kind == Kind::list ? "[]." : one.kind == Kind::table ? "{}." : "."), shared, text);
  }
}

}  // namespace

std::string settings_table(const SettingNode& scene) {
  std::vector<const SettingNode*> shared;
  std::string text(head);
  append(scene, "", shared, text);
  std::set<std::string_view> written;
  for (std::size_t k = 0; k < shared.size(); ++k) {
    const SettingNode& object = *shared[k];
    if (!written.insert(object.shared).second) continue;
    const std::string name(object.shared);
    text += "\n### `" + name + "` keys\n\n" + std::string(head);
    append(object, "", shared, text);
  }
  return text;
}

}  // namespace toile::internal
