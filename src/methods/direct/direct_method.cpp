// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/direct/direct_method.h"

#include <fmt/format.h>

#include "methods/direct/direct.h"

namespace opaline {

double DirectMethod::seconds_of_pixel(const Scene& scene, const Lighting& lighting) const {
  constexpr double kEntrySample = 1e-7;  // beside its shadow rays
  return double(scene.settings.entry_samples.value_or(kDefaultEntrySamples)) *
         (kEntrySample + kSecondsOfShadowRay * lighting.lights);
}

std::string DirectMethod::bounces_stage() const {
  return "bounces: light between shapes, by a path from each point of entry";
}

std::string DirectMethod::shading_stage(const Scene& scene) const {
  const Settings& settings = scene.settings;
  if (settings.until_error)
    return fmt::format("direct, until the noise is {:.3g} %", 100 * *settings.until_error);
  const std::size_t wanted = settings.entry_samples.value_or(kDefaultEntrySamples),
                    pass = entry_samples_per_pass(scene.film);
  return fmt::format("direct, {} entry samples per pixel", (wanted + pass - 1) / pass * pass);
}

std::optional<RenderResult> DirectMethod::render_image(const PrecomputeInput& input) const {
  DirectState state;
  return render_direct(input, state).picture;
}

}  // namespace opaline
