// tests/garment/broken_patterns.hpp: our own garments, broken one way each, with what the linter must say of them.
#pragma once
#include "garment/lint.hpp"
#include "io/file.hpp"
#include "io/json_value.hpp"
#include "support/paths.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal::test {

// A pattern file that can be broken.
class PatternFile {
 public:
  explicit PatternFile(const std::string& garment)
      : root(Json::parse(read_file(test::source_path("patterns/") + garment + ".json"), "good.json")) {}

  JsonValue& panel(std::string_view name) { return root.member("pattern").member("panels").member(name); }
  JsonValue::Array& corners(std::string_view name) { return *panel(name).member("vertices").array(); }
  JsonValue::Array& edges(std::string_view name) { return *panel(name).member("edges").array(); }
  JsonValue::Array& stitches() { return *root.member("pattern").member("stitches").array(); }
  JsonValue::Array& ends(std::string_view name, std::size_t edge) {
    return *edges(name)[edge].member("endpoints").array();
  }
  JsonValue& side(std::size_t stitch, std::size_t side) { return (*stitches()[stitch].array())[side]; }
  static double& number(JsonValue& value) { return std::get<double>(value.value); }
  double x(std::string_view name, std::size_t corner) { return number(corners(name)[corner].array()->front()); }
  double y(std::string_view name, std::size_t corner) { return number(corners(name)[corner].array()->back()); }
  static JsonValue point(double x, double y) { return JsonValue(JsonValue::Array{x, y}); }
  static JsonValue edge(double start, double end) {
    return JsonValue(JsonValue::Object{{"endpoints", JsonValue(JsonValue::Array{start, end})}});
  }
  static JsonValue stitch(std::string a, double edge_a, std::string b, double edge_b) {
    const auto make = [](std::string panel, double edge) {
      return JsonValue(JsonValue::Object{{"panel", JsonValue(std::move(panel))}, {"edge", JsonValue(edge)}});
    };
    return JsonValue(JsonValue::Array{make(std::move(a), edge_a), make(std::move(b), edge_b)});
  }

  // The same curve, run the other way.
  void turn_edge(std::string_view name, std::size_t number_of_edge) {
    std::swap(ends(name, number_of_edge)[0], ends(name, number_of_edge)[1]);
    JsonValue* curvature = edges(name)[number_of_edge].find("curvature");
    if (curvature == nullptr) return;
    JsonValue::Array& points = *curvature->member("params").array();
    std::swap(points.front(), points.back());
    for (JsonValue& p : points) {
      number(p.array()->front()) = 1 - number(p.array()->front());
      number(p.array()->back()) *= -1;
    }
  }
  void turn_outline(std::string_view name) {
    for (std::size_t e = 0; e < edges(name).size(); ++e) turn_edge(name, e);
  }
  // The last corner of an edge becomes two, so far apart (cm), and the outline is open there.
  void open_corner(std::string_view name, std::size_t edge_number, double dx, double dy) {
    const auto corner = static_cast<std::size_t>(number(ends(name, edge_number)[1]));
    number(ends(name, edge_number)[1]) = static_cast<double>(corners(name).size());
    corners(name).push_back(point(x(name, corner) + dx, y(name, corner) + dy));
  }
  // An edge without length comes after another.
  void add_empty_edge(std::string_view name, std::size_t edge_number) {
    const double corner = number(ends(name, edge_number)[1]);
    open_corner(name, edge_number, 0, 0);
    edges(name).push_back(edge(number(ends(name, edge_number)[1]), corner));
    std::vector<std::size_t> order;
    for (std::size_t e = 0; e + 1 < edges(name).size(); ++e) {
      order.push_back(e);
      if (e == edge_number) order.push_back(edges(name).size() - 1);
    }
    shuffle_edges(name, order);
  }
  // Edge k gets the number order[k] had; the stitches follow.
  void shuffle_edges(std::string_view name, const std::vector<std::size_t>& order) {
    JsonValue::Array shuffled;
    std::vector<double> place(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      shuffled.push_back(edges(name)[order[k]]);
      place[order[k]] = static_cast<double>(k);
    }
    edges(name) = std::move(shuffled);
    for (JsonValue& stitch_value : stitches())
      for (JsonValue& one : *stitch_value.array()) {
        JsonValue* panel_name = one.find("panel");
        if (panel_name == nullptr || *panel_name->string() != name) continue;
        number(one.member("edge")) = place[static_cast<std::size_t>(number(one.member("edge")))];
      }
  }
  void shift_all(double dx, double dy, double dz) {
    for (auto& [name, value] : *root.member("pattern").member("panels").object()) {
      JsonValue::Array& translation = *value.member("translation").array();
      number(translation[0]) += dx;
      number(translation[1]) += dy;
      number(translation[2]) += dz;
    }
  }
  void set_units(double units) { number(root.member("properties").member("units_in_meter")) = units; }

  JsonValue root;
};

struct BrokenPattern {
  std::string name;  // what was done to it
  std::string garment;
  std::function<void(PatternFile&)> break_it;
  std::string_view code;
  Severity severity;
  std::string place;       // that the place must name
  bool mended;             // or refused
  bool as_before = false;  // mended, it is the good pattern again: every placed edge, every seam
  std::optional<BodyFigures> body = std::nullopt;
};

std::vector<BrokenPattern> broken_patterns();

}  // namespace toile::internal::test
