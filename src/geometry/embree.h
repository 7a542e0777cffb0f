// SPDX-License-Identifier: GPL-3.0-or-later
// Embree 3 or 4: one set of ray queries for both.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstddef>
#include <span>

#include "geometry/ray_scene.h"

namespace opaline {

static_assert(sizeof(Ray) == sizeof(RTCRay));
static_assert(offsetof(Ray, near) == offsetof(RTCRay, tnear) &&
              offsetof(Ray, direction) == offsetof(RTCRay, dir_x));
static_assert(offsetof(Ray, far) == offsetof(RTCRay, tfar) && offsetof(Ray, mask) == offsetof(RTCRay, mask));

/// First hit of each ray; fastest for coherent rays.
void find_hits(RTCScene scene, std::span<TracedRay> rays);
/// First hit of a single ray.
void find_hit(RTCScene scene, TracedRay& ray);
/// Sets far < 0 for each blocked ray.
void find_blocked(RTCScene scene, std::span<Ray> rays);

/// Called with each hit along a ray. Set valid to 0 to continue behind it.
using HitFilter = void (*)(const RTCFilterFunctionNArguments*);

/// Scene flag allowing a filter in find_hits_with.
#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
constexpr RTCSceneFlags kAllowsHitFilter = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using QueryContext = RTCIntersectContext;
constexpr RTCSceneFlags kAllowsHitFilter = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

/// Traces a ray through all hits refused by the filter. The filter's arguments point to the context, usable
/// as the first member of the caller's record.
void find_hits_with(HitFilter filter, QueryContext& context, RTCScene scene, const Ray& ray);

}  // namespace opaline
