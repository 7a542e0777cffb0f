// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/memory_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/machine_memory.h"
#include "core/units.h"
#include "opaline/error.h"
#include "render/layers.h"
#include "render/render.h"
#include "subsurface/method.h"

namespace opaline {

void check_memory(const Scene& scene, const Plan& plan, std::size_t more_bytes) {
  // The whole picture has to have an address, empty parts of it as well.
  const Rectangle part = rendered_part(scene.film);
  const std::size_t picture = std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0) *
                              layer_names(method_of(scene.settings.method).layers()).size() * sizeof(float);
  const std::size_t bytes = std::max(plan.bytes + more_bytes, picture), taken = resident_memory(),
                    left = available_memory();
  if (bytes <= taken || bytes - taken <= left) return;
  std::string advice = "a lower film.resolution, or rendering in parts with --crop,";
  if (method_of(scene.settings.method).needs_samples() && !plan.groups.empty())
    advice += " or a lower settings.max_samples";
  throw run_failed({},
                   fmt::format("out of memory: the image needs about {}, and {} are available; {} needs less",
                               short_bytes(bytes), short_bytes(left + taken), advice));
}

}  // namespace opaline
