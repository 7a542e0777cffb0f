// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/outward.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace opaline {
namespace {

using Kind = MeshParts::Kind;

constexpr double kMostHoles = 0.25;  // largest area of holes over a part's area for it to count as closed
// Length of the area vector over the area: 0 if closed, 1 if flat, 0.85 for a spherical cap of 45 degrees.
constexpr double kCurved = 0.6, kSheet = 0.85;
constexpr double kLeastVolume = 1e-6;  // over area times diagonal: below, an open part is flat
// Least volume over magnitudes of an open part with an inside: below kCurved, and from there to kSheet, where
// uneven patches of an outward surface may have a negative volume.
constexpr double kLeastOneSided = 0.1, kLeastOneSidedIfFlat = 0.5;
constexpr double kLeastAgreement = 0.9;  // least area with agreeing normals, over that with usable normals
constexpr double kLeastNormals = 0.1;    // area with usable normals, over the whole

enum class Shape : unsigned char { none, sheet, wide, solid };  // none: not tested

bool meets(const Bounds& a, const Bounds& b) {
  return component_max(a.low, b.low) ==
         component_min(component_max(a.low, b.low), component_min(a.high, b.high));
}

bool encloses(const Bounds& outer, const Bounds& inner) {
  return component_min(outer.low, inner.low) == outer.low &&
         component_max(outer.high, inner.high) == outer.high;
}

class Chooser {
 public:
  Chooser(const WoundMesh& mesh, const MeshParts& parts)
      : parts_(parts), measured_(mesh, parts), result_(parts.kinds.size()), around_(parts.kinds.size()) {
    for (std::uint32_t i = 0; i < result_.size(); ++i) shapes_.push_back(shape(i));
  }

  std::vector<Inward> run() {
    if (!any_doubt()) return std::move(result_);
    order_by_box();
    find_outermost();
    find_crowded();
    for (std::uint32_t i = 0; i < result_.size(); ++i)
      if (around_[i] == i && shapes_[i] != Shape::none) decide_alone(i);
    for (std::uint32_t i = 0; i < result_.size(); ++i)
      if (around_[i] != i) decide_inside(i);
    decide_together();
    return std::move(result_);
  }

 private:
  Shape shape(std::uint32_t i) const {
    const PartMeasures& m = measured_[i];
    if (parts_.kinds[i] == Kind::ignored) return Shape::none;
    if (parts_.kinds[i] == Kind::closed)  // a flat double sheet has no outside
      return std::abs(m.volume) <= 1e-12 * m.magnitudes ? Shape::none : Shape::solid;
    if (std::abs(m.volume) <= kLeastVolume * m.area * length(m.box.high - m.box.low)) return Shape::sheet;
    if (m.hole_area < kMostHoles * m.area) return Shape::solid;
    const double flatness = length(m.area_vector) / m.area;
    const double least = flatness < kCurved ? kLeastOneSided : kLeastOneSidedIfFlat;
    return flatness >= kSheet || std::abs(m.volume) < least * m.magnitudes ? Shape::sheet : Shape::wide;
  }

  /// Agreement of a part with its normals: 1, or -1 if opposite; 0 without normals.
  int agreement(std::uint32_t i) const {
    const PartMeasures& m = measured_[i];
    const double sum = m.area_for_normals + m.area_against_normals;
    if (parts_.kinds[i] != Kind::open || sum < kLeastNormals * m.area) return 0;
    if (m.area_for_normals >= kLeastAgreement * sum) return 1;
    return m.area_against_normals >= kLeastAgreement * sum ? -1 : 0;
  }

  /// True if normals are inconclusive: the part may be a piece of a surface.
  bool is_piece(std::uint32_t i) const {
    return (shapes_[i] == Shape::sheet || shapes_[i] == Shape::wide) && agreement(i) == 0;
  }

  bool any_doubt() const {
    std::size_t pieces = 0;
    for (std::uint32_t i = 0; i < result_.size(); ++i) {
      if (shapes_[i] != Shape::none && (measured_[i].volume < 0 || agreement(i) < 0)) return true;
      pieces += is_piece(i);
    }
    return pieces > 1;
  }

