// contact/pinched.hpp: what is held between two parts of a body (step/flypaper.hpp), and which pairs of it are let be.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace toile::internal {

enum class Pinched : std::uint8_t { no, with_room, without_room };

// All of the particles are held, -1 for none: nothing that acts on them would move them.
template <class Particles>
bool all_pinched(const Particles& particles, std::span<const Pinched> pinched) {
  return std::all_of(particles.begin(), particles.end(),
                     [&](Index i) { return i < 0 || pinched[static_cast<std::size_t>(i)] != Pinched::no; });
}

// Likewise, and one of them without room: they may pass through each other.  What is free is kept out of what is held.
template <class Particles>
bool is_let_be(const Particles& particles, std::span<const Pinched> pinched) {
  if (pinched.empty() || !all_pinched(particles, pinched)) return false;
  return std::any_of(particles.begin(), particles.end(),
                     [&](Index i) { return i >= 0 && pinched[static_cast<std::size_t>(i)] == Pinched::without_room; });
}

}  // namespace toile::internal
