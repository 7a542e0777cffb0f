// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/sample_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/surface_patch.h"
#include "methods/hierarchical/near_field/crease_error.h"
#include "methods/hierarchical/near_field/selection_bias.h"
#include "render/fields/make_fields.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

bool needs_irradiance(const HierarchicalState& state) {
  return state.cache() != nullptr ? state.cache()->needs_irradiance() : state.kernel().needs_irradiance();
}

bool leaves_some_to_points(const SurfaceCache& cache) {
  return std::ranges::any_of(cache.patches, [](const SurfaceCache::Patch& patch) {
    return patch.lattice == SurfaceCache::kLeftToPoints;
  });
}

SurfaceHits chosen_hits(const SurfaceHits& hits, std::span<const std::uint32_t> chosen) {
  SurfaceHits some;
  for (const std::uint32_t i : chosen) {
    some.points.push_back(hits.points[i]);
    some.hits.push_back(hits.hits[i]);
    some.keys.push_back(hits.keys[i]);
    some.rays.push_back(hits.rays[i]);
    if (!hits.textures.empty()) some.textures.push_back(hits.textures[i]);
  }
  return some;
}

// Nothing where the field does not know the values.
template <class T>
void put(const std::vector<T>& values, std::span<const std::uint32_t> places, std::size_t count,
         std::vector<T>& all) {
  if (values.empty()) return;
  all.resize(count);
  for (std::size_t i = 0; i < places.size(); ++i) all[places[i]] = values[i];
}

RgbF crease_deviation(const RenderInput& input, const Body& group) {
  const HierarchicalState& state = hierarchical_state(group);
  const Vec3f eye(into_world(input.world, input.scene.camera.position));
  const std::array<float, 3> error = crease_error(
      {state.octree(), state.kernel(), group.profile, eye, input.scene.settings.laboratory.instruction_set});
  return RgbF{error[0], error[1], error[2]} * std::sqrt(float(std::numbers::pi) / 2);
}

RgbF in_quadrature(const RgbF& a, const RgbF& b) {
  return {std::hypot(a.x, b.x), std::hypot(a.y, b.y), std::hypot(a.z, b.z)};
}

/// Null: images cache nothing.
std::shared_ptr<IrradianceLattice>* held_lattice(const RenderInput& input, const Body& group) {
  if (input.view == nullptr) return nullptr;
  input.view->lattices.resize(input.groups.size());
  return &input.view->lattices[std::size_t(&group - input.groups.data())];
}

}  // namespace

SampleField::SampleField(const RenderInput& input, const Body& group)
    : input_(input),
      group_(group),
      state_(hierarchical_state(group)),
      is_noisy_(has_area_lights(input.scene)),
      asks_irradiance_(needs_irradiance(state_)),
      creases_(crease_deviation(input, group)) {
  if (asks_irradiance_ || (state_.cache() != nullptr && leaves_some_to_points(*state_.cache())))
    near_field_.emplace(group, light_samples_of_ray(input.scene), held_lattice(input, group));
  if (near_field_ && has_maps(input.scene, group.plan.meshes)) maps_.emplace(input.scene, input.world);
}

LeavingLight SampleField::at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                             HeldView::Surface* held) const {
  const bool looks_near = near_field_ && pass.is_seen;
  if (state_.cache() == nullptr || asks_irradiance_) return at_points(hits, lighting, looks_near, held);
  LeavingLight light;
  put_exitance(looked_up(hits, {}), light);
  if (looks_near) replace_left(hits, lighting, light);
  return light;
}

// Evaluates the points not covered by the surface cache.
void SampleField::replace_left(const SurfaceHits& hits, const PointIrradianceInput& lighting,
                               LeavingLight& light) const {
  std::vector<std::uint32_t> left;
  const std::size_t count = hits.hits.size();
  for (std::uint32_t i = 0; i < count; ++i) {
    const Hit& hit = hits.hits[i];
    if (state_.cache()->is_left_to_points(hit.mesh, hit.triangle, hit.u, hit.v)) left.push_back(i);
  }
  if (left.empty()) return;
  const SurfaceHits some = chosen_hits(hits, left);
  PointIrradianceInput some_lighting = lighting;
  some_lighting.points = some.points;
  some_lighting.keys = some.keys;
  const LeavingLight found = at_points(some, some_lighting, true, nullptr);
  put(found.exitance, left, count, light.exitance);
  put(found.irradiance, left, count, light.irradiance);
  put(found.error, left, count, light.error);
  put(found.noise, left, count, light.noise);
  put(found.bias, left, count, light.bias);
}

