// garment/pattern_json.cpp: the reader of pattern files (docs/pattern-format.md).
//
// Curvature in relative coordinates (a, b):  control = start + a e + b (-e_y, e_x),  e = end - start.
// All lengths are divided by units_in_meter as they are read; relative coordinates have no unit.
//
// Easily got wrong: stitches name edges by their number in the file.  When a loop is given out of order, its edges
// move and the numbers do not, so both are kept.
//
// The reader has two modes: for a garment it throws at the first fault; for the linter it is lenient and returns all that can be read
// (garment/pattern_reading.hpp).
#include "garment/edge_loop.hpp"
#include "garment/pattern_check.hpp"
#include "garment/pattern_reading.hpp"
#include "garment/pattern_values.hpp"
#include "io/json.hpp"
#include "material/fabric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace toile::internal {
namespace {

// The file's name without folder and ending; a file called plainly "specification" has its name from the folder.
std::string pattern_name(std::string_view path) {
  const auto last_part = [](std::string_view p) {
    const std::size_t slash = p.find_last_of("/\\");
    return slash == std::string_view::npos ? p : p.substr(slash + 1);
  };
  std::string_view name = last_part(path);
  std::string_view folder = path.substr(0, path.size() - name.size());
  while (!folder.empty() && (folder.back() == '/' || folder.back() == '\\')) folder.remove_suffix(1);
  if (name.ends_with(".json")) name.remove_suffix(5);
  if ((name == "specification" || name == "template") && !last_part(folder).empty())
    return std::string(last_part(folder));
  constexpr std::string_view ending = "_specification";
  if (name.size() > ending.size() && name.ends_with(ending)) name.remove_suffix(ending.size());
  return std::string(name);
}

class PatternReader {
 public:
  PatternReader(const Json& root, bool leniently) : root_(root), leniently_(leniently) {}

  // Leniently, `pattern` may be unsound: find_faults is not called.
  PatternReading read(std::string_view file) {
    if (!root_.is_object()) root_.fail("an object with the key \"pattern\"", root_.describe());
    pattern_.name = pattern_name(file);
    read_properties();
    const Json& pattern = root_.at("pattern");
    if (const Json* extension = root_.find("toile")) {
      if (!extension->is_object()) extension->fail("an object with the key \"panels\"", extension->describe());
      extension->allow_only({"panels", "stitches"});
      extension_ = extension->find("panels");
    }
    read_panels(pattern);
    if (extension_ != nullptr) {
      for (const auto& [name, panel] : extension_->object()) {
        if (!place_of_panel_.contains(name))
          panel.fail("the name of a panel", '"' + printable(name) + '"' + suggestion(name, panel_names_));
      }
    }
    read_stitches(pattern.at("stitches"));
    if (const Json* extension = root_.find("toile")) {
      if (const Json* stitches = extension->find("stitches")) read_pressed(*stitches);
    }
    if (!leniently_) report_faults(pattern);
    if (!leniently_) check_allowances();
    pattern_.legacy_frame = is_legacy_frame();
    return {std::move(pattern_), std::move(sources_), stitches_, absolute_, centre_panels_, std::move(places_)};
  }

 private:
  void read_properties() {
    const Json* properties = root_.find("properties");
    const Json* units = properties != nullptr ? properties->find("units_in_meter") : nullptr;
    if (units != nullptr) {
      pattern_.units_in_meter = units->number();
      if (!(pattern_.units_in_meter > 0)) units->fail("a number > 0, 100 for centimetres", units->describe());
    }
    pattern_.units_assumed = units == nullptr;
    if (properties == nullptr) return;
    if (const Json* coordinates = properties->find("curvature_coords")) {
      absolute_ = read_word(*coordinates, {"relative", "absolute"}) == 1;
    }
    centre_panels_ = properties->boolean_or("normalize_panel_translation", false);
  }

  double length(double file_units) const { return file_units / pattern_.units_in_meter; }
  Vec2 length(const Vec2& p) const { return p / pattern_.units_in_meter; }

  // ---- panels -------------------------------------------------------------------------------------------------------

  void read_panels(const Json& pattern) {
    const Json& panels = pattern.at("panels");
    const auto& members = panels.object();
    if (members.empty()) panels.fail("at least one panel", "an object without members");
    for (const auto& [name, panel] : members) {
      place_of_panel_.emplace(name, static_cast<Index>(panel_names_.size()));
      panel_names_.push_back(name);
    }
    std::vector<std::size_t> order(members.size());
    for (std::size_t p = 0; p < order.size(); ++p) order[p] = p;
    if (const Json* names = pattern.find("panel_order")) order = read_order(*names);
    for (std::size_t place = 0; place < order.size(); ++place) {
      const auto& [name, panel] = members[order[place]];
      place_of_panel_[name] = static_cast<Index>(place);
      read_panel(name, panel);
    }
  }

