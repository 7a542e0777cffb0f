// SPDX-License-Identifier: GPL-3.0-or-later
// The reference of the hierarchical picture: the same BSSRDF sampled at random, progressively.
#pragma once

#include <functional>
#include <vector>

#include "bodies/plan.h"
#include "render/render.h"

namespace opaline {

/// Sums over the passes so far, each pass an independent estimate of every pixel: all that going on later
/// takes.
struct DirectState {
  std::size_t passes = 0;
  /// Per pixel of the rendered part, row by row: diffuse radiance R G B, then the roots of the sums of its
  /// squares.
  std::vector<float> sums;
  static constexpr std::size_t kSums = 6;
};

struct DirectInput {
  const Scene& scene;
  const World& world;
  const RayScene& rays;
  const Plan& plan;
  Monitor* monitor = nullptr;
  std::function<void(const DirectState&)> after_pass = {};  ///< called between passes
};

struct DirectResult {
  /// Layers R G B A, diffuse, specular, albedo, N, P, Z, and variance: of the diffuse radiance's mean,
  /// infinite or 0 where a float does not hold it (radiances beyond 1e19 or below 1e-18).
  RenderResult picture;
  std::size_t entry_samples = 0;  ///< a pixel
  double relative_error = 0;      ///< see relative_noise; infinite after a single pass
};

/// Entry samples of a pixel in one pass, whatever asks for how many in all.
std::size_t entry_samples_per_pass(const Film& film);

/// Goes on from `state` (default: from nothing) until Settings::entry_samples or Settings::until_error; state
/// is the last whole pass's, also when the monitor's cancellation throws. The picture depends on the scene
/// and the number of passes alone: not on where it was stopped, nor on threads. Unbiased; nothing is cut but
/// weights of entries under 5 % of a usual one, which Russian roulette replaces. Light paths and boundary as
/// `render`.
DirectResult render_direct(const DirectInput& input, DirectState& state);

/// Mean of a pixel's passes and the variance of that mean; pixel: its place in DirectState::sums.
struct DirectEstimate {
  RgbF mean{};
  Rgb variance{};
};
/// Mean and standard error of a pixel, from the sums of all passes.
DirectEstimate direct_estimate(const DirectState& state, std::size_t pixel);

/// Rms over the pixels with light of the estimated standard error over sqrt(mean^2 + (1 % of the
/// brightest)^2), the largest channel.
double relative_noise(const DirectState& state);

/// Keeps a state in an EXR of 32-bit sums; `scene_key`: what the sums belong to.
/// error Error{run_failed} naming the file: not writable, disk full; the old file is left as it was
void write_direct_state(const std::string& path, const DirectState& state, const Scene& scene,
                        const std::string& scene_key);

/// The state in the file, or a new one where there is no file.
/// error Error{bad_input} naming the file: damaged, not such a state, of another scene or picture size
DirectState read_direct_state(const std::string& path, const Scene& scene, const std::string& scene_key);

}  // namespace opaline
