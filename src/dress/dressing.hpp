// dress/dressing.hpp: puts on one more garment: its placed panels are sewn around body and outfit, and welded.
#pragma once
#include "dress/outfit.hpp"
#include "dress/sewing.hpp"

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>

namespace toile::internal {

// The outfit after sewing the garment onto it, except positions: mesh, parts, fabrics, with all particles at rest in the origin.  Returns the
// label springs of the new garment.
LabelSprings wear(Outfit& outfit, const GarmentMesh& garment, std::span<const Fabric> fabrics,
                  std::span<const Vec2> rest_stretch, std::span<const LabelHeight> heights);

// Gives `fine`, the outfit as wear() makes it of `before` and `refined`, the positions of `worn`, in which the same garment was `sewn`; it is at rest.
// `ends`: of the particles that `refined` has beyond those of `sewn` (garment/refine.hpp).
void carry_over(const Outfit& worn, const GarmentMesh& sewn, const Outfit& before, const GarmentMesh& refined,
                std::span<const std::array<Index, 2>> ends, Outfit& fine);

class Dressing {
 public:
  // `garment` is placed already, its panels have the fabrics and elastic of the two spans.  The outfit's particles are
  // pinned.  `body` may be null.
  Dressing(const Outfit& outfit, const GarmentMesh& garment, std::span<const Fabric> fabrics,
           std::span<const Vec2> rest_stretch, BodySurface* body, const StepOptions& step, SewingOptions options);
  Dressing(const Dressing&) = delete;
  Dressing& operator=(const Dressing&) = delete;

  // Panels start through each other or through the outfit: contact is switched off there for the whole sewing.
  bool tangled() const { return tangled_; }
  Sewing& sewing() { return *sewing_; }
  const GarmentMesh& panels() const { return panels_; }  // the outfit's and the garment's
  std::string explain() const;                           // which seams are open, and why
  // Once blocked: pairs that are near enough are welded, and folds caught between the sides of seams are untangled (dress/untangle.hpp).
  // Sewing goes on from there if there are fewer obstacles than after the last call: open pairs, and edges that pass through cloth or body,
  // around which contact is off.  False: it stays blocked, at the same positions; or `stop` ended it.
  bool take_apart(std::span<const Triangle> body, std::span<const Vec3> body_x, const std::function<bool()>& stop);
  // Gives up the pairs that are still apart; required before worn() when seams are open, which then stay open.  Returns
  // Sewing::open_pairs().
  std::vector<Index> leave_open();
  // The outfit with the garment on, once the seams are closed, at the positions where sewing left it, at rest.
  Outfit worn() const { return worn(panels_); }
  // [particle of panels()] particle of worn().
  std::vector<Index> particle_of() const;
  // The label springs of the new garment, on the particles of worn().
  LabelSprings labels() const;

  template <class Archive>
  void remember(Archive& archive) {
    archive(least_in_the_way_, *sewing_);
  }

 private:
  Outfit worn(const GarmentMesh& panels) const;
  bool switch_off_tangles(const Vec3s& x, std::vector<double>& scale) const;

  Outfit outfit_;  // the garments already worn, with the new garment's fabrics after theirs
  SewingOptions options_;
  GarmentMesh panels_;
  bool tangled_ = false;
  std::optional<Sewing> sewing_;
  std::size_t least_in_the_way_ =
      std::numeric_limits<std::size_t>::max();  // open pairs and crossings, the least after any call of take_apart
};

}  // namespace toile::internal
