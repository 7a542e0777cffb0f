// SPDX-License-Identifier: GPL-3.0-or-later
// The library: a Scene, a Session that renders it, images and their files, comparison of images.
#pragma once

#include "opaline/core/error.h"
#include "opaline/core/monitor.h"
#include "opaline/image/image.h"
#include "opaline/image/metrics.h"
#include "opaline/scene/scene.h"
#include "opaline/session/session.h"
