// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/image_space/image_space_method.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bodies/surface_textures.h"
#include "exitance/evaluate.h"
#include "input/settings_table.h"
#include "lights/light.h"
#include "methods/hierarchical/hierarchical_state.h"
#include "methods/image_space/light_views.h"
#include "render/fields/make_fields.h"
#include "scene/scene_properties.h"
#include "subsurface/plan_samples.h"

namespace opaline {
namespace {

constexpr std::uint64_t kVersion = 2;
constexpr double kLeastTolerance = .02;  // a finer sum changes the error by less than 0.01 %
constexpr double kSpacing = 1.1;         // pixels over samples; pays for the rays of oblique pixels
constexpr double kBytesOfSample = 300;   // while the tree is built; bench_plan

struct ImageSpaceState : MethodState {
  static constexpr Method kMethod = Method::image_space;
  struct Lit {
    Octree tree;
    SplitKernel kernel;
  };
  StageResult<Lit> lit;
};

class ImageSpaceField : public Field {
 public:
  ImageSpaceField(const RenderInput& input, const Body& body)
      : input_(input),
        boundary_(body.boundary),
        total_(body.profile.total),
        lit_(state_of<ImageSpaceState>(body).lit.value) {
    if (has_maps(input.scene, body.plan.meshes)) maps_.emplace(input.scene, input.world);
  }

  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  OuterBoundary boundary() const override { return boundary_; }
  bool asks_irradiance() const override { return true; }
  bool reflects() const override { return true; }

 private:
  std::vector<RgbF> by_blurred_normals(const SurfaceHits& hits, PointIrradianceInput lighting,
                                       int samples) const;

  const RenderInput& input_;
  std::optional<SurfaceTextures> maps_;  // none: the body has no maps of normals and heights
  OuterBoundary boundary_;
  RgbF total_;
  const ImageSpaceState::Lit& lit_;
};

// Irradiance at the hits with maps filtered over the near field, as at samples. Held light has the normals of the pixels.
std::vector<RgbF> ImageSpaceField::by_blurred_normals(const SurfaceHits& hits, PointIrradianceInput lighting,
                                                      int samples) const {
  constexpr float kWidth = .4f;  // times the radius of the near field: the spacing of the samples
  std::vector<SurfacePoint> points(lighting.points.begin(), lighting.points.end());
  std::vector<float> factors(points.size(), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!hits.textures[i].is_bent) continue;
    const Hit& hit = hits.hits[i];
    points[i].normal = input_.rays.surface_point(hit.mesh, hit.triangle, hit.u, hit.v).normal;
    points[i].width = kWidth * lit_.kernel.radius;
    factors[i] = maps_->bend(points[i]);
  }
  lighting.points = points;
  std::vector<RgbF> irradiance = irradiance_at_hits(lighting, samples, nullptr);
  for (std::size_t i = 0; i < irradiance.size(); ++i) irradiance[i] *= factors[i];
  return irradiance;
}

// The near field has the irradiance of the hit itself: views from the lights have no points in shadow, so
// their mean around a hit would be too bright there.
LeavingLight ImageSpaceField::at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                                 HeldView::Surface* held) const {
  const std::span<const RgbF> bounced = lighting.bounced;
  lighting.bounced = {};
  LeavingLight light;
  if (lit_.kernel.needs_irradiance()) {
    const int samples = pass.is_seen ? input_.scene.film.samples_per_pixel : 1;
    light.irradiance =
        maps_ ? by_blurred_normals(hits, lighting, samples) : irradiance_at_hits(lighting, samples, held);
    tint_entering(hits.textures, light.irradiance, {});
  }
  std::vector<Query> queries;
  queries.reserve(hits.points.size());
  for (const SurfacePoint& point : hits.points) queries.push_back({point.position, point.normal});
  const Settings& settings = input_.scene.settings;
  const std::vector<Exitance> found = evaluate({.octree = lit_.tree,
                                                .kernel = lit_.kernel,
                                                .queries = queries,
                                                .irradiance = light.irradiance,
                                                .tolerance = std::max(kLeastTolerance, settings.tolerance),
                                                .instruction_set = settings.laboratory.instruction_set,
                                                .packets = held != nullptr ? &held->packets : nullptr});
  const bool is_traced = !light.irradiance.empty();
  for (std::size_t i = 0; i < found.size(); ++i) {
    light.exitance.push_back(found[i].exitance);
    if (!is_traced) light.irradiance.push_back(found[i].irradiance);
    if (bounced.empty()) continue;
    const RgbF entering = hits.textures.empty() ? bounced[i] : bounced[i] * hits.textures[i].tint.entering;
    light.exitance[i] += total_ * entering;
    light.irradiance[i] += entering;
  }
  return light;
}

