// tests/generated/cloth_part.cpp: the cloths of a generated scene.
#include "generated/scene_files.hpp"
#include "generated/scene_parts.hpp"

#include <cmath>

namespace toile::internal::generated {

std::string ClothPart::fabric() const {
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
  return word(is("fabric", "default") ? "cotton" : name_of("fabric"));
}

std::string ClothPart::ribbon(bool closed) const {
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

void ClothPart::set_shape(Object& cloth) const {
  const bool fine = is("edges", "fine");
  if (is_sewn()) {
    cloth.set("pattern", word("pattern.json"));
    if (is("edges", "counted")) {
      cloth.set("vertices", number(counted_vertices));
    } else {
      cloth.set("resolution_cm", fine ? "9" : "13");
    }
    cloth.set("hem_mm", fine ? "20" : "0").set("tape_mm", fine ? "0" : "12");
    if (!fine) cloth.set("allowance_mm", "10").set("topstitched", "true");
  } else if (is("cloth", "tube")) {
    cloth.set("tube",
              Object().set("radius_m", "0.35").set("length_m", "0.3").set("edge_m", fine ? "0.1" : "0.14").text());
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

void ClothPart::place(Object& cloth) const {
  if (is("placed", "as drawn")) {
    if (variant_.defaults)
      cloth.set("placement",
                Object().set("translation_m", vector(0, 0, 0)).set("rotation_deg", vector(0, 0, 0)).text());
    return;
  }
  Object placement;
  placement.set("translation_m", centre_.text());
  if (is("placed", "lying above")) placement.set("rotation_deg", vector(-90, 0, 0));
  if (is("placed", "turned"))
    placement.set("rotation_deg", vector(draw_.between("turn x", -180, 180), draw_.between("turn y", -180, 180),
                                         draw_.between("turn z", -180, 180)));
  cloth.set("placement", placement.text());
}

void ClothPart::set_panels(Object& cloth, const std::string& panel) const {
  Object what;
  if (is("panel", "fabric")) what.set("fabric", word(is("fabric", "denim") ? "silk" : "denim"));
  if (is("panel", "rest_stretch"))
    what.set("rest_stretch_u", "0.95").set("rest_stretch_v", number(draw_.between("rest stretch", 0.8, 1.1)));
  if (is("panel", "rest_stretch_path"))
    what.set("rest_stretch_path", list({list({"0", "1", "1"}), list({number(seconds_), "0.93", "0.97"})}));
  if (is("panel", "pressure")) what.set("pressure_Pa", number(draw_.between("pressure", -1, 3)));
  if (is("panel", "pressure_path"))
    what.set("pressure_path",
             list({list({"0", "0"}), list({number(seconds_), number(draw_.between("pumped", -1, 3))})}));
  if (variant_.defaults) {
    what.set_if_absent("fabric", fabric());
    if (!is("panel", "pressure_path")) what.set_if_absent("pressure_Pa", "0");
    what.set_if_absent("rest_stretch_u", "1").set_if_absent("rest_stretch_v", "1");
  }
  if (!what.empty()) cloth.set("panels", Object().set(panel, what.text()).text());
}

std::string ClothPart::turning_moves() const {
  const std::string begin = Object().set("t_s", "0").text();
  const std::string end = Object()
                              .set("t_s", number(seconds_))
                              .set("shift_m", vector(0.04, draw_.between("pin rises", -0.05, 0.1), 0))
                              .set("rotation_deg", vector(0, draw_.between("pin turns", -20, 20), 0))
                              .text();
  return list({begin, end});
}

void ClothPart::set_pins(Object& cloth) const {
  const std::string corner = (centre_ + Place{-0.3, 0.3, 0}).text(), other = (centre_ + Place{0.3, 0.3, 0}).text();
  // A cloth that is turned may reach no farther to this side than its middle.
  const double side = is("placed", "turned") ? 0.001 : -0.05;
  const std::string box = list({vector(-9, -9, -9), vector(centre_.x + side, 9, 9)});
  const std::string half = number(0.5 * seconds_);
  std::vector<std::string> pins;
  if (is("pins", "near")) pins = {Object().set("near_m", corner).text()};
  if (is("pins", "box")) pins = {Object().set("in_box_m", box).text()};
  if (is("pins", "path"))
    pins = {Object()
                .set("near_m", corner)
                .set("hold", word("path"))
                .set("path_m", list({list({"0", number(centre_.x - 0.28), number(centre_.y + 0.28), number(centre_.z)}),
                                     list({number(seconds_), number(centre_.x - 0.25), number(centre_.y + 0.35),
                                           number(centre_.z)})}))
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
  if (is("pins", "let go"))
    pins = {Object().set("near_m", corner).set("to_s", half).text(),
            Object().set("near_m", corner).set("from_s", half).text()};
  if (is("pins", "taken later"))
    pins = {Object().set("in_box_m", box).set("from_s", half).set("hold", word("fixed")).text()};
  if (!pins.empty() || (variant_.defaults && !is_sewn())) cloth.set("pins", list(pins));
}

void ClothPart::set_drags(Object& cloth) const {
  const Place at = centre_ + Place{0.2, -0.2, 0};
  const std::string path =
      list({list({"0", number(at.x), number(at.y), number(at.z)}),
            list({number(seconds_), number(at.x + 0.1), number(at.y), number(at.z + draw_.between("drag", 0, 0.2))})});
  Object drag;
  drag.set("near_m", at.text()).set("path_m", path);
  if (is("drags", "stiff"))
    drag.set("stiffness_N_per_m", "5000").set("damping_N_s_per_m", "0").set("max_force_N", "40");
  if (variant_.defaults)
    drag.set_if_absent("stiffness_N_per_m", "50")
        .set_if_absent("damping_N_s_per_m", "0.5")
        .set_if_absent("max_force_N", "5");
  std::vector<std::string> drags;
  if (!is("drags", "none")) drags.push_back(drag.text());
  if (is("drags", "two"))
    drags.push_back(Object()
                        .set("near_m", centre_.text())
                        .set("path_m", path)
                        .set("from_s", number(0.3 * seconds_))
                        .set("to_s", number(0.8 * seconds_))
                        .text());
  if (!drags.empty() || variant_.defaults) cloth.set("drags", list(drags));
}

std::string ClothPart::cloths() const {
  Object cloth;
  cloth.set("name", word("first"));
  set_shape(cloth);
  if (!is("fabric", "default") || variant_.defaults) cloth.set("fabric", fabric());
  if (!is_sewn()) place(cloth);
  set_panels(cloth, is_sewn() ? "front" : "first");
  set_pins(cloth);
  set_drags(cloth);
  if (is("labels", "held")) cloth.set("label_heights_m", Object().set("lower_interface", "0.9").text());
  std::vector<std::string> all = {cloth.text()};
  if (is("cloth", "two patterns"))
    all.push_back(
        Object().set("pattern", word("outer.json")).set("resolution_cm", "14").set("fabric", word("cotton")).text());
  if (is("cloth", "two shapes"))
    all.push_back(Object()
                      .set("name", word("second"))
                      .set("ribbon", ribbon(false))
                      .set("placement", Object().set("translation_m", (centre_ + Place{0, 0.05, 0.3}).text()).text())
                      .text());
  return list(all);
}

}  // namespace toile::internal::generated
