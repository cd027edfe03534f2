// step/body_attachment.hpp: a point of the cloth that a moving body carries: a button, a strap, a glued patch.
//
//   x(t) = sum_k b_k x_k(t) + [e1 e2 n](t) l       b, l fixed at attachment; e1 along the triangle's first edge, n its normal, e2 = n x e1
// It turns with its triangle, and keeps its distance.
#pragma once
#include "contact/body_surface.hpp"

namespace toile::internal {

struct BodyAttachment {
  Index triangle = -1;
  Vec3 barycentric = Vec3::Zero();
  Vec3 local_m = Vec3::Zero();
  template <class Archive>
  void remember(Archive& archive) {
    archive(triangle, barycentric, local_m);
  }
};

// Attaches to the point of the body nearest to x, with the body at the end of its step; of equally near points the first triangle's.
BodyAttachment attach(const BodySurface& body, const Vec3& x);
// Its position at the end of the body's step.
Vec3 carried(const BodyAttachment& attachment, const BodySurface& body);

}  // namespace toile::internal
