// preview/looks.cpp: reads rules, and joins those of a panel.
#include "preview/looks.hpp"

#include "io/file.hpp"
#include "io/mesh_writer.hpp"
#include "preview/print_reading.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace toile::internal {
namespace {

constexpr float sewing_shade = 0.8f;  // of a thread against the cloth that it sews, where no rule says
constexpr std::size_t most_names = 24;
constexpr long long most_garments = 1000000;

// A name or several, spelled as in a run's files.
std::vector<std::string> names_in(const Json& value) {
  std::vector<std::string> names;
  if (value.is_string()) return {name_on_one_line(value.string())};
  if (!value.is_array() || value.array().empty()) value.fail("a name or a list of names", value.describe());
  for (const Json& one : value.array()) names.push_back(name_on_one_line(one.string()));
  return names;
}

// Panels of one of several garments are called "garment/panel" in a run.
bool is_named(const ClothPart& part, const std::string& panel) {
  return part.panel == panel || part.panel == part.garment_name + '/' + panel;
}

std::string listed(const std::set<std::string>& names) {
  std::string list;
  std::size_t count = 0;
  for (const std::string& name : names) {
    if (count++ == most_names) return list + " ...";
    list += (list.empty() ? "\"" : ", \"") + printable(name) + '"';
  }
  return list.empty() ? "none" : list;
}

void refuse_name(const Json& value, std::string_view of, const std::set<std::string>& known, const std::string& name) {
  const std::vector<std::string_view> names(known.begin(), known.end());
  const std::string_view nearest = nearest_name(name, names.data(), names.size());
  value.fail(std::string(of) + " of this run: " + listed(known) +
                 (nearest.empty() ? "" : "; nearest is \"" + printable(nearest) + '"'),
             '"' + printable(name) + '"');
}

}  // namespace

Looks Looks::parse(std::string_view text, const std::string& file) {
  Looks looks;
  looks.files_.push_back(file);
  const Json root = Json::parse(text, file);
  root.allow_only({"looks"});
  for (const Json& rule : root.at("looks").array()) looks.rules_.push_back(looks.read_rule(rule));
  return looks;
}

Looks Looks::load(const std::string& path) { return parse(read_file(path, Json::text_limit), path); }

Looks::Rule Looks::read_rule(const Json& json) {
  json.allow_only({"garment", "panel", "fabric", "colour", "print", "stitch", "sheen", "gloss", "roughness"});
  Rule rule{json, {}, {}, {}, {}, {}};
  if (const Json* const garment = json.find("garment")) {
    if (garment->is_number()) {
      const long long number = garment->integer();
      if (number < 0 || number > most_garments)
        garment->fail("a garment's name, or its number from 0, from the inside out", garment->describe());
      rule.garment = static_cast<Index>(number);
    } else {
      rule.garments = names_in(*garment);
    }
  }
  if (const Json* const panel = json.find("panel")) rule.panels = names_in(*panel);
  if (const Json* const fabric = json.find("fabric")) rule.fabrics = names_in(*fabric);

  Style& style = rule.style;
  if (const Json* const colour = json.find("colour")) style.colour = colour_in(*colour);
  if (const Json* const stitch = json.find("stitch")) style.stitch = colour_in(*stitch);
  const auto read_number = [&](const char* key, double least, double most, std::optional<float>& into) {
    if (const Json* const value = json.find(key)) into = static_cast<float>(number_between(*value, least, most));
  };
  read_number("sheen", 0, 1, style.sheen);
  read_number("gloss", 0, 1, style.gloss);
  read_number("roughness", 0.05, 1, style.roughness);
  if (const Json* const print = json.find("print")) {
    if (print->is_object()) {
      style.print = std::make_shared<const Print>(print_in(*print, files_.front(), files_));
    } else if (print->is_string() && print->string() == "none") {
      style.print = nullptr;
    } else {
      print->fail("an object with \"stripes\", \"check\", \"dots\" or \"image\", or \"none\"", print->describe());
    }
  }
  if (!style.colour && !style.stitch && !style.sheen && !style.gloss && !style.roughness && !style.print)
    json.fail("at least one of \"colour\", \"print\", \"stitch\", \"sheen\", \"gloss\", \"roughness\"", "none");
  return rule;
}

