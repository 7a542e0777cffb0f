// SPDX-License-Identifier: GPL-3.0-or-later
#include "subsurface/held_view.h"

#include "irradiance/irradiance_lattice.h"

namespace opaline {
namespace {

template <class Visit>
void visit_gathered(HeldView::Batch& batch, const Visit& visit);

template <class Visit>
void visit_gathering(HeldView::Gathering& gathering, const Visit& visit) {
  for (HeldView::Gathered& part : gathering.parts) {
    visit_gathered(part.seen, visit);  // further bounces
    visit(part);
  }
}

template <class Visit>
void visit_gathered(HeldView::Batch& batch, const Visit& visit) {
  for (HeldView::Surface& surface : batch.surfaces) {
    if (surface.gathering != nullptr) visit_gathering(*surface.gathering, visit);
    if (surface.coat != nullptr) visit_gathered(surface.coat->seen, visit);
  }
}

/// Calls visit(gathered) for all gathered hits.
template <class Visit>
void visit_gathered(HeldView& view, const Visit& visit) {
  for (std::vector<HeldView::Batch>& tile : view.tiles)
    for (HeldView::Batch& batch : tile) visit_gathered(batch, visit);
  for (auto* lists : {&view.at_places, &view.at_samples})
    for (std::vector<HeldView::Gathering>& list : *lists)
      for (HeldView::Gathering& gathering : list) visit_gathering(gathering, visit);
}

/// Calls visit(batch) for camera hits and gathered hits, but not for hits of specular reflections.
template <class Visit>
void visit_batches(HeldView& view, const Visit& visit) {
  for (std::vector<HeldView::Batch>& tile : view.tiles)
    for (HeldView::Batch& batch : tile) visit(batch);
  visit_gathered(view, [&](HeldView::Gathered& gathered) { visit(gathered.seen); });
}

}  // namespace

void HeldView::forget_camera() {
  for (std::vector<Batch>& tile : tiles)
    for (Batch& batch : tile) {  // keeps its memory for the next camera
      batch.is_traced = false;
      batch.hits.clear();
      batch.points.clear();
      batch.surfaces.clear();
    }
  at_places.clear();
  *coat_bytes = 0;
}

void HeldView::forget_surfaces() {
  at_places.clear();  // textures bend normals there
  visit_batches(*this, [](Batch& batch) { batch.surfaces.clear(); });
  *coat_bytes = 0;
}

void HeldView::forget_coats() {
  for (std::vector<Batch>& tile : tiles)
    for (Batch& batch : tile)
      for (Surface& surface : batch.surfaces) surface.coat.reset();
  *coat_bytes = 0;
}

void HeldView::set_fields(const std::vector<std::size_t>& of_mesh,
                          const std::vector<OuterBoundary>& boundaries) {
  if (of_mesh == field_of_mesh && boundaries == boundary_of_field) return;
  forget_coats();  // they contain light of the other surfaces
  if (of_mesh != field_of_mesh || boundaries.size() != boundary_of_field.size()) {
    forget_surfaces();
  } else {
    visit_batches(*this, [&](Batch& batch) {
      for (std::size_t f = 0; f < batch.surfaces.size(); ++f)
        if (boundaries[f] != boundary_of_field[f]) batch.surfaces[f] = {};
    });
  }
  field_of_mesh = of_mesh;
  boundary_of_field = boundaries;
}

void HeldView::set_lights(std::span<const std::optional<std::size_t>> before) {
  forget_coats();
  visit_batches(*this, [&](Batch& batch) {
    for (Surface& surface : batch.surfaces) set_held_lights(surface.lights, before);
  });
  for (const std::shared_ptr<IrradianceLattice>& lattice : lattices)
    if (lattice != nullptr) lattice->set_lights(before);
}

void HeldView::count_gathered() {
  std::size_t sum = 0;
  visit_gathered(*this, [&](const Gathered& gathered) { sum += gathered.bytes(); });
  *gathered_bytes = sum;
}

void HeldView::next_picture() {
  for (const std::shared_ptr<IrradianceLattice>& lattice : lattices)
    if (lattice != nullptr) lattice->next_picture();
}

}  // namespace opaline
