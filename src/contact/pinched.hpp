// contact/pinched.hpp: particles pinched by a body (step/flypaper.hpp), and the pairs of them exempt from contact.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace toile::internal {

enum class Pinched : std::uint8_t { no, with_room, without_room };

// Whether all of the particles are pinched (-1: none): no contact force would move them.
template <class Particles>
bool all_pinched(const Particles& particles, std::span<const Pinched> pinched) {
  return std::all_of(particles.begin(), particles.end(),
                     [&](Index i) { return i < 0 || pinched[static_cast<std::size_t>(i)] != Pinched::no; });
}

// Whether the safe filter exempts the pair: all particles are pinched and one is without room.  They may pass through
// each other; free particles are kept out of the pinch.
template <class Particles>
bool is_exempt(const Particles& particles, std::span<const Pinched> pinched) {
  if (pinched.empty() || !all_pinched(particles, pinched)) return false;
  return std::any_of(particles.begin(), particles.end(),
                     [&](Index i) { return i >= 0 && pinched[static_cast<std::size_t>(i)] == Pinched::without_room; });
}

}  // namespace toile::internal
