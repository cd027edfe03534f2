// garment/pattern_repair.cpp: see the header.
//
//   relative curve turned round    (a, b) -> (1 - a, -b), two control points change places; a circle's sweep changes
//   half a turn about x = c        world = R (x - 2c .. )  ->  R' = R Ry(180),  t' = t + R (2c, 0, 0);  Rz Ry Rx Ry(180) = Rz Ry(y + 180) R(-x)
#include "garment/pattern_repair.hpp"

#include "garment/pattern.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

double& number_of(JsonValue& value) {
  if (value.number() == nullptr) value.value = 0.0;
  return std::get<double>(value.value);
}

Index index_of(const JsonValue& value) { return value.number() == nullptr ? -1 : static_cast<Index>(*value.number()); }

void turn_point(JsonValue& point) {
  if (point.array() == nullptr || point.array()->size() != 2) return;
  double &a = number_of(point.array()->front()), &b = number_of(point.array()->back());
  a = 1 - a;
  b = b == 0 ? 0 : -b;
}

}  // namespace

JsonValue& PatternRepair::panel(std::string_view name) {
  return root_->member("pattern").member("panels").member(name);
}

JsonValue& PatternRepair::edge(std::string_view panel_name, Index number) {
  return panel(panel_name).member("edges").array()->at(at(number));
}

JsonValue::Array& PatternRepair::stitches() { return *root_->member("pattern").member("stitches").array(); }

JsonValue* PatternRepair::extension(std::string_view key) {
  JsonValue* found = root_->find("toile");
  return found == nullptr ? nullptr : found->find(key);
}

template <class Renumber>
void PatternRepair::renumber_edges(std::string_view panel_name, Renumber&& number) {
  for (JsonValue& stitch : stitches()) {
    for (JsonValue& side : *stitch.array()) {
      JsonValue *name = side.find("panel"), *value = side.find("edge");
      if (name == nullptr || value == nullptr || name->string() == nullptr || *name->string() != panel_name) continue;
      number_of(*value) = number(index_of(*value));
    }
  }
  if (JsonValue::Array* finishes = finished_edges(panel_name)) {
    for (JsonValue& finish : *finishes)
      if (JsonValue* value = finish.find("edge")) number_of(*value) = number(index_of(*value));
  }
}

JsonValue::Array* PatternRepair::finished_edges(std::string_view panel_name) {
  JsonValue* panels = extension("panels");
  JsonValue* extended = panels == nullptr ? nullptr : panels->find(panel_name);
  JsonValue* edges = extended == nullptr ? nullptr : extended->find("edges");
  return edges == nullptr ? nullptr : edges->array();
}

template <class Renumber>
void PatternRepair::renumber_corners(std::string_view panel_name, Renumber&& number) {
  const auto renumber_ends = [&](JsonValue& line) {
    JsonValue* ends = line.find("endpoints");
    if (ends == nullptr || ends->array() == nullptr) return;
    for (JsonValue& end : *ends->array()) number_of(end) = number(index_of(end));
  };
  for (JsonValue& line : *panel(panel_name).member("edges").array()) renumber_ends(line);
  JsonValue* panels = extension("panels");
  JsonValue* extended = panels == nullptr ? nullptr : panels->find(panel_name);
  JsonValue* folds = extended == nullptr ? nullptr : extended->find("folds");
  if (folds == nullptr || folds->array() == nullptr) return;
  for (JsonValue& fold : *folds->array()) renumber_ends(fold);
}

void PatternRepair::set_ends(std::string_view panel_name, Index number, Index start, Index end) {
  edge(panel_name, number).member("endpoints") = JsonValue(JsonValue::Array{double(start), double(end)});
}

void PatternRepair::reverse_edge(std::string_view panel_name, Index number) {
  JsonValue& line = edge(panel_name, number);
  if (JsonValue* ends = line.find("endpoints"); ends != nullptr && ends->array() != nullptr)
    std::reverse(ends->array()->begin(), ends->array()->end());
  JsonValue* curvature = line.find("curvature");
  if (curvature == nullptr) return;
  JsonValue *type = curvature->find("type"), *params = curvature->find("params");
  if (type != nullptr && type->string() != nullptr && *type->string() == "circle") {
    if (params == nullptr || params->array() == nullptr || params->array()->size() != 3) return;
    JsonValue& sweep = params->array()->back();
    if (bool* flag = std::get_if<bool>(&sweep.value)) {
      *flag = !*flag;
    } else {
      number_of(sweep) = 1 - number_of(sweep);
    }
    return;
  }
  JsonValue* points = params != nullptr ? params : curvature;
  if (points->array() == nullptr) return;
  if (params == nullptr) {  // a bare pair
    if (!absolute_curves_) turn_point(*curvature);
    return;
  }
  if (!absolute_curves_)
    for (JsonValue& point : *points->array()) turn_point(point);
  std::reverse(points->array()->begin(), points->array()->end());
}

void PatternRepair::reorder_edges(std::string_view panel_name, std::span<const Index> order) {
  JsonValue::Array& edges = *panel(panel_name).member("edges").array();
  JsonValue::Array ordered;
  std::vector<Index> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    ordered.push_back(edges[at(order[k])]);
    place[at(order[k])] = static_cast<Index>(k);
  }
  edges = std::move(ordered);
  renumber_edges(panel_name, [&](Index e) { return double(e >= 0 && at(e) < place.size() ? place[at(e)] : e); });
}

