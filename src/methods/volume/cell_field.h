// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance of means over the samples' cells.
#pragma once

#include <memory>
#include <vector>

#include "subsurface/field.h"
#include "subsurface/render_input.h"
#include "volume/cell_fit.h"

namespace opaline {

/// Means over the cells of a surface.
struct CellMeans {
  std::shared_ptr<const NearestSample> cells;
  std::vector<RgbF> values;  ///< one per cell
};

class CellField : public Field {
 public:
  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  OuterBoundary boundary() const override { return body_.boundary; }
  bool asks_irradiance() const override { return local_ != RgbF{}; }
  bool reflects() const override { return asks_irradiance(); }

 protected:
  /// local: diffuse reflectance of channels without a mean free path, which is below the resolution of cells;
  /// 0 in the others. All must outlive the field.
  CellField(const RenderInput& input, const Body& body, const RgbF& local);

 private:
  /// out   light: exitance of the cells and its error, one entry per hit
  virtual void read_cells(const SurfaceHits& hits, HeldView::Surface* held, LeavingLight& light) const = 0;
  void add_local(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                 HeldView::Surface* held, LeavingLight& light) const;

  const Body& body_;
  RgbF local_;
  bool is_noisy_;
  int samples_per_pixel_;
};

/// Interpolated between the cells.
class FittedCellField : public CellField {
 public:
  FittedCellField(const RenderInput& input, const Body& body, const CellFit& fit, const RgbF& local)
      : CellField(input, body, local), fit_(fit) {}

 private:
  /// The error is the sum of the means' noise and the interpolation error.
  void read_cells(const SurfaceHits& hits, HeldView::Surface* held, LeavingLight& light) const override;

  const CellFit& fit_;
};

/// Mean of the nearest cell, for gathered rays: the interpolated field has the same sum over a cell's hits.
/// Without errors.
class NearestCellField : public CellField {
 public:
  NearestCellField(const RenderInput& input, const Body& body, const CellMeans& means, const RgbF& local)
      : CellField(input, body, local), means_(means) {}

 private:
  void read_cells(const SurfaceHits& hits, HeldView::Surface* held, LeavingLight& light) const override;

  const CellMeans& means_;
};

}  // namespace opaline
