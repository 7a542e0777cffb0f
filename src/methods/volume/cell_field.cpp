// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/volume/cell_field.h"

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "render/fields/make_fields.h"

namespace opaline {
namespace {

constexpr std::size_t kBlocks = 16;

/// Block of 4 x 4 pixels in a tile of 16 x 16, with rays row by row: its hits are close together.
std::size_t block_of(std::uint32_t ray) {
  return ray / 64 % 4 * 4 + ray / 4 % 4;
}

struct Blocks {
  std::vector<std::uint32_t> hits;               ///< block by block
  std::array<std::size_t, kBlocks + 1> first{};  ///< first hit of each block
};

Blocks blocks_of(const SurfaceHits& hits) {
  Blocks blocks;
  blocks.hits.resize(hits.rays.size());
  for (const std::uint32_t ray : hits.rays) ++blocks.first[block_of(ray) + 1];
  for (std::size_t b = 1; b <= kBlocks; ++b) blocks.first[b] += blocks.first[b - 1];
  auto next = blocks.first;
  for (std::uint32_t i = 0; i < hits.rays.size(); ++i) blocks.hits[next[block_of(hits.rays[i])]++] = i;
  return blocks;
}

}  // namespace

CellField::CellField(const RenderInput& input, const Body& body, const RgbF& local)
    : body_(body),
      local_(local),
      is_noisy_(has_area_lights(input.scene)),
      samples_per_pixel_(input.scene.film.samples_per_pixel) {}

void CellField::add_local(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                          HeldView::Surface* held, LeavingLight& light) const {
  if (is_noisy_) light.noise.resize(hits.points.size());
  lighting.variance = light.noise;
  light.irradiance = irradiance_at_hits(lighting, pass.is_seen ? samples_per_pixel_ : 1, held);
  tint_entering(hits.textures, light.irradiance, light.noise);
  for (std::size_t i = 0; i < hits.points.size(); ++i) {
    light.exitance[i] += local_ * light.irradiance[i];
    if (is_noisy_) light.noise[i] = light.noise[i] * Rgb(local_ * local_);
  }
}

LeavingLight CellField::at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                           HeldView::Surface* held) const {
  LeavingLight light;
  light.exitance.resize(hits.points.size());
  light.error.resize(hits.points.size());
  read_cells(hits, held, light);
  if (local_ != RgbF{}) add_local(hits, lighting, pass, held, light);
  return light;
}

void FittedCellField::read_cells(const SurfaceHits& hits, HeldView::Surface*, LeavingLight& light) const {
  CellFit::Reader reader(fit_);
  std::vector<Vec3f> positions;
  const Blocks blocks = blocks_of(hits);
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const auto block = std::span(blocks.hits).subspan(blocks.first[b], blocks.first[b + 1] - blocks.first[b]);
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
}

void NearestCellField::read_cells(const SurfaceHits& hits, HeldView::Surface* held,
                                  LeavingLight& light) const {
  HeldView::Surface own;
  HeldView::Surface& found = held != nullptr ? *held : own;
  if (found.cells != means_.cells) {
    found.nearest.clear();
    for (const SurfacePoint& point : hits.points)
      found.nearest.push_back(means_.cells->at(point.position, point.normal));
    found.cells = means_.cells;
  }
  for (std::size_t i = 0; i < hits.points.size(); ++i) light.exitance[i] = means_.values[found.nearest[i]];
}

}  // namespace opaline
