// preview/embree.hpp: Embree 3 and 4 under one name.  TOILE_EMBREE is the major version that the build found.
#pragma once
#if TOILE_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace toile::internal {

#if TOILE_EMBREE >= 4
inline void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, nullptr); }
inline void occlude(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, nullptr); }
#else
inline void intersect(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}
inline void occlude(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}
#endif

}  // namespace toile::internal
