// SPDX-License-Identifier: GPL-3.0-or-later
// Specular reflection at dielectric and metallic boundaries: of lights, environments and other surfaces. A
// smooth boundary traces one ray. A rough boundary samples its lobe and the lights, combined by the power
// heuristic (Veach & Guibas 1995).
#include <algorithm>
#include <numbers>
#include <optional>

#include "core/random.h"
#include "irradiance/sample_key.h"
#include "lights/environment_sample.h"
#include "render/shade.h"

namespace opaline {
namespace {

// Lobe samples and light samples per camera ray, at one ray per pixel.
constexpr int kFacets = 16, kLightSamples = 16;
// Factor by which both are reduced behind a specular reflection.
constexpr int kFewerOfMirrored = 4;
// Maximum specular reflections of a camera ray: if all are metallic, and if all are dielectric. Further
// reflections are approximated by a uniform illumination.
constexpr int kMostMirrors = 4, kMostCoats = 2;
// Factor by which shadow rays are reduced behind a specular reflection.
constexpr int kFewerInMirrors = 4;
// Spread of the cones around the directions of a lobe, for texture filtering.
constexpr float kGlossySpread = .1f;

TracedRay leaving(const SurfacePoint& point, const Vec3f& direction) {
  const float side = dot(direction, point.geometric) >= 0 ? 1.0f : -1.0f;
  return {{point.position + point.geometric * (side * point.offset), direction}, {}};
}

// Shading frame of a hit, as in RoughBoundary.
struct Frame {
  Vec3f x, y, z, view;

