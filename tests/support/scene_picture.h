// SPDX-License-Identifier: GPL-3.0-or-later
// From the text of a scene file to its picture, by any method.
#pragma once

#include <string>
#include <vector>

#include "core/scratch_folder.h"
#include "opaline/render/direct.h"
#include "opaline/scene/load_scene.h"
#include "opaline/session/session.h"

namespace opaline::test {

/// The picture of a scene file in the folder.
inline Image picture_of(const ScratchFolder& folder, const std::string& text,
                        const std::vector<std::string>& overrides = {}) {
  Session session;
  session.edit(parse_scene(text, folder.file("scene.json"), overrides));
  session.prepare();
  if (session.scene().settings.method != Method::direct) return session.render().image;
  DirectState state;
  return render_direct({session.scene(), session.world(), session.rays(), session.plan()}, state)
      .picture.image;
}

}  // namespace opaline::test
