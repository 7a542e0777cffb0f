// SPDX-License-Identifier: GPL-3.0-or-later
// Worlds without a scene file, samples on them, and what tests compare them with: points at the centres of a
// fine subdivision of the mesh, and a grid that finds samples near a point.
#pragma once

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "geometry/make_mesh.h"
#include "geometry/surface_point.h"
#include "geometry/world.h"
#include "opaline/scene.h"
#include "sampling/sample_surface.h"

namespace opaline::test {

inline World world_of(const std::vector<ShapeSource>& sources, NormalMode normals = NormalMode::smooth) {
  Scene scene;
  for (const ShapeSource& source : sources) {
    Shape shape;
    shape.name = "shape " + std::to_string(scene.shapes.size());
    shape.source = source;
    shape.normals = normals;
    scene.shapes.push_back(std::move(shape));
  }
  return make_world(scene);
}

/// One faceted mesh as a world around the origin as it is.
inline World world_of_mesh(Mesh mesh) {
  World world;
  const Bounds box = bounds(mesh);
  world.diagonal = length(box.high - box.low);
  world.measures.push_back(measures_of(mesh));
  world.meshes.push_back(std::move(mesh));
  world.reports.resize(1);
  return world;
}

/// The same world, every length times k.
inline World scaled(World world, double k) {
  for (Mesh& mesh : world.meshes)
    for (Vec3d& p : mesh.positions) p *= k;
  for (std::size_t i = 0; i < world.meshes.size(); ++i) world.measures[i] = measures_of(world.meshes[i]);
  world.origin *= k;
  world.diagonal *= k;
  return world;
}

/// Square of side 2 h in the plane y = 0 around the origin, normal +y.
inline QuadShape floor_quad(double h) {
  return {{-h, 0, -h}, {0, 0, 2 * h}, {2 * h, 0, 0}};
}

/// The demo's bunny, 50 mm tall or wide.
inline MeshFile bunny_file() {
  MeshFile file;
  file.path = OPALINE_SCENES_DIR "/assets/bunny.obj";
  file.fit_size = 50;
  return file;
}

struct NamedWorld {
  std::string name;
  World world;
};

/// The shapes that most tests of sampling go through.
inline std::vector<NamedWorld> table_of_worlds() {
  std::vector<NamedWorld> table;
  table.push_back({"sphere", world_of({SphereShape{{}, 25}})});
  table.push_back({"torus", world_of({TorusShape{{}, 20, 6}})});
  table.push_back({"box", world_of({BoxShape{{-10, -20, -5}, {10, 20, 5}}})});
  table.push_back({"quad", world_of({floor_quad(20)})});
  table.push_back({"bunny", world_of({bunny_file()})});
  return table;
}

/// Samples over all meshes of the world as one surface.
inline SurfaceSamples samples_on(const World& world, std::size_t count, std::uint64_t seed = 0) {
  std::vector<std::uint32_t> meshes(world.meshes.size());
  std::iota(meshes.begin(), meshes.end(), 0u);
  return sample_surface({world, meshes, count, seed});
}

inline SurfacePoint point_of(const World& world, const SurfaceSample& s) {
  return surface_point(world.meshes[s.mesh], s.triangle, s.u, s.v);
}

/// A sample set by hand, of area 1.
inline SurfaceSample sample_at(const World& world, std::uint32_t mesh, std::uint32_t triangle, float u,
                               float v) {
  const SurfacePoint p = surface_point(world.meshes[mesh], triangle, u, v);
  return {mesh, triangle, u, v, p.position, p.normal, 1};
}

/// A sample at the middle of every `step`th triangle of mesh 0.
inline std::vector<SurfaceSample> samples_at_centroids(const World& world, std::size_t step = 1) {
  std::vector<SurfaceSample> samples;
  for (std::size_t t = 0; t < world.meshes[0].triangles.size(); t += step)
    samples.push_back(sample_at(world, 0, std::uint32_t(t), 1 / 3.f, 1 / 3.f));
  return samples;
}

inline double sum_of_shares(const SurfaceSamples& surface) {
  double sum = 0;
  for (const SurfaceSample& s : surface.samples) sum += double(s.area);
  return sum;
}

/// A piece of surface: its middle, geometric normal and area.
struct Piece {
  Vec3d position;
  Vec3f geometric;
  double area;
};

/// The surface cut into pieces no larger than `largest`: each triangle into k^2 equal ones.
inline std::vector<Piece> dense_pieces(const World& world, double largest) {
  std::vector<Piece> pieces;
  for (const Mesh& mesh : world.meshes)
    for (const auto& [ia, ib, ic] : mesh.triangles) {
      const Vec3d a = mesh.positions[ia], ab = mesh.positions[ib] - a, ac = mesh.positions[ic] - a;
      const Vec3d normal = cross(ab, ac);
      const int k = std::max(1, int(std::ceil(std::sqrt(length(normal) / 2 / largest))));
      const double area = length(normal) / 2 / k / k;
      const Vec3f geometric(normalized(normal));
      for (int i = 0; i < k; ++i)
        for (int j = 0; i + j < k; ++j) {
          pieces.push_back({a + ab * ((i + 1. / 3) / k) + ac * ((j + 1. / 3) / k), geometric, area});
          if (i + j + 1 < k)
            pieces.push_back({a + ab * ((i + 2. / 3) / k) + ac * ((j + 2. / 3) / k), geometric, area});
        }
    }
  return pieces;
}

/// Samples in the cells of a hashed grid.
class SampleGrid {
 public:
  SampleGrid(const World& world, const SurfaceSamples& surface, double cell) : cell_(cell) {
    for (const SurfaceSample& s : surface.samples) {
      const auto index = std::uint32_t(positions_.size());
      positions_.push_back(Vec3d(s.position));
      geometric_.push_back(point_of(world, s).geometric);
      cells_[key(place(positions_.back().x), place(positions_.back().y), place(positions_.back().z))]
          .push_back(index);
    }
  }

