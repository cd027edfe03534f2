#include "generated/scene_generator.hpp"

#include "generated/draw.hpp"
#include "generated/json_words.hpp"
#include "generated/scene_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace toile::generated {
namespace {

struct Place {
  double x, y, z;
  std::string text() const { return vector(x, y, z); }
  Place operator+(const Place& b) const { return {x + b.x, y + b.y, z + b.z}; }
};

struct Variant {
  bool earlier = false;     // the run that another one starts from
  bool far_solid = false;   // besides what there is
  bool far_moves = false;
  bool defaults = false;    // written out
};

class Builder {
 public:
  Builder(const Choice& choice, const Draw& draw, const Variant& variant)
      : choice_(choice), draw_(draw), variant_(variant) {
    const std::array<std::pair<std::string_view, double>, 4> rates = {{{"30", 30}, {"24", 24}, {"60", 60}, {"10", 10}}};
    for (const auto& [name, rate] : rates)
      if (is("fps", name)) fps_ = rate;
    int frames = is("seconds", "few frames") ? draw.whole("frames", 3, 5) : draw.whole("frames", 6, is("fps", "10") ? 6 : 10);
    if (variant.earlier) frames = 3;
    seconds_ = frames / fps_;
    centre_ = place_of_cloth();
  }

  std::string scene() const {
    Object root;
    root.set("name", word("generated"));
    root.set("cloth", cloths());
    if (const Object one = body(); !one.empty()) root.set("body", one.text());
    if (const std::vector<std::string> all = solids(); !all.empty() || variant_.defaults) root.set("solids", list(all));
    add(root, "world", world());
    add(root, "time", time());
    add(root, "solver", solver());
    add(root, "contact", contact());
    if (is("start", "earlier run") && !variant_.earlier) root.set("start", word("earlier"));
    if (variant_.defaults) root.set("output", Object().set("preview", "false").set("picture_frames", "[0, 2]").text());
    return root.text() + '\n';
  }

  bool is(std::string_view axis, std::string_view value) const { return scene_space().name_of(choice_, axis) == value; }
  bool is_sewn() const { return is("cloth", "pattern") || is("cloth", "two patterns"); }
  bool is_person() const { return is("body", "mannequin"); }
  bool has_mesh_body() const { return is("body", "mesh") || is("body", "mesh in cm"); }
  bool moves() const { return !is("motion", "none") || !is("solid moves", "no"); }
  double solid_mesh_scale() const { return is("solid place", "room") ? 16 : draw_.between("solid size", 0.15, 0.3); }

 private:
  static void add(Object& root, std::string_view key, const Object& part) {
    if (!part.empty()) root.set(key, part.text());
  }

  // ---- cloth