  /// tangent: 0 for an isotropic boundary
  Frame(const SurfacePoint& point, const Vec3f& tangent, const Vec3f& towards_eye) : z(point.normal) {
    if (tangent == Vec3f{}) {
      tangent_frame(z, x, y);
    } else {
      x = tangent;
      y = cross(z, x);
    }
    view = {dot(towards_eye, x), dot(towards_eye, y), cos_view(point, -towards_eye)};
    view = normalized(view);
  }
  Vec3f local(const Vec3f& d) const { return {dot(d, x), dot(d, y), dot(d, z)}; }
  Vec3f world(const Vec3f& d) const { return x * d.x + y * d.y + z * d.z; }
};

/// False if all lights are below the horizon of a point.
bool may_be_lit(std::span<const Light> lights, const SurfacePoint& point) {
  return std::ranges::any_of(lights, [&](const Light& light) {
    if (!is_delta(light)) return true;
    const LightSample sample = sample_light(light, point.position, point.normal, {.5, .5}, 1);
    return sample.weight > 0 && dot(sample.direction, point.normal) > 0;
  });
}

/// Irradiance by all lights, without shadows.
RgbF unshadowed_irradiance(std::span<const Light> lights, const SurfacePoint& point) {
  constexpr int kSamples = 4;  // per light that is not a point
  Rgb sum{};
  for (const Light& light : lights) {
    const int samples = is_delta(light) ? 1 : kSamples;
    for (int s = 0; s < samples; ++s) {
      const LightSample sample =
          sample_light(light, point.position, point.normal, r2_point(std::uint64_t(s), {.5, .5}), samples);
      const double cosine = double(std::max(0.f, dot(sample.direction, point.normal)));
      sum += emission(light) * (double(sample.weight) * cosine / samples);
    }
  }
  return RgbF(sum);
}

void add_hit(const SurfaceHits& hits, std::size_t i, SurfaceHits& to) {
  to.points.push_back(hits.points[i]);
  to.hits.push_back(hits.hits[i]);
  to.keys.push_back(hits.keys[i]);
  to.rays.push_back(hits.rays[i]);
  if (!hits.textures.empty()) to.textures.push_back(hits.textures[i]);
}

// Radiance of a light with an area, or of an environment. is_free: the ray hits no surface.
RgbF seen_radiance(const Light& light, const Ray& ray, bool is_free) {
  const EmitterHit emitter = intersect_emitter(light, ray.origin, ray.direction, ray.far);
  return emitter.hit ? emitter.radiance : is_free ? background(light, ray.direction) : RgbF{};
}

// Power heuristic: less noise than the balance heuristic where one strategy is much better.
float power(float own, float other) {
  const float ratio = other / own;
  return own > 0 ? 1 / (1 + ratio * ratio) : 0;
}

// Number of recent lobes searched for a similar one.
constexpr std::size_t kRecentLobes = 8;

bool are_alike(const Lobe& a, const Lobe& b) {
  constexpr float kApart = 1, kWiden = 1.25f;
  const float apart = kApart * std::min(a.alpha, b.alpha);
  return dot(a.mirrored, b.mirrored) > 1 - apart * apart / 2 && a.alpha < kWiden * b.alpha &&
         b.alpha < kWiden * a.alpha;
}

}  // namespace

void Shader::add_specular(const SurfaceHits& hits, const RayBatch& batch, const Pass& pass,
                          HeldView::Surface* held) const {
  SurfaceHits smooth, rough;
  for (std::size_t i = 0; i < hits.rays.size(); ++i) {
    const Appearance& appearance = appearances_[hits.hits[i].mesh];
    add_hit(hits, i, appearance.is_rough() ? rough : smooth);
  }
  if (!smooth.rays.empty() && mirrors_surfaces()) add_mirrored(smooth, batch, pass);
  if (!rough.rays.empty()) add_glossy(rough, batch, pass, held);
}

std::vector<PixelSample> Shader::seen_along(std::span<const TracedRay> rays,
                                            std::span<const std::uint64_t> keys, const Cones& cones,
                                            const Pass& pass, int mirrors, HeldView::Batch* held) const {
  std::vector<PixelSample> seen(rays.size());
  const RayBatch batch{.rays = rays,
                       .keys = keys,
                       .out = seen,
                       .light_samples = std::max(1, light_samples_ / kFewerInMirrors),
                       .spread = cones.spread,
                       .widths = cones.widths,
                       .mirrors = mirrors,
                       .specular = Specular::none};
  const Pass& mirrored = pass.in_mirrors != nullptr ? *pass.in_mirrors : pass;
  const std::vector<SurfaceHits> all_hits = shade(batch, mirrored, held).hits;
  for (std::size_t f = 0; f < all_hits.size(); ++f) {
    const SurfaceHits& hits = all_hits[f];
    SurfaceHits followed, last;
    for (std::size_t i = 0; i < hits.rays.size(); ++i) {
      const Appearance& plain = appearances_[hits.hits[i].mesh];
      if (!plain.mirrors()) continue;
      const float metalness = (hits.textures.empty() ? plain : appearance_of(hits, i)).metalness;
      add_hit(hits, i, mirrors < (metalness > 0 ? kMostMirrors : kMostCoats) ? followed : last);
    }
    if (!followed.rays.empty())
      add_specular(followed, batch, mirrored, held != nullptr ? &held->surfaces[f] : nullptr);
    add_evenly_mirrored(last, batch);
  }
  return seen;
}

void Shader::add_evenly_mirrored(const SurfaceHits& hits, const RayBatch& batch) const {
  constexpr float kInversePi = std::numbers::inv_pi_v<float>;
  constexpr float kDark = .1f;  // albedo
  for (std::size_t i = 0; i < hits.rays.size(); ++i) {
    const bool is_plain = hits.textures.empty();
    const Appearance textured = is_plain ? Appearance{} : appearance_of(hits, i);
    const Appearance& appearance = is_plain ? appearances_[hits.hits[i].mesh] : textured;
    const bool is_elsewhere = appearance.translucent && mirrored_by_bodies_ == MirroredByBodies::of_surfaces,
               mirrors = appearance.mirrors() && !is_elsewhere;
    if (!mirrors && !appearance.boundary.has_fuzz()) continue;
    const float cosine = cos_view(hits.points[i], batch.rays[hits.rays[i]].ray.direction);
    PixelSample& sample = batch.out[hits.rays[i]];
    RgbF arriving = sample.irradiance *
                    (kInversePi / ((1 - appearance.average_reflectance) * appearance.boundary.past_fuzz()));
    // Without an irradiance in the field, it follows from the exitance: outgoing light over that of uniform
    // illumination. Light leaving a face in shadow may come from inside alone.
    const float past_fuzz = appearance.boundary.past_fuzz(cosine);
    RgbF leaving(appearance.translucent ? 1 - appearance.reflectance(cosine) : 0);
    if (appearance.translucent && appearance.boundary.has_fuzz())
      leaving = appearance.radiance_past_fuzz(cosine) *
                (std::numbers::pi_v<float> * (1 - appearance.average_reflectance) *
                 appearance.boundary.past_fuzz());
    if (arriving == RgbF{} && min_component(leaving) > 0 && may_be_lit(lights_, hits.points[i])) {
      for (std::size_t c = 0; c < 3; ++c)
        if (appearance.albedo[c] > 0) arriving[c] = sample.diffuse[c] / (leaving[c] * appearance.albedo[c]);
      // Dark media may send out light that has crossed them, many times their albedo.
      if (min_component(appearance.albedo) < kDark)
        arriving = component_min(arriving, unshadowed_irradiance(lights_, hits.points[i]) * kInversePi);
    }
    if (mirrors) sample.specular += arriving * appearance.mirrored_share(cosine) * (past_fuzz * past_fuzz);
    if (batch.specular == Specular::uniform) sample.specular += arriving * appearance.fuzz_share(cosine);
  }
}

// Other surfaces mirrored by bodies, as by smooth ones: one ray from some hits, chosen with the probability of reflection.
void Shader::add_mirrored_surfaces(const SurfaceHits& hits, const RayBatch& batch) const {
  constexpr std::uint64_t kChoice = 4950;
  std::vector<TracedRay> mirrored;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> rays;
  for (std::size_t i = 0; i < hits.rays.size(); ++i) {
    const Appearance& appearance = appearances_[hits.hits[i].mesh];
    if (!appearance.translucent || !appearance.mirrors()) continue;
    const SurfacePoint& point = hits.points[i];
    const Vec3f arriving = batch.rays[hits.rays[i]].ray.direction;
    const float cosine = cos_view(point, arriving), past_fuzz = appearance.boundary.past_fuzz(cosine),
                likely = appearance.reflectance(cosine) * past_fuzz * past_fuzz;
    const std::uint64_t key = hash_bits(hits.keys[i], kChoice);
    const Vec3f along = arriving - point.normal * (2 * dot(arriving, point.normal));
    if (!(float(unit_double(key)) < likely) || !(dot(along, point.geometric) > 0)) continue;
    mirrored.push_back(leaving(point, along));
    keys.push_back(hash_bits(key, 1));
    rays.push_back(hits.rays[i]);
  }
  if (mirrored.empty()) return;
  input_.rays.intersect(mirrored);
  std::vector<PixelSample> seen(mirrored.size());
  shade({.rays = mirrored, .keys = keys, .out = seen, .spread = batch.spread, .specular = Specular::none},
        {.entry_samples = 1, .is_seen = false});
  for (std::size_t k = 0; k < rays.size(); ++k) batch.out[rays[k]].specular += seen[k].diffuse;
}

// Lights without an area are invisible in smooth boundaries.
void Shader::add_mirrored(const SurfaceHits& hits, const RayBatch& batch, const Pass& pass) const {
  std::vector<TracedRay> mirrored;
  Cones cones{batch.spread, {}};
  for (std::size_t i = 0; i < hits.rays.size(); ++i) {
    const Vec3f d = normalized(batch.rays[hits.rays[i]].ray.direction), &normal = hits.points[i].normal;
    mirrored.push_back(leaving(hits.points[i], d - normal * (2 * dot(d, normal))));
    if (!textures_.empty()) cones.widths.push_back(width_at(batch, hits.rays[i]));
  }
  input_.rays.intersect(mirrored);
  const std::vector<PixelSample> seen = seen_along(mirrored, hits.keys, cones, pass, batch.mirrors + 1);
  for (std::size_t i = 0; i < hits.rays.size(); ++i) {
    const float cosine = cos_view(hits.points[i], batch.rays[hits.rays[i]].ray.direction);
    const bool is_plain = hits.textures.empty();
    const Appearance textured = is_plain ? Appearance{} : appearance_of(hits, i);
    const Appearance& appearance = is_plain ? appearances_[hits.hits[i].mesh] : textured;
    const float past_fuzz = appearance.boundary.past_fuzz(cosine);
    const RgbF share =
        appearance.mirror_color(cosine) * (appearance.reflectance(cosine) * past_fuzz * past_fuzz);
    batch.out[hits.rays[i]].specular += (seen[i].diffuse + seen[i].specular + seen[i].emitted) * share;
  }
}

/// Hits of rough boundaries, and the tables for sampling their lobes.
struct Shader::GlossyHits {
  const SurfaceHits& hits;
  const RayBatch& batch;
  std::vector<Frame> frames;
  std::vector<Appearance> textured;  // with textures only
  std::vector<const Appearance*> appearances;
  int facets, to_lights;
  std::uint64_t seed;
  std::vector<std::uint64_t> keys;  // random-number keys, in the sequence of the pixel
  std::vector<Lobe> lobes;
  std::vector<EnvironmentLobe> reflected;  // reflections of an environment by the lobes, if any

