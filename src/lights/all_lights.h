// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of light, with the functions listed in light_kind.h.
#pragma once

#include "lights/directional_light.h"
#include "lights/environment_light.h"
#include "lights/many_lights.h"
#include "lights/point_light.h"
#include "lights/quad_light.h"
#include "lights/shape_light.h"
#include "lights/sphere_light.h"
#include "lights/spot_light.h"
#include "lights/surroundings.h"