  std::vector<std::size_t> read_order(const Json& names) {
    std::vector<std::size_t> order;
    std::vector<char> listed(panel_names_.size());
    for (const Json& name : names.array()) {
      const std::size_t panel = at(find_panel(name));
      if (listed[panel]) name.fail("each panel once", name.describe() + " again");
      listed[panel] = 1;
      order.push_back(panel);
    }
    for (std::size_t p = 0; p < listed.size(); ++p) {
      if (!listed[p]) names.fail("all panels", "none called \"" + printable(panel_names_[p]) + "\"");
    }
    return order;
  }

  Index find_panel(const Json& name) const {
    if (!name.is_string()) name.fail("the name of a panel", name.describe());
    const auto found = place_of_panel_.find(name.string());
    if (found == place_of_panel_.end()) {
      name.fail("the name of a panel", name.describe() + suggestion(name.string(), panel_names_));
    }
    return found->second;
  }

  void read_panel(const std::string& name, const Json& json) {
    if (!json.is_object()) json.fail("a panel: an object", json.describe());
    json.allow_only({"translation", "rotation", "vertices", "edges", "label"});
    Panel panel;
    panel.name = name;
    panel.label = json.string_or("label", "");
    const Vec3 translation = read_numbers<3>(json.at("translation"));
    panel.translation_m = translation / pattern_.units_in_meter;
    panel.rotation_deg = read_numbers<3>(json.at("rotation"));
    for (const Json& corner : json.at("vertices").array()) panel.corners.push_back(length(read_numbers<2>(corner)));
    const Json& edges = json.at("edges");
    for (const Json& edge : edges.array()) {
      panel.edges.push_back(read_edge(panel, edge));
      panel.edges.back().file_number = static_cast<Index>(panel.edges.size() - 1);
    }
    sources_.push_back(put_in_order(panel, json, edges));
    read_extension(panel);
    if (centre_panels_) centre(panel);
    pattern_.panels.push_back(std::move(panel));
  }

  PanelEdge read_edge(const Panel& panel, const Json& json) const {
    if (!json.is_object()) json.fail("an edge: an object", json.describe());
    json.allow_only({"endpoints", "curvature", "label"});
    return read_line(panel, json);
  }

  // Common to edges and folds.
  PanelEdge read_line(const Panel& panel, const Json& json) const {
    const Json& ends = json.at("endpoints");
    if (!ends.is_array() || ends.array().size() != 2) ends.fail("two corners: [start, end]", ends.describe());
    PanelEdge edge;
    edge.start = read_index_or_none(ends.array()[0], panel.corners.size(), "a corner");
    edge.end = read_index_or_none(ends.array()[1], panel.corners.size(), "a corner");
    if (edge.start == edge.end && !leniently_)
      ends.fail("two different corners", "corner " + std::to_string(edge.start) + " twice");
    if (edge.start < 0 || edge.end < 0 || edge.start == edge.end) return edge;  // leniently
    edge.label = json.string_or("label", "");
    const Json* curvature = json.find("curvature");
    if (curvature == nullptr) return edge;

    const Vec2 &start = panel.corners[at(edge.start)], &end = panel.corners[at(edge.end)];
    const auto control = [&](const Json& point) -> Vec2 {
      const Vec2 p = read_numbers<2>(point);
      if (absolute_) return length(p);
      const Vec2 along = end - start;
      return start + p.x() * along + p.y() * Vec2{-along.y(), along.x()};
    };
    if (curvature->is_array()) {  // before 2022 a bare pair was the only curvature
      edge.kind = CurveKind::quadratic;
      edge.control[0] = control(*curvature);
      return edge;
    }
    if (!curvature->is_object()) {
      curvature->fail("a curvature: {\"type\": ..., \"params\": ...} or [a, b]", curvature->describe());
    }
    curvature->allow_only({"type", "params"});
    constexpr CurveKind kinds[] = {CurveKind::quadratic, CurveKind::cubic, CurveKind::circle};
    edge.kind = kinds[read_word(curvature->at("type"), {"quadratic", "cubic", "circle"})];
    const Json& params = curvature->at("params");
    const std::size_t count = edge.kind == CurveKind::quadratic ? 1 : edge.kind == CurveKind::cubic ? 2 : 3;
    if (!params.is_array() || params.array().size() != count) {
      params.fail(edge.kind == CurveKind::circle      ? "[radius, large_arc, sweep]"
                  : edge.kind == CurveKind::quadratic ? "one control point: [[a, b]]"
                                                      : "two control points: [[a, b], [a, b]]",
                  params.describe());
    }
    if (edge.kind == CurveKind::circle) {
      const Json& radius = params.array()[0];
      if (!(radius.number() > 0)) radius.fail("a radius > 0", radius.describe());
      edge.radius_m = length(radius.number());
      edge.large_arc = read_flag(params.array()[1]);
      edge.sweep = read_flag(params.array()[2]);
    } else {
      for (std::size_t k = 0; k < count; ++k) edge.control[k] = control(params.array()[k]);
    }
    return edge;
  }

