// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/gltf_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <mutex>

#include "asset_files/asset_file.h"
#include "asset_files/build_gltf.h"
#include "asset_files/gltf_animation.h"
#include "asset_files/gltf_compression.h"
#include "asset_files/gltf_file.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace opaline {
namespace {

namespace fs = std::filesystem;

void add_hash(std::string& contents, std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, hash);
  contents.append(reinterpret_cast<const char*>(canonical.digest), sizeof canonical.digest);
}

void check_compression(const GltfModel& gltf) {
  constexpr const char* kUnsupported = "KHR_meshopt_compression";
  if (std::ranges::find(gltf.extensions_required, kUnsupported) != gltf.extensions_required.end())
    throw bad_file(gltf.path,
                   std::string("its meshes are compressed by ") + kUnsupported + ", which is not supported",
                   "an asset exported without compression, or with EXT_meshopt_compression or "
                   "KHR_draco_mesh_compression");
}

/// Checks indices between the records; names are as in their JSON.
class ReferenceCheck {
 public:
  explicit ReferenceCheck(GltfModel& gltf) : gltf_(gltf) {}

  void run() {
    for (std::size_t i = 0; i < gltf_.views.size(); ++i) view(i);
    for (std::size_t i = 0; i < gltf_.accessors.size(); ++i) accessor(i);
    for (std::size_t i = 0; i < gltf_.meshes.size(); ++i) mesh(i);
    for (std::size_t i = 0; i < gltf_.nodes.size(); ++i) node(i);
    for (std::size_t i = 0; i < gltf_.scenes.size(); ++i)
      for (const std::uint32_t root : gltf_.scenes[i])
        index(record_name("scenes", i) + ".nodes", root, gltf_.nodes.size());
    optional("scene", gltf_.scene, gltf_.scenes.size());
  }

 private:
  void index(const std::string& place, std::uint32_t value, std::size_t size) const {
    if (value < size) return;
    fail_at(gltf_.path, place, "refers to nothing",
            size == 0 ? "no index: the list is empty" : "0 to " + std::to_string(size - 1),
            std::to_string(value));
  }

  void optional(const std::string& place, std::uint32_t value, std::size_t size) const {
    if (value != kNoRecord) index(place, value, size);
  }

  void view(std::size_t i) const {
    const GltfBufferView& view = gltf_.views[i];
    const std::string place = record_name("bufferViews", i);
    index(place + ".buffer", view.buffer, gltf_.buffers.size());
    const std::size_t size = gltf_.buffers[view.buffer].size();
    if (view.offset > size || view.length > size - view.offset)
      fail_at(gltf_.path, place, "reaches beyond its buffer", "within " + std::to_string(size) + " bytes",
              std::to_string(view.length) + " from " + std::to_string(view.offset));
  }

  void accessor(std::size_t i) const {
    const GltfAccessor& accessor = gltf_.accessors[i];
    const std::string place = record_name("accessors", i);
    optional(place + ".bufferView", accessor.view, gltf_.views.size());
    if (!accessor.sparse) return;
    index(place + ".sparse.indices.bufferView", accessor.sparse->index_view, gltf_.views.size());
    index(place + ".sparse.values.bufferView", accessor.sparse->value_view, gltf_.views.size());
  }

  void attributes(const std::string& place, const GltfAttributes& all) const {
    for (const auto& [name, accessor] : all) index(place + '.' + name, accessor, gltf_.accessors.size());
  }

  void mesh(std::size_t i) const {
    for (std::size_t p = 0; p < gltf_.meshes[i].primitives.size(); ++p) {
      const GltfPrimitive& primitive = gltf_.meshes[i].primitives[p];
      const std::string place = record_name("meshes", i) + '.' + record_name("primitives", p);
      attributes(place + ".attributes", primitive.attributes);
      for (std::size_t t = 0; t < primitive.targets.size(); ++t)
        attributes(place + '.' + record_name("targets", t), primitive.targets[t]);
      optional(place + ".indices", primitive.indices, gltf_.accessors.size());
      optional(place + ".material", primitive.material, gltf_.count("materials"));
      optional(place + ".extensions.KHR_draco_mesh_compression.bufferView", primitive.draco_view,
               gltf_.views.size());
    }
  }

