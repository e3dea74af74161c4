#pragma once

// The one place that knows how Embree 3 and Embree 4 differ; CMake says which one was found.
#if SHADOWBENCH_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
using EmbreeContext = RTCIntersectContext;
#else
#include <embree4/rtcore.h>
using EmbreeContext = RTCRayQueryContext;
#endif

namespace shadowbench::truth {

class Dimming;

/// What filter functions get beside the rays.
struct OcclusionContext : EmbreeContext {
  Dimming* dimming;
};

#if SHADOWBENCH_EMBREE_MAJOR == 3
/// Sets `tfar` of every active ray that something blocks to minus infinity. Filter functions find `dimming` in their
/// context. The rays of a packet visit the same parts of the scene: Embree is told so, and blocks the same rays; but it
/// would report hits of surfaces that dim in any order and as often as it likes, so not where there are any.
inline void occlude_packet(const int* active, RTCScene scene, RTCRay16* rays, Dimming* dimming = nullptr) {
  OcclusionContext context;
  rtcInitIntersectContext(&context);
  if (!dimming) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.dimming = dimming;
  rtcOccluded16(active, scene, &context, rays);
}

/// Finds the nearest hit of every active ray.
inline void intersect_packet(const int* active, RTCScene scene, RTCRayHit16* rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect16(active, scene, &context, rays);
}
#else
inline void occlude_packet(const int* active, RTCScene scene, RTCRay16* rays, Dimming* dimming = nullptr) {
  OcclusionContext context;
  rtcInitRayQueryContext(&context);
  context.dimming = dimming;
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  if (!dimming) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context;
  rtcOccluded16(active, scene, rays, &arguments);
}
inline void intersect_packet(const int* active, RTCScene scene, RTCRayHit16* rays) {
  rtcIntersect16(active, scene, rays);
}
#endif

}  // namespace shadowbench::truth