  Index read_index_or_none(const Json& json, std::size_t count, const char* what) const {
    try {
      return read_index(json, count, what);
    } catch (const InputError&) {
      if (!leniently_) throw;
      return -1;
    }
  }

  PanelSource put_in_order(Panel& panel, const Json& json, const Json& edges) const {
    PanelSource source{&json, {}, true};
    try {
      if (std::any_of(panel.edges.begin(), panel.edges.end(),
                      [](const PanelEdge& e) { return e.start < 0 || e.end < 0 || e.start == e.end; }))
        edges.fail("", "");
      source.place_of_edge = order_loop(panel, edges);
    } catch (const InputError&) {
      if (!leniently_) throw;
      source.is_loop = false;
      for (std::size_t e = 0; e < panel.edges.size(); ++e) source.place_of_edge.push_back(static_cast<Index>(e));
    }
    return source;
  }

  // "normalize_panel_translation": the corners are meant around their mean, which moves to the translation.  The panel then
  // turns about its middle.
  static void centre(Panel& panel) {
    if (panel.corners.empty()) return;
    Vec2 sum{0, 0};
    for (const Vec2& corner : panel.corners) sum += corner;
    const Vec2 mean = sum / static_cast<double>(panel.corners.size());
    for (Vec2& corner : panel.corners) corner -= mean;
    for (PanelEdge& edge : panel.edges) {
      for (Vec2& control : edge.control) control -= mean;
    }
    for (PanelFold& fold : panel.folds) {
      for (Vec2& control : fold.line.control) control -= mean;
    }
    panel.translation_m += Vec3{mean.x(), mean.y(), 0};
  }

  // Data beyond the format: docs/pattern-format.md, "The extension".
  void read_extension(Panel& panel) {
    const Json* json = extension_ != nullptr ? extension_->find(panel.name) : nullptr;
    if (json == nullptr) return;
    if (!json->is_object()) json->fail("an object", json->describe());
    json->allow_only({"fabric", "interfacing", "interfacing_mm", "rest_stretch_u", "rest_stretch_v", "folds", "edges"});
    if (const Json* edges = json->find("edges")) read_finishes(panel, *edges);
    if (const Json* fabric = json->find("fabric"))
      panel.fabric = fabric_preset(fabric->string(), fabric->where(), fabric->pointer()).name;
    if (const Json* fabric = json->find("interfacing"))
      panel.interfacing.fabric = fabric_preset(fabric->string(), fabric->where(), fabric->pointer()).name;
    if (const Json* apart = json->find("interfacing_mm")) {
      if (!(apart->number() >= 0 && apart->number() <= 10)) apart->fail("a number from 0 to 10", apart->describe());
      if (panel.interfacing.fabric.empty()) apart->fail("`interfacing` beside it", "none");
      panel.interfacing.apart_m = 1e-3 * apart->number();
    }
    const auto rest_stretch = [&](const char* key) {
      const Json* b = json->find(key);
      if (b == nullptr) return 1.0;
      if (!(b->number() >= 0.2 && b->number() <= 5)) b->fail("a number from 0.2 to 5", b->describe());
      return b->number();
    };
    panel.rest_stretch = {rest_stretch("rest_stretch_u"), rest_stretch("rest_stretch_v")};
    const Json* folds = json->find("folds");
    if (folds == nullptr) return;
    constexpr std::size_t most_folds = 100;
    if (folds->array().size() > most_folds) folds->fail("at most 100 folds", folds->describe());
    for (const Json& entry : folds->array()) {
      if (!entry.is_object()) entry.fail("a fold: an object", entry.describe());
      entry.allow_only({"endpoints", "curvature", "angle_deg"});
      PanelFold fold{read_line(panel, entry), read_angle(entry.at("angle_deg"))};
      places_.add(path_of_fold(panel, panel.folds.size()), entry, " (" + name_of_fold(panel, panel.folds.size()) + ")");
      const auto is_side = [&](const PanelEdge& edge) {
        return (edge.start == fold.line.start && edge.end == fold.line.end) ||
               (edge.start == fold.line.end && edge.end == fold.line.start);
      };
      if (fold.line.kind == CurveKind::line && std::any_of(panel.edges.begin(), panel.edges.end(), [&](const auto& e) {
            return e.kind == CurveKind::line && is_side(e);
          }))
        entry.fail("a line through the panel", "a side of its outline");
      panel.folds.push_back(std::move(fold));
    }
  }

