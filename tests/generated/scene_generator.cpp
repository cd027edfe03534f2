#include "generated/scene_generator.hpp"

#include "generated/scene_files.hpp"
#include "generated/scene_parts.hpp"

#include <algorithm>
#include <array>

namespace toile::internal::generated {

SceneParts::SceneParts(const Choice& choice, const Draw& draw, const Variant& variant)
    : choice_(choice), draw_(draw), variant_(variant) {
  const std::array<std::pair<std::string_view, double>, 4> rates = {{{"30", 30}, {"24", 24}, {"60", 60}, {"10", 10}}};
  for (const auto& [name, rate] : rates)
    if (is("fps", name)) fps_ = rate;
  int frames =
      is("seconds", "few frames") ? draw.whole("frames", 3, 5) : draw.whole("frames", 6, is("fps", "10") ? 6 : 10);
  if (variant.earlier) frames = 3;
  seconds_ = frames / fps_;
  centre_ = place_of_cloth();
}

Place SceneParts::place_of_cloth() const {
  if (is_sewn()) return {0, 0.75, 0};
  const double top = is_person() ? 1.8 : 1.25;
  const double half_m = is("cloth", "tube") || is("cloth", "closed ribbon") ? 0.5 : 0;  // of what lies on its side
  if (is("placed", "around the body")) return {0, 0.6, 0};
  if (is("placed", "lying above")) return {0, top + half_m + draw_.between("above", 0.02, 0.1), 0};
  if (is("placed", "in front")) return {0, 0.9, draw_.between("in front", 0.8, 1)};
  if (is("placed", "turned")) return {draw_.between("turned x", 0.4, 0.8), 0.9, 0.8};
  if (is("placed", "through")) return {draw_.between("through x", 0.05, 0.2), 0.8, 0.03};
  return {0, 0, 0};
}

namespace {

std::string scene_text(const Choice& choice, const Draw& draw, const Variant& variant) {
  const ClothPart cloth(choice, draw, variant);
  const BodyPart body(choice, draw, variant);
  const NumberPart numbers(choice, draw, variant);
  Object root;
  root.set("name", word("generated"));
  root.set("cloth", cloth.cloths());
  const auto add = [&](std::string_view key, const Object& part) {
    if (!part.empty()) root.set(key, part.text());
  };
  add("body", body.body());
  if (const std::vector<std::string> all = body.solids(); !all.empty() || variant.defaults)
    root.set("solids", list(all));
  add("world", numbers.world());
  add("time", numbers.time());
  add("solver", numbers.solver());
  add("contact", numbers.contact());
  if (cloth.is("start", "earlier run") && !variant.earlier) root.set("start", word("earlier"));
  if (variant.defaults) root.set("output", Object().set("preview", "false").set("picture_frames", "[0, 2]").text());
  return root.text() + '\n';
}

Choice by_chance(const Draw& draw) {
  const Space& space = scene_space();
  std::vector<std::vector<std::size_t>> wishes;
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t k = 0; k < space.axes().size(); ++k) {
    const Axis& axis = space.axes()[k];
    std::vector<std::pair<std::uint64_t, std::size_t>> values;
    for (std::size_t v = 0; v < axis.values.size(); ++v)
      values.emplace_back(draw.bits(std::string(axis.name) + '=' + std::string(axis.values[v])), v);
    std::sort(values.begin(), values.end());
    wishes.emplace_back();
    for (const auto& value : values) wishes.back().push_back(value.second);
    order.emplace_back(draw.bits(axis.name), k);
  }
  // The first few axes, by chance, get what they wish.
  std::sort(order.begin(), order.end());
  std::vector<std::pair<std::size_t, std::size_t>> fixed;
  for (const auto& one : order) {
    for (const std::size_t v : wishes[one.second]) {
      fixed.emplace_back(one.second, v);
      if (!space.complete(fixed, wishes).empty()) break;
      fixed.pop_back();
    }
  }
  return space.complete(fixed, wishes);
}

}  // namespace

Choice choice_of(std::uint64_t number) {
  static const std::vector<Choice> rows = covering_rows(scene_space());
  return number < rows.size() ? rows[number] : by_chance(Draw(number));
}

GeneratedScene generate_scene(std::uint64_t number) {
  const Draw draw(number);
  GeneratedScene made;
  made.choice = choice_of(number);
  const auto build = [&](const Variant& variant) { return scene_text(made.choice, draw, variant); };
  const SceneParts parts(made.choice, draw, {});
  made.scene = build({});
  if (parts.is("start", "earlier run")) made.earlier = build({.earlier = true});
  // A garment waits for rest where nothing moves, and ends differently where something does.
  const bool far_moves = (parts.moves() || !parts.is_sewn()) && draw.whole("far solid moves", 0, 1) == 1;
  made.begins_to_move = far_moves && !parts.moves();
  const bool far_solid = made.earlier.empty();  // a run begins with the body of the one that it starts from
  if (far_solid) made.with_far_solid = build({.far_solid = true, .far_moves = far_moves});
  made.with_defaults = build({.defaults = true});
  made.with_both = build({.far_solid = far_solid, .far_moves = far_moves, .defaults = true});
  made.may_refuse_start = parts.is("strict start", "yes");
  if (parts.has_mesh_body()) made.files.push_back(body_file(draw, parts.is("body", "mesh in cm")));
  if (parts.is("motion", "pc2") || parts.is("motion", "obj files"))
    for (TextFile& file : motion_files(draw, parts.is("body", "mesh in cm"), parts.is("motion", "obj files")))
      made.files.push_back(std::move(file));
  if (parts.is("solid", "mesh")) made.files.push_back(solid_file(parts.solid_mesh_scale()));
  if (parts.is_sewn())
    made.files.push_back(
        pattern_file(draw, scene_space().name_of(made.choice, "drawing"), false, parts.is("edges", "counted")));
  if (parts.is("cloth", "two patterns")) made.files.push_back(pattern_file(draw, "plain", true, false));
  return made;
}

std::string describe(const Choice& choice) {
  std::string text;
  const Space& space = scene_space();
  for (std::size_t k = 0; k < choice.size(); ++k) {
    if (choice[k] == 0 && k > 0) continue;
    text += (text.empty() ? "" : "; ") + std::string(space.axes()[k].name) + ": " +
            std::string(space.axes()[k].values[choice[k]]);
  }
  return text;
}

}  // namespace toile::internal::generated
