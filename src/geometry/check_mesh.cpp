// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/check_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "geometry/orient.h"
#include "geometry/repair_mesh.h"
#include "geometry/topology.h"
#include "geometry/vertex_normals.h"
#include "opaline/error.h"

namespace opaline {
namespace {

class MeshChecker {
 public:
  MeshChecker(SourceMesh source, const CheckSettings& settings, CheckMemory* memory)
      : settings_(settings), source_(std::move(source)), memory_(memory) {}

  CheckedMesh run() {
    origins_.resize(std::max({source_.uvs.size(), source_.tangents.size(), source_.colors.size(),
                              source_.smoothing.groups.size()}));
    for (std::size_t t = 0; t < origins_.size(); ++t) origins_[t] = std::uint32_t(2 * t);
    const std::vector<Vec3d>& p = source_.positions;
    if (std::ranges::all_of(source_.triangles,
                            [&](const Triangle& t) { return is_sliver(p[t[0]], p[t[1]], p[t[2]]); }))
      throw without_area(source_.triangles.size() + source_.collapsed);  // its parts take time
    find_same_vertices();
    if (!recall()) {
      start_memory();
      merge_vertices();
      drop_collapsed();
      mend_winding_and_holes();
      finish_memory();
    }
    for (std::string& text : report_.warnings) text = settings_.name + ": " + text;
    report_.warnings.insert(report_.warnings.begin(), source_.warnings.begin(), source_.warnings.end());
    report_.zero_area_dropped += source_.collapsed;
    drop_slivers();
    if (source_.triangles.empty()) throw without_area(report_.zero_area_dropped);
    warn_about_drops();
    CheckedMesh checked;
    checked.mesh = compacted();
    const bool is_faceted = checked.mesh.normals.empty() && source_.smoothing.is_nowhere();
    if (settings_.smooth && !is_faceted)
      complete_normals(checked.mesh, mended_smoothing(), settings_.name, report_.warnings);
    checked.report = std::move(report_);
    return checked;
  }

 private:
  Error without_area(std::size_t dropped) const {
    return bad_file(settings_.name, "the mesh has no area", "at least one triangle with nonzero area",
                    std::to_string(dropped) + " with zero area");
  }

  /// Warnings lack the mesh's name until all are known.
  void warn(std::string text) { report_.warnings.push_back(std::move(text)); }

  /// Sets site_: the first vertex at the same position, defining neighbourhood. Vertices of the mesh are
  /// distinct only if their normals differ.
  void find_same_vertices() {
    for (Vec3f& n : source_.normals)
      if (!is_finite(n)) n = {};
    if (!settings_.smooth) facet_normals_ = std::exchange(source_.normals, {});
    same_ = weld(source_.positions, source_.normals);
    site_ = source_.normals.empty() ? same_ : weld(source_.positions);
  }

  void merge_vertices() {
    for (Triangle& triangle : source_.triangles)
      for (std::uint32_t& v : triangle) v = same_[v];
  }

  /// Reuses the results of an earlier check if they still apply.
  bool recall() {
    if (memory_ == nullptr || !memory_->holds || memory_->fill_holes != settings_.fill_holes ||
        memory_->same != same_ || memory_->site != site_ || memory_->has_inside != settings_.has_inside ||
        memory_->given != source_.triangles || memory_->origins.empty() != origins_.empty() ||
        would_turn(memory_->mended, memory_->parts))
      return false;
    memory_->recalled = true;
    source_.triangles = memory_->mended;
    origins_ = memory_->origins;
    report_ = memory_->report;
    return true;
  }

  const std::vector<Vec3f>& normals() const { return settings_.smooth ? source_.normals : facet_normals_; }

  bool would_turn(const std::vector<Triangle>& triangles, const MeshParts& parts) const {
    const std::vector<Inward> inward = inward_parts({source_.positions, triangles, normals()}, parts);
    return std::ranges::any_of(inward, [](Inward reason) { return reason != Inward::no; });
  }

  void start_memory() {
    if (memory_ == nullptr) return;
    *memory_ = {};
    memory_->given = source_.triangles;
  }

  /// Meshes with filled holes or inward parts are checked again each time, as both depend on positions.
  void finish_memory() {
    if (memory_ == nullptr) return;
    memory_->holds = !places_matter_;
    if (places_matter_) return;
    memory_->fill_holes = settings_.fill_holes;
    memory_->has_inside = settings_.has_inside;
    memory_->same = std::move(same_);
    memory_->site = std::move(site_);
    memory_->mended = source_.triangles;
    memory_->origins = origins_;
    memory_->report = report_;
  }

  Triangle sites(const Triangle& t) const { return {site_[t[0]], site_[t[1]], site_[t[2]]}; }

  std::vector<Triangle> all_sites() const {
    std::vector<Triangle> triangles;
    triangles.reserve(source_.triangles.size());
    for (const Triangle& t : source_.triangles) triangles.push_back(sites(t));
    return triangles;
  }