  void read_finishes(Panel& panel, const Json& edges) {
    for (const Json& entry : edges.array()) {
      if (!entry.is_object()) entry.fail("an edge: an object", entry.describe());
      entry.allow_only({"edge", "hem_mm", "tape_mm", "allowance_mm", "topstitched"});
      const Json& number = entry.at("edge");
      const Index wanted = read_index_or_none(number, panel.edges.size(), "an edge");
      const auto edge = std::find_if(panel.edges.begin(), panel.edges.end(),
                                     [&](const PanelEdge& one) { return one.file_number == wanted; });
      if (edge == panel.edges.end()) continue;  // leniently
      if (edge->finish_given) number.fail("each edge once", "edge " + std::to_string(wanted) + " twice");
      const auto width_m = [&](const char* key) {
        const Json* width = entry.find(key);
        if (width == nullptr) return 0.0;
        if (!(width->number() >= 0 && width->number() <= 200)) width->fail("a number from 0 to 200", width->describe());
        return 1e-3 * width->number();
      };
      edge->finish = {width_m("hem_mm"), width_m("tape_mm"), width_m("allowance_mm"),
                      entry.boolean_or("topstitched", false)};
      if (edge->finish.topstitched && edge->finish.allowance_m <= 0)
        entry.at("topstitched").fail("an `allowance_mm` above zero beside it", "none");
      if (edge->finish.allowance_m > 0) allowances_.push_back({panel.name, wanted, &entry.at("allowance_mm")});
      edge->finish_given = true;
    }
  }

  // ---- stitches -----------------------------------------------------------------------------------------------------

  void read_stitches(const Json& stitches) {
    stitches_ = &stitches;
    for (const Json& json : stitches.array()) {
      if (!json.is_array() || json.array().size() < 2 || json.array().size() > 3) {
        json.fail("a stitch: two sides and perhaps \"right_wrong\"", json.describe());
      }
      Stitch stitch;
      stitch.a = read_side(json.array()[0]);
      stitch.b = read_side(json.array()[1]);
      if (json.array().size() == 3) {
        read_word(json.array()[2], {"right_wrong"});
        stitch.right_wrong = true;
      }
      pattern_.stitches.push_back(stitch);
    }
  }

  // Beyond an open edge there is no cloth.
  void check_allowances() const {
    for (const Allowance& given : allowances_) {
      const auto is_its = [&](const StitchSide& side) {
        const Panel& panel = pattern_.panels[at(side.panel)];
        return panel.name == given.panel && panel.file_number(side.edge) == given.edge;
      };
      if (std::none_of(pattern_.stitches.begin(), pattern_.stitches.end(),
                       [&](const Stitch& stitch) { return is_its(stitch.a) || is_its(stitch.b); }))
        given.json->fail("none on an open edge: a seam allowance belongs to an edge that is stitched",
                         given.json->describe());
    }
  }

  // Seams that are pressed to an angle.
  void read_pressed(const Json& stitches) {
    for (const Json& entry : stitches.array()) {
      if (!entry.is_object()) entry.fail("an object", entry.describe());
      entry.allow_only({"stitch", "angle_deg"});
      const Index stitch = read_index(entry.at("stitch"), pattern_.stitches.size(), "a stitch");
      pattern_.stitches[at(stitch)].angle_rad = read_angle(entry.at("angle_deg"));
    }
  }