  void node(std::size_t i) {
    const GltfNode& node = gltf_.nodes[i];
    const std::string place = record_name("nodes", i);
    optional(place + ".mesh", node.mesh, gltf_.meshes.size());
    optional(place + ".camera", node.camera, gltf_.count("cameras"));
    optional(place + ".skin", node.skin, gltf_.count("skins"));
    optional(place + ".extensions.KHR_lights_punctual.light", node.light, gltf_.count("lights"));
    if (const auto found = gltf_.instances.find(i); found != gltf_.instances.end())
      attributes(place + ".extensions.EXT_mesh_gpu_instancing.attributes", found->second);
    for (const std::uint32_t child : node.children) {
      index(place + ".children", child, gltf_.nodes.size());
      if (gltf_.nodes[child].parent != kNoRecord)
        fail_at(gltf_.path, record_name("nodes", child), "has two parents, or is its own", "a tree of nodes");
      gltf_.nodes[child].parent = std::uint32_t(i);
    }
  }

  GltfModel& gltf_;
};

std::size_t record_bytes(const GltfModel& gltf, std::string_view json) {
  constexpr std::size_t kOfAllocation = 16;
  std::size_t bytes = json.size();
  for (const GltfNode& node : gltf.nodes)
    bytes += sizeof node + (node.placed ? sizeof *node.placed + kOfAllocation : 0);
  return bytes;
}

/// The last asset, and its files.
struct Kept {
  std::mutex mutex;
  std::shared_ptr<const GltfModel> gltf;
  std::vector<std::string> files;  ///< the asset, then its buffers
};

Kept& kept() {
  static Kept last;
  return last;
}

/// The bytes of a buffer lying outside of the asset's own file.
/// in    files: its file is added
std::string bytes_of_uri(const GltfModel& gltf, std::size_t index, const std::string& uri,
                         std::vector<std::string>& files) {
  const std::string place = record_name("buffers", index) + ".uri";
  if (is_data_uri(uri)) {
    std::optional<std::string> bytes = data_of_uri(uri);
    if (!bytes) fail_at(gltf.path, place, "cannot be read", "a file, or data in base64");
    return *std::move(bytes);
  }
  const std::string name = decoded_uri(uri);
  const NamedFile file = find_named_file(name, gltf.path, fs::path(gltf.path).parent_path());
  if (file.path.empty())
    fail_at(gltf.path, place, "refers to a missing file", "a file in the asset's folder", name);
  files.push_back(file.path.string());
  return read_asset_bytes(files.back());
}

void read_buffers(GltfModel& gltf, std::string_view binary, const std::vector<GltfBuffer>& buffers,
                  std::vector<std::string>& files) {
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const auto& [length, uri, is_fallback] = buffers[i];
    if (is_fallback) {
      gltf.buffers.emplace_back();
      continue;
    }
    std::string_view bytes = binary;
    if (!uri.empty()) {
      const std::size_t known = files.size();
      bytes = gltf.own_bytes.emplace_back(bytes_of_uri(gltf, i, uri, files));
      if (files.size() > known) add_hash(gltf.contents, bytes);
    } else if (i > 0 || binary.data() == nullptr) {
      fail_at(gltf.path, record_name("buffers", i), "has no data",
              "a uri, or the binary chunk of a GLB file");
    }
    if (bytes.size() < length)
      fail_at(gltf.path, record_name("buffers", i), "is shorter than its byteLength", std::to_string(length),
              std::to_string(bytes.size()));
    gltf.buffers.push_back(bytes.substr(0, length));
  }
}

