// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/direct/entry_sampler.h"

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "diffusion/diffuse_profile.h"
#include "sampling/sample_surface.h"

namespace opaline {
namespace {

constexpr float kNormalShare = 0.5f, kTangentShare = 0.25f;

// The table's kernel is constant below this fraction of the smallest mean free path; little of the flux
// enters there.
constexpr double kSmallestDistance = 1e-5;

// Mean free paths below this fraction of the body's reach are no more than a few rounding errors of a
// position, and count as zero.
constexpr double kLocal = 1e-6;

// Removes the channels with zero mean free path.
DiffuseProfile carried_part(DiffuseProfile profile, double reach) {
  for (std::size_t c = 0; c < 3; ++c)
    if (profile.mean_free_path[c] <= kLocal * reach) {
      profile.channels[c] = {};
      profile.total[c] = 0;
    }
  return profile;
}

double smallest_distance(const DiffuseProfile& profile, double reach) {
  double smallest = reach;
  for (std::size_t c = 0; c < 3; ++c)
    if (profile.total[c] > 0) smallest = std::min(smallest, profile.mean_free_path[c]);
  return smallest * kSmallestDistance;
}

struct Frame {
  Vec3f normal, tangent, bitangent;
  explicit Frame(const Vec3f& n) : normal(n) { tangent_frame(normal, tangent, bitangent); }
};

// u falls into [begin, begin + share): mapped to [0, 1).
double rescaled(double u, double begin, double share) {
  return std::min((u - begin) / share, 1 - 0x1p-53);
}

}  // namespace

EntrySampler::EntrySampler(const BodyPlan& plan, const DiffuseProfile& profile, const RayScene& rays,
                           double diagonal, EntryStrategy strategy)
    : meshes_(plan.meshes),
      profile_(carried_part(profile, diagonal)),
      rays_(rays),
      lines_(rays, plan.meshes),
      table_(profile_, smallest_distance(profile_, diagonal), diagonal),
      reach_(diagonal),
      strategy_(strategy),
      local_(profile.total - profile_.total) {
  for (std::size_t c = 0; c < 3; ++c)
    if (profile_.total[c] > 0) channels_.push_back(c);
  for (const std::size_t c : channels_)
    inverse_total_[c] = float(1 / (double(channels_.size()) * profile_.total[c]));
  usual_weight_ = float(max_component(profile.total));
  if (profile.has_far_side)
    far_table_ = KernelTable::of_far_side(profile_, smallest_distance(profile_, diagonal), diagonal);
  for (const ChannelProfile& channel : profile_.channels)
    is_directional_ = is_directional_ || std::holds_alternative<DirectionalDipole>(channel);
}

RgbF EntrySampler::directional(const SurfacePoint& exit, const SurfacePoint& entry,
                               const Vec3f& towards_light) const {
  RgbF result;
  const DirectedPlace in{{}, Vec3d(entry.normal)},
      out{Vec3d(exit.position) - Vec3d(entry.position), Vec3d(exit.normal)};
  for (std::size_t c = 0; c < 3; ++c)
    if (const auto* profile = std::get_if<DirectionalDipole>(&profile_.channels[c]))
      result[c] = float(directional_reflectance(*profile, in, Vec3d(towards_light), out));
  return result;
}

void EntrySampler::sample(const SurfacePoint& exit, const EntryRandom& random, std::vector<Hit>& crossings,
                          std::vector<Entry>& entries) const {
  if (local_ != RgbF{}) entries.push_back({exit, local_});
  if (channels_.empty()) return;
  const Line line =
      strategy_ == EntryStrategy::disc_axes ? disc_line(exit, random) : chord_line(exit, random);
  if (line.empty) return;
  lines_.find(line.ray, crossings);
  for (const Hit& hit : crossings) {
    const SurfacePoint point = rays_.surface_point(hit.mesh, hit.triangle, hit.u, hit.v);
    const Vec3f offset = point.position - exit.position;
    const float p = density(exit, offset, point.geometric);
    if (!(p > 0)) continue;  // the profile has underflowed
    const bool crosses = far_table_ && !same_sheet(point.geometric, exit.geometric);
    alignas(16) float kernel[4];
    _mm_store_ps(kernel, (crosses ? *far_table_ : table_)(dot(offset, offset)));
    entries.push_back({point, RgbF{kernel[0], kernel[1], kernel[2]} * (1 / p), 1 / p, hit.mesh, hit.triangle,
                       hit.u, hit.v});
  }
}

const ChannelProfile& EntrySampler::choose_channel(double& u) const {
  const double n = double(channels_.size());
  const std::size_t chosen = std::min(std::size_t(u * n), channels_.size() - 1);
  u = rescaled(u, double(chosen) / n, 1 / n);
  return profile_.channels[channels_[chosen]];
}

EntrySampler::Line EntrySampler::disc_line(const SurfacePoint& exit, const EntryRandom& random) const {
  auto [which, channel, beyond, turn] = random.stratified;
  const Frame frame(exit.geometric);
  Vec3f axis = frame.normal, x = frame.tangent, y = frame.bitangent;
  if (which >= double(kNormalShare + kTangentShare)) {
    axis = frame.bitangent, x = frame.normal, y = frame.tangent;
  } else if (which >= double(kNormalShare)) {
    axis = frame.tangent, x = frame.bitangent, y = frame.normal;
  }
  const double r = sample_diffusion_distance(choose_channel(channel), 1 - beyond);
  if (r > reach_) return {{}, true};
  const double angle = 2 * std::numbers::pi * turn;
  const Vec3f place = exit.position + x * float(r * std::cos(angle)) + y * float(r * std::sin(angle));
  return {Ray(place - axis * float(reach_), axis, float(2 * reach_)), false};
}

EntrySampler::Line EntrySampler::chord_line(const SurfacePoint& exit, const EntryRandom& random) const {
  auto [channel_and_radius, height, turn, across2] = random.stratified;
  const double v = 1 - unit_double(random.key), disc_turn = unit_double(hash_bits(random.key, 1));
  const ChannelProfile& profile = choose_channel(channel_and_radius);
  const double radius = sample_chord_sphere_radius(profile, channel_and_radius, v);
  const double cosine = 2 * height - 1, sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double angle = 2 * std::numbers::pi * turn, disc_angle = 2 * std::numbers::pi * disc_turn;
  const Frame frame(Vec3f(Vec3d{sine * std::cos(angle), sine * std::sin(angle), cosine}));
  // A chord is uniform when its middle is uniform on the disc across its direction.
  const double across = radius * std::sqrt(across2);
  if (across > reach_) return {{}, true};
  const Vec3f middle = exit.position + frame.tangent * float(across * std::cos(disc_angle)) +
                       frame.bitangent * float(across * std::sin(disc_angle));
  const double half = std::min(std::sqrt(radius * radius - across * across), reach_);
  return {Ray(middle - frame.normal * float(half), frame.normal, float(2 * half)), false};
}

// Mean of R_d / total over the scattering channels.
float EntrySampler::channel_mean(float r2) const {
  alignas(16) float kernel[4];
  _mm_store_ps(kernel, table_(r2));
  return kernel[0] * inverse_total_[0] + kernel[1] * inverse_total_[1] + kernel[2] * inverse_total_[2];
}

// Expected entries per area at a point; normal: geometric.
float EntrySampler::density(const SurfacePoint& exit, const Vec3f& offset, const Vec3f& normal) const {
  if (strategy_ == EntryStrategy::chords) return channel_mean(dot(offset, offset)) / 2;
  const Frame frame(exit.geometric);
  const float n = dot(offset, frame.normal), t = dot(offset, frame.tangent), b = dot(offset, frame.bitangent);
  return kNormalShare * channel_mean(t * t + b * b) * std::abs(dot(normal, frame.normal)) +
         kTangentShare * (channel_mean(b * b + n * n) * std::abs(dot(normal, frame.tangent)) +
                          channel_mean(n * n + t * t) * std::abs(dot(normal, frame.bitangent)));
}

}  // namespace opaline