  Place place_of_cloth() const {
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

  std::string fabric() const {
    if (is("fabric", "numbers"))
      return Object()
          .set("base", word("cotton"))
          .set("density_kg_per_m2", number(draw_.between("density", 0.05, 0.6)))
          .set("stretch_u_N_per_m", number(draw_.between("stretch u", 300, 5000)))
          .set("stretch_v_N_per_m", number(draw_.between("stretch v", 300, 5000)))
          .set("shear_N_per_m", number(draw_.between("shear", 5, 300)))
          .set("bend_u_N_m", number(draw_.between("bend u", 1e-6, 5e-5)))
          .set("bend_v_N_m", number(draw_.between("bend v", 1e-6, 5e-5)))
          .set("compression_ratio", number(draw_.between("compression", 0.1, 1)))
          .set("friction", number(draw_.between("fabric friction", 0, 1)))
          .text();
    if (is("fabric", "limited")) return Object().set("base", word("knit")).set("strain_limit", "0.05").text();
    if (is("fabric", "bare"))
      return Object()
          .set("shear_N_per_m", "0")
          .set("bend_u_N_m", "0")
          .set("bend_v_N_m", "0")
          .set("stretch_damping_s", "0")
          .set("shear_damping_s", "0")
          .set("bend_damping_s", "0")
          .set("friction", "0")
          .text();
    return word(is("fabric", "default") ? "cotton" : scene_space().name_of(choice_, "fabric"));
  }

  std::string ribbon(bool closed) const {
    Object ribbon;
    const double radius = draw_.between("ribbon radius", 0.38, 0.45);
    std::vector<std::string> path;
    const int points = closed ? 6 : 4;
    for (int k = 0; k < points; ++k) {
      const double turn = closed ? 6.283185307 * k / points : 2.0 * k / points - 0.9;
      path.push_back(vector(radius * std::sin(turn), draw_.between("ribbon waves", 0, 0.1) * (k % 2),
                            radius * std::cos(turn) - (closed ? 0 : radius)));
    }
    ribbon.set("path_m", list(path)).set("width_m", "0.2").set("edge_m", is("edges", "fine") ? "0.07" : "0.1");
    if (closed) ribbon.set("closed", "true").set("across", vector(0, 1, 0));
    if (variant_.defaults) ribbon.set_if_absent("closed", "false").set_if_absent("across", vector(0, 0, 1));
    return ribbon.text();
  }

  void set_shape(Object& cloth) const {
    const bool fine = is("edges", "fine");
    if (is_sewn()) {
      cloth.set("pattern", word("pattern.json"));
      if (is("edges", "counted")) {
        cloth.set("vertices", number(counted_vertices));
      } else {
        cloth.set("resolution_cm", fine ? "9" : "13");
      }
    } else if (is("cloth", "tube")) {
      cloth.set("tube", Object().set("radius_m", "0.35").set("length_m", "0.3").set("edge_m", fine ? "0.1" : "0.14").text());
    } else if (is("cloth", "ribbon") || is("cloth", "closed ribbon")) {
      cloth.set("ribbon", ribbon(is("cloth", "closed ribbon")));
    } else {
      cloth.set("grid", Object()
                            .set("width_m", number(draw_.between("width", 0.4, 0.7)))
                            .set("height_m", number(draw_.between("height", 0.4, 0.6)))
                            .set("edge_m", fine ? "0.08" : "0.12")
                            .text());
    }
  }

  void set_placement(Object& cloth) const {
    if (is("placed", "as drawn")) {
      if (variant_.defaults) cloth.set("placement", Object().set("translation_m", vector(0, 0, 0)).set("rotation_deg", vector(0, 0, 0)).text());
      return;
    }
    Object placement;
    placement.set("translation_m", centre_.text());
    if (is("placed", "lying above")) placement.set("rotation_deg", vector(-90, 0, 0));
    if (is("placed", "turned"))
      placement.set("rotation_deg", vector(draw_.between("turn x", -180, 180), draw_.between("turn y", -180, 180), draw_.between("turn z", -180, 180)));
    cloth.set("placement", placement.text());
  }

  void set_panels(Object& cloth, const std::string& panel) const {
    Object what;
    if (is("panel", "fabric")) what.set("fabric", word(is("fabric", "denim") ? "silk" : "denim"));
    if (is("panel", "rest_stretch")) what.set("rest_stretch_u", "0.95").set("rest_stretch_v", number(draw_.between("rest stretch", 0.8, 1.1)));
    if (is("panel", "rest_stretch_path"))
      what.set("rest_stretch_path", list({list({"0", "1", "1"}), list({number(seconds_), "0.93", "0.97"})}));
    if (variant_.defaults) {
      what.set_if_absent("fabric", fabric());
      what.set_if_absent("rest_stretch_u", "1").set_if_absent("rest_stretch_v", "1");
    }
    if (!what.empty()) cloth.set("panels", Object().set(panel, what.text()).text());
  }

  std::string turning_moves() const {
    const std::string begin = Object().set("t_s", "0").text();
    const std::string end = Object()
                                .set("t_s", number(seconds_))
                                .set("shift_m", vector(0.04, draw_.between("pin rises", -0.05, 0.1), 0))
                                .set("rotation_deg", vector(0, draw_.between("pin turns", -20, 20), 0))
                                .text();
    return list({begin, end});
  }

  void set_pins(Object& cloth) const {
    const std::string corner = (centre_ + Place{-0.3, 0.3, 0}).text(), other = (centre_ + Place{0.3, 0.3, 0}).text();
    const std::string box = list({vector(-9, -9, -9), vector(centre_.x - 0.05, 9, 9)});
    const std::string half = number(0.5 * seconds_);
    std::vector<std::string> pins;
    if (is("pins", "near")) pins = {Object().set("near_m", corner).text()};
    if (is("pins", "box")) pins = {Object().set("in_box_m", box).text()};
    if (is("pins", "path"))
      pins = {Object()
                  .set("near_m", corner)
                  .set("hold", word("path"))
                  .set("path_m", list({list({"0", number(centre_.x - 0.28), number(centre_.y + 0.28), number(centre_.z)}),
                                       list({number(seconds_), number(centre_.x - 0.25), number(centre_.y + 0.35), number(centre_.z)})}))
                  .text()};
    if (is("pins", "moves") || is("pins", "box moves")) {
      Object pin;
      if (is("pins", "moves")) {
        pin.set("near_m", corner);
      } else {
        pin.set("in_box_m", box);
      }
      pins = {pin.set("hold", word("moves")).set("moves", turning_moves()).set("about_m", corner).text()};
    }
    if (is("pins", "let go")) pins = {Object().set("near_m", corner).set("to_s", half).text(), Object().set("near_m", corner).set("from_s", half).text()};
    if (is("pins", "taken later")) pins = {Object().set("in_box_m", box).set("from_s", half).set("hold", word("fixed")).text()};
    if (!pins.empty() || (variant_.defaults && !is_sewn())) cloth.set("pins", list(pins));
  }

  void set_drags(Object& cloth) const {
    const Place at = centre_ + Place{0.2, -0.2, 0};
    const std::string path = list({list({"0", number(at.x), number(at.y), number(at.z)}),
                                   list({number(seconds_), number(at.x + 0.1), number(at.y), number(at.z + draw_.between("drag", 0, 0.2))})});
    Object drag;
    drag.set("near_m", at.text()).set("path_m", path);
    if (is("drags", "stiff")) drag.set("stiffness_N_per_m", "5000").set("damping_N_s_per_m", "0").set("max_force_N", "40");
    if (variant_.defaults) drag.set_if_absent("stiffness_N_per_m", "50").set_if_absent("damping_N_s_per_m", "0.5").set_if_absent("max_force_N", "5");
    std::vector<std::string> drags;
    if (!is("drags", "none")) drags.push_back(drag.text());
    if (is("drags", "two"))
      drags.push_back(Object().set("near_m", centre_.text()).set("path_m", path).set("from_s", number(0.3 * seconds_)).set("to_s", number(0.8 * seconds_)).text());
    if (!drags.empty() || variant_.defaults) cloth.set("drags", list(drags));
  }

  std::string cloths() const {
    Object cloth;
    cloth.set("name", word("first"));
    set_shape(cloth);
    if (!is("fabric", "default") || variant_.defaults) cloth.set("fabric", fabric());
    if (!is_sewn()) set_placement(cloth);
    set_panels(cloth, is_sewn() ? "front" : "first");
    set_pins(cloth);
    set_drags(cloth);
    if (is("labels", "held")) cloth.set("label_heights_m", Object().set("lower_interface", "0.9").text());
    std::vector<std::string> all = {cloth.text()};
    if (is("cloth", "two patterns"))
      all.push_back(Object().set("pattern", word("outer.json")).set("resolution_cm", "14").set("fabric", word("cotton")).text());
    if (is("cloth", "two shapes"))
      all.push_back(Object()
                        .set("name", word("second"))
                        .set("ribbon", ribbon(false))
                        .set("placement", Object().set("translation_m", (centre_ + Place{0, 0.05, 0.3}).text()).text())
                        .text());
    return list(all);
  }

  // ---- what it collides with

  Object body() const {
    Object body;
    if (is_person()) body.set("mannequin", word(std::array{"woman", "dancer", "man"}[draw_.bits("mannequin") % 3]));
    if (has_mesh_body()) body.set("mesh", word("body.obj"));
    if (is("body", "mesh in cm")) body.set("unit", word("cm"));
    if (is("body", "cylinder"))
      body.set("cylinder", Object().set("radius_m", "0.18").set("height_m", "1.2").set("top_m", vector(0, 1.2, 0)).text());
    if (!is("motion", "none")) {
      const bool from_file = is("motion", "pc2") || is("motion", "obj files");
      const std::string name = std::array{"stand", "sway", "walk", "twist", "crouch", "dance"}[draw_.bits("motion") % 6];
      Object motion;
      if (from_file) {
        motion.set("file", word(is("motion", "pc2") ? "motion.pc2" : "motion")).set("fps", "20");
      } else {
        motion.set("name", word(name));
      }
      if (is("lead-in", "none")) motion.set("lead_in_s", "0");
      if (is("lead-in", "short")) motion.set("lead_in_s", "0.1");
      const bool plain = !from_file && is("lead-in", "default");
      if (variant_.defaults) motion.set_if_absent("lead_in_s", "1");
      body.set("motion", plain && !variant_.defaults ? word(name) : motion.text());
    }
    if (!is("body friction", "default")) body.set("friction", std::string(scene_space().name_of(choice_, "body friction")));
    if (is("offset", "4 mm")) body.set("offset_mm", "4");
    if (variant_.defaults && is("body", "none") && is("solid", "none")) body.set("friction", "0.7").set("offset_mm", "5");
    return body;
  }

  Object solid_of(std::string_view kind) const {
    Object solid;
    const bool room = is("solid place", "room");
    if (kind == "sphere")
      solid.set("sphere", Object().set("radius_m", room ? "5" : number(draw_.between("radius", 0.1, 0.2))).text());
    if (kind == "box") solid.set("box", Object().set("size_m", room ? "[9, 8, 7]" : vector(0.3, draw_.between("box", 0.1, 0.3), 0.4)).text());
    if (kind == "revolved") {
      const double r = room ? 4 : draw_.between("radius", 0.1, 0.2);
      // A drum, or a ring beside the axis.
      if (room || draw_.whole("drum", 0, 1) == 1) {
        solid.set("revolved", Object().set("profile_m", list({list({"0", number(-r)}), list({number(r), number(-r)}), list({number(r), number(r)}), list({"0", number(r)})})).text());
      } else {
        solid.set("revolved", Object().set("profile_m", list({list({number(r), "0"}), list({number(r + 0.1), "0.05"}), list({number(r), "0.1"})})).text());
      }
    }
    if (kind == "mesh") solid.set("mesh", word("solid.obj"));
    if (kind == "sphere" || kind == "revolved") solid.set("edge_m", room ? "1.5" : "0.12");
    if (room) solid.set("inside_out", "true");
    if (variant_.defaults) solid.set_if_absent("inside_out", "false");
    return solid;
  }

  void set_moves(Object& solid) const {
    if (is("solid moves", "no")) return;
    const bool room = is("solid place", "room");
    Object begin, end;
    begin.set("t_s", is("solid moves", "later") ? number(0.5 * seconds_) : "0");
    end.set("t_s", number(seconds_));
    if (is("solid moves", "shifts") || is("solid moves", "later"))
      end.set("shift_m", vector(draw_.between("shift x", -0.1, 0.1), draw_.between("shift y", -0.05, 0.1), 0.03));
    if (is("solid moves", "turns")) end.set("rotation_deg", room ? vector(2, 5, 0) : vector(20, draw_.between("turns", -90, 90), 0));
    if (is("solid moves", "grows")) end.set("scale", room ? "1.03" : number(draw_.between("scale", 0.8, 1.2)));
    solid.set("moves", list({begin.text(), end.text()}));
  }

  std::vector<std::string> solids() const {
    std::vector<std::string> all;
    Place at = centre_ + Place{0, -0.5, 0};
    if (is("solid place", "beside")) at = centre_ + Place{0.75, 0, 0};
    if (is("solid place", "far")) at = {50, 3, -20};
    if (is("solid place", "room")) at = {0, 1, 0};
    if (!is("solid", "none")) {
      Object solid = solid_of(is("solid", "two") ? "sphere" : scene_space().name_of(choice_, "solid"));
      solid.set("placement", Object().set("translation_m", at.text()).text());
      set_moves(solid);
      all.push_back(solid.text());
    }
    if (is("solid", "two")) {
      Object box;
      box.set("box", Object().set("size_m", vector(0.2, 0.2, 0.2)).text());
      box.set("placement", Object().set("translation_m", (centre_ + Place{-0.8, -0.1, 0}).text()).set("rotation_deg", vector(0, 30, 10)).text());
      all.push_back(box.text());
    }
    if (variant_.far_solid) {
      Object box;
      box.set("box", Object().set("size_m", vector(1, 2, 1)).text());
      box.set("placement", Object().set("translation_m", vector(-50, 2, 10)).text());
      if (variant_.far_moves)
        box.set("moves", list({Object().set("t_s", "0").text(), Object().set("t_s", "0.05").set("shift_m", vector(0, 0.1, 0)).text()}));
      all.push_back(box.text());
    }
    return all;
  }

  // ---- numbers

  Object world() const {
    Object world;
    if (is("gravity", "none")) world.set("gravity_m_per_s2", vector(0, 0, 0));
    if (is("gravity", "sideways")) world.set("gravity_m_per_s2", vector(6, -3, 0));
    if (is("gravity", "up")) world.set("gravity_m_per_s2", vector(0, 5, 0));
    if (is("wind", "breeze")) world.set("wind_m_per_s", vector(2, 0, draw_.between("wind", -2, 2)));
    if (is("wind", "gale")) world.set("wind_m_per_s", vector(draw_.between("gale", -20, 20), 3, -8));
    if (is("air", "none")) world.set("air_density_kg_per_m3", "0");
    if (is("air", "dense")) world.set("air_density_kg_per_m3", "20");
    if (variant_.defaults)
      world.set_if_absent("gravity_m_per_s2", vector(0, -9.81, 0)).set_if_absent("wind_m_per_s", vector(0, 0, 0)).set_if_absent("air_density_kg_per_m3", "1.2");
    return world;
  }

  Object time() const {
    Object time;
    if (!is("fps", "30")) time.set("fps", number(fps_));
    if (!is("seconds", "whole motion") || variant_.earlier) time.set("seconds", number(seconds_));
    if (is("drape", "none")) time.set("drape_seconds", "0");
    if (is("drape", "few frames")) time.set("drape_seconds", number(3 / fps_));
    if (!is("until still", "default")) time.set("until_still", is("until still", "yes") ? "true" : "false");
    if (is("step", "short")) time.set("step_max_ms", "5");
    if (is("step", "long")) time.set("step_max_ms", "100");
    if (is("integrator", "bdf2")) time.set("integrator", word("bdf2"));
    if (variant_.defaults) {
      time.set_if_absent("fps", "30").set_if_absent("integrator", word("backward_euler"));
      time.set_if_absent("until_still", is_sewn() ? "true" : "false");
      if (is_sewn()) time.set_if_absent("drape_seconds", "10");
    }
    return time;
  }

  Object solver() const {
    Object solver;
    if (!is("preconditioner", "default")) solver.set("preconditioner", word(scene_space().name_of(choice_, "preconditioner")));
    if (is("procedure", "paper_1998")) solver.set("procedure", word("paper_1998"));
    if (is("tolerance", "tight")) solver.set("tolerance", "1e-5");
    if (is("tolerance", "loose")) solver.set("tolerance", "0.2");
    if (!is("newton", "default")) solver.set("newton_iterations", std::string(scene_space().name_of(choice_, "newton")));
    if (!is("relinearisations", "default")) solver.set("relinearisations", std::string(scene_space().name_of(choice_, "relinearisations")));
    if (is("scaling", "paper")) solver.set("paper_scaling", "true");
    if (is("jacobian", "paper")) solver.set("damping_jacobian", word("paper"));
    if (variant_.defaults) {
      const bool coarse = (is("preconditioner", "default") || is("preconditioner", "block_ssor_coarse")) && is("procedure", "default");
      solver.set_if_absent("preconditioner", word("auto")).set_if_absent("procedure", word("prefiltered"));
      solver.set_if_absent("tolerance", coarse ? "0.01" : "0.001").set_if_absent("newton_iterations", "1");
      solver.set_if_absent("relinearisations", "6").set_if_absent("paper_scaling", "false");
      solver.set_if_absent("damping_jacobian", word("gauss_newton"));
    }
    return solver;
  }

  // A fabric that no cloth of the scene has.
  std::string other_fabric() const { return is("fabric", "wool") ? "silk" : "wool"; }

  Object contact() const {
    Object contact;
    if (is("thickness", "0.5 mm")) contact.set("thickness_mm", "0.5");
    if (is("thickness", "6 mm")) contact.set("thickness_mm", "6");
    if (!is("friction", "default")) contact.set("friction", std::string(scene_space().name_of(choice_, "friction")));
    if (is("friction between", "of these")) {
      const bool named = is("fabric", "silk") || is("fabric", "wool") || is("fabric", "denim") || is("fabric", "knit");
      const std::string own = named ? std::string(scene_space().name_of(choice_, "fabric")) : is("fabric", "limited") ? "knit" : "cotton";
      contact.set("friction_between", list({list({word(own), word(own), "0.25"}), list({word(own), word("cotton"), "0.5"})}));
    } else if (is("friction between", "of others") || variant_.defaults) {
      contact.set("friction_between", list({list({word(other_fabric()), word(other_fabric()), "0.3"})}));
    }
    if (is("self contact", "no")) contact.set("self_contact", "false");
    if (is("flypaper", "no")) contact.set("flypaper", "false");
    if (is("strict start", "yes") && !variant_.earlier) contact.set("strict_start", "true");
    if (variant_.defaults)
      contact.set_if_absent("self_contact", "true").set_if_absent("flypaper", "true").set_if_absent("strict_start", "false");
    return contact;
  }

  const Choice& choice_;
  const Draw& draw_;
  Variant variant_;
  double fps_ = 30, seconds_ = 0;
  Place centre_{0, 0, 0};
};

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
  const auto build = [&](const Variant& variant) { return Builder(made.choice, draw, variant).scene(); };
  const Builder builder(made.choice, draw, {});
  made.scene = builder.scene();
  if (builder.is("start", "earlier run")) made.earlier = build({.earlier = true});
  // A garment waits for rest where nothing moves, and ends differently where something does.
  const bool far_moves = (builder.moves() || !builder.is_sewn()) && draw.whole("far solid moves", 0, 1) == 1;
  made.begins_to_move = far_moves && !builder.moves();
  const bool far_solid = made.earlier.empty();  // a run begins with the body of the one that it starts from
  if (far_solid) made.with_far_solid = build({.far_solid = true, .far_moves = far_moves});
  made.with_defaults = build({.defaults = true});
  made.with_both = build({.far_solid = far_solid, .far_moves = far_moves, .defaults = true});
  made.may_refuse_start = builder.is("strict start", "yes");
  if (builder.has_mesh_body()) made.files.push_back(body_file(draw, builder.is("body", "mesh in cm")));
  if (builder.is("motion", "pc2") || builder.is("motion", "obj files"))
    for (TextFile& file : motion_files(draw, builder.is("body", "mesh in cm"), builder.is("motion", "obj files")))
      made.files.push_back(std::move(file));
  if (builder.is("solid", "mesh")) made.files.push_back(solid_file(builder.solid_mesh_scale()));
  if (builder.is_sewn()) made.files.push_back(pattern_file(draw, scene_space().name_of(made.choice, "drawing"), false, builder.is("edges", "counted")));
  if (builder.is("cloth", "two patterns")) made.files.push_back(pattern_file(draw, "plain", true, false));
  return made;
}

std::string describe(const Choice& choice) {
  std::string text;
  const Space& space = scene_space();
  for (std::size_t k = 0; k < choice.size(); ++k) {
    if (choice[k] == 0 && k > 0) continue;
    text += (text.empty() ? "" : "; ") + std::string(space.axes()[k].name) + ": " + std::string(space.axes()[k].values[choice[k]]);
  }
  return text;
}

}  // namespace toile::generated