/// Contents of all files, read again.
std::string contents_of(const std::vector<std::string>& files, const std::string& first) {
  std::string contents;
  add_hash(contents, first);
  for (std::size_t i = 1; i < files.size(); ++i) add_hash(contents, read_asset_bytes(files[i]));
  return contents;
}

bool is_kept(const std::string& path, const std::string& file) {
  const Kept& last = kept();
  if (!last.gltf || last.files.front() != path) return false;
  try {
    return contents_of(last.files, file) == last.gltf->contents;
  } catch (const Error&) {
    return false;  // a buffer is missing: reading it again reports it
  }
}

}  // namespace

GltfRecord GltfModel::record(const char* list, std::size_t index) const {
  const std::size_t size = count(list);
  if (index >= size)
    fail_at(path, record_name(list, index), "is not there",
            size == 0 ? "no index: the list is empty" : "below " + std::to_string(size));
  return {path, record_name(list, index), lists.find(list)->second[index]};
}

std::size_t GltfModel::count(const char* list) const {
  const auto found = lists.find(list);
  return found == lists.end() ? 0 : found->second.size();
}

std::shared_ptr<const GltfModel> load_gltf(const std::string& path) {
  std::string file = read_asset_bytes(path);
  if (file.empty()) throw bad_file(path, "the file is empty");
  const std::lock_guard lock(kept().mutex);
  if (is_kept(path, file)) return kept().gltf;
  const auto gltf = std::make_shared<GltfModel>();
  gltf->path = path;
  add_hash(gltf->contents, file);
  gltf->file = std::move(file);
  const GltfChunks chunks = gltf_chunks(path, gltf->file);
  if (!chunks.is_aligned) gltf->warnings.push_back("its chunks are not aligned to 4 bytes, as glTF requires");
  const std::vector<GltfBuffer> buffers = build_gltf(chunks.json, *gltf);
  gltf->record_bytes = record_bytes(*gltf, chunks.json);
  check_compression(*gltf);
  std::vector<std::string> files{path};
  read_buffers(*gltf, chunks.binary, buffers, files);
  decode_buffer_views(*gltf);
  ReferenceCheck(*gltf).run();
  decode_primitives(*gltf);
  if (chunks.binary.data() == nullptr) gltf->file = {};
  kept().gltf = gltf;
  kept().files = std::move(files);
  return gltf;
}

Transform rotation(const std::array<double, 4>& quaternion) {
  const auto [x0, y0, z0, w0] = quaternion;
  const double norm = std::sqrt(x0 * x0 + y0 * y0 + z0 * z0 + w0 * w0);
  const double x = x0 / norm, y = y0 / norm, z = z0 / norm, w = w0 / norm;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
          {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
          {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
          {}};
}

Transform GltfPlacement::to_parent() const {
  Transform t = opaline::rotation(rotation);
  t.x *= scale.x, t.y *= scale.y, t.z *= scale.z;
  t.translation = translation;
  return t;
}

Transform GltfNode::to_parent() const {
  if (!placed) return {};
  const auto* placement = std::get_if<GltfPlacement>(placed.get());
  return placement != nullptr ? placement->to_parent() : std::get<Transform>(*placed);
}

Transform node_to_world(const GltfModel& gltf, std::size_t node, const GltfState* state) {
  const auto to_parent = [&](std::size_t at) {
    if (state != nullptr)
      if (const auto moved = state->placed.find(std::uint32_t(at)); moved != state->placed.end())
        return moved->second;
    return gltf.nodes[at].to_parent();
  };
  Transform to_world = to_parent(node);
  std::size_t steps = 0;
  for (std::uint32_t at = gltf.nodes[node].parent; at != kNoRecord; at = gltf.nodes[at].parent) {
    if (++steps > gltf.nodes.size())
      fail_at(gltf.path, record_name("nodes", node), "has two parents, or is its own", "a tree of nodes");
    to_world = compose(to_parent(at), to_world);
  }
  return to_world;
}

}  // namespace opaline
