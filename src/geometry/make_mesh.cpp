// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/make_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "geometry/builtin_shapes.h"
#include "geometry/check_mesh.h"
#include "geometry/displace.h"
#include "geometry/read_mesh.h"
#include "geometry/shape_label.h"
#include "geometry/subdivide.h"
#include "opaline/error.h"

namespace opaline {
namespace {

constexpr std::size_t kMostTriangles = 200'000'000;
constexpr std::size_t kFewVertices = 1000;  // fewer in a displaced mesh: a hint

struct SourceReader {
  const std::string& name;
  MeshUvs uvs;
  SourceMesh operator()(const MeshFile& file) const {
    return read_mesh(file.path, file.part, uvs, file.pose);
  }
  template <class Builtin>
  SourceMesh operator()(const Builtin& shape) const {
    SourceMesh mesh = tessellate(shape, name);
    if (uvs != MeshUvs::unread) add_uvs(shape, mesh);
    return mesh;
  }
};

/// Bounds of the vertices used by triangles.
Bounds used_bounds(const SourceMesh& mesh) {
  Bounds box;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) widen(box.low, box.high, mesh.positions[v]);
  }
  return box;
}

/// See MeshFile::fit_size.
void fit(SourceMesh& mesh, double size, const std::string& name) {
  if (!(std::isfinite(size) && size > 0))
    throw bad_file(name, "bad fit_size", "a finite number above 0", std::to_string(size));
  if (mesh.triangles.empty()) return;
  const Bounds box = used_bounds(mesh);
  const double largest = max_component(box.high - box.low);
  if (!(largest > 0)) throw bad_file(name, "the mesh has no area", "", "all vertices at one point");
  const double scale = size / largest;
  const Vec3d origin((box.low.x + box.high.x) / 2, box.low.y, (box.low.z + box.high.z) / 2);
  for (Vec3d& p : mesh.positions) p = (p - origin) * scale;
}

/// Transform of normals: the inverse transpose up to a positive factor, so they keep their side.
struct NormalMap {
  Vec3d x, y, z;
  Vec3f operator()(const Vec3f& n) const {
    return Vec3f(normalized(x * double(n.x) + y * double(n.y) + z * double(n.z)));
  }
};

void place(SourceMesh& mesh, const Transform& to_world, const std::string& name) {
  const Vec3d x = normalized(to_world.x), y = normalized(to_world.y), z = normalized(to_world.z);
  const double determinant = dot(x, cross(y, z));  // determinant of unit directions, independent of scale
  if (!(std::abs(determinant) > 1e-12) || !is_finite(to_world.translation))
    throw bad_file(name, "the transform is singular or not finite", "three independent axes",
                   "relative determinant " + std::to_string(determinant));
  for (Vec3d& p : mesh.positions) {
    p = transform_point(to_world, p);
    if (!is_finite(p) || max_component(component_max(p, -p)) >= 1e18)
      throw bad_file(name, "a vertex is too far from the origin after the transform",
                     "coordinates below 1e18");
  }
  const double side = determinant < 0 ? -1 : 1;
  const double lx = length(to_world.x), ly = length(to_world.y), lz = length(to_world.z);
  const double largest = std::max({lx, ly, lz});
  const NormalMap map{cross(y, z) * (side * (largest / lx)), cross(z, x) * (side * (largest / ly)),
                      cross(x, y) * (side * (largest / lz))};
  for (Vec3f& n : mesh.normals) n = map(n);
  for (CornerTangents& tangents : mesh.tangents)
    for (auto& [direction, handedness] : tangents) {
      const Vec3d d(direction);
      direction = Vec3f(normalized(to_world.x * d.x + to_world.y * d.y + to_world.z * d.z));
      handedness *= float(side);
    }
  if (determinant < 0) {
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    for (CornerUvs& uvs : mesh.uvs) std::swap(uvs[1], uvs[2]);
    for (CornerTangents& tangents : mesh.tangents) std::swap(tangents[1], tangents[2]);
    for (CornerColors& colors : mesh.colors) std::swap(colors[1], colors[2]);
  }
}

/// White changes nothing.
void choose_colors(const MeshFile& file, const std::string& name, SourceMesh& mesh) {
  if (file.vertex_colors == true && mesh.colors.empty())
    throw bad_file(name, "has no vertex colours", "colours in OBJ, PLY or OFF, COLOR_0 in glTF", "none");
  const auto is_white = [](const CornerColors& colors) {
    return std::ranges::all_of(colors, [](const RgbF& color) { return color == RgbF(1); });
  };
  if (file.vertex_colors == false || std::ranges::all_of(mesh.colors, is_white)) mesh.colors.clear();
}

