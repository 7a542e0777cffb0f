// SPDX-License-Identifier: GPL-3.0-or-later
// How much of a body's light its kernel carries across the air.
#pragma once

#include "bodies/plan.h"

namespace opaline {

/// A kernel knows distances alone, and so light gets from one part of a body to another facing it, ear to back, without
/// having left the body. Of what it carries in even light the share that does, in the channel where that is largest: between
/// places whose chord lies outside at both ends. Chords that begin and end inside and cross the air between are not counted:
/// a lower bound.
/// out   [0, 1]; 0 for a convex body, and by a method without a kernel. Some .01 off, for it asks few places
double share_across_air(const Scene& scene, const World& world, const GroupPlan& group);

}  // namespace opaline
