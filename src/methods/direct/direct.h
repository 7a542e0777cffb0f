// SPDX-License-Identifier: GPL-3.0-or-later
// Progressive reference of the hierarchical image: importance sampling of the same BSSRDF.
#pragma once

#include <functional>
#include <vector>

#include "bodies/body.h"
#include "core/image_part.h"
#include "render/render.h"

namespace opaline {

/// Sums over the passes so far, each pass an independent estimate of every pixel; sufficient for continuing
/// later.
struct DirectState {
  std::size_t passes = 0;
  /// Per pixel of the rendered part, row by row: diffuse radiance R G B, then the roots of its summed
  /// squares.
  std::vector<float> sums;
  static constexpr std::size_t kSums = 6;
};

struct DirectResult {
  /// Layers R G B A, diffuse, specular, albedo, N, P, Z, and variance of the diffuse radiance's mean,
  /// infinite or 0 beyond float's range (radiances beyond 1e19 or below 1e-18).
  RenderResult picture;
  std::size_t entry_samples = 0;  ///< a pixel
  double relative_error = 0;      ///< see relative_noise; infinite after a single pass
};

/// Entry samples of a pixel in one pass, for any total.
std::size_t entry_samples_per_pass(const Film& film);

/// Continues `state` (default: empty) until Settings::entry_samples or Settings::until_error; state is that
/// of the last whole pass, also if the monitor interrupts. The image depends on the scene and the number of
/// passes alone, not on interruptions or threads. Unbiased: Russian roulette replaces weights of entries
/// under 5 % of a typical one. Light paths and boundary as in `render`.
/// in    after_pass: called between passes
DirectResult render_direct(const PrecomputeInput& input, DirectState& state,
                           const std::function<void(const DirectState&)>& after_pass = {});

/// Continues the sums of one part of the tiles until Settings::entry_samples, without an image; the others stay 0.
/// Each pixel has the bits of render_direct.
/// in    as render_direct; part: count at most that of the tiles
void add_direct_passes(const PrecomputeInput& input, const ImagePart& part, DirectState& state,
                       const std::function<void(const DirectState&)>& after_pass = {});
/// Tiles of an image, and pixels of a part, as numbers in DirectState::sums.
std::size_t direct_tiles(const Film& film);
std::vector<std::size_t> pixels_of_part(const Film& film, const ImagePart& part);

/// Mean of a pixel's passes and its variance; pixel: index into DirectState::sums.
struct DirectEstimate {
  RgbF mean{};
  Rgb variance{};
};
/// Mean and standard error of a pixel, from the sums of all passes.
DirectEstimate direct_estimate(const DirectState& state, std::size_t pixel);

/// RelativeNoise of the diffuse radiance.
double relative_noise(const DirectState& state);

/// Writes a state as an EXR of 32-bit sums; `scene_key`: identifies their scene.
/// error Error{run_failed} naming the file: not writable, disk full; the old file remains unchanged
void write_direct_state(const std::string& path, const DirectState& state, const Scene& scene,
                        const std::string& scene_key);

/// The state in the file, or a new one if there is no file.
/// error Error{bad_input} naming the file: damaged, not such a state, of another scene or image size
DirectState read_direct_state(const std::string& path, const Scene& scene, const std::string& scene_key);

}  // namespace opaline