LeavingLight SampleField::at_points(const SurfaceHits& hits, PointIrradianceInput lighting, bool looks_near,
                                    HeldView::Surface* held) const {
  LeavingLight light;
  if (looks_near) {
    light.noise.resize(hits.points.size());
    if (is_noisy_) lighting.variance = light.noise;
    light.irradiance = irradiance_at_hits(lighting, input_.scene.film.samples_per_pixel, held);
    lighting.variance = {};
    tint_entering(hits.textures, light.irradiance, light.noise);
  }
  std::vector<Exitance> exitance =
      state_.cache() != nullptr && asks_irradiance_
          ? looked_up(hits, light.irradiance)
          : summed(hits, light.irradiance, held != nullptr ? &held->packets : nullptr);
  // Beside edges of a tint, the samples' irradiance differs from the point's own without a shadow edge.
  if (looks_near && group_.entering.empty()) {
    if (maps_) lighting.bend = [this](SurfacePoint& point) { return maps_->bend(point); };
    refine_near_field(lighting, exitance, light);
  }
  put_exitance(exitance, light);
  return light;
}

// With the irradiance, unless it was traced at the hits.
void SampleField::put_exitance(std::span<const Exitance> exitance, LeavingLight& light) const {
  const bool is_traced = !light.irradiance.empty();
  for (std::vector<RgbF>* values : {&light.exitance, &light.error, &light.irradiance})
    values->reserve(exitance.size());
  for (const Exitance& e : exitance) {
    light.exitance.push_back(e.exitance);
    light.error.push_back(in_quadrature(e.error, e.exitance * creases_));
    if (!is_traced) light.irradiance.push_back(e.irradiance);
  }
}

std::vector<Exitance> SampleField::summed(const SurfaceHits& hits, std::span<const RgbF> irradiance,
                                          QueryPackets* packets) const {
  std::vector<Query> queries;
  queries.reserve(hits.points.size());
  for (const SurfacePoint& point : hits.points) queries.push_back({point.position, point.normal});
  const Settings& settings = input_.scene.settings;
  return evaluate({state_.octree(), state_.kernel(), queries, irradiance, settings.evaluator,
                   settings.tolerance, settings.laboratory.max_solid_angle,
                   settings.laboratory.instruction_set, state_.cloud, nullptr, packets});
}

std::vector<Exitance> SampleField::looked_up(const SurfaceHits& hits,
                                             std::span<const RgbF> irradiance) const {
  std::vector<Exitance> exitance;
  exitance.reserve(hits.hits.size());
  for (std::size_t i = 0; i < hits.hits.size(); ++i) {
    const Hit& hit = hits.hits[i];
    exitance.push_back(state_.cache()->at(hit.mesh, hit.triangle, hit.u, hit.v,
                                          irradiance.empty() ? nullptr : &irradiance[i]));
  }
  return exitance;
}

// Replaces the irradiance at the hit: it is noisy, and beside a shadow edge not the near field's.
void SampleField::refine_near_field(const PointIrradianceInput& lighting, std::vector<Exitance>& exitance,
                                    LeavingLight& light) const {
  const auto& share = state_.kernel().own_irradiance;
  for (std::size_t i = 0; i < light.noise.size(); ++i) {
    const Rgb own(own_part(share, exitance[i], RgbF(1)));
    light.noise[i] = light.noise[i] * own * own;
  }
  const std::vector<Rgb> noise = light.noise;
  const std::vector<std::uint32_t> refined =
      near_field_->refine(lighting, light.irradiance, exitance, light.noise);
  if (is_noisy_ && !refined.empty())
    light.bias = selection_bias({share, light.irradiance, exitance, noise, refined});
}

}  // namespace opaline
