// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/entry_contents.h"

#include <algorithm>

#include "cache/check_contents.h"

namespace opaline {
namespace {

herr_t leave_open(hid_t) {
  return 0;
}

struct Member {
  const char* name;
  std::size_t offset;
  hid_t number;       // HDF5's type of its numbers
  hsize_t count = 1;  // of them
};

Hdf5Handle array_of(hid_t number, hsize_t count) {
  return {H5Tarray_create2(number, 1, &count), H5Tclose};
}

/// A struct as it lies in memory, so that reading is copying.
Hdf5Handle struct_of(std::size_t size, std::initializer_list<Member> members) {
  Hdf5Handle type(H5Tcreate(H5T_COMPOUND, size), H5Tclose);
  for (const Member& m : members) {
    const Hdf5Handle array = array_of(m.number, m.count);
    H5Tinsert(type.id(), m.name, m.offset, m.count > 1 ? array.id() : m.number);
  }
  return type;
}

}  // namespace

template <>
Hdf5Handle hdf5_type<float>() {
  return {H5T_NATIVE_FLOAT, leave_open};
}

template <>
Hdf5Handle hdf5_type<double>() {
  return {H5T_NATIVE_DOUBLE, leave_open};
}

template <>
Hdf5Handle hdf5_type<Vec3f>() {
  return array_of(H5T_NATIVE_FLOAT, 3);
}

template <>
Hdf5Handle hdf5_type<SurfaceSample>() {
  using S = SurfaceSample;
  static_assert(sizeof(S) == 56, "every member is in the list below");
  return struct_of(sizeof(S), {{"mesh", offsetof(S, mesh), H5T_NATIVE_UINT32},
                               {"triangle", offsetof(S, triangle), H5T_NATIVE_UINT32},
                               {"u", offsetof(S, u), H5T_NATIVE_FLOAT},
                               {"v", offsetof(S, v), H5T_NATIVE_FLOAT},
                               {"position", offsetof(S, position), H5T_NATIVE_FLOAT, 3},
                               {"normal", offsetof(S, normal), H5T_NATIVE_FLOAT, 3},
                               {"area", offsetof(S, area), H5T_NATIVE_FLOAT},
                               {"centroid", offsetof(S, centroid), H5T_NATIVE_FLOAT, 3}});
}

template <>
Hdf5Handle hdf5_type<OctreeNode>() {
  using N = OctreeNode;
  static_assert(sizeof(N) == 128 && offsetof(N, leaf) == 124, "every member is in the list below");
  return struct_of(sizeof(N), {{"x", offsetof(N, x), H5T_NATIVE_FLOAT, 4},
                               {"y", offsetof(N, y), H5T_NATIVE_FLOAT, 4},
                               {"z", offsetof(N, z), H5T_NATIVE_FLOAT, 4},
                               {"flux", offsetof(N, flux), H5T_NATIVE_FLOAT, 4},
                               {"center", offsetof(N, center), H5T_NATIVE_FLOAT, 3},
                               {"half", offsetof(N, half), H5T_NATIVE_FLOAT, 3},
                               {"spread", offsetof(N, spread), H5T_NATIVE_FLOAT, 6},
                               {"skip", offsetof(N, skip), H5T_NATIVE_UINT32},
                               {"first", offsetof(N, first), H5T_NATIVE_UINT32},
                               {"count", offsetof(N, count), H5T_NATIVE_UINT32},
                               {"leaf", offsetof(N, leaf), H5T_NATIVE_UINT8}});
}

template <>
Hdf5Handle hdf5_type<TreeSample>() {
  using S = TreeSample;
  static_assert(sizeof(S) == 32, "every member is in the list below");
  return struct_of(sizeof(S), {{"x", offsetof(S, x), H5T_NATIVE_FLOAT},
                               {"y", offsetof(S, y), H5T_NATIVE_FLOAT},
                               {"z", offsetof(S, z), H5T_NATIVE_FLOAT},
                               {"area", offsetof(S, area), H5T_NATIVE_FLOAT},
                               {"flux", offsetof(S, flux), H5T_NATIVE_FLOAT, 4}});
}

template <>
Hdf5Handle hdf5_type<std::uint32_t>() {
  return {H5T_NATIVE_UINT32, leave_open};
}

template <>
Hdf5Handle hdf5_type<Exitance>() {
  using E = Exitance;
  static_assert(sizeof(E) == 48, "every member is in the list below");
  return struct_of(sizeof(E), {{"exitance", offsetof(E, exitance), H5T_NATIVE_FLOAT, 3},
                               {"irradiance", offsetof(E, irradiance), H5T_NATIVE_FLOAT, 3},
                               {"near", offsetof(E, near), H5T_NATIVE_FLOAT, 3},
                               {"error", offsetof(E, error), H5T_NATIVE_FLOAT, 3}});
}

template <>
Hdf5Handle hdf5_type<SurfaceCache::Vertex>() {
  using V = SurfaceCache::Vertex;
  static_assert(sizeof(V) == 96 && offsetof(V, value) == 0, "every member is in the list below");
  return struct_of(sizeof(V), {{"value", offsetof(V, value), H5T_NATIVE_FLOAT, 12},
                               {"position", offsetof(V, position), H5T_NATIVE_FLOAT, 3},
                               {"slope", offsetof(V, slope), H5T_NATIVE_FLOAT, 9}});
}

template <>
Hdf5Handle hdf5_type<SurfaceCache::Patch>() {
  using P = SurfaceCache::Patch;
  static_assert(sizeof(P) == 16, "every member is in the list below");
  return struct_of(sizeof(P), {{"vertices", offsetof(P, vertices), H5T_NATIVE_UINT32, 3},
                               {"lattice", offsetof(P, lattice), H5T_NATIVE_UINT32}});
}

template <>
Hdf5Handle hdf5_type<SurfaceCache::Lattice>() {
  using L = SurfaceCache::Lattice;
  static_assert(sizeof(L) == 8, "every member is in the list below");
  return struct_of(sizeof(L), {{"first", offsetof(L, first), H5T_NATIVE_UINT32},
                               {"segments", offsetof(L, segments), H5T_NATIVE_UINT32}});
}

template <>
Hdf5Handle hdf5_type<SurfaceCache::Split>() {
  using S = SurfaceCache::Split;
  static_assert(sizeof(S) == 8, "every member is in the list below");
  return struct_of(sizeof(S), {{"first", offsetof(S, first), H5T_NATIVE_UINT32},
                               {"segments", offsetof(S, segments), H5T_NATIVE_UINT32}});
}

void put_samples(Hdf5Writer& file, const SurfaceSamples& samples, std::span<const std::uint32_t> meshes) {
  std::vector<SurfaceSample> local = samples.samples;
  for (SurfaceSample& s : local) s.mesh = std::uint32_t(std::ranges::find(meshes, s.mesh) - meshes.begin());
  file.put("samples", std::span<const SurfaceSample>(local));
  file.put("area", samples.area);
  file.put("radius", samples.radius);
}

std::optional<SurfaceSamples> get_samples(const CheckedEntry& entry, const SampledSurface& surface) {
  auto samples = entry.get<SurfaceSample>("samples");
  const std::optional<double> area = entry.number("area"), radius = entry.number("radius");
  if (!samples || !area || !radius) return {};
  for (SurfaceSample& s : *samples) {
    if (s.mesh >= surface.meshes.size()) return {};
    s.mesh = surface.meshes[s.mesh];
  }
  SurfaceSamples all{std::move(*samples), *area, *radius};
  if (!are_samples_of(all, surface)) return {};
  return all;
}

void put_light(Hdf5Writer& file, const LightTransfer& transfer) {
  file.put("weights", std::span(transfer.weights));
  file.put("relative_error", transfer.relative_error);
  file.put("edge_shift", transfer.edge_shift);
}

std::optional<LightTransfer> get_light(const CheckedEntry& entry, std::size_t samples) {
  auto weights = entry.get<float>("weights");
  const std::optional<double> error = entry.number("relative_error");
  const std::optional<double> shift = entry.number("edge_shift");
  if (!weights || !error || !shift) return {};
  LightTransfer transfer{std::move(*weights), *error, *shift};
  if (!is_light_of(transfer, samples)) return {};
  return transfer;
}

void put_octree(Hdf5Writer& file, const Octree& octree) {
  file.put("nodes", std::span(octree.nodes));
  file.put("samples", std::span(octree.samples));
  file.put("normals", std::span(octree.normals));
  file.put("flux_unit", double(octree.flux_unit));
}

std::optional<Octree> get_octree(const CheckedEntry& entry, const SurfaceSamples& samples) {
  const auto bytes = entry.bytes_of("nodes", sizeof(OctreeNode));
  if (!bytes || !has_flags(*bytes, sizeof(OctreeNode), offsetof(OctreeNode, leaf))) return {};
  auto nodes = entry.get<OctreeNode>("nodes");
  auto tree_samples = entry.get<TreeSample>("samples");
  auto normals = entry.get<Vec3f>("normals");
  const std::optional<double> unit = entry.number("flux_unit");
  if (!nodes || !tree_samples || !normals || !unit) return {};
  Octree octree{std::move(*nodes), std::move(*tree_samples), std::move(*normals), float(*unit)};
  if (!is_tree_of(octree, samples)) return {};
  list_children(octree);
  return octree;
}

void put_exitance(Hdf5Writer& file, const SurfaceCache& exitance, std::span<const std::uint32_t> meshes) {
  std::vector<std::uint32_t> triangles;
  std::vector<SurfaceCache::Split> splits;
  for (const std::uint32_t m : meshes) {
    triangles.push_back(std::uint32_t(exitance.splits[m].size()));
    splits.insert(splits.end(), exitance.splits[m].begin(), exitance.splits[m].end());
  }
  const std::vector<float> own(exitance.own_irradiance.begin(), exitance.own_irradiance.end());
  file.put("own_irradiance", std::span(own));
  file.put("triangles", std::span<const std::uint32_t>(triangles));
  file.put("splits", std::span<const SurfaceCache::Split>(splits));
  file.put("patches", std::span(exitance.patches));
  file.put("vertices", std::span(exitance.vertices));
  file.put("lattices", std::span(exitance.lattices));
  file.put("lattice_nodes", std::span(exitance.lattice_nodes));
  file.put("nodes", std::span(exitance.nodes));
}

std::optional<SurfaceCache> get_exitance(const CheckedEntry& entry, const World& world,
                                         std::span<const std::uint32_t> meshes) {
  const auto own = entry.get<float>("own_irradiance");
  const auto triangles = entry.get<std::uint32_t>("triangles");
  const auto splits = entry.get<SurfaceCache::Split>("splits");
  auto patches = entry.get<SurfaceCache::Patch>("patches");
  auto vertices = entry.get<SurfaceCache::Vertex>("vertices");
  auto lattices = entry.get<SurfaceCache::Lattice>("lattices");
  auto lattice_nodes = entry.get<std::uint32_t>("lattice_nodes");
  auto nodes = entry.get<Exitance>("nodes");
  if (!own || own->size() != 3 || !triangles || triangles->size() != meshes.size() || !splits || !patches ||
      !vertices || !lattices || !lattice_nodes || !nodes)
    return {};
  SurfaceCache exitance{{(*own)[0], (*own)[1], (*own)[2]},
                        {},
                        std::move(*patches),
                        std::move(*vertices),
                        std::move(*lattices),
                        std::move(*lattice_nodes),
                        std::move(*nodes)};
  exitance.splits.resize(world.meshes.size());
  auto next = splits->begin();
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (splits->end() - next < std::ptrdiff_t((*triangles)[m])) return {};
    exitance.splits[meshes[m]].assign(next, next + std::ptrdiff_t((*triangles)[m]));
    next += std::ptrdiff_t((*triangles)[m]);
  }
  if (!is_exitance_of(exitance, world, meshes)) return {};
  return exitance;
}

namespace {
constexpr std::uint64_t kAroundSets = 1 << 16;  // what HDF5 adds, generously
}

std::uint64_t most_bytes_of_samples(const SampledSurface& surface) {
  return most_samples(surface) * sizeof(SurfaceSample) + kAroundSets;
}

std::uint64_t most_bytes_of_light(std::size_t samples) {
  return samples * sizeof(float) + kAroundSets;
}

// A node that is no leaf has two children or more.
std::uint64_t most_bytes_of_octree(std::size_t samples) {
  return samples * (2 * sizeof(OctreeNode) + sizeof(TreeSample) + sizeof(Vec3f)) + kAroundSets;
}

}  // namespace opaline
