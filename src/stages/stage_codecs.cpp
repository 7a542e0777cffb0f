// SPDX-License-Identifier: GPL-3.0-or-later
#include "stages/stage_codecs.h"

#include <algorithm>

#include "stages/check_contents.h"

namespace opaline {
namespace {

constexpr BlobNumber kFloat = BlobNumber::float32, kUint = BlobNumber::uint32;

}  // namespace

template <>
BlobType blob_type<Vec3f>() {
  return {sizeof(Vec3f), {{"", 0, kFloat, 3}}};
}

template <>
BlobType blob_type<SurfaceSample>() {
  using S = SurfaceSample;
  static_assert(sizeof(S) == 56, "every member is in the list below");
  return {sizeof(S),
          {{"mesh", offsetof(S, mesh), kUint},
           {"triangle", offsetof(S, triangle), kUint},
           {"u", offsetof(S, u), kFloat},
           {"v", offsetof(S, v), kFloat},
           {"position", offsetof(S, position), kFloat, 3},
           {"normal", offsetof(S, normal), kFloat, 3},
           {"area", offsetof(S, area), kFloat},
           {"centroid", offsetof(S, centroid), kFloat, 3}}};
}

template <>
BlobType blob_type<OctreeNode>() {
  using N = OctreeNode;
  static_assert(sizeof(N) == 128 && offsetof(N, leaf) == 124, "every member is in the list below");
  return {sizeof(N),
          {{"x", offsetof(N, x), kFloat, 4},
           {"y", offsetof(N, y), kFloat, 4},
           {"z", offsetof(N, z), kFloat, 4},
           {"flux", offsetof(N, flux), kFloat, 4},
           {"center", offsetof(N, center), kFloat, 3},
           {"half", offsetof(N, half), kFloat, 3},
           {"spread", offsetof(N, spread), kFloat, 6},
           {"skip", offsetof(N, skip), kUint},
           {"first", offsetof(N, first), kUint},
           {"count", offsetof(N, count), kUint},
           {"leaf", offsetof(N, leaf), BlobNumber::uint8}}};
}

template <>
BlobType blob_type<TreeSample>() {
  using S = TreeSample;
  static_assert(sizeof(S) == 32, "every member is in the list below");
  return {sizeof(S),
          {{"x", offsetof(S, x), kFloat},
           {"y", offsetof(S, y), kFloat},
           {"z", offsetof(S, z), kFloat},
           {"area", offsetof(S, area), kFloat},
           {"flux", offsetof(S, flux), kFloat, 4}}};
}

template <>
BlobType blob_type<Exitance>() {
  using E = Exitance;
  static_assert(sizeof(E) == 48, "every member is in the list below");
  return {sizeof(E),
          {{"exitance", offsetof(E, exitance), kFloat, 3},
           {"irradiance", offsetof(E, irradiance), kFloat, 3},
           {"near", offsetof(E, near), kFloat, 3},
           {"error", offsetof(E, error), kFloat, 3}}};
}

template <>
BlobType blob_type<SurfaceCache::Vertex>() {
  using V = SurfaceCache::Vertex;
  static_assert(sizeof(V) == 96 && offsetof(V, value) == 0, "every member is in the list below");
  return {sizeof(V),
          {{"value", offsetof(V, value), kFloat, 12},
           {"position", offsetof(V, position), kFloat, 3},
           {"slope", offsetof(V, slope), kFloat, 9}}};
}

template <>
BlobType blob_type<SurfaceCache::Patch>() {
  using P = SurfaceCache::Patch;
  static_assert(sizeof(P) == 16, "every member is in the list below");
  return {sizeof(P),
          {{"vertices", offsetof(P, vertices), kUint, 3}, {"lattice", offsetof(P, lattice), kUint}}};
}

template <>
BlobType blob_type<SurfaceCache::Lattice>() {
  using L = SurfaceCache::Lattice;
  static_assert(sizeof(L) == 8, "every member is in the list below");
  return {sizeof(L), {{"first", offsetof(L, first), kUint}, {"segments", offsetof(L, segments), kUint}}};
}

template <>
BlobType blob_type<SurfaceCache::Split>() {
  using S = SurfaceCache::Split;
  static_assert(sizeof(S) == 8, "every member is in the list below");
  return {sizeof(S), {{"first", offsetof(S, first), kUint}, {"segments", offsetof(S, segments), kUint}}};
}

void SamplesCodec::put(BlobWriter& file, const SurfaceSamples& samples) const {
  std::vector<SurfaceSample> local = samples.samples;
  for (SurfaceSample& s : local)
    s.mesh = std::uint32_t(std::ranges::find(surface.meshes, s.mesh) - surface.meshes.begin());
  file.put("samples", std::span<const SurfaceSample>(local));
  file.put("area", samples.area);
  file.put("radius", samples.radius);
}

std::optional<SurfaceSamples> SamplesCodec::get(const BlobReader& entry) const {
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

void LightCodec::put(BlobWriter& file, const LightTransfer& transfer) const {
  file.put("weights", std::span(transfer.weights));
  file.put("relative_error", transfer.relative_error);
  file.put("edge_shift", transfer.edge_shift);
}

std::optional<LightTransfer> LightCodec::get(const BlobReader& entry) const {
  auto weights = entry.get<float>("weights");
  const std::optional<double> error = entry.number("relative_error");
  const std::optional<double> shift = entry.number("edge_shift");
  if (!weights || !error || !shift) return {};
  LightTransfer transfer{std::move(*weights), *error, *shift};
  if (!is_light_of(transfer, samples)) return {};
  return transfer;
}

void BouncedCodec::put(BlobWriter& file, const std::vector<RgbF>& bounced) const {
  file.put("irradiance", std::span(bounced));
}

std::optional<std::vector<RgbF>> BouncedCodec::get(const BlobReader& entry) const {
  auto bounced = entry.get<RgbF>("irradiance");
  if (!bounced || !are_values_of(*bounced, samples)) return {};
  return bounced;
}

void WalkedProfileCodec::put(BlobWriter& file, const RadialTable& table) const {
  file.put("logarithms", std::span(table.logarithms()));
  file.put("decay", table.reference().decay);
  file.put("width", table.reference().width);
}

std::optional<RadialTable> WalkedProfileCodec::get(const BlobReader& entry) const {
  auto logarithms = entry.get<double>("logarithms");
  const std::optional<double> decay = entry.number("decay"), width = entry.number("width");
  if (!logarithms || !decay || !width || !is_walked_profile(*logarithms, *decay, *width)) return {};
  return RadialTable({*decay, *width}, std::move(*logarithms));
}

void OctreeCodec::put(BlobWriter& file, const Octree& octree) const {
  file.put("nodes", std::span(octree.nodes));
  file.put("samples", std::span(octree.samples));
  file.put("normals", std::span(octree.normals));
  file.put("flux_unit", double(octree.flux_unit));
}

std::optional<Octree> OctreeCodec::get(const BlobReader& entry) const {
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

void VolumeCodec::put(BlobWriter& file, const VolumeExitance& volume) const {
  file.put("exitance", std::span(volume.exitance));
  file.put("error", std::span(volume.error));
}

std::optional<VolumeExitance> VolumeCodec::get(const BlobReader& entry) const {
  auto exitance = entry.get<RgbF>("exitance"), error = entry.get<RgbF>("error");
  if (!exitance || !error || !are_values_of(*exitance, samples) || !are_values_of(*error, samples)) return {};
  return VolumeExitance{.exitance = std::move(*exitance), .error = std::move(*error)};
}

void SurfaceCacheCodec::put(BlobWriter& file, const SurfaceCache& exitance) const {
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

std::optional<SurfaceCache> SurfaceCacheCodec::get(const BlobReader& entry) const {
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
constexpr std::uint64_t kAroundSets = 1 << 16;  // overhead of HDF5, upper estimate
}

std::uint64_t SamplesCodec::most_bytes() const {
  return most_samples(surface) * sizeof(SurfaceSample) + kAroundSets;
}

std::uint64_t BouncedCodec::most_bytes() const {
  return samples * sizeof(RgbF) + kAroundSets;
}

std::uint64_t LightCodec::most_bytes() const {
  return samples * sizeof(float) + kAroundSets;
}

std::uint64_t VolumeCodec::most_bytes() const {
  return samples * 2 * sizeof(RgbF) + kAroundSets;
}

// An inner node has at least two children.
std::uint64_t OctreeCodec::most_bytes() const {
  return samples.samples.size() * (2 * sizeof(OctreeNode) + sizeof(TreeSample) + sizeof(Vec3f)) + kAroundSets;
}

}  // namespace opaline