  StitchSide read_side(const Json& json) const {
    if (!json.is_object()) json.fail("one side of a stitch: {\"panel\": ..., \"edge\": ...}", json.describe());
    json.allow_only({"panel", "edge"});
    StitchSide side{-1, -1};  // its value if it cannot be read, leniently
    try {
      side.panel = find_panel(json.at("panel"));
    } catch (const InputError&) {
      if (!leniently_ || !json.at("panel").is_string()) throw;
      return side;
    }
    const std::vector<Index>& place = sources_[at(side.panel)].place_of_edge;
    const std::string what = "an edge of panel \"" + printable(pattern_.panels[at(side.panel)].name) + "\"";
    const Index edge = read_index_or_none(json.at("edge"), place.size(), what.c_str());
    if (edge >= 0) side.edge = place[at(edge)];
    return side;
  }

  // ---- the whole ----------------------------------------------------------------------------------------------------

  void report_faults(const Json& pattern) const {
    const std::vector<PatternFault> faults = find_faults(pattern_);
    if (faults.empty()) return;
    const PatternFault& fault = faults.front();
    json_of_fault(fault, pattern, pattern_, sources_, *stitches_).fail(fault.expected, fault.got);
  }

  // The templates of 2021 put the origin near the pelvis; GarmentCode puts it on the floor.  No key says which, so:
  //   a garment whose middle lies below the floor can only be meant in the old frame;
  //   a file with `parameters` (which only the templates have) is in the old frame when its middle is below 0.4 m: that of a jacket with a hood,
  //   which is drawn above the head, is at 0.23 m with the pelvis at 0; that of trousers on the floor, the lowest there are, at 0.47 m.
  bool is_legacy_frame() const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Panel& panel : pattern_.panels) {
      const Mat3 rotation = panel.rotation();
      for (const Vec2& corner : panel.corners) {
        const double y = (rotation * Vec3{corner.x(), corner.y(), 0} + panel.translation_m).y();
        low = std::min(low, y);
        high = std::max(high, y);
      }
    }
    constexpr double highest_middle_m = 0.4;
    const Json* parameters = root_.find("parameters");
    const bool is_template = parameters != nullptr && parameters->is_object() && !parameters->object().empty();
    return low + high < (is_template ? 2 * highest_middle_m : 0);
  }

  const Json& root_;
  const bool leniently_;
  Pattern pattern_;
  bool absolute_ = false, centre_panels_ = false;
  std::vector<std::string> panel_names_;         // in the order of the file
  std::map<std::string, Index> place_of_panel_;  // first in the order of the file, then in Pattern::panels
  std::vector<PanelSource> sources_;             // as Pattern::panels
  const Json* stitches_ = nullptr;
  const Json* extension_ = nullptr;  // /toile/panels
  struct Allowance {
    std::string panel;
    Index edge = 0;  // its number in the file
    const Json* json = nullptr;
  };
  std::vector<Allowance> allowances_;
  JsonPlaces places_;
};

}  // namespace

const Json& json_of_fault(const PatternFault& fault, const Json& root, const Pattern& pattern,
                          std::span<const PanelSource> panels, const Json& stitches) {
  const Json* json = &root;
  if (fault.part == PatternFault::Part::stitch) {
    json = &stitches.array()[at(fault.index)];
    if (fault.side >= 0) json = &json->array()[static_cast<std::size_t>(fault.side)];
  } else if (fault.part != PatternFault::Part::pattern) {
    json = panels[at(fault.panel)].panel;
    if (fault.part == PatternFault::Part::corner) json = &json->at("vertices").array()[at(fault.index)];
    if (fault.part == PatternFault::Part::edge)
      json = &json->at("edges").array()[at(pattern.panels[at(fault.panel)].file_number(fault.index))];
  }
  return *json;
}

PatternReading read_pattern_leniently(const Json& root, std::string_view file) {
  return PatternReader(root, true).read(file);
}

Pattern parse_pattern(std::string_view text, std::string_view file) {
  const Json root = Json::parse(text, file);
  return PatternReader(root, false).read(file).pattern;
}

PatternFile read_pattern(std::string_view text, std::string_view file) {
  const Json root = Json::parse(text, file);
  PatternReading reading = PatternReader(root, false).read(file);
  return {std::move(reading.pattern), std::move(reading.places)};
}

std::string path_of_fold(const Panel& panel, std::size_t fold) {
  return "/panels" + pointer_step(panel.name) + "/folds/" + std::to_string(fold);
}

std::string name_of_fold(const Panel& panel, std::size_t fold) {
  return "panel " + printable(panel.name) + ", fold " + std::to_string(fold);
}

Pattern load_pattern(const std::string& path) {
  const Json root = Json::load(path);
  return PatternReader(root, false).read(path).pattern;
}

}  // namespace toile::internal
