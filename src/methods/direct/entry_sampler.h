// SPDX-License-Identifier: GPL-3.0-or-later
// Sampling of entry points for a point of exit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bodies/plan.h"
#include "diffusion/diffuse_profile.h"
#include "diffusion/kernel_table.h"
#include "geometry/line_query.h"

namespace opaline {

/// Random numbers of one sample: four in [0, 1), stratified over the samples of a point, and a key for more.
struct EntryRandom {
  std::array<double, 4> stratified;
  std::uint64_t key;
};

/// One entry point of a sample: M_o is the expected sum of weight x E(point) over the entries of a sample.
struct Entry {
  SurfacePoint point;
  RgbF weight;                                    ///< R_d / density per area, per channel
  float inverse_density = 0;                      ///< per area; 0: the weight is of local reflection
  std::uint32_t mesh = Hit::kMiss, triangle = 0;  ///< mesh and triangle of the point; kMiss: the exit itself
  float u = 0, v = 0;
  RgbF tint{1, 1, 1};  ///< tint of the light entering
};

/// Importance-samples entry points on the surfaces of a body by R_d of the distance.
///
/// `disc_axes` (King et al. 2013, BSSRDF Importance Sampling): a line along one of three axes (the normal
/// with probability 1/2, and two tangents) through a disc around the point, at a distance sampled from one
/// channel's profile; every intersection with the body is an entry. Balance heuristic over axes and channels.
/// R_d falls with distance and projection to the disc shortens distances, so weights are at most total / (1/4
/// x 1/sqrt(3) x 1/channels).
/// `chords`: a random chord of a sphere around the point, see sample_chord_sphere_radius. Weights are at most
/// 2 x total for one channel, for any surface. Channels with a mean free path below float resolution reflect
/// locally: the exit itself is their entry.
class EntrySampler {
 public:
  EntrySampler(const BodyPlan& plan, const DiffuseProfile& profile, const RayScene& rays, double diagonal,
               EntryStrategy strategy);

  const std::vector<std::uint32_t>& meshes() const { return meshes_; }

  /// Approximate weight of an entry on a flat surface, largest channel.
  float usual_weight() const { return usual_weight_; }

  /// True if R_d depends on the direction of the light; the weights then contain its mean.
  bool is_directional() const { return is_directional_; }
  /// R_d, 1/mm^2, for light from a direction, per channel; 0 for local channels.
  RgbF directional(const SurfacePoint& exit, const SurfacePoint& entry, const Vec3f& towards_light) const;

  /// Adds the entries of one sample to `entries`; crossings: scratch.
  void sample(const SurfacePoint& exit, const EntryRandom& random, std::vector<Hit>& crossings,
              std::vector<Entry>& entries) const;

 private:
  struct Line {
    Ray ray;
    bool empty = false;  // the line misses the body
  };
  Line disc_line(const SurfacePoint& exit, const EntryRandom& random) const;
  Line chord_line(const SurfacePoint& exit, const EntryRandom& random) const;
  const ChannelProfile& choose_channel(double& u) const;
  float density(const SurfacePoint& exit, const Vec3f& offset, const Vec3f& normal) const;
  float channel_mean(float r2) const;

  std::vector<std::uint32_t> meshes_;
  DiffuseProfile profile_;  // profile of channels_ alone
  const RayScene& rays_;
  LineQuery lines_;
  KernelTable table_;
  std::optional<KernelTable> far_table_;  // between sheets, if the profile has a far side
  bool is_directional_ = false;
  double reach_;  // upper bound of the distance of two points of the body, mm
  EntryStrategy strategy_;
  RgbF local_;                         // total of the local channels
  std::vector<std::size_t> channels_;  // the other scattering channels
  float usual_weight_ = 0;
  std::array<float, 3> inverse_total_{};  // 1 / (channels x total)
};

}  // namespace opaline
