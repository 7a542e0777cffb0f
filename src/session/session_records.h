// SPDX-License-Identifier: GPL-3.0-or-later
// A session and the definitions of its internal records, for the program and its tests.
#pragma once

#include "bodies/body.h"
#include "bodies/plan.h"
#include "core/stopwatch.h"
#include "geometry/ray_scene.h"
#include "geometry/world.h"
#include "opaline/session.h"
#include "render/render.h"
#include "stages/session_work.h"
#include "stages/stage_cache.h"
