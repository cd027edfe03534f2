// tests/generated/number_part.cpp: the numbers of a generated scene.
#include "generated/scene_parts.hpp"

namespace toile::internal::generated {

Object NumberPart::world() const {
  Object world;
  if (is("gravity", "none")) world.set("gravity_m_per_s2", vector(0, 0, 0));
  if (is("gravity", "sideways")) world.set("gravity_m_per_s2", vector(6, -3, 0));
  if (is("gravity", "up")) world.set("gravity_m_per_s2", vector(0, 5, 0));
  if (is("wind", "breeze")) world.set("wind_m_per_s", vector(2, 0, draw_.between("wind", -2, 2)));
  if (is("wind", "gale")) world.set("wind_m_per_s", vector(draw_.between("gale", -20, 20), 3, -8));
  if (is("air", "none")) world.set("air_density_kg_per_m3", "0");
  if (is("air", "dense")) world.set("air_density_kg_per_m3", "20");
  if (variant_.defaults)
    world.set_if_absent("gravity_m_per_s2", vector(0, -9.81, 0))
        .set_if_absent("wind_m_per_s", vector(0, 0, 0))
        .set_if_absent("air_density_kg_per_m3", "1.2");
  return world;
}

Object NumberPart::time() const {
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

Object NumberPart::solver() const {
  Object solver;
  if (!is("preconditioner", "default")) solver.set("preconditioner", word(name_of("preconditioner")));
  if (is("procedure", "paper_1998")) solver.set("procedure", word("paper_1998"));
  if (is("tolerance", "tight")) solver.set("tolerance", "1e-5");
  if (is("tolerance", "loose")) solver.set("tolerance", "0.2");
  if (!is("newton", "default")) solver.set("newton_iterations", name_of("newton"));
  if (!is("relinearisations", "default")) solver.set("relinearisations", name_of("relinearisations"));
  if (is("scaling", "paper")) solver.set("paper_scaling", "true");
  if (is("jacobian", "paper")) solver.set("damping_jacobian", word("paper"));
  if (variant_.defaults) {
    const bool coarse =
        (is("preconditioner", "default") || is("preconditioner", "block_ssor_coarse")) && is("procedure", "default");
    solver.set_if_absent("preconditioner", word("auto")).set_if_absent("procedure", word("prefiltered"));
    solver.set_if_absent("tolerance", coarse ? "0.01" : "0.001").set_if_absent("newton_iterations", "1");
    solver.set_if_absent("relinearisations", "6").set_if_absent("paper_scaling", "false");
    solver.set_if_absent("damping_jacobian", word("gauss_newton"));
  }
  return solver;
}

// A fabric that no cloth of the scene has.
std::string NumberPart::other_fabric() const { return is("fabric", "wool") ? "silk" : "wool"; }

Object NumberPart::contact() const {
  Object contact;
  if (is("thickness", "0.5 mm")) contact.set("thickness_mm", "0.5");
  if (is("thickness", "6 mm")) contact.set("thickness_mm", "6");
  if (!is("friction", "default")) contact.set("friction", name_of("friction"));
  if (is("friction between", "of these")) {
    const bool named = is("fabric", "silk") || is("fabric", "wool") || is("fabric", "denim") || is("fabric", "knit");
    const std::string own = named ? name_of("fabric") : is("fabric", "limited") ? "knit" : "cotton";
    contact.set("friction_between",
                list({list({word(own), word(own), "0.25"}), list({word(own), word("cotton"), "0.5"})}));
  } else if (is("friction between", "of others") || variant_.defaults) {
    contact.set("friction_between", list({list({word(other_fabric()), word(other_fabric()), "0.3"})}));
  }
  if (is("self contact", "no")) contact.set("self_contact", "false");
  if (is("flypaper", "no")) contact.set("flypaper", "false");
  if (is("strict start", "yes") && !variant_.earlier) contact.set("strict_start", "true");
  if (variant_.defaults)
    contact.set_if_absent("self_contact", "true")
        .set_if_absent("flypaper", "true")
        .set_if_absent("strict_start", "false");
  return contact;
}

}  // namespace toile::internal::generated
