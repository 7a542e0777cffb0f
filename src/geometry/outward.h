// SPDX-License-Identifier: GPL-3.0-or-later
// Detection of inward-wound parts of a mesh.
#pragma once

#include <vector>

#include "geometry/mesh_parts.h"

namespace opaline {

enum class Inward : unsigned char {
  no,
  by_volume,           ///< a closed part
  by_normals,          ///< an open part opposite to its normals
  by_volume_if_closed  ///< an open part of negative volume after closing its holes
};

/// Classifies parts with inward winding by the reason. A closed part faces outward if its volume is positive.
/// An inward part inside another part is a cavity and keeps its winding, unless the outermost part around it
/// is flipped: both are then. An open part with holes below a quarter of its area counts as closed. A wider
/// open part follows its normals if they agree, otherwise its volume, except for flat and shallow sheets, which
/// have no inside, and parts intersecting other such parts. The remaining parts follow their common volume if they
/// nearly close together. Undecided parts keep their winding.
std::vector<Inward> inward_parts(const WoundMesh& mesh, const MeshParts& parts);

}  // namespace opaline
