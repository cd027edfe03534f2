// sim/falling.hpp: a garment that nothing holds and nothing will catch.                                     docs/reason-codes.md
//
// h is height along -g.  A garment whose particles are at h_i and rise at u_i cannot get above
//     top = max_i (h_i + u_i^2 / 2g)
// and falls from there.  Sideways it is thrown by at most v t = 2 sqrt(d v^2/2g) <= d + v^2/2g over a fall of d, v being its fastest particle's
// horizontal speed, and it may glide: by at most `most_glide` times its fall.  So a solid with the lowest point l, at the distance s beside
// the garment, is in its reach only when
//     top >= l   and   s <= most_glide (top - l) + v^2/2g
// A garment is lost when no solid is in its reach, and no garment that is not lost itself.  A solid that supports it, or hooks into it, has points
// below its top and is at the distance 0: in reach.  So is a floor that it will land on.  A moving solid is taken to be at all its future
// positions at once.
//
// Easily got wrong: this is about still air, in which cloth gains no height.  In wind, without gravity, or while a hand drags the cloth,
// nothing follows for the future; the caller must not ask.
#pragma once
#include "body/measure.hpp"
#include "dress/outfit.hpp"
#include "dress/outfit_run.hpp"
#include "garment/garment_mesh.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

// The glide ratio: trimmed paper planes reach 4 to 8, and need a shape that cloth does not keep.  A larger one is safe: a garment that is far
// beside the body is then only found later.
inline constexpr double most_glide = 4;

// The state kept from frame to frame.
struct TouchMemory {
  std::vector<std::uint8_t> touched;  // [part] has a particle of it touched the body or another solid since the weld?
  template <class Archive>
  void remember(Archive& archive) {
    archive(touched);
  }
};
void note_touches(std::span<const OutfitPart> parts, const OutfitRun& run, TouchMemory& memory);

struct LostGarment {
  Index part = 0;
  std::string where;  // in words
};

class FallWatch {
 public:
  // `moves`: where the solids will be, over `seconds`; empty: where they are.
  FallWatch(const Vec3& gravity_m_per_s2, std::span<const Triangle> solids, BodyAt moves, double seconds,
            double frame_s);

  // The first part that is lost, if any is.  `parts` have the particles of `state` in their order; `x` are the solids' vertices now.
  std::optional<LostGarment> find(std::span<const OutfitPart> parts, const ClothState& state, std::span<const Vec3> x);

 private:
  struct Box {  // in the frame of gravity; z is h
    Vec3 low, high;
  };
  struct Flight {
    Box box;  // of the particles
    double top_m = 0, throw_m = 0;
  };
  Flight flight_of(std::span<const Vec3> x, std::span<const Vec3> v) const;
  static bool in_reach(const Flight& flight, const Box& box);
  bool reaches_solids(const Flight& flight, std::span<const Vec3> x);
  Box box_of(std::span<const Vec3> x) const;
  const Box& swept(std::span<const Vec3> x);

  double g_ = 0;
  Mat3 frame_;  // rows: two directions across gravity, and up
  std::span<const Triangle> solids_;
  BodyAt moves_;
  double seconds_, frame_s_;
  std::optional<Box> swept_;  // all places of solids that move; made on first use
};

// Where a garment belongs on a person, by the labels of its edges.
struct Belonging {
  double waist_girth_m = 0;  // length of the edges that belong at the waist, as cut; 0: none do
  bool bodice = false;       // it has collars, armholes or a strapless top
};
Belonging belonging_of(const GarmentMesh& garment);

struct TrunkLevels {
  Level hips;
  double waist_m = 0;  // 0: there is none
};
TrunkLevels trunk_levels(std::span<const Vec3> person, std::span<const Triangle> triangles);

// The first garment that is not worn though the person is within it: one with a bodice that is wholly below her waist, or one with a waist that is
// wholly below her hips; or below `share` of these heights.  `belongings`: [part].
std::optional<LostGarment> slid_down(std::span<const OutfitPart> parts, std::span<const Belonging> belongings,
                                     std::span<const Vec3> cloth, const TrunkLevels& trunk, double share = 1);

}  // namespace toile::internal