  static constexpr std::uint32_t kNone = ~0u;

  /// The nearest sample of the point's sheet other than `skip`, and its distance; kNone and infinity beyond
  /// 16 cells.
  std::pair<std::uint32_t, double> nearest(const Vec3d& p, const Vec3f& geometric,
                                           std::uint32_t skip = kNone) const {
    std::uint32_t best = kNone;
    double distance = std::numeric_limits<double>::infinity();
    const std::int64_t x = place(p.x), y = place(p.y), z = place(p.z);
    for (std::int64_t ring = 0; ring <= 16 && distance > double(ring - 1) * cell_; ++ring)
      for (std::int64_t i = -ring; i <= ring; ++i)
        for (std::int64_t j = -ring; j <= ring; ++j) {
          const bool shell = std::max(std::abs(i), std::abs(j)) == ring;
          for (std::int64_t k = -ring; k <= ring; k += shell ? 1 : std::max<std::int64_t>(1, 2 * ring)) {
            const auto found = cells_.find(key(x + i, y + j, z + k));
            if (found == cells_.end()) continue;
            for (const std::uint32_t s : found->second) {
              const double d = length(positions_[s] - p);
              if (s != skip && d < distance && same_sheet(geometric_[s], geometric)) best = s, distance = d;
            }
          }
        }
    return {best, distance};
  }

  const Vec3d& position(std::uint32_t sample) const { return positions_[sample]; }
  const Vec3f& geometric(std::uint32_t sample) const { return geometric_[sample]; }

 private:
  std::int64_t place(double x) const { return std::int64_t(std::floor(x / cell_)); }
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return ((std::uint64_t(x) & 0x1fffff) << 42) | ((std::uint64_t(y) & 0x1fffff) << 21) |
           (std::uint64_t(z) & 0x1fffff);
  }

  double cell_;
  std::vector<Vec3d> positions_;
  std::vector<Vec3f> geometric_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

/// What `work` returns when TBB may use so many threads.
template <class Work>
auto with_threads(std::size_t threads, const Work& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return work();
}

/// Whether two arrays of records without padding hold the same bytes.
template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}
static_assert(sizeof(SurfaceSample) == 56);

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace opaline::test
