// SPDX-License-Identifier: GPL-3.0-or-later
// All public headers: scenes, sessions, images and their files, comparison of images.
#pragma once

#include "opaline/compare.h"
#include "opaline/error.h"
#include "opaline/image.h"
#include "opaline/monitor.h"
#include "opaline/scene.h"
#include "opaline/session.h"
