// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/render/held_view.h"

#include "render/irradiance_lattice.h"

namespace opaline {

void set_held_lights(std::vector<PointTransfers>& lights,
                     std::span<const std::optional<std::size_t>> before) {
  std::vector<PointTransfers> now(before.size());
  for (std::size_t l = 0; l < before.size(); ++l)
    if (before[l] && *before[l] < lights.size()) now[l] = std::move(lights[*before[l]]);
  lights = std::move(now);
}

void HeldView::set_fields(const std::vector<std::size_t>& of_mesh, const std::vector<float>& eta) {
  if (of_mesh == field_of_mesh && eta == eta_of_field) return;
  forget_coats();  // which mirror the others
  if (of_mesh != field_of_mesh || eta.size() != eta_of_field.size()) {
    forget_surfaces();
  } else {
    for (std::vector<Batch>& tile : tiles)
      for (Batch& batch : tile)
        for (std::size_t f = 0; f < batch.surfaces.size(); ++f)
          if (eta[f] != eta_of_field[f]) batch.surfaces[f] = {};
  }
  field_of_mesh = of_mesh;
  eta_of_field = eta;
}

void HeldView::set_lights(std::span<const std::optional<std::size_t>> before) {
  forget_coats();
  for (std::vector<Batch>& tile : tiles)
    for (Batch& batch : tile)
      for (Surface& surface : batch.surfaces) set_held_lights(surface.lights, before);
  for (const std::shared_ptr<IrradianceLattice>& lattice : lattices)
    if (lattice != nullptr) lattice->set_lights(before);
}

void HeldView::next_picture() {
  for (const std::shared_ptr<IrradianceLattice>& lattice : lattices)
    if (lattice != nullptr) lattice->next_picture();
}

}  // namespace opaline