  /// Sorts along the longest axis of the mesh.
  void order_by_box() {
    Bounds all;
    for (std::uint32_t i = 0; i < result_.size(); ++i) {
      if (shapes_[i] == Shape::none) continue;
      by_box_.push_back(i);
      all.low = component_min(all.low, measured_[i].box.low);
      all.high = component_max(all.high, measured_[i].box.high);
    }
    const Vec3d size = all.high - all.low;
    axis_ = size.x == max_component(size) ? 0 : size.y == max_component(size) ? 1 : 2;
    std::ranges::stable_sort(by_box_, {}, [&](std::uint32_t i) {
      return std::pair(measured_[i].box.low[axis_], -std::abs(measured_[i].volume));
    });
  }

  /// visit(part, earlier parts with possibly intersecting boxes), in the order of their lower ends
  template <class Visitor>
  void sweep(Visitor visit) {
    std::vector<std::uint32_t> before;
    for (const std::uint32_t i : by_box_) {
      std::erase_if(before, [&](std::uint32_t j) {
        return measured_[j].box.high[axis_] < measured_[i].box.low[axis_];
      });
      visit(i, std::as_const(before));
      before.push_back(i);
    }
  }

  /// around_: the largest part around each one, or itself.
  void find_outermost() {
    std::iota(around_.begin(), around_.end(), 0u);
    sweep([&](std::uint32_t inner, const std::vector<std::uint32_t>& before) {
      for (const std::uint32_t outer : before) {
        const bool may_contain = shapes_[outer] == Shape::solid
                                     ? shapes_[inner] != Shape::sheet
                                     : shapes_[outer] == Shape::wide && shapes_[inner] == Shape::wide;
        if (may_contain && encloses(measured_[outer].box, measured_[inner].box) &&
            std::abs(measured_[outer].volume) > std::abs(measured_[around_[inner]].volume) &&
            measured_.contains(outer, inner))
          around_[inner] = outer;
      }
    });
  }

  /// Wide open parts and sheets without conclusive normals may be pieces of one surface, if their boxes
  /// intersect.
  void find_crowded() {
    crowded_.resize(result_.size());
    sweep([&](std::uint32_t i, const std::vector<std::uint32_t>& before) {
      if (around_[i] != i || !is_piece(i)) return;
      for (const std::uint32_t j : before) {
        if ((crowded_[i] && crowded_[j]) || around_[j] != j || !is_piece(j) ||
            !meets(measured_[i].box, measured_[j].box))
          continue;
        crowded_[i] = crowded_[j] = true;
      }
    });
  }

  void decide_alone(std::uint32_t i) {
    if (shapes_[i] == Shape::solid) {
      if (measured_[i].volume < 0)
        result_[i] = parts_.kinds[i] == Kind::closed ? Inward::by_volume : Inward::by_volume_if_closed;
    } else if (agreement(i) != 0) {
      if (agreement(i) < 0) result_[i] = Inward::by_normals;
    } else if (shapes_[i] == Shape::wide && !crowded_[i]) {
      if (measured_[i].volume < 0) result_[i] = Inward::by_volume_if_closed;
    } else {
      pieces_.push_back(i);
    }
  }

  void decide_inside(std::uint32_t i) {
    if (agreement(i) != 0)
      result_[i] = agreement(i) < 0 ? Inward::by_normals : Inward::no;
    else if (result_[around_[i]] != Inward::no)
      result_[i] = parts_.kinds[i] == Kind::closed ? Inward::by_volume : Inward::by_volume_if_closed;
  }

  /// Pieces of one surface with cracks between them.
  void decide_together() {
    if (pieces_.size() < 2) return;
    const PartMeasures common = measured_.common_measures(pieces_);
    constexpr double kLeastCommon = 0.5;  // volume over magnitudes
    if (length(common.area_vector) >= kMostHoles * common.area ||
        !(-common.volume > kLeastCommon * common.magnitudes))
      return;
    for (const std::uint32_t i : pieces_) result_[i] = Inward::by_volume_if_closed;
  }

  const MeshParts& parts_;
  MeasuredParts measured_;
  std::vector<Inward> result_;
  std::vector<Shape> shapes_;
  std::vector<std::uint32_t> around_, by_box_, pieces_;
  std::vector<bool> crowded_;
  std::size_t axis_ = 0;
};

}  // namespace

std::vector<Inward> inward_parts(const WoundMesh& mesh, const MeshParts& parts) {
  return Chooser(mesh, parts).run();
}

}  // namespace opaline
