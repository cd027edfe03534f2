// preview/cloth_look.hpp: a cloth's surface as a studio photographs it: threads, thickness, sheen, gloss, hems and stitches.
//
// Threads lie along the drawing as cloth.obj has it: x to the right, y up the warp.  A pixel shows their mean over its extent, so threads finer than a
// pixel leave their mean colour and do not flicker.  Mean colours are kept: the same cloth has one colour at any distance.
#pragma once
#include "core/types.hpp"
#include "preview/print.hpp"
#include "preview/vec3f.hpp"

#include <memory>
#include <string_view>

namespace toile::internal {

enum class Weave {
  plain,
  twill,
  even_twill,  // of checks: warp over as many as under
  satin,
  knit,
  none
};  // none: leather, its right side in the colour of the warp, its flesh in that of the weft

struct ClothLook {
  Weave weave = Weave::plain;
  Vec3f warp = Vec3f::Constant(0.6f), weft = Vec3f::Constant(0.6f);  // linear RGB
  Vec3f stitch = Vec3f::Constant(0.6f);                              // of the thread along hems
  float thread_m = 3e-4f;                   // from warp thread to warp thread; in a knit from wale to wale
  float uneven = 0.03f;                     // brightness of a thread against the next, largest deviation
  float thickness_m = 4e-4f;                // of one layer
  float hem_m = 0.015f;                     // folded twice along open edges
  float sheen = 0.3f;                       // share of light that fibres standing off the cloth catch at grazing view
  float gloss = 0.0f;                       // reflectance of the surface's highlight, facing
  float roughness = 0.4f;                   // width of the highlight, rad
  std::shared_ptr<const Print> print = {};  // on threads of the colours above; none: they are seen
};

// Of a preset (material/fabric.hpp); any other name: cotton's.
ClothLook look_of(std::string_view fabric);
// In another colour: threads keep how much lighter or darker than their mean they are.
ClothLook dyed(const ClothLook& look, const Vec3f& colour);
// The same, and its right side has that mean colour: threads that would be too bright for it differ less.
ClothLook coloured(const ClothLook& look, const Vec3f& colour);

// The mean over right and wrong side alike is that of the threads which show, and of what is printed on them.
Vec3f mean_colour(const ClothLook& look, bool right_side);
// At a point of the drawing, m, averaged over `extent` m of cloth in x and y.
Vec3f thread_colour(const ClothLook& look, bool right_side, const Vec2& point, const Vec2f& extent);

// The share of the interval [x - extent/2, x + extent/2] that a line of `width` around 0 covers.
float line_cover(float x, float extent, float width);

}  // namespace toile::internal
