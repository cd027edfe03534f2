#include "generated/scene_space.hpp"

namespace toile::internal::generated {

const Space& scene_space() {
  static const Space space(
      {
          {"cloth", {"grid", "tube", "ribbon", "closed ribbon", "two shapes", "pattern", "two patterns"}},
          {"edges", {"coarse", "fine", "counted"}},
          {"drawing", {"plain", "fold", "elastic", "pressed seam"}},
          {"placed", {"in front", "lying above", "turned", "as drawn", "through", "around the body"}},
          {"labels", {"free", "held"}},
          {"fabric", {"default", "silk", "wool", "denim", "knit", "numbers", "limited", "bare"}},
          {"panel", {"none", "fabric", "rest_stretch", "rest_stretch_path", "pressure", "pressure_path"}},
          {"pins", {"none", "near", "box", "path", "moves", "box moves", "let go", "taken later"}},
          {"drags", {"none", "one", "stiff", "two"}},
          {"body", {"none", "mannequin", "mesh", "mesh in cm", "cylinder"}},
          {"motion", {"none", "of its own", "pc2", "obj files"}},
          {"lead-in", {"default", "none", "short"}},
          {"body friction", {"default", "0", "0.6"}},
          {"offset", {"default", "4 mm"}},
          {"solid", {"none", "sphere", "box", "revolved", "mesh", "two"}},
          {"solid moves", {"no", "shifts", "turns", "grows", "later"}},
          {"solid place", {"under", "beside", "far", "room"}},
          {"wind", {"none", "breeze", "gale"}},
          {"air", {"default", "none", "dense"}},
          {"gravity", {"default", "none", "sideways", "up"}},
          {"fps", {"30", "24", "60", "10"}},
          {"seconds", {"few frames", "more frames", "whole motion"}},
          {"drape", {"default", "none", "few frames"}},
          {"until still", {"default", "yes", "no"}},
          {"step", {"default", "short", "long"}},
          {"integrator", {"default", "bdf2"}},
          {"preconditioner", {"default", "diagonal", "block_jacobi", "block_ssor", "block_ssor_coarse"}},
          {"procedure", {"default", "paper_1998"}},
          {"tolerance", {"default", "tight", "loose"}},
          {"newton", {"default", "2", "3"}},
          {"relinearisations", {"default", "0", "1", "10"}},
          {"scaling", {"default", "paper"}},
          {"jacobian", {"default", "paper"}},
          {"thickness", {"default", "0.5 mm", "6 mm"}},
          {"friction", {"default", "0", "0.9"}},
          {"friction between", {"none", "of these", "of others"}},
          {"self contact", {"yes", "no"}},
          {"flypaper", {"yes", "no"}},
          {"strict start", {"no", "yes"}},
          {"start", {"none", "earlier run"}},
      },
      {
          // What is sewn is not pinned yet, and has no edge length of its own shape; the rest is only of patterns.
          {"cloth",
           {"pattern", "two patterns"},
           "pins",
           {"near", "box", "path", "moves", "box moves", "let go", "taken later"}},
          {"cloth", {"grid", "tube", "ribbon", "closed ribbon", "two shapes"}, "edges", {"counted"}},
          {"cloth",
           {"grid", "tube", "ribbon", "closed ribbon", "two shapes"},
           "drawing",
           {"fold", "elastic", "pressed seam"}},
          {"cloth", {"grid", "tube", "ribbon", "closed ribbon", "two shapes"}, "labels", {"held"}},
          // Panels are drawn around the body.
          {"cloth",
           {"pattern", "two patterns"},
           "placed",
           {"in front", "lying above", "turned", "as drawn", "through"}},
          {"cloth", {"grid", "ribbon", "two shapes"}, "placed", {"around the body"}},
          // Who moves how.
          {"body", {"none", "cylinder"}, "motion", {"of its own", "pc2", "obj files"}},
          {"body", {"mesh", "mesh in cm"}, "motion", {"of its own"}},
          {"body", {"mannequin"}, "motion", {"pc2", "obj files"}},
          {"motion", {"none"}, "lead-in", {"none", "short"}},
          {"motion", {"none", "of its own"}, "seconds", {"whole motion"}},
          {"body", {"none"}, "body friction", {"0", "0.6"}},
          {"body", {"none"}, "offset", {"4 mm"}},
          {"lead-in", {"default"}, "seconds", {"whole motion"}},  // a second of it, by itself
          {"solid", {"none"}, "solid moves", {"shifts", "turns", "grows", "later"}},
          {"solid", {"none"}, "solid place", {"beside", "far", "room"}},
          // Ten seconds of drape are not short.
          {"motion", {"of its own", "pc2", "obj files"}, "drape", {"default"}},
          {"solid moves", {"shifts", "turns", "grows", "later"}, "drape", {"default"}},
          {"cloth", {"two patterns"}, "drape", {"default"}},
          // A refusal is no run.
          {"strict start", {"yes"}, "placed", {"as drawn", "through"}},
      });
  return space;
}

}  // namespace toile::internal::generated
