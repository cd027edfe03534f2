// dress/start_state.hpp: cloth that passes through itself or the body before the first frame, and how it is taken apart.
//
// What is held stays where it is, to the bit: a pin's place is the user's word, and what is worn already has come to rest.  A garment that is
// moved far is not where its maker put it, which is told (`moved_by_untangling`, docs/reason-codes.md).
#pragma once
#include "dress/outfit.hpp"
#include "dress/outfit_run.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

struct StartCrossings {  // edges
  int cloth_cloth = 0, cloth_body = 0;
  int all() const { return cloth_cloth + cloth_body; }
};
// `body` may be empty.
StartCrossings start_crossings(const Outfit& outfit, std::span<const Triangle> body, std::span<const Vec3> body_x);

// Particles that a pin holds from the first moment on, ascending.
std::vector<Index> held_from_the_start(const Events& events);

struct UntangledStart {
  int trials = 0;
  double largest_move_mm = 0;
  std::string
      moved_far;  // garments that were moved by more than `most_edges_moved` of their edges, and how far; empty: none
};
inline constexpr double most_edges_moved = 3;  // mean edges of the garment as it is cut

// Moves the outfit's particles (dress/untangle.hpp) but for those that are held.  Of a body that is not closed inside and outside are not
// known: then the cloth alone is untangled.  It gives up after `most_in_vain` trials without progress; 0: when there have been enough.
// `stop` ends it.
UntangledStart untangle_start(Outfit& outfit, std::span<const Triangle> body, std::span<const Vec3> body_x,
                              std::vector<Index> held, const std::function<bool()>& stop, int most_in_vain = 0);
// Of what sewing leaves: what has not come apart by then comes apart as the body grows, or not at all.
inline constexpr int sewn_in_vain = 60;

}  // namespace toile::internal