void PatternRepair::remove_edge(std::string_view panel_name, Index number) {
  JsonValue::Array& edges = *panel(panel_name).member("edges").array();
  edges.erase(edges.begin() + number);
  if (JsonValue::Array* finishes = finished_edges(panel_name))
    std::erase_if(*finishes, [&](JsonValue& finish) {
      const JsonValue* value = finish.find("edge");
      return value != nullptr && index_of(*value) == number;
    });
  renumber_edges(panel_name, [&](Index e) { return double(e > number ? e - 1 : e); });
}

void PatternRepair::remove_corner(std::string_view panel_name, Index corner) {
  JsonValue& whole = panel(panel_name);
  JsonValue::Array& corners = *whole.member("vertices").array();
  const auto mean = [&] {
    Vec2 sum{0, 0};
    for (JsonValue& c : corners) sum += Vec2(number_of(c.array()->front()), number_of(c.array()->back()));
    return Vec2(sum / std::max(1.0, static_cast<double>(corners.size())));
  };
  const Vec2 before = mean();
  corners.erase(corners.begin() + corner);
  renumber_corners(panel_name, [&](Index c) { return double(c > corner ? c - 1 : c); });
  if (!centred_panels_) return;
  // The panel turns about the mean of its corners, which has moved by d: t' = t - d + R d keeps it where it was.
  Panel turned;
  JsonValue::Array *rotation = whole.member("rotation").array(), *translation = whole.member("translation").array();
  if (rotation == nullptr || translation == nullptr || rotation->size() != 3 || translation->size() != 3) return;
  for (int k = 0; k < 3; ++k) turned.rotation_deg[k] = number_of((*rotation)[static_cast<std::size_t>(k)]);
  const Vec2 moved = mean() - before;
  const Vec3 d(moved.x(), moved.y(), 0), correction = turned.rotation() * d - d;
  for (int k = 0; k < 3; ++k) number_of((*translation)[static_cast<std::size_t>(k)]) += correction[k];
}

void PatternRepair::merge_corner(std::string_view panel_name, Index corner, Index other) {
  renumber_corners(panel_name, [&](Index c) { return double(c == corner ? other : c); });
  remove_corner(panel_name, corner);
}

void PatternRepair::swap_corners(std::string_view panel_name, Index a, Index b) {
  JsonValue::Array& corners = *panel(panel_name).member("vertices").array();
  std::swap(corners.at(at(a)), corners.at(at(b)));
}

void PatternRepair::remove_stitch(Index stitch) {
  stitches().erase(stitches().begin() + stitch);
  JsonValue* pressed = extension("stitches");
  if (pressed == nullptr || pressed->array() == nullptr) return;
  JsonValue::Array kept;
  for (JsonValue& entry : *pressed->array()) {
    JsonValue* number = entry.find("stitch");
    if (number != nullptr && index_of(*number) == stitch) continue;
    if (number != nullptr && index_of(*number) > stitch) number_of(*number) -= 1;
    kept.push_back(std::move(entry));
  }
  *pressed->array() = std::move(kept);
}

void PatternRepair::turn_stitch(Index stitch) {
  JsonValue::Array& sides = *stitches().at(at(stitch)).array();
  if (sides.size() > 2) {
    sides.resize(2);
  } else {
    sides.emplace_back(std::string("right_wrong"));
  }
}

void PatternRepair::set_side(Index stitch, int side, std::string_view panel_name, Index edge_number) {
  JsonValue& value = stitches().at(at(stitch)).array()->at(static_cast<std::size_t>(side));
  value.member("panel") = JsonValue(std::string(panel_name));
  value.member("edge") = JsonValue(double(edge_number));
}

void PatternRepair::turn_panel(std::string_view panel_name, double axis, const Mat3& rotation) {
  JsonValue& whole = panel(panel_name);
  JsonValue::Array *angles = whole.member("rotation").array(), *translation = whole.member("translation").array();
  if (angles == nullptr || translation == nullptr || angles->size() != 3 || translation->size() != 3) return;
  const auto negative = [](double v) { return v == 0 ? 0.0 : -v; };
  number_of((*angles)[0]) = negative(number_of((*angles)[0]));
  double& about_y = number_of((*angles)[1]);
  about_y = std::remainder(about_y + 180, 360.0);
  if (about_y == -180) about_y = 180;
  const Vec3 moved = rotation * Vec3(2 * axis, 0, 0);
  for (int k = 0; k < 3; ++k) number_of((*translation)[static_cast<std::size_t>(k)]) += moved[k];
}

void PatternRepair::shift_panels(const Vec3& shift) {
  for (auto& [name, whole] : *root_->member("pattern").member("panels").object()) {
    JsonValue::Array* translation = whole.member("translation").array();
    if (translation == nullptr || translation->size() != 3) continue;
    for (int k = 0; k < 3; ++k) number_of((*translation)[static_cast<std::size_t>(k)]) += shift[k];
  }
}

void PatternRepair::set_units_in_meter(double units) {
  root_->member("properties").member("units_in_meter") = JsonValue(units);
}

}  // namespace toile::internal
