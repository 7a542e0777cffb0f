// SPDX-License-Identifier: GPL-3.0-or-later
// Which parts of a mesh are wound inward.
#pragma once

#include <vector>

#include "geometry/mesh_parts.h"

namespace opaline {

enum class Inward : unsigned char {
  no,
  by_volume,           ///< a closed part
  by_normals,          ///< an open part, wound against its normals
  by_volume_if_closed  ///< an open part whose volume is negative once its holes are closed
};

/// For each part whether its winding has to be turned, and why.
/// A closed part is wound outward if its volume is positive. One wound inward inside another part is a cavity and
/// stays, unless the outermost part around it is turned: then it is turned with it. An open part whose holes have less
/// than a quarter of its area counts as closed. A part that is wider open goes by its normals where they agree, else by
/// its volume, unless it is a sheet, which has no inside, or meets other such parts. All parts that are left go by their
/// common volume if together they nearly close. A part that nothing decides stays.
std::vector<Inward> inward_parts(const WoundMesh& mesh, const MeshParts& parts);

}  // namespace opaline