  /// Removes the triangles with drop(index) true; returns their number.
  template <class Predicate>
  std::size_t drop_triangles(Predicate drop) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < source_.triangles.size(); ++t) {
      if (drop(t)) continue;
      if (!origins_.empty()) origins_[kept] = origins_[t];
      source_.triangles[kept++] = source_.triangles[t];
    }
    if (!origins_.empty()) origins_.resize(kept);
    const std::size_t dropped = source_.triangles.size() - kept;
    source_.triangles.resize(kept);
    return dropped;
  }

  void drop_collapsed() {
    report_.zero_area_dropped += drop_triangles([&](std::size_t t) {
      const auto [a, b, c] = sites(source_.triangles[t]);
      return a == b || b == c || c == a;
    });
  }

  void mend_winding_and_holes() {
    std::vector<Triangle> triangles = all_sites();
    EdgeTable edges(triangles, source_.positions.size());
    const std::vector<bool> duplicate = find_duplicates(triangles, edges);
    report_.duplicates_dropped = drop_triangles([&](std::size_t t) { return duplicate[t]; });
    if (report_.duplicates_dropped > 0) {
      triangles = all_sites();
      edges = EdgeTable(triangles, source_.positions.size());
    }
    if (wants_filling(triangles, open_edges(edges))) {
      apply(find_winding(wound(), triangles, edges, false), false);
      fill(edges);
      places_matter_ = true;
      triangles = all_sites();
      edges = EdgeTable(triangles, source_.positions.size());
    }
    Winding winding = find_winding(wound(), triangles, edges, settings_.has_inside);
    apply(winding, true);
    count_edges(edges);
    for (const TurnedParts& turned : winding.turned) places_matter_ |= turned.parts > 0;
    if (memory_ != nullptr) memory_->parts = std::move(winding.parts);
  }

  bool wants_filling(const std::vector<Triangle>& sites, const std::vector<Edge>& open) {
    if (settings_.fill_holes == FillHoles::none || open.empty()) return false;
    if (settings_.fill_holes == FillHoles::all) return true;
    places_matter_ = true;
    return has_small_holes(source_.positions, sites, open);
  }

  WoundMesh wound() const { return {source_.positions, source_.triangles, normals()}; }

  static std::vector<Edge> open_edges(const EdgeTable& edges) {
    std::vector<Edge> open;
    edges.for_each([&](std::uint32_t low, std::uint32_t high, std::span<const std::uint32_t> corners) {
      if (corners.size() == 1) open.push_back({low, high});
    });
    return open;
  }

  void apply(const Winding& winding, bool final) {
    for (std::size_t t = 0; t < winding.flip.size(); ++t) {
      if (!winding.flip[t]) continue;
      std::swap(source_.triangles[t][1], source_.triangles[t][2]);
      if (!origins_.empty() && origins_[t] != kNew) origins_[t] ^= 1;
      ++report_.flipped;
    }
    if (winding.inconsistent > 0)
      warn(std::to_string(winding.inconsistent) +
           " triangles with winding opposite to their neighbours were flipped");
    const auto turned = [&](Inward reason) { return winding.turned[std::size_t(reason)]; };
    if (const TurnedParts closed = turned(Inward::by_volume); closed.parts > 0)
      warn(std::to_string(closed.triangles) + " triangles of closed parts with inward winding were flipped");
    warn_of_open(turned(Inward::by_normals), "against the file's normals");
    warn_of_open(turned(Inward::by_volume_if_closed), "by the volume with holes closed");
    if (final && winding.unorientable_edges > 0)
      warn("one-sided surface: no consistent winding for " + std::to_string(winding.unorientable_edges) +
           " edges");
  }

  void warn_of_open(const TurnedParts& turned, const char* reason) {
    if (turned.parts > 0)
      warn(std::to_string(turned.triangles) + " triangles of " + std::to_string(turned.parts) +
           (turned.parts == 1 ? " open part" : " open parts") + " wound inward, " + reason +
           ", were flipped");
  }

  double area_of(const std::vector<Triangle>& triangles) const {
    const std::vector<Vec3d>& p = source_.positions;
    double area = 0;
    for (const auto& [a, b, c] : triangles) area += 0.5 * length(cross(p[b] - p[a], p[c] - p[a]));
    return area;
  }

  void warn_of_filling(const HoleFilling& filling) {
    const bool is_default = settings_.fill_holes == FillHoles::if_small;
    warn(std::to_string(filling.filled) + (is_default ? " small" : "") +
         (filling.filled == 1 ? " hole, " : " holes, ") +
         short_percent(area_of(filling.triangles) / area_of(source_.triangles)) +
         " of the mesh's area, closed" + (is_default ? " (\"fill_holes\": false leaves them open)" : ""));
  }

  void fill(const EdgeTable& edges) {
    const HoleFilling filling =
        fill_holes(source_.positions, all_sites(), edges, settings_.fill_holes, settings_.has_inside);
    if (filling.filled > 0) warn_of_filling(filling);
    source_.triangles.insert(source_.triangles.end(), filling.triangles.begin(), filling.triangles.end());
    if (!origins_.empty()) origins_.resize(source_.triangles.size(), kNew);
    report_.holes_filled = filling.filled;
    report_.hole_triangles_added = filling.triangles.size();
    if (filling.unfilled.empty()) return;
    warn(std::to_string(filling.unfilled.size()) + " holes could not be filled; the largest has " +
         std::to_string(*std::max_element(filling.unfilled.begin(), filling.unfilled.end())) + " edges");
  }