bool Looks::Rule::is_of(const ClothPart& part) const {
  const auto among = [](const std::vector<std::string>& names, const auto& fits) {
    return names.empty() || std::any_of(names.begin(), names.end(), fits);
  };
  return (!garment || *garment == part.garment) &&
         among(garments, [&](const std::string& name) { return name == part.garment_name; }) &&
         among(panels, [&](const std::string& name) { return is_named(part, name); }) &&
         among(fabrics, [&](const std::string& name) { return name == part.fabric; });
}

void Looks::check(std::span<const ClothPart> parts) const {
  std::set<std::string> garments, panels, fabrics;
  Index last = -1;
  for (const ClothPart& part : parts) {
    last = std::max(last, part.garment);
    garments.insert(part.garment_name);
    panels.insert(part.panel);
    if (!part.fabric.empty()) fabrics.insert(part.fabric);
  }
  for (const Rule& rule : rules_) {
    if (rule.garment && *rule.garment > last) {
      const Json& value = rule.json.at("garment");
      value.fail("a garment of this run: 0" + (last > 0 ? " to " + std::to_string(last) : ""), value.describe());
    }
    for (const std::string& name : rule.garments)
      if (!garments.contains(name)) refuse_name(rule.json.at("garment"), "a garment", garments, name);
    for (const std::string& name : rule.panels)
      if (std::none_of(parts.begin(), parts.end(), [&](const ClothPart& part) { return is_named(part, name); }))
        refuse_name(rule.json.at("panel"), "a panel", panels, name);
    for (const std::string& name : rule.fabrics)
      if (!fabrics.contains(name)) refuse_name(rule.json.at("fabric"), "a fabric", fabrics, name);
    if (std::none_of(parts.begin(), parts.end(), [&](const ClothPart& part) { return rule.is_of(part); }))
      rule.json.fail("names that one panel of this run has together", "names of different ones");
  }
}

Looks::Style Looks::style_of(const ClothPart& part) const {
  Style all;
  const auto replace = [](auto& old, const auto& given) {
    if (given) old = given;
  };
  for (const Rule& rule : rules_) {
    if (!rule.is_of(part)) continue;
    replace(all.colour, rule.style.colour);
    replace(all.stitch, rule.style.stitch);
    replace(all.sheen, rule.style.sheen);
    replace(all.gloss, rule.style.gloss);
    replace(all.roughness, rule.style.roughness);
    replace(all.print, rule.style.print);
  }
  return all;
}

ClothLook Looks::look_of(const ClothPart& part, const ClothLook& own) const {
  const Style style = style_of(part);
  ClothLook look = style.colour ? coloured(own, *style.colour) : own;
  look.sheen = style.sheen.value_or(own.sheen);
  look.gloss = style.gloss.value_or(own.gloss);
  look.roughness = style.roughness.value_or(own.roughness);
  if (style.print) look.print = *style.print;
  if (look.print && look.print->is_woven() && (look.weave == Weave::twill || look.weave == Weave::satin))
    look.weave = Weave::even_twill;
  if (style.stitch)
    look.stitch = *style.stitch;
  else if (style.colour || look.print)
    look.stitch = sewing_shade * mean_colour(look, true);
  return look;
}

std::optional<Vec3f> Looks::colour_of(const ClothPart& part, const ClothLook& own) const {
  const Style style = style_of(part);
  if (!style.colour && !(style.print && *style.print)) return {};
  return mean_colour(look_of(part, own), true);
}

}  // namespace toile::internal