StageKey lit_key(const BodyStages& stages, double spacing) {
  const auto& [scene, world, rays, plan, monitor] = stages.input;
  const Medium& medium = scene.media[stages.body.plan.medium];
  KeyBuilder key("light views", kVersion);
  add_profile(key, medium);
  add_fuzz(key, scene, world, medium.fuzz, stages.body.plan.meshes);
  key.add(spacing).add(world.diagonal).add(world.unit);
  key.add(settings_in_key(KeyedStage::transfers, scene)).add(settings_in_key(KeyedStage::kernel, scene));
  add_maps(key, scene, world, stages.body.plan.meshes);
  for (const MeshKeys& mesh : stages.mesh_keys) key.add(mesh.all);
  for (const std::uint32_t mesh : stages.body.plan.meshes) key.add(mesh);
  for (const Light& light : scene.lights) {
    const Light moved = light_in_world(scene, world, light);
    key.add(view_light_key(moved)).add(light_seed(0, moved)).add(emission(moved));
  }
  return key.add(tint_key(scene, world, stages.body.plan.meshes, {})).key();
}

}  // namespace

void ImageSpaceMethod::plan(const PlanningInput& input, BodyPlan& body,
                            std::vector<std::string>& warnings) const {
  choose_samples(input.scene, input.fewest_samples, body, warnings);
}

BodyMemory ImageSpaceMethod::memory(const PlanningInput& input, const BodyPlan& body) const {
  BodyMemory memory{.evaluated_samples = body.samples};
  memory.kept = std::size_t(kBytesOfSample * double(body.samples * input.lights.size()));
  const Bounds box = bounds(input.world, body.meshes);
  const Vec3d size = box.high - box.low;
  const double spacing = body.spacing / input.world.unit,
               pixels = 3 * (size.x * size.y + size.y * size.z + size.z * size.x) / (spacing * spacing);
  memory.temporary = 1.5 * std::min(double(kMostPixelsOfView), pixels) * double(sizeof(Ray) + sizeof(float));
  return memory;
}

double ImageSpaceMethod::seconds(const Scene&, const BodyPlan& body, const Lighting& lighting) const {
  constexpr double kSample = 2e-6;  // a ray, and a point of the tree
  return kSample * double(body.samples) * double(lighting.lights);
}

double ImageSpaceMethod::seconds_of_pixel(const Scene&, const Lighting& lighting) const {
  constexpr double kEvaluation = 1e-6;
  return kEvaluation + kSecondsOfShadowRay * lighting.rays;
}

void ImageSpaceMethod::prepare(BodyStages& stages) const {
  const Body& body = stages.body;
  auto& state = state_of<ImageSpaceState>(stages.body);
  const World& world = stages.input.world;
  const double spacing = body.plan.spacing / world.unit;
  const ResultSource source = stages.store.get(state.lit, lit_key(stages, spacing), [&] {
    std::vector<FluxSample> points = seen_from_lights(stages.input, body, kSpacing * spacing);
    ImageSpaceState::Lit lit{.tree = build_octree(std::move(points)),
                             .kernel = make_split_kernel(body.profile, spacing, world.diagonal,
                                                         stages.input.scene.settings.laboratory.near_field,
                                                         NearIrradiance::point)};
    if (lit.kernel.far_side != nullptr) bound_normals(lit.tree);
    return lit;
  });
  stages.note("views from the lights", source, "traced");
}

StageKey ImageSpaceMethod::direct_key(const Body& body) const {
  return state_of<ImageSpaceState>(body).lit.key;
}

std::unique_ptr<Field> ImageSpaceMethod::field(const RenderInput& input, const Body& body) const {
  return std::make_unique<ImageSpaceField>(input, body);
}

}  // namespace opaline
