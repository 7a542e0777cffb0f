// SPDX-License-Identifier: GPL-3.0-or-later
// The charts of `opaline profile`, each of one channel.
#pragma once

#include "benchmark/plot.h"
#include "benchmark/profile_report.h"

namespace opaline {

/// R_d(r) in 1/mm^2 on the entry face, or on the far one of a slab.
Plot profile_plot(const ProfileReport& report, const ProfiledChannel& channel, bool is_far);

/// Each model over the walks in diffuse light, ring by ring.
Plot ratio_plot(const ProfileReport& report, const ProfiledChannel& channel);

/// What comes back of light that entered at an angle.
Plot entry_plot(const ProfileReport& report, const ProfiledChannel& channel);

/// Radiance by angle of exit over a Lambert emitter's.
Plot exit_plot(const ProfileReport& report, const ProfiledChannel& channel);

/// Diffusion's fluence around a point source in an endless medium over the exact one.
Plot point_source_plot(const ProfiledChannel& channel);

}  // namespace opaline
