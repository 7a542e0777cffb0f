// SPDX-License-Identifier: GPL-3.0-or-later
// Measurements of `opaline profile`: each radial profile of a medium against random walks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diffusion/diffuse_profile.h"
#include "opaline/monitor.h"
#include "transport/laboratory.h"

namespace opaline {

/// A medium at one wavelength; several layers from the surface inwards, or one.
struct ChannelLayers {
  std::string name;
  std::vector<SlabLayer> layers;
};

struct ProfileRequest {
  std::string name;  ///< displayed name of the medium
  std::vector<ChannelLayers> channels;
  std::vector<ProfileKind> kinds;  ///< radial profiles; none: all
  double eta = 1.3;
  double g = 0;                                                ///< mean cosine of the walks at equal sigma_s'
  double thickness = std::numeric_limits<double>::infinity();  ///< mm; infinite: a half space
  /// Per channel and angle of incidence; none: by a limit on collisions; 0: models only, with empty walks in default_radii.
  std::optional<std::size_t> walks;
  std::uint64_t seed = 1;
};

/// One channel, or all if they are equal.
struct ProfiledChannel {
  std::string name;
  HomogeneousMedium medium;  ///< the equivalent one of layers
  /// With layers: reflected fraction of a beam along the normal by the diffusion equation in the stack.
  std::optional<double> layered_diffusion;
  std::vector<ChannelProfile> models;  ///< as kProfileNames has them; empty if not among the request's kinds
  SlabWalks diffuse, normal;           ///< by angle of incidence
};

inline bool has_kind(const ProfileRequest& request, std::size_t kind) {
  return request.kinds.empty() || std::ranges::find(request.kinds, ProfileKind(kind)) != request.kinds.end();
}

/// Notes as in BenchReport.
struct ProfileReport {
  ProfileRequest request;
  std::vector<std::pair<std::string, std::string>> notes;
  std::vector<ProfiledChannel> channels;

  bool is_slab() const { return request.thickness < std::numeric_limits<double>::infinity(); }
};

/// The same bits for any number of threads: the number of walks follows from collisions counted, not from
/// time.
/// error as walk_slab
ProfileReport measure_profiles(const ProfileRequest& request, Monitor& monitor);

/// Exitance of a model on one face of the slab. On the far face it is the transmission, or for a model
/// without two faces (has_far_side) the profile at that distance.
struct ModelFace {
  const ChannelProfile* profile;
  double height = 0;  ///< thickness for the far face, mm

  double within(double r) const;      ///< fraction of the transmitted flux leaving there, nearer than r
  double profile_at(double r) const;  ///< 1/mm^2
  double total() const;
};

/// Largest difference of the cumulative fractions, each over its own total.
double shape_difference(const ModelFace& model, const WalkedFace& walked);

}  // namespace opaline
