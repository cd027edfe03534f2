// step/collider_contact.hpp: rest offset and friction of a body, and of each collider that it is the union of.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace toile::internal {

// Values of one collider that replace the common ones.
struct ColliderContact {
  std::optional<double> offset_m, friction;
};

struct BodyContactOptions {
  double offset_m = 2.5e-3;                     // r: rest offset of cloth above a collider
  std::optional<double> friction;               // mu, kinetic; the static one is 2 % larger; absent: the cloth's own
  std::vector<ColliderContact> colliders = {};  // [BodySurface::collider]; missing values are the two above

  double offset_of(Index collider) const {
    const ColliderContact* own = find(collider);
    return own == nullptr ? offset_m : own->offset_m.value_or(offset_m);
  }
  double friction_of(Index collider, double of_cloth) const {
    const ColliderContact* own = find(collider);
    if (own != nullptr && own->friction) return *own->friction;
    return friction.value_or(of_cloth);
  }
  void set_friction(std::optional<Index> collider, double mu) {
    if (!collider) {
      friction = mu;
      return;
    }
    if (colliders.size() <= at(*collider)) colliders.resize(at(*collider) + 1);
    colliders[at(*collider)].friction = mu;
  }
  double largest_offset_m() const {
    double largest = colliders.empty() ? offset_m : 0;
    for (const ColliderContact& own : colliders) largest = std::max(largest, own.offset_m.value_or(offset_m));
    return largest;
  }
  double smallest_offset_m() const {
    double smallest = colliders.empty() ? offset_m : largest_offset_m();
    for (const ColliderContact& own : colliders) smallest = std::min(smallest, own.offset_m.value_or(offset_m));
    return smallest;
  }

  // The same without friction, and with no offset below `least_m`.
  BodyContactOptions slippery(double least_m) const {
    BodyContactOptions changed = *this;
    changed.offset_m = std::max(offset_m, least_m);
    changed.friction = 0;
    for (ColliderContact& own : changed.colliders) {
      own.friction = 0;
      if (own.offset_m) own.offset_m = std::max(*own.offset_m, least_m);
    }
    return changed;
  }

 private:
  const ColliderContact* find(Index collider) const {
    return at(collider) < colliders.size() ? &colliders[at(collider)] : nullptr;
  }
};

}  // namespace toile::internal