SourceMesh read_source(const Shape& shape, const std::string& name, MeshUvs uvs) {
  SourceMesh mesh = std::visit(SourceReader{name, uvs}, shape.source);
  if ((uvs == MeshUvs::required || uvs == MeshUvs::with_tangents) && mesh.uvs.empty())
    throw bad_file(
        name, "has textures but no UVs",
        "vt lines in OBJ, u and v in PLY, TEXCOORD_0 in glTF; or textures with 'triplanar' or 'noise'",
        "none");
  if (const auto* file = std::get_if<MeshFile>(&shape.source)) {
    choose_colors(*file, name, mesh);
    if (mesh.triangles.size() > kMostTriangles >> (2 * file->subdivide))
      throw bad_file(name,
                     "has too many triangles to subdivide " + std::to_string(file->subdivide) + " times",
                     "at most " + grouped(kMostTriangles) + " after subdivision");
    for (int round = 0; round < file->subdivide; ++round) mesh = subdivided(std::move(mesh));
    if (file->fit_size) fit(mesh, *file->fit_size, name);
    if (file->crease_angle) mesh.smoothing = {{}, *file->crease_angle};
  }
  return mesh;
}

/// Checks the mesh before, for normals on its outside, and after its vertices have moved.
CheckedMesh make_displaced(const Shape& shape, SourceMesh mesh, CheckSettings settings, CheckMemory* memory) {
  const double crease_angle = mesh.smoothing.crease_angle;
  mesh.normals.clear();
  mesh.smoothing = {};
  const bool is_smooth = std::exchange(settings.smooth, true);
  CheckedMesh before = check_mesh(std::move(mesh), settings, memory);
  SourceMesh moved = displaced(std::move(before.mesh), shape);
  moved.smoothing.crease_angle = crease_angle;
  settings.smooth = is_smooth;
  settings.fill_holes = FillHoles::none;
  CheckedMesh after = check_mesh(std::move(moved), settings);
  const std::size_t dropped = after.report.zero_area_dropped;
  after.report = std::move(before.report);
  after.report.zero_area_dropped += dropped;
  if (after.mesh.positions.size() < kFewVertices)
    after.report.warnings.push_back(settings.name + ": displacement moves only " +
                                    std::to_string(after.mesh.positions.size()) +
                                    " vertices; use a finer mesh, or a mesh file with a larger 'subdivide'");
  return after;
}

CheckedMesh make_mesh(const Shape& shape, const std::string& name, SourceMesh mesh, CheckMemory* memory) {
  CheckSettings settings;
  settings.name = name;
  settings.smooth = shape.normals == NormalMode::smooth;
  const auto* file = std::get_if<MeshFile>(&shape.source);
  settings.has_inside = shape.medium.has_value();
  if (file != nullptr && file->fill_holes)
    settings.fill_holes = *file->fill_holes ? FillHoles::all : FillHoles::none;
  else if (shape.medium)
    settings.fill_holes = FillHoles::if_small;
  place(mesh, shape.to_world, name);
  if (shape.displacement) return make_displaced(shape, std::move(mesh), settings, memory);
  return check_mesh(std::move(mesh), settings, memory);
}

}  // namespace

struct MeshMemory::State {
  SourceMesh source;
  bool is_current = false;  // else the source has changed since it was read
  CheckMemory check;
  Work work;
};

MeshMemory::MeshMemory() : state_(std::make_unique<State>()) {}
MeshMemory::~MeshMemory() = default;
MeshMemory::MeshMemory(MeshMemory&&) noexcept = default;
MeshMemory& MeshMemory::operator=(MeshMemory&&) noexcept = default;

void MeshMemory::source_changed() {
  state_->is_current = false;
}

const MeshMemory::Work& MeshMemory::work() const {
  return state_->work;
}

CheckedMesh make_mesh(const Shape& shape, MeshUvs uvs) {
  const std::string name = shape_label(shape);
  return make_mesh(shape, name, read_source(shape, name, uvs), nullptr);
}

CheckedMesh make_mesh(const Shape& shape, MeshMemory& memory, MeshUvs uvs) {
  const std::string name = shape_label(shape);
  MeshMemory::State& state = *memory.state_;
  if (!state.is_current) {
    state.source = read_source(shape, name, uvs);
    state.is_current = true;
    ++state.work.read;
  }
  CheckedMesh mesh = make_mesh(shape, name, state.source, &state.check);
  state.work.checked += state.check.recalled ? 0 : 1;
  return mesh;
}

}  // namespace opaline
