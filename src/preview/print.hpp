// preview/print.hpp: the colours of patterned cloth, by its pattern coordinates: stripes, checks, dots, pictures.
//
//   stripes   bands of a sett side by side along x, which run up the warp: the colours of all threads there
//   check     the same sett across: its bands along x are those of the warp threads, along y those of the weft
//   dots      discs at the corners of a square grid
//   picture   repeats of a texture, its lower left corner at the origin
//
// x points to the right in the drawing and y up the warp, in metres; both are turned by `turn`, counter-clockwise, around the origin, which is then
// moved by `offset`.  A pixel shows the mean light over its extent in x and in y: what is finer than a pixel leaves its mean colour and does not
// flicker.
//
// Mind: every panel has its own origin, that of its drawing: a pattern is cut by a seam and meets the other side by chance.
#pragma once
#include "core/types.hpp"
#include "preview/texture.hpp"
#include "preview/vec3f.hpp"

#include <variant>
#include <vector>

namespace toile::internal {

// No cloth reflects more: bleached cotton.
constexpr float whitest = 0.9f;

struct Band {
  Vec3f colour;  // linear RGB
  double width_m;
};

// Bands that repeat, the first from 0 on.
class Sett {
 public:
  // At least one band; widths above 0.
  explicit Sett(std::vector<Band> bands);
  // Over [x - extent/2, x + extent/2].
  Vec3f mean_over(double x, double extent_m) const;
  Vec3f mean() const;
  // Of two bands as wide as the mean one.
  double fine_m() const { return 2 * repeat_m_ / static_cast<double>(bands_.size()); }

 private:
  using Sum = Eigen::Vector3d;
  Sum integral(double x) const;  // from 0

  std::vector<Band> bands_;
  double repeat_m_ = 0;
  Sum whole_ = Sum::Zero();  // over one repeat
};

struct Stripes {
  Sett sett;
};
struct Check {
  Sett sett;
};
struct Dots {
  Vec3f colour;
  double diameter_m = 0.005, spacing_m = 0.02;  // diameter <= spacing
};
struct Picture {
  Texture texture;
  Vec2 repeat_m{0.1, 0.1};
};

// Of the threads at a place: colours, weighted by `cover`, the share of the ground that they hide.
struct Dye {
  Vec3f warp = Vec3f::Zero(), weft = Vec3f::Zero();
  float cover = 0;
};

struct Print {
  std::variant<Stripes, Check, Dots, Picture> pattern;
  Vec2 offset_m{0, 0};
  double turn_rad = 0;
  // The share that the wrong side shows: 1 where the threads are dyed, less where the right side is printed.
  float through = 1;

  // The threads have these colours themselves: they are not printed over.
  bool is_woven() const { return std::holds_alternative<Check>(pattern); }
  Dye at(const Vec2& point, const Vec2f& extent) const;
  Dye mean() const;
};

}  // namespace toile::internal
