// The list of broken patterns: what is done to which garment, and what the linter must say.
#include "broken_patterns.hpp"

#include <gtest/gtest.h>

namespace toile::internal::test {
namespace {

constexpr Severity error = Severity::error, warning = Severity::warning, note = Severity::note;

BodyFigures figures(double height_m) {  // of nobody in particular
  BodyFigures body;
  body.low_m = Vec3(-0.3 * height_m, 0, -0.1 * height_m);
  body.high_m = Vec3(0.3 * height_m, height_m, 0.1 * height_m);
  body.middle_m = Vec3(0, 0.62 * height_m, 0);
  body.head_girth_m = 0.4 + 0.1 * height_m;
  body.waist_girth_m = 0.42 * height_m;
  body.hips_girth_m = 0.56 * height_m;
  body.waist_m = 0.62 * height_m;
  return body;
}

void sew(PatternFile& f, const char* a, double edge_a, const char* b, double edge_b) {
  f.stitches().push_back(PatternFile::stitch(a, edge_a, b, edge_b));
}

void swap_corners(PatternFile& f, const char* panel, std::size_t a, std::size_t b) {
  std::swap(f.corners(panel)[a], f.corners(panel)[b]);
}

void deepen(PatternFile& f, const char* panel, std::size_t edge, double factor) {
  for (JsonValue& p : *f.edges(panel)[edge].member("curvature").member("params").array())
    PatternFile::number(p.array()->back()) *= factor;
}

void turn_half(PatternFile& f, const char* panel) {
  PatternFile::number((*f.panel(panel).member("rotation").array())[1]) += 180;
}

void mirror(PatternFile& f, const char* panel) {
  for (JsonValue& corner : f.corners(panel)) PatternFile::number(corner.array()->front()) *= -1;
  for (JsonValue& edge : f.edges(panel)) {
    JsonValue* curvature = edge.find("curvature");
    if (curvature == nullptr) continue;
    for (JsonValue& p : *curvature->member("params").array()) PatternFile::number(p.array()->back()) *= -1;
  }
}

void add_triangle(PatternFile& f, const char* panel) {
  const auto first = static_cast<double>(f.corners(panel).size());
  for (const auto& [x, y] : {std::pair{100.0, 0.0}, {110.0, 0.0}, {100.0, 10.0}})
    f.corners(panel).push_back(PatternFile::point(x, y));
  for (int k = 0; k < 3; ++k) f.edges(panel).push_back(PatternFile::edge(first + k, first + (k + 1) % 3));
}

void scale_width(PatternFile& f, const char* panel, double factor) {
  for (JsonValue& corner : f.corners(panel)) PatternFile::number(corner.array()->front()) *= factor;
}

void right_wrong(PatternFile& f, std::size_t stitch) {
  JsonValue::Array& sides = *f.stitches()[stitch].array();
  if (sides.size() > 2) {
    sides.pop_back();
  } else {
    sides.emplace_back(std::string("right_wrong"));
  }
}

std::vector<BrokenPattern> outlines() {
  using F = PatternFile;
  return {
      {"an edge runs the other way", "tshirt", [](F& f) { f.turn_edge("front", 1); }, reason::loop_reversed, error,
       "panel \"front\", edge 1", true, true},
      {"a curved edge runs the other way", "man_pants", [](F& f) { f.turn_edge("left_front", 5); },
       reason::loop_reversed, error, "panel \"left_front\", edge 5", true, true},
      {"two of four edges run the other way", "skirt",
       [](F& f) {
         f.turn_edge("back", 0);
         f.turn_edge("back", 1);
       },
       reason::loop_reversed, error, "panel \"back\", edge 0", true, true},
      {"edges in another order", "tshirt",
       [](F& f) {
         f.shuffle_edges("back", {0, 3, 5, 1, 7, 2, 6, 4});
       },
       reason::loop_order, note, "panel \"back\"", true, true},
      {"edges listed backwards", "long_skirt",
       [](F& f) {
         f.shuffle_edges("front", {3, 2, 1, 0});
       },
       reason::loop_order, note, "panel \"front\"", true, true},
      {"a gap of 1.5 mm", "tshirt", [](F& f) { f.open_corner("back", 7, 0.15, 0); }, reason::loop_open, error,
       "panel \"back\", edge 7", true, true},
      {"a gap without width", "man_pants", [](F& f) { f.open_corner("left_back", 4, 0, 0); }, reason::loop_open, error,
       "panel \"left_back\", edge 4", true, true},
      {"a gap of 1 cm in an outline of 2 m", "blouse", [](F& f) { f.open_corner("back", 10, 0.6, 0.8); },
       reason::loop_open, error, "panel \"back\", edge 10", true},
      {"a gap of 6 cm", "blouse", [](F& f) { f.open_corner("front", 0, 0, 6); }, reason::loop_open, error,
       "panel \"front\", edge 0", false},
      {"an edge is missing", "skirt", [](F& f) { f.edges("front").erase(f.edges("front").begin()); }, reason::loop_open,
       error, "panel \"front\"", false},
      {"a corner that is not there", "tshirt", [](F& f) { F::number(f.ends("front", 7)[1]) = 88; }, reason::edge_ends,
       error, "panel \"front\", edge 7", true, true},
      {"a negative corner", "long_skirt", [](F& f) { F::number(f.ends("back", 2)[0]) = -1; }, reason::edge_ends, error,
       "panel \"back\", edge 2", true, true},
      {"an edge from a corner to itself", "short_skirt", [](F& f) { f.edges("front").push_back(F::edge(2, 2)); },
       reason::edge_ends, error, "panel \"front\", edge 6", true, true},
      {"an edge twice", "tshirt", [](F& f) { f.edges("front").push_back(f.edges("front")[1]); }, reason::edge_twice,
       error, "panel \"front\", edge 8", true, true},
      {"an edge twice, back", "blouse", [](F& f) { f.edges("left_cuff_front").push_back(F::edge(2, 1)); },
       reason::edge_twice, error, "panel \"left_cuff_front\", edge 4", true, true},
      {"a corner too many", "skirt", [](F& f) { f.corners("back").push_back(F::point(1, 2)); }, reason::corner_unused,
       error, "panel \"back\", corner 4", true, true},
      {"a corner too many, amidst", "man_pants",
       [](F& f) {
         f.corners("waistband_back").insert(f.corners("waistband_back").begin(), F::point(3, 3));
         for (JsonValue& edge : f.edges("waistband_back"))
           for (JsonValue& end : *edge.member("endpoints").array()) F::number(end) += 1;
       },
       reason::corner_unused, error, "panel \"waistband_back\", corner 0", true, true},
      {"an edge without length", "tshirt", [](F& f) { f.add_empty_edge("front", 1); }, reason::corner_twice, error,
       "panel \"front\", corner 8", true, true},
      {"an edge without length", "man_shirt", [](F& f) { f.add_empty_edge("left_cuff_back", 2); }, reason::corner_twice,
       error, "panel \"left_cuff_back\", corner 4", true, true},
      {"two corners in each other's place", "skirt", [](F& f) { swap_corners(f, "front", 1, 2); },
       reason::outline_crosses, error, "panel \"front\", edge", true, true},
      {"two corners in each other's place", "tshirt", [](F& f) { swap_corners(f, "right_sleeve_front", 1, 2); },
       reason::outline_crosses, error, "panel \"right_sleeve_front\", edge", true, true},
      {"two corners of a narrow panel in each other's place", "short_skirt",
       [](F& f) { swap_corners(f, "waistband_back", 2, 3); }, reason::outline_crosses, error,
       "panel \"waistband_back\", edge", false},
      {"a curve that cuts through the panel", "tshirt", [](F& f) { deepen(f, "front", 4, 9); }, reason::outline_crosses,
       error, "panel \"front\", edge 0", false},
      {"a curve that cuts through the panel", "long_skirt", [](F& f) { deepen(f, "back", 1, 80); },
       reason::outline_crosses, error, "panel \"back\", edge", false},
      {"a second outline", "tshirt", [](F& f) { add_triangle(f, "back"); }, reason::loop_several, error,
       "panel \"back\", edge 8", false},
      {"a second outline", "man_shirt", [](F& f) { add_triangle(f, "right_cuff_back"); }, reason::loop_several, error,
       "panel \"right_cuff_back\", edge 4", false},
      {"a circle too small for its ends", "skirt",
       [](F& f) {
         f.edges("front")[0].member("curvature") = JsonValue(JsonValue::Object{
             {"type", JsonValue(std::string("circle"))}, {"params", JsonValue(JsonValue::Array{10.0, 0.0, 1.0})}});
       },
       reason::curve_impossible, error, "panel \"front\", edge 0", false},
      {"a circle too small for its ends", "tshirt",
       [](F& f) {
         f.edges("back")[7].member("curvature") = JsonValue(JsonValue::Object{
             {"type", JsonValue(std::string("circle"))}, {"params", JsonValue(JsonValue::Array{5.0, 0.0, 1.0})}});
       },
       reason::curve_impossible, error, "panel \"back\", edge 7", false},
  };
}

std::vector<BrokenPattern> panels_and_seams() {
  using F = PatternFile;
  return {
      {"its outline runs the other way", "tshirt", [](F& f) { f.turn_outline("back"); }, reason::panel_flipped, error,
       "panel \"back\"", true, true},
      {"its outline runs the other way", "man_pants", [](F& f) { f.turn_outline("left_back"); }, reason::panel_flipped,
       error, "panel \"left_back\"", true, true},
      {"a sleeve's outline runs the other way", "blouse", [](F& f) { f.turn_outline("right_sleeve_back"); },
       reason::panel_flipped, error, "panel \"right_sleeve_back\"", true, true},
      {"turned to the wrong side", "long_skirt", [](F& f) { turn_half(f, "back"); }, reason::panel_flipped, error,
       "panel \"back\"", true, true},
      {"turned to the wrong side", "man_shirt", [](F& f) { turn_half(f, "front"); }, reason::panel_flipped, warning,
       "panel \"front\"", true, true},
      {"drawn mirrored", "blouse", [](F& f) { mirror(f, "back"); }, reason::panel_flipped, warning, "panel \"back\"",
       true, true},
      {"drawn mirrored", "man_pants", [](F& f) { mirror(f, "waistband_back"); }, reason::panel_flipped, warning,
       "panel \"waistband_back\"", true, true},
      {"a seam the wrong way round", "tshirt", [](F& f) { right_wrong(f, 2); }, reason::seam_twisted, error,
       "stitch 2, edge 1 of panel \"front\"", true, true},
      {"a seam the wrong way round", "man_pants", [](F& f) { right_wrong(f, 6); }, reason::seam_twisted, error,
       "stitch 6, edge 6 of panel \"left_front\"", true, true},
      {"a collar the wrong way round", "man_shirt", [](F& f) { right_wrong(f, 28); }, reason::seam_twisted, error,
       "stitch 28, edge 3 of panel \"stand_back\"", true, true},
      {"a panel's name misspelt", "tshirt", [](F& f) { f.side(3, 1).member("panel") = JsonValue(std::string("bcak")); },
       reason::seam_missing, error, "stitch 3, edge 7 of panel \"front\"", true, true},
      {"a panel that is not there", "blouse",
       [](F& f) { f.side(8, 0).member("panel") = JsonValue(std::string("hood")); }, reason::seam_missing, error,
       "stitch 8, edge 5 of panel \"front\"", false},
      {"an edge that is not there", "skirt", [](F& f) { f.side(1, 1).member("edge") = JsonValue(9.0); },
       reason::seam_missing, error, "stitch 1, edge 3 of panel \"front\"", true, true},
      {"an edge that is not there", "man_shirt", [](F& f) { f.side(14, 0).member("edge") = JsonValue(4.0); },
       reason::seam_missing, error, "stitch 14, edge 0 of panel \"left_sleeve_back\"", true, true},
      {"a stitch twice", "tshirt", [](F& f) { f.stitches().push_back(f.stitches()[0]); }, reason::seam_twice, error,
       "stitch 16, edge 3 of panel \"front\"", true, true},
      {"a stitch twice, its sides in the other order", "man_pants",
       [](F& f) { sew(f, "left_back", 8, "left_front", 1); }, reason::seam_twice, error,
       "stitch 20, edge 8 of panel \"left_back\"", true, true},
      {"an edge that another stitch sews", "man_shirt", [](F& f) { f.side(2, 0).member("edge") = JsonValue(10.0); },
       reason::seam_twice, error, "stitch 3, edge 10 of panel \"front\"", true, true},
      {"an edge of a third panel", "short_skirt", [](F& f) { sew(f, "front", 0, "waistband_front", 0); },
       reason::seam_twice, error, "stitch 6, edge 0 of panel \"front\"", false},
      {"an edge with itself", "skirt", [](F& f) { sew(f, "front", 0, "front", 0); }, reason::seam_to_itself, error,
       "stitch 2", false},
      {"an edge with itself", "tshirt", [](F& f) { f.side(2, 1) = f.side(2, 0); }, reason::seam_to_itself, error,
       "stitch 2, edge 1 of panel \"front\"", false},
      {"the hem instead of the side", "tshirt", [](F& f) { f.side(2, 0).member("edge") = JsonValue(0.0); },
       reason::seam_wrong_edge, warning, "stitch 2, edge 0 of panel \"front\"", false},
      {"the neck instead of the shoulder", "blouse", [](F& f) { f.side(0, 0).member("edge") = JsonValue(7.0); },
       reason::seam_wrong_edge, warning, "stitch 0, edge 7 of panel \"front\"", true, true},
      {"gathered eight times", "short_skirt", [](F& f) { scale_width(f, "waistband_front", 0.125); },
       reason::seam_unequal, error, "stitch 4, edge 3 of panel \"front\"", false},
      {"gathered nine times", "long_skirt", [](F& f) { scale_width(f, "waistband_back", 0.1); }, reason::seam_unequal,
       error, "stitch 5, edge 1 of panel \"back\"", false},
      {"gathered on one side only", "man_shirt",
       [](F& f) { F::number(f.corners("left_sleeve_front")[1].array()->front()) -= 24; }, reason::seam_unequal, warning,
       "stitch 16, edge 1 of panel \"left_sleeve_front\"", false},
      {"a panel far away", "tshirt",
       [](F& f) { F::number((*f.panel("left_sleeve_back").member("translation").array())[2]) -= 900; },
       reason::panel_far, warning, "left_sleeve_back", false},
      {"a panel far away", "long_skirt",
       [](F& f) { F::number((*f.panel("waistband_back").member("translation").array())[1]) += 900; }, reason::panel_far,
       warning, "waistband_back", false},
  };
}

std::vector<BrokenPattern> garments() {
  using F = PatternFile;
  const BodyFigures woman = figures(1.72), man = figures(1.80), child = figures(1.10);
  return {
      {"centimetres read as metres", "tshirt", [](F& f) { f.set_units(1); }, reason::unit_doubtful, error, "properties",
       true, true},
      {"inches read as centimetres", "blouse", [](F& f) { f.set_units(254); }, reason::unit_doubtful, warning,
       "properties", true, true},
      {"centimetres read as inches", "man_pants", [](F& f) { f.set_units(39.37007874); }, reason::unit_doubtful,
       warning, "properties", true, true},
      {"millimetres read as centimetres", "skirt", [](F& f) { f.set_units(10); }, reason::unit_doubtful, warning,
       "properties", true, true},
      {"centimetres read as millimetres", "long_skirt", [](F& f) { f.set_units(1000); }, reason::unit_doubtful, warning,
       "properties", true, true},
      {"on a child", "tshirt", [](F&) {}, reason::other_body, warning, "the garment", false, false, child},
      {"on a child", "long_skirt", [](F&) {}, reason::other_body, warning, "the garment", false, false, child},
      {"a metre beside the body", "tshirt", [](F& f) { f.shift_all(100, 0, 0); }, reason::off_body, warning,
       "the garment", true, true, woman},
      {"a metre behind the body", "skirt", [](F& f) { f.shift_all(0, 0, -150); }, reason::off_body, warning,
       "the garment", true, false, woman},
      {"above the head", "man_shirt", [](F& f) { f.shift_all(0, 120, 0); }, reason::off_body, warning, "the garment",
       true, false, man},
      {"above the head", "man_pants", [](F& f) { f.shift_all(0, 190, 0); }, reason::off_body, warning, "the garment",
       false, false, man},
      {"the neck sewn up", "tshirt", [](F& f) { sew(f, "band_front", 2, "band_back", 1); }, reason::no_way_for_head,
       warning, "front", false},
      {"half of the neck sewn up", "blouse", [](F& f) { sew(f, "front", 7, "back", 6); }, reason::no_way_for_head,
       warning, "the opening with edge", false},
      {"a sleeve sewn up", "tshirt", [](F& f) { sew(f, "left_sleeve_front", 2, "left_sleeve_back", 1); },
       reason::no_way_for_hand, warning, "panel \"left_sleeve_", false},
      {"a cuff sewn up", "man_shirt", [](F& f) { sew(f, "right_cuff_front", 2, "right_cuff_back", 1); },
       reason::no_way_for_hand, warning, "right_cuff", false},
      {"a leg sewn up", "man_pants", [](F& f) { sew(f, "left_front", 0, "left_back", 9); }, reason::no_way_for_foot,
       warning, "left_", false},
      {"the waist sewn up", "skirt", [](F& f) { sew(f, "front", 2, "back", 1); }, reason::no_way_in, warning, "front",
       false},
      {"sewn up all round", "long_skirt",
       [](F& f) {
         sew(f, "front", 0, "back", 3);
         sew(f, "waistband_front", 2, "waistband_back", 1);
       },
       reason::no_way_in, warning, "front", false},
  };
}

}  // namespace

std::vector<BrokenPattern> broken_patterns() {
  std::vector<BrokenPattern> all = outlines();
  for (BrokenPattern& broken : panels_and_seams()) all.push_back(std::move(broken));
  for (BrokenPattern& broken : garments()) all.push_back(std::move(broken));
  return all;
}

}  // namespace toile::internal::test
