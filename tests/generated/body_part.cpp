// tests/generated/body_part.cpp: what the cloth of a generated scene collides with.
#include "generated/scene_parts.hpp"

#include <array>

namespace toile::internal::generated {

Object BodyPart::body() const {
  Object body;
  if (is_person()) body.set("mannequin", word(std::array{"woman", "dancer", "man"}[draw_.bits("mannequin") % 3]));
  if (has_mesh_body()) body.set("mesh", word("body.obj"));
  if (is("body", "mesh in cm")) body.set("unit", word("cm"));
  if (is("body", "cylinder"))
    body.set("cylinder",
             Object().set("radius_m", "0.18").set("height_m", "1.2").set("top_m", vector(0, 1.2, 0)).text());
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
  if (!is("body friction", "default")) body.set("friction", name_of("body friction"));
  if (is("offset", "4 mm")) body.set("offset_mm", "4");
  if (variant_.defaults && is("body", "none") && is("solid", "none")) body.set("friction", "0.7").set("offset_mm", "5");
  return body;
}

Object BodyPart::solid_of(std::string_view kind) const {
  Object solid;
  const bool room = is("solid place", "room");
  if (kind == "sphere")
    solid.set("sphere", Object().set("radius_m", room ? "5" : number(draw_.between("radius", 0.1, 0.2))).text());
  if (kind == "box")
    solid.set("box",
              Object().set("size_m", room ? "[9, 8, 7]" : vector(0.3, draw_.between("box", 0.1, 0.3), 0.4)).text());
  if (kind == "revolved") {
    const double r = room ? 4 : draw_.between("radius", 0.1, 0.2);
    // A drum, or a ring beside the axis.
    if (room || draw_.whole("drum", 0, 1) == 1) {
      solid.set("revolved", Object()
                                .set("profile_m", list({list({"0", number(-r)}), list({number(r), number(-r)}),
                                                        list({number(r), number(r)}), list({"0", number(r)})}))
                                .text());
    } else {
      solid.set("revolved", Object()
                                .set("profile_m", list({list({number(r), "0"}), list({number(r + 0.1), "0.05"}),
                                                        list({number(r), "0.1"})}))
                                .text());
    }
  }
  if (kind == "mesh") solid.set("mesh", word("solid.obj"));
  if (kind == "sphere" || kind == "revolved") solid.set("edge_m", room ? "1.5" : "0.12");
  if (room) solid.set("inside_out", "true");
  if (variant_.defaults) solid.set_if_absent("inside_out", "false");
  return solid;
}

void BodyPart::set_moves(Object& solid) const {
  if (is("solid moves", "no")) return;
  const bool room = is("solid place", "room");
  Object begin, end;
  begin.set("t_s", is("solid moves", "later") ? number(0.5 * seconds_) : "0");
  end.set("t_s", number(seconds_));
  if (is("solid moves", "shifts") || is("solid moves", "later"))
    end.set("shift_m", vector(draw_.between("shift x", -0.1, 0.1), draw_.between("shift y", -0.05, 0.1), 0.03));
  if (is("solid moves", "turns"))
    end.set("rotation_deg", room ? vector(2, 5, 0) : vector(20, draw_.between("turns", -90, 90), 0));
  if (is("solid moves", "grows")) end.set("scale", room ? "1.03" : number(draw_.between("scale", 0.8, 1.2)));
  solid.set("moves", list({begin.text(), end.text()}));
}

std::vector<std::string> BodyPart::solids() const {
  std::vector<std::string> all;
  Place at = centre_ + Place{0, -0.5, 0};
  if (is("solid place", "beside")) at = centre_ + Place{0.75, 0, 0};
  if (is("solid place", "far")) at = {50, 3, -20};
  if (is("solid place", "room")) at = {0, 1, 0};
  if (!is("solid", "none")) {
    Object solid = solid_of(is("solid", "two") ? "sphere" : name_of("solid"));
    solid.set("placement", Object().set("translation_m", at.text()).text());
    set_moves(solid);
    all.push_back(solid.text());
  }
  if (is("solid", "two")) {
    Object box;
    box.set("box", Object().set("size_m", vector(0.2, 0.2, 0.2)).text());
    box.set("placement", Object()
                             .set("translation_m", (centre_ + Place{-0.8, -0.1, 0}).text())
                             .set("rotation_deg", vector(0, 30, 10))
                             .text());
    all.push_back(box.text());
  }
  if (variant_.far_solid) {
    Object box;
    box.set("box", Object().set("size_m", vector(1, 2, 1)).text());
    box.set("placement", Object().set("translation_m", vector(-50, 2, 10)).text());
    if (variant_.far_moves)
      box.set("moves", list({Object().set("t_s", "0").text(),
                             Object().set("t_s", "0.05").set("shift_m", vector(0, 0.1, 0)).text()}));
    all.push_back(box.text());
  }
  return all;
}

}  // namespace toile::internal::generated
