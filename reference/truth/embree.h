#pragma once

// The one place that knows how Embree 3 and Embree 4 differ; CMake says which one was found.
#if SHADOWBENCH_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

namespace shadowbench::truth {

#if SHADOWBENCH_EMBREE_MAJOR == 3
/// Sets `tfar` of every active ray that something blocks to minus infinity.
inline void occlude_packet(const int* active, RTCScene scene, RTCRay16* rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(active, scene, &context, rays);
}

/// Finds the nearest hit of every active ray.
inline void intersect_packet(const int* active, RTCScene scene, RTCRayHit16* rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect16(active, scene, &context, rays);
}
#else
inline void occlude_packet(const int* active, RTCScene scene, RTCRay16* rays) { rtcOccluded16(active, scene, rays); }
inline void intersect_packet(const int* active, RTCScene scene, RTCRayHit16* rays) {
  rtcIntersect16(active, scene, rays);
}
#endif

}  // namespace shadowbench::truth
