// dress/dressing.hpp: puts one more garment on: its panels placed, sewn around body and outfit, and welded.
#pragma once
#include "dress/outfit.hpp"
#include "dress/sewing.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>

namespace toile::internal {

// What sewing the garment onto the outfit leads to, but for where it is: mesh, parts, fabrics, all at rest in the origin.  Returns the springs of
// the labels that hold the new garment.
LabelSprings wear(Outfit& outfit, const GarmentMesh& garment, std::span<const Fabric> fabrics,
                  std::span<const Vec2> rest_stretch, std::span<const LabelHeight> heights);

class Dressing {
 public:
  // `garment` is placed already, its panels have the fabrics and elastic of the two spans.  What the outfit has is held
  // where it is.  `body` may be null.
  Dressing(const Outfit& outfit, const GarmentMesh& garment, std::span<const Fabric> fabrics,
           std::span<const Vec2> rest_stretch, BodySurface* body, const StepOptions& step, SewingOptions options);
  Dressing(const Dressing&) = delete;
  Dressing& operator=(const Dressing&) = delete;

  // Panels that start through each other or through the outfit: their contact is switched off there, for the whole sewing.
  bool tangled() const { return tangled_; }
  Sewing& sewing() { return *sewing_; }
  const GarmentMesh& panels() const { return panels_; }  // the outfit's and the garment's
  std::string explain() const;                           // where a seam is open, and why
  // Once blocked: what is near enough is welded, and the folds that were caught between the sides of its seams are taken apart
  // (dress/untangle.hpp).  Sewing goes on from there, if less is in the way than after the last time: pairs that are open and edges that pass
  // through cloth or body, around which contact is off.  False: it stays blocked, where it was; or `stop` ended it.
  bool take_apart(std::span<const Triangle> body, std::span<const Vec3> body_x, const std::function<bool()>& stop);
  // Gives up what is still apart, before worn() of seams that are not closed: what would not close stays open.  Returns
  // Sewing::open_pairs().
  std::vector<Index> leave_open();
  // The outfit with the garment on, once the seams are closed; its particles come to rest from where sewing left them.
  Outfit worn() const { return worn(panels_); }
  // [particle of panels()] particle of worn().
  std::vector<Index> particle_of() const;
  // Springs of the labels that hold the new garment, on the particles of worn().
  LabelSprings labels() const;

  template <class Archive>
  void remember(Archive& archive) {
    archive(least_in_the_way_, *sewing_);
  }

 private:
  Outfit worn(const GarmentMesh& panels) const;
  bool switch_off_tangles(const Vec3s& x, std::vector<double>& scale) const;

  Outfit outfit_;  // worn until now, with the new garment's fabrics behind its own
  SewingOptions options_;
  GarmentMesh panels_;
  bool tangled_ = false;
  std::optional<Sewing> sewing_;
  std::size_t least_in_the_way_ =
      std::numeric_limits<std::size_t>::max();  // pairs and crossings, of all times that cloth was taken apart
};

}  // namespace toile::internal
