// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/direct/direct_exitance.h"

#include "core/random.h"
#include "irradiance/irradiance.h"
#include "lights/light.h"
#include "render/bounced_light.h"

namespace opaline {
namespace {

// Russian roulette below this fraction of a typical weight: the far tail of a steep profile is not worth its
// shadow rays.
constexpr float kRouletteBelow = 0.05f;

// True if the entry survives Russian roulette; divides its weight by the probability.
bool survives(Entry& entry, float usual, double random) {
  const float chance = max_component(entry.weight) / (kRouletteBelow * usual);
  if (chance >= 1) return true;
  if (random >= double(chance)) return false;
  entry.weight *= 1 / chance;
  entry.inverse_density *= 1 / chance;
  return true;
}

/// Tint of transmitted light at an entry, at the full resolution of the texture.
RgbF entering_tint(const DirectExitanceInput& input, const Entry& entry, std::size_t exit) {
  if (input.textures == nullptr || input.textures->empty()) return RgbF(1);
  const bool is_exit = entry.mesh == Hit::kMiss;
  const Hit& hit = input.hits[exit];
  const std::uint32_t mesh = is_exit ? hit.mesh : entry.mesh;
  if (!input.textures->tints_entering(mesh)) return RgbF(1);
  const SurfaceTextures::Place place =
      is_exit ? input.textures->place(mesh, hit.triangle, hit.u, hit.v, {})
              : input.textures->place(mesh, entry.triangle, entry.u, entry.v, {});
  return input.textures->tint(place).entering;
}

/// Fraction of the light entering from a direction that leaves at the exit.
RgbF weight_of(const EntrySampler& sampler, const SurfacePoint& exit, const Entry& entry,
               const Vec3f& towards_light) {
  if (!sampler.is_directional() || !(entry.inverse_density > 0)) return entry.weight;
  return sampler.directional(exit, entry.point, towards_light) * entry.inverse_density;
}

/// For profiles depending on the light's direction: ray by ray.
void add_directed_light(const DirectExitanceInput& input, const PointIrradianceInput& at,
                        std::span<const Entry> entries, std::span<const std::size_t> exits,
                        std::vector<RgbF>& exitance) {
  std::vector<RgbF> colours;
  for (const Light& light : at.lights) colours.emplace_back(emission(light));
  for_each_ray(at, [&](std::size_t l, std::size_t e, const Vec3f& towards_light, float irradiance) {
    const Entry& entry = entries[e];
    const RgbF weight = weight_of(input.sampler, input.exits.points[exits[e]], entry, towards_light);
    exitance[exits[e]] += weight * colours[l] * irradiance * entry.tint;
  });
}

/// Adds light from other surfaces at the entries, by one ray each.
void add_bounced_light(const DirectExitanceInput& input, const PointIrradianceInput& at,
                       std::span<const Entry> entries, std::span<const std::size_t> exits,
                       std::vector<RgbF>& exitance) {
  constexpr std::uint64_t kSeed = 5;
  for_each_gathered({at.rays, *input.gathers, at.points, at.keys, at.boundary, 1, hash_bits(at.seed, kSeed)},
                    [&](const SurfaceLight& light) {
                      const Entry& entry = entries[light.point];
                      const std::size_t exit = exits[light.point];
                      const RgbF weight =
                          weight_of(input.sampler, input.exits.points[exit], entry, light.towards);
                      exitance[exit] += weight * light.irradiance * entry.tint;
                    });
}

}  // namespace

std::vector<RgbF> direct_exitance(const DirectExitanceInput& input) {
  const std::size_t points = input.exits.points.size();
  std::vector<RgbF> exitance(points);
  std::vector<Hit> crossings;
  std::vector<Entry> entries, taken;
  std::vector<SurfacePoint> entry_points;
  std::vector<std::uint64_t> keys;
  std::vector<std::size_t> exits;  // exits of the accepted entries
  const float usual = input.sampler.usual_weight();
  for (std::size_t p = 0; p < points; ++p) {
    const std::uint64_t key = hash_bits(input.exits.seed, input.exits.keys[p]);
    const std::array<double, 4> shift{unit_double(hash_bits(key, 0)), unit_double(hash_bits(key, 1)),
                                      unit_double(hash_bits(key, 2)), unit_double(hash_bits(key, 3))};
    for (int s = 0; s < input.entry_samples; ++s) {
      entries.clear();
      const std::uint64_t sample_key = hash_bits(key, 4 + std::uint64_t(s));
      input.sampler.sample(input.exits.points[p], {r4_point(std::uint64_t(s), shift), sample_key}, crossings,
                           entries);
      for (std::size_t e = 0; e < entries.size(); ++e) {
        const std::uint64_t entry_key = hash_bits(sample_key, 2 + e);
        if (!survives(entries[e], usual, unit_double(entry_key))) continue;
        entries[e].tint = entering_tint(input, entries[e], p);
        if (input.textures != nullptr && entries[e].mesh != Hit::kMiss)
          entries[e].tint *= input.textures->bend(entries[e].point);
        entry_points.push_back(entries[e].point);
        taken.push_back(entries[e]);
        keys.push_back(entry_key);
        exits.push_back(p);
      }
    }
  }
  PointIrradianceInput at = input.exits;
  at.points = entry_points;
  at.keys = keys;
  at.light_samples = 1;
  if (input.sampler.is_directional()) {
    add_directed_light(input, at, taken, exits, exitance);
  } else {
    const std::vector<RgbF> entered = irradiance_at(at);
    for (std::size_t e = 0; e < taken.size(); ++e)
      exitance[exits[e]] += taken[e].weight * entered[e] * taken[e].tint;
  }
  if (input.gathers != nullptr) add_bounced_light(input, at, taken, exits, exitance);
  if (input.entry_samples > 0)
    for (RgbF& m : exitance) m *= 1 / float(input.entry_samples);
  return exitance;
}

}  // namespace opaline
