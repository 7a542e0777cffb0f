// SPDX-License-Identifier: GPL-3.0-or-later
// A session with the records that it gives access to, for the program and its tests.
#pragma once

#include "opaline/core/stopwatch.h"
#include "opaline/geometry/ray_scene.h"
#include "opaline/geometry/world.h"
#include "opaline/render/plan.h"
#include "opaline/render/precompute.h"
#include "opaline/render/render.h"
#include "opaline/session/session.h"
#include "opaline/session/session_work.h"
#include "opaline/session/stage_cache.h"
