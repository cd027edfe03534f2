// material/bend_hysteresis.hpp: bending that stays: the friction of threads, and a slow set.                   docs/theory/bend.md
//
// Beside the cloth's elastic rigidity D, which KES-F calls B, a second rigidity D_f = M_f/kappa_y resists the curvature S until threads slip at
// |S - S_f| = kappa_y; beyond, S_f follows.  A moment M_f per width, half of KES-F's 2HB, is what then lies between bending and unbending.
// A share of D turns about S_s, which follows S over a time tau (Maxwell).
//
//   M = C ((1 - s) S + s (S - S_s)) + C D_f/D (S - S_f) = (1 + D_f/D) C (S - S_0),     S_0 = r S_f + (1 - r) s S_s,   r = D_f/(D + D_f)
//
// so what is remembered acts as one curvature at rest.  D = sqrt(D_u D_v); curvature as (S_uu, S_vv, 2 S_uv), 1/m.
#pragma once
#include "core/types.hpp"
#include "material/fabric.hpp"

namespace toile::internal {

struct BendHysteresis {
  double friction_share = 0;        // r
  double slip_curvature_per_m = 1;  // kappa_y
  double set_share = 0, set_s = 1;  // s, tau
  bool any() const { return friction_share > 0 || set_share > 0; }
};

BendHysteresis bend_hysteresis(const Fabric& fabric);

// (D + D_f)/D: how much stiffer than its elastic rigidity a cloth resists a bend that is too small to make threads slip.
double friction_stiffening(const Fabric& fabric);

// What cloth remembers of its bends at one place.
struct BentCurvature {
  Vec3 slipped = Vec3::Zero(), set = Vec3::Zero();  // S_f, S_s
  Vec3 rest(const BendHysteresis& of) const {
    return of.friction_share * slipped + (1 - of.friction_share) * of.set_share * set;
  }
  // After h_s at the curvature S.
  void follow(const BendHysteresis& of, const Vec3& S, double h_s);
  template <class Archive>
  void remember(Archive& archive) {
    archive(slipped, set);
  }
};

}  // namespace toile::internal