  GlossyHits(const Shader& shader, const SurfaceHits& all, const RayBatch& rays)
      : hits(all),
        batch(rays),
        seed(point_irradiance_seed(shader.input_.scene.settings) + 1 + (std::uint64_t(rays.mirrors) << 32)) {
    const int spp = shader.input_.scene.film.samples_per_pixel;
    const int shared_by = rays.mirrors > 0 ? spp * kFewerOfMirrored : spp;
    facets = (kFacets + shared_by - 1) / shared_by;
    to_lights = (kLightSamples + shared_by - 1) / shared_by;
    textured.reserve(hits.textures.size());
    for (std::size_t i = 0; i < hits.rays.size(); ++i) {
      // Directions behind a reflection are independent: the first reflection uses the pixel's sequence.
      keys.push_back(rays.mirrors > 0 ? hash_bits(seed, hits.keys[i])
                                      : key_in_pixel(hits.keys[i], std::uint64_t(spp)));
      frames.emplace_back(hits.points[i], hits.textures.empty() ? Vec3f{} : hits.textures[i].grain.tangent,
                          -normalized(batch.rays[hits.rays[i]].ray.direction));
      if (!hits.textures.empty()) textured.push_back(shader.appearance_of(hits, i));
      appearances.push_back(hits.textures.empty() ? &shader.appearances_[hits.hits[i].mesh]
                                                  : &textured.back());
      const Vec3f& view = frames.back().view;
      lobes.push_back({frames.back().world({-view.x, -view.y, view.z}), boundary(i).alpha()});
    }
    const auto environment = std::ranges::find_if(
        shader.lights_, [](const Light& l) { return std::holds_alternative<EnvironmentLight>(l.source); });
    if (environment == shader.lights_.end()) return;
    reflected.reserve(lobes.size());
    // Neighbouring rays have similar lobes, which share one table.
    std::vector<Lobe> known;
    for (std::size_t i = 0; i < lobes.size(); ++i) {
      const auto recent = known.end() - std::ptrdiff_t(std::min(known.size(), kRecentLobes));
      auto alike = std::find_if(recent, known.end(), [&](const Lobe& k) { return are_alike(k, lobes[i]); });
      if (alike == known.end()) {
        reflected.push_back(environment_lobe(std::get<EnvironmentLight>(environment->source),
                                             hits.points[i].normal, lobes[i]));
        lobes[i].in_environment = &reflected.back();
        known.push_back(lobes[i]);
      } else {
        lobes[i].in_environment = alike->in_environment;
      }
    }
  }
  const RoughBoundary& boundary(std::size_t i) const { return *appearances[i]->rough; }
  // Reflectance by direction, in the local frame.
  RgbF color(std::size_t i, const Vec3f& light) const {
    if (!(appearances[i]->metalness > 0)) return RgbF(1);
    return appearances[i]->mirror_color(dot(frames[i].view, normalized(frames[i].view + light)),
                                        boundary(i).reflected_once(frames[i].view.z));
  }
  // Light past the fuzz on both ways.
  float past_fuzz(std::size_t i, const Vec3f& light) const {
    const OuterBoundary& outer = appearances[i]->boundary;
    return outer.has_fuzz() ? outer.past_fuzz(frames[i].view.z) * outer.past_fuzz(light.z) : 1;
  }
  RgbF& specular(std::size_t i) const { return batch.out[hits.rays[i]].specular; }
  // A bent normal may reflect into the surface, and from there outwards again: the direction below the surface of
  // such light, local; none: it does not reach the camera.
  std::optional<Vec3f> below(std::size_t i, const Vec3f& towards) const {
    if (hits.textures.empty() || !hits.textures[i].is_bent) return {};
    const Vec3f& geometric = hits.points[i].geometric;
    const float height = dot(towards, geometric);
    const Vec3f local = frames[i].local(towards - geometric * (2 * height));
    return height > 0 && local.z > 0 ? std::optional(local) : std::nullopt;
  }
  // Sampling densities of the lobe and of a light, times their number of samples, 1/sr.
  float of_lobe(std::size_t i, const Vec3f& towards) const {
    float density = boundary(i).density(frames[i].view, frames[i].local(towards));
    if (const auto again = below(i, towards)) density += boundary(i).density(frames[i].view, *again);
    return float(facets) * density;
  }
  float of_light(std::size_t i, const Light& light, const Vec3f& towards) const {
    const SurfacePoint& point = hits.points[i];
    return float(to_lights * lobe_draws(light, lobes[i])) *
           sampling_density(light, point.position, point.normal, towards, &lobes[i]);
  }

