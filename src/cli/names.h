// SPDX-License-Identifier: GPL-3.0-or-later
// Scene values by the words a scene file uses.
#pragma once

#include "opaline/scene/scene.h"

namespace opaline {

const char* name_of(Method method);
const char* name_of(EvaluatorKind evaluator);
const char* name_of(EntryStrategy strategy);
const char* name_of(PixelFilter filter);
const char* name_of(const LightSource& source);

}  // namespace opaline
