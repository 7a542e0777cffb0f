// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/memory_check.h"

#include <fmt/format.h>

#include "opaline/core/error.h"
#include "opaline/core/machine_memory.h"
#include "opaline/core/units.h"

namespace opaline {

void check_memory(const Scene& scene, const Plan& plan, std::size_t more_bytes) {
  const std::size_t bytes = plan.bytes + more_bytes, taken = resident_memory(), left = available_memory();
  if (bytes <= taken || bytes - taken <= left) return;
  std::string advice = "a lower film.resolution, or --crop for one part after the other,";
  if (has_samples(scene.settings.method) && !plan.groups.empty())
    advice += " or a lower settings.max_samples";
  throw run_failed({},
                   fmt::format("out of memory: the picture needs about {}, and there are {}; {} takes less",
                               short_bytes(bytes), short_bytes(left + taken), advice));
}

}  // namespace opaline
