#include "sim/fabric_file.hpp"

#include "core/error.hpp"
#include "io/json_text.hpp"
#include "sim/scene_reader.hpp"
#include "sim/settings_cloth.hpp"

#include <array>
#include <vector>

namespace toile::internal {
namespace {

constexpr std::array<std::string_view, 7> keys_of_fit = {"name",     "fabric", "uncertainty", "sources",
                                                         "measured", "flags",  "drape"};

void add_estimate(JsonText& json, const Estimate& estimate) {
  json.member("value", four_digits(estimate.value));
  json.member("uncertainty", four_digits(estimate.uncertainty()));
  json.member("readings", estimate.readings);
  json.member("from", estimate.from);
}

void add_sources(JsonText& json, std::string_view key, const std::vector<FittedNumber>& numbers) {
  json.key(key);
  json.begin_object();
  for (const FittedNumber& number : numbers) {
    json.key(number.key);
    json.begin_object();
    json.member("value", four_digits(number.estimate.value));
    json.key("uncertainty");
    if (number.estimate.readings > 0)
      json.value(four_digits(number.estimate.uncertainty()));
    else
      json.null();
    json.member("readings", number.estimate.readings);
    json.member("from", number.estimate.from);
    json.key("methods");
    json.begin_array();
    for (const Estimate& source : number.sources) {
      json.begin_object();
      add_estimate(json, source);
      json.end_object();
    }
    json.end_array();
    json.end_object();
  }
  json.end_object();
}

void add_percent(JsonText& json, std::string_view key, const std::optional<Estimate>& percent) {
  json.key(key);
  if (!percent) return json.null();
  json.begin_object();
  add_estimate(json, *percent);
  json.end_object();
}

}  // namespace

std::string to_json(const FabricFit& fit) {
  JsonText json;
  json.begin_object();
  json.member("name", fit.name);
  json.key("fabric");
  json.begin_object();
  json.member("base", fit.fabric.name);
  for (const FittedNumber& number : fit.numbers)
    if (number.estimate.readings > 0) json.member(number.key, four_digits(number.estimate.value));
  json.end_object();
  json.key("uncertainty");
  json.begin_object();
  for (const FittedNumber& number : fit.numbers)
    if (number.estimate.readings > 0) json.member(number.key, four_digits(number.estimate.uncertainty()));
  json.end_object();
  add_sources(json, "sources", fit.numbers);
  add_sources(json, "measured", fit.beside);
  json.key("flags");
  json.begin_array();
  for (const FitFlag& flag : fit.flags) {
    json.begin_object();
    json.member("code", flag.code);
    json.member("key", flag.key);
    json.member("text", flag.text);
    json.end_object();
  }
  json.end_array();
  json.key("drape");
  json.begin_object();
  add_percent(json, "measured_percent", fit.drape.measured);
  add_percent(json, "of_the_fabric_percent", fit.drape.of_the_fabric);
  json.member("gives_bending", fit.drape.gives_bending);
  json.end_object();
  json.end_object();
  return json.str() + '\n';
}

bool is_fabric_fit(std::string_view text) {
  try {
    const Json root = Json::parse(text, "");
    return root.is_object() && root.find("fabric") != nullptr && root.find("uncertainty") != nullptr &&
           root.find("sources") != nullptr;
  } catch (const InputError&) {
    return false;
  }
}

Fabric read_fabric_file(const std::string& path) {
  const Json root = Json::parse(read_text_file(path), printable(path));
  if (!root.is_object()) root.fail("an object with the keys of a fabric", root.describe());
  const Json* const inner = root.find("fabric");
  if (inner != nullptr) root.allow_only(keys_of_fit);
  for (const std::string_view figure : {"weight_g_per_m2", "cantilever", "fast", "kes", "tensile", "drape_percent"})
    if (root.find(figure) != nullptr) root.fail("a fabric", "laboratory figures: toile fit-fabric makes one of them");
  JsonPlaces places;
  Fabric fabric;
  scene_reading::SceneReader::read(inner != nullptr ? *inner : root, {path, places}, fabric);
  return fabric;
}

bool names_a_fabric_file(const std::string& name_or_file) { return name_or_file.ends_with(".json"); }

Fabric fabric_of(const std::string& name_or_file, std::string_view place) {
  if (names_a_fabric_file(name_or_file)) return read_fabric_file(name_or_file);
  return fabric_preset(name_or_file, "", place);
}

}  // namespace toile::internal
