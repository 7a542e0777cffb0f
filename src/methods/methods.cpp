// SPDX-License-Identifier: GPL-3.0-or-later
// The one list of methods.
#include <array>

#include "bodies/surface_textures.h"
#include "methods/automatic/automatic_method.h"
#include "methods/direct/direct_method.h"
#include "methods/hierarchical/hierarchical_method.h"
#include "methods/image_space/image_space_method.h"
#include "methods/lambert/lambert_method.h"
#include "methods/preintegrated/preintegrated_method.h"
#include "methods/volume/volume_method.h"
#include "methods/volume_diffusion/volume_diffusion_method.h"

namespace opaline {

const SubsurfaceMethod& method_of(Method method) {
  static const HierarchicalMethod hierarchical;
  static const LambertMethod lambert;
  static const DirectMethod direct;
  static const VolumeMethod volume;
  static const VolumeDiffusionMethod volume_diffusion;
  static const AutomaticMethod automatic;
  static const PreintegratedMethod preintegrated;
  static const ImageSpaceMethod image_space;
  // In the order of the enumeration.
  static const auto kAll =
      std::to_array<const SubsurfaceMethod*>({&hierarchical, &lambert, &direct, &volume, &volume_diffusion,
                                              &automatic, &preintegrated, &image_space});
  static_assert(std::tuple_size_v<decltype(kAll)> == kMethodNames.size());
  return *kAll[std::size_t(method)];
}

bool follows_textures_inside(Method method, bool is_closed) {
  return method_of(method).follows_textures_inside(is_closed);
}

std::vector<RgbF> radiant_exitance(const Body& body, const World& world, std::span<const Vec3d> points,
                                   std::span<const Vec3f> normals, const Settings& settings) {
  std::vector<Query> queries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    queries[i] = {Vec3f(into_world(world, points[i])), normals[i]};
  return method_of(body.plan.method).exitance_at(body, queries, settings);
}

}  // namespace opaline
