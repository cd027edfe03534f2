#include "garment/pattern_values.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

constexpr double largest_fold_deg = 170;  // at 180 a hinge cannot tell one side from the other

std::string list_text(const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  for (const std::string& name : names) quoted.push_back('"' + name + '"');
  return alternatives(quoted);
}

}  // namespace

// "..., did you mean X?"; a hostile name is cut before its distance to every candidate is taken.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
  const std::vector<std::string_view> views(candidates.begin(), candidates.end());
  const std::string_view nearest = nearest_name(name.substr(0, 100), views.data(), views.size());
  return nearest.empty() ? "" : "; did you mean \"" + printable(nearest) + "\"?";
}

// One of a few words; returns its number.
std::size_t read_word(const Json& json, const std::vector<std::string>& words) {
  if (!json.is_string()) json.fail(list_text(words), json.describe());
  const auto found = std::find(words.begin(), words.end(), json.string());
  if (found == words.end()) json.fail(list_text(words), json.describe() + suggestion(json.string(), words));
  return static_cast<std::size_t>(found - words.begin());
}

double read_angle(const Json& json) {
  if (!(std::abs(json.number()) <= largest_fold_deg))
    json.fail("an angle between -170 and 170 degrees", json.describe());
  return json.number() * std::numbers::pi / 180;
}

bool read_flag(const Json& json) {  // 0 or 1; JSON's own booleans as well
  if (json.type() == Json::Type::boolean) return json.boolean();
  if (!json.is_number() || (json.number() != 0 && json.number() != 1)) json.fail("0 or 1", json.describe());
  return json.number() == 1;
}

// An index below `count`.
Index read_index(const Json& json, std::size_t count, const char* what) {
  const std::string range = count == 0 ? std::string("none, as there is no ") + what
                                       : std::string("the number of ") + what + ", 0 to " + std::to_string(count - 1);
  if (!json.is_number()) json.fail(range, json.describe());
  const double value = json.number();
  if (!(value >= 0 && value < static_cast<double>(count) && value == std::floor(value))) {
    json.fail(range, json.describe());
  }
  return static_cast<Index>(value);
}

}  // namespace toile::internal