  struct LobeRay {
    float weight;
    RgbF color;  // factor of metals
    std::uint32_t hit;
  };
  // Samples directions of the lobes, hit by hit; fills `rays`, to be traced.
  std::vector<LobeRay> draw_from_lobes(std::vector<TracedRay>& rays) const {
    std::vector<LobeRay> drawn;
    for (std::size_t i = 0; i < hits.rays.size(); ++i) {
      const auto [key, part] = part_of(keys[i]);
      const std::array<double, 2> shift{unit_double(hash_bits(seed, 2 * key)),
                                        unit_double(hash_bits(seed, 2 * key + 1))};
      for (int k = 0; k < facets; ++k) {
        const std::uint64_t number = part * std::uint64_t(facets) + std::uint64_t(k);
        const auto [direction, weight] = boundary(i).sample(frames[i].view, r2_point(number, shift));
        Vec3f towards = frames[i].world(direction);
        const float height = dot(towards, hits.points[i].geometric);
        const bool is_again = height < 0 && !hits.textures.empty() && hits.textures[i].is_bent;
        if (!(weight > 0 && (height > 0 || is_again))) continue;
        if (is_again) towards = towards - hits.points[i].geometric * (2 * height);
        rays.push_back(leaving(hits.points[i], towards));
        drawn.push_back(
            {weight / float(facets) * past_fuzz(i, direction), color(i, direction), std::uint32_t(i)});
      }
    }
    return drawn;
  }
};

// True if the radiance of all lights is exactly proportional to their emission and no surface is a metal, as
// a metal's colour depends on the direction.
bool Shader::can_hold_coats() const {
  const auto has_plain_radiance = [](const Light& light) {
    return is_delta(light) || std::holds_alternative<EnvironmentLight>(light.source) ||
           std::holds_alternative<QuadLight>(light.source) ||
           std::holds_alternative<SphereLight>(light.source) ||
           std::holds_alternative<Surroundings>(light.source);
  };
  return textures_.empty() && std::ranges::all_of(lights_, has_plain_radiance) &&
         std::ranges::none_of(appearances_, [](const Appearance& a) { return a.metalness > 0; });
}

void Shader::add_glossy(const SurfaceHits& hits, const RayBatch& batch, const Pass& pass,
                        HeldView::Surface* held) const {
  const bool may_hold = held != nullptr && !unit_lights_.empty();
  if (may_hold && held->coat != nullptr) return add_held_coat(*held->coat, batch, pass);
  const GlossyHits glossy(*this, hits, batch);
  std::unique_ptr<HeldView::Coat> coat;
  if (may_hold && *input_.view->coat_bytes < kMostCoatBytes) coat = std::make_unique<HeldView::Coat>();
  add_highlights(glossy, coat.get());
  if (mirrors_surfaces()) add_reflections(glossy, pass, coat.get());
  if (coat == nullptr) return;
  *input_.view->coat_bytes += coat->bytes();
  held->coat = std::move(coat);
}

// Repeats add_highlights and add_reflections, sum by sum.
void Shader::add_held_coat(HeldView::Coat& coat, const RayBatch& batch, const Pass& pass) const {
  for (const auto& [ray, light, unit, weight] : coat.lights)
    batch.out[ray].specular += emitted_[light] * unit * weight;
  const std::vector<PixelSample> seen =
      seen_along(coat.mirrored, coat.keys, {kGlossySpread, {}}, pass, batch.mirrors + 1, &coat.seen);
  for (std::size_t m = 0; m < seen.size(); ++m)
    batch.out[coat.rays[m]].specular += (seen[m].diffuse + seen[m].specular) * coat.shares[m];
}

// Samples the lights.
void Shader::add_highlights(const GlossyHits& glossy, HeldView::Coat* coat) const {
  const PointIrradianceInput lighting{input_.rays, glossy.hits.points, glossy.keys, lights_,
                                      0,           glossy.to_lights,   glossy.seed};
  for_each_ray(
      lighting,
      [&](std::size_t l, std::size_t i, const Vec3f& towards, float irradiance) {
        const Light& light = lights_[l];
        const Vec3f local = glossy.frames[i].local(towards);
        const float share =
            is_delta(light) ? 1 : power(glossy.of_light(i, light, towards), glossy.of_lobe(i, towards));
        const auto weight_of = [&](const Vec3f& direction) {
          const float value = glossy.boundary(i).value(glossy.frames[i].view, direction) / local.z *
                              glossy.past_fuzz(i, direction);
          return irradiance * value * share;
        };
        const float weight = weight_of(local);
        glossy.specular(i) += emitted_[l] * glossy.color(i, local) * weight;
        if (const auto again = glossy.below(i, towards))
          glossy.specular(i) += emitted_[l] * glossy.color(i, *again) * weight_of(*again);
        if (coat != nullptr) coat->lights.push_back({glossy.hits.rays[i], std::uint32_t(l), 1, weight});
      },
      glossy.lobes);
}

// Samples the lobes.
void Shader::add_reflections(const GlossyHits& glossy, const Pass& pass, HeldView::Coat* coat) const {
  struct Met {
    float weight;  // sum over the rays that hit surfaces
    RgbF share;    // the same with each ray's colour
    std::uint32_t hit;
  };
  std::vector<TracedRay> rays;
  const std::vector<GlossyHits::LobeRay> drawn = glossy.draw_from_lobes(rays);
  input_.rays.intersect(rays);

  // One randomly chosen surface represents all surfaces hit by the rays of a hit.
  std::vector<Met> met;
  Cones cones{kGlossySpread, {}};
  std::vector<TracedRay> met_rays;
  std::vector<std::uint64_t> met_keys;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    const auto& [ray, mesh_hit] = rays[r];
    const auto& [weight, color, i] = drawn[r];
    const bool is_free = mesh_hit.mesh == Hit::kMiss;
    for (std::size_t l = 0; l < lights_.size(); ++l) {
      const Light& light = lights_[l];
      if (is_delta(light)) continue;
      if (const auto* own = std::get_if<ShapeLight>(&light.source);
          own != nullptr && own->shape != mesh_hit.mesh)
        continue;  // hidden, or beside the ray
      RgbF radiance = seen_radiance(coat != nullptr ? unit_lights_[l] : light, ray, is_free);
      if (radiance == RgbF{}) continue;
      const float balanced =
          weight * power(glossy.of_lobe(i, ray.direction), glossy.of_light(i, light, ray.direction));
      if (coat != nullptr) {
        const float unit = max_component(radiance);
        coat->lights.push_back({glossy.hits.rays[i], std::uint32_t(l), unit, balanced});
        radiance = emitted_[l] * unit;
      }
      glossy.specular(i) += radiance * color * balanced;
    }
    if (is_free) continue;
    if (met.empty() || met.back().hit != i) {
      met.push_back({0, RgbF(0), i});
      met_rays.push_back(rays[r]);
      met_keys.push_back(glossy.hits.keys[i]);
      if (!textures_.empty()) cones.widths.push_back(width_at(glossy.batch, glossy.hits.rays[i]));
    }
    met.back().weight += weight;
    met.back().share += color * weight;
    const double chance = unit_double(hash_bits(glossy.seed + r, glossy.hits.keys[i]));
    if (chance * double(met.back().weight) < double(weight)) met_rays.back() = rays[r];
  }
  const std::vector<PixelSample> seen = seen_along(met_rays, met_keys, cones, pass, glossy.batch.mirrors + 1,
                                                   coat != nullptr ? &coat->seen : nullptr);
  for (std::size_t m = 0; m < met.size(); ++m)
    glossy.specular(met[m].hit) += (seen[m].diffuse + seen[m].specular) * met[m].share;
  if (coat == nullptr) return;
  for (const Met& one : met) {
    coat->rays.push_back(glossy.hits.rays[one.hit]);
    coat->shares.push_back(one.share);
  }
  coat->mirrored = std::move(met_rays);
  coat->keys = std::move(met_keys);
}

}  // namespace opaline