  void count_edges(const EdgeTable& edges) {
    edges.for_each([&](std::uint32_t, std::uint32_t, std::span<const std::uint32_t> corners) {
      report_.open_edges += corners.size() == 1;
      report_.non_manifold_edges += corners.size() > 2;
    });
    if (report_.open_edges > 0 && settings_.has_inside)
      warn("open mesh: " + std::to_string(report_.open_edges) + " boundary edges; light can leak");
    if (report_.non_manifold_edges > 0)
      warn("non-manifold mesh: " + std::to_string(report_.non_manifold_edges) +
           " edges with more than two triangles; inside and outside are ambiguous there");
  }

  /// Runs last: a degenerate triangle still connects its neighbours.
  void drop_slivers() {
    const std::vector<Vec3d>& p = source_.positions;
    report_.zero_area_dropped += drop_triangles([&](std::size_t t) {
      const auto [a, b, c] = source_.triangles[t];
      return is_sliver(p[a], p[b], p[c]);
    });
  }

  void warn_about_drops() {
    const auto warn_of = [&](std::size_t count, const char* what) {
      if (count > 0) report_.warnings.push_back(settings_.name + ": " + std::to_string(count) + what);
    };
    warn_of(report_.zero_area_dropped, " triangles with zero area were removed");
    warn_of(report_.duplicates_dropped, " duplicate triangles were removed");
  }

  /// Corner data of the remaining triangles; those filling holes have none. given: data of the source, or
  /// empty
  template <class Corners>
  std::vector<Corners> mended(const std::vector<Corners>& given) const {
    std::vector<Corners> corners;
    if (given.empty()) return corners;
    corners.reserve(origins_.size());
    for (const std::uint32_t origin : origins_) {
      corners.push_back(origin == kNew ? Corners{} : given[origin / 2]);
      if (origin != kNew && origin % 2 == 1) std::swap(corners.back()[1], corners.back()[2]);
    }
    return corners;
  }

  /// Triangles filling holes are in no group.
  Smoothing mended_smoothing() const {
    Smoothing smoothing{{}, source_.smoothing.crease_angle};
    if (source_.smoothing.groups.empty()) return smoothing;
    smoothing.groups.reserve(origins_.size());
    for (const std::uint32_t origin : origins_)
      smoothing.groups.push_back(origin == kNew ? 0 : source_.smoothing.groups[origin / 2]);
    return smoothing;
  }

  /// White where holes are filled.
  std::vector<CornerColors> mended_colors() const {
    std::vector<CornerColors> colors = mended(source_.colors);
    for (std::size_t t = 0; t < colors.size(); ++t)
      if (origins_[t] == kNew) colors[t].fill(RgbF(1));
    return colors;
  }

  std::vector<CornerUvs> mended_uvs() const {
    std::vector<CornerUvs> uvs = mended(source_.uvs);
    constexpr float farthest = 1e6f;
    for (CornerUvs& corners : uvs)
      for (auto& corner : corners)
        for (float& value : corner)
          if (!(std::abs(value) < farthest)) value = 0;
    return uvs;
  }

  /// The mesh with only the vertices its triangles use, in their order.
  Mesh compacted() {
    constexpr std::uint32_t unused = 0xffffffff;
    std::vector<std::uint32_t> place(source_.positions.size(), unused);
    for (const Triangle& triangle : source_.triangles)
      for (const std::uint32_t v : triangle) place[v] = 0;
    Mesh mesh;
    for (std::size_t v = 0; v < place.size(); ++v) {
      if (place[v] == unused) continue;
      place[v] = std::uint32_t(mesh.positions.size());
      mesh.positions.push_back(source_.positions[v]);
      if (!source_.normals.empty()) mesh.normals.push_back(source_.normals[v]);
    }
    mesh.uvs = mended_uvs();
    mesh.tangents = mended(source_.tangents);
    mesh.colors = mended_colors();
    mesh.triangles = std::move(source_.triangles);
    for (Triangle& triangle : mesh.triangles)
      for (std::uint32_t& v : triangle) v = place[v];
    return mesh;
  }

  static constexpr std::uint32_t kNew = ~0u;  // index of a triangle filling a hole

  const CheckSettings& settings_;
  SourceMesh source_;
  std::vector<std::uint32_t> origins_;  // see CheckMemory; empty: nothing is given by triangle
  CheckMemory* memory_;
  MeshReport report_;
  std::vector<Vec3f> facet_normals_;  // from the file, unless the mesh is smooth
  std::vector<std::uint32_t> same_, site_;
  bool places_matter_ = false;
};

}  // namespace

CheckedMesh check_mesh(SourceMesh source, const CheckSettings& settings, CheckMemory* memory) {
  return MeshChecker(std::move(source), settings, memory).run();
}

}  // namespace opaline
