// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/fields/volume_field.h"

#include <array>
#include <cmath>

namespace opaline {
namespace {

/// Hits that lie close together: of 4 x 4 pixels of a tile of 16 x 16, whose rays go row by row.
std::array<std::vector<std::uint32_t>, 16> blocks_of(const SurfaceHits& hits) {
  std::array<std::vector<std::uint32_t>, 16> blocks;
  for (std::uint32_t i = 0; i < hits.rays.size(); ++i)
    blocks[hits.rays[i] / 64 % 4 * 4 + hits.rays[i] / 4 % 4].push_back(i);
  return blocks;
}

}  // namespace

LeavingLight VolumeField::at(const SurfaceHits& hits, PointIrradianceInput, const Pass&,
                             HeldView::Surface*) const {
  LeavingLight light;
  light.exitance.resize(hits.points.size());
  light.error.resize(hits.points.size());
  CellFit::Reader reader(*body_.volume_fit);
  std::vector<Vec3f> positions;
  for (const std::vector<std::uint32_t>& block : blocks_of(hits)) {
    positions.clear();
    for (const std::uint32_t hit : block) positions.push_back(hits.points[hit].position);
    reader.expect(positions);
    for (const std::uint32_t hit : block) {
      const SurfacePoint& point = hits.points[hit];
      const CellFit::Value found = reader.at(point.position, point.normal);
      light.exitance[hit] = found.value;
      for (std::size_t c = 0; c < 3; ++c) {
        const double noise = double(found.noise[c]), shape = double(found.shape[c]);
        light.error[hit][c] = float(std::sqrt(noise * noise + shape * shape));
      }
    }
  }
  return light;
}

}  // namespace opaline
