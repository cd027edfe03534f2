// dress/start_state.hpp: finds and untangles cloth that passes through itself or the body before the first frame.
//
// Pinned particles and the garments already worn stay in place, to the bit: pins are the user's, and the garments have come to rest.  A
// garment that is moved far from its given place is reported (`moved_by_untangling`, docs/reason-codes.md).
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

// Particles pinned from the start on, ascending.
std::vector<Index> held_from_the_start(const Events& events);

struct UntangledStart {
  int trials = 0;
  double largest_move_mm = 0;
  std::string
      moved_far;  // garments that were moved by more than `most_edges_moved` of their edges, and the distance; empty: none
};
inline constexpr double most_edges_moved = 3;  // mean edges of the garment as it is cut

// Moves the outfit's particles (dress/untangle.hpp) except `held`.  An open body has no inside: then only the cloth is untangled from itself.
// It gives up after `most_in_vain` trials without progress; 0: at the limit of trials.
// `stop` ends it.
UntangledStart untangle_start(Outfit& outfit, std::span<const Triangle> body, std::span<const Vec3> body_x,
                              std::vector<Index> held, const std::function<bool()>& stop, int most_in_vain = 0);
// `most_in_vain` after a sewing: crossings that remain then are resolved as the body grows, or never.
inline constexpr int sewn_in_vain = 60;

}  // namespace toile::internal
