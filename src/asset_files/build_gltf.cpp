// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/build_gltf.h"

#include <algorithm>
#include <array>

namespace opaline {
namespace {

constexpr const char *kMeshopt = "EXT_meshopt_compression", *kDraco = "KHR_draco_mesh_compression";
constexpr int kMostDepth = 128;
constexpr std::array<std::string_view, 6> kLazyLists{"materials", "cameras",  "skins",
                                                     "images",    "textures", "animations"};
constexpr std::array<std::string_view, 6> kReadLists{"buffers", "bufferViews", "accessors",
                                                     "meshes",  "nodes",       "scenes"};

bool contains(const auto& list, std::string_view name) {
  return std::ranges::find(list, name) != list.end();
}

GltfAttributes read_attributes(const GltfRecord& record) {
  GltfAttributes attributes;
  for (const std::string& key : record.keys()) attributes[key] = record.index(key.c_str());
  return attributes;
}

GltfBufferView read_view(const GltfRecord& record) {
  return {record.need("buffer").index("buffer"), record.size("byteOffset", 0),
          record.need("byteLength").size("byteLength", 0), record.size("byteStride", 0)};
}

GltfCompressedView read_compressed_view(const GltfRecord& record) {
  return {.buffer = record.need("buffer").index("buffer"),
          .offset = record.size("byteOffset", 0),
          .length = record.need("byteLength").size("byteLength", 0),
          .stride = record.need("byteStride").size("byteStride", 0),
          .count = record.need("count").size("count", 0),
          .mode = record.need("mode").text("mode"),
          .filter = record.text("filter", "NONE")};
}

GltfSparse read_sparse(const GltfRecord& record) {
  const GltfRecord indices = record.need("indices").record("indices"),
                   values = record.need("values").record("values");
  return {.count = record.need("count").size("count", 0),
          .index_offset = indices.size("byteOffset", 0),
          .value_offset = values.size("byteOffset", 0),
          .index_view = indices.need("bufferView").index("bufferView"),
          .value_view = values.need("bufferView").index("bufferView"),
          .index_component = indices.need("componentType").size("componentType", 0)};
}

GltfAccessor read_accessor(const GltfRecord& record) {
  GltfAccessor accessor{.view = record.index("bufferView"),
                        .offset = record.size("byteOffset", 0),
                        .count = record.need("count").size("count", 0),
                        .component = record.need("componentType").size("componentType", 0),
                        .type = record.need("type").text("type"),
                        .is_normalized = record.flag("normalized", false)};
  if (record.has("sparse")) accessor.sparse = read_sparse(record.record("sparse"));
  return accessor;
}

GltfMesh read_mesh(const GltfRecord& record) {
  GltfMesh mesh{record.text("name"), {}, record.numbers("weights")};
  for (const GltfRecord& part : record.need("primitives").records("primitives")) {
    GltfPrimitive primitive{.attributes = read_attributes(part.record("attributes")),
                            .indices = part.index("indices"),
                            .material = part.index("material"),
                            .mode = part.size("mode", kGltfTriangles)};
    for (const GltfRecord& target : part.records("targets"))
      primitive.targets.push_back(read_attributes(target));
    if (const GltfRecord extensions = part.record("extensions"); extensions.has(kDraco)) {
      const GltfRecord draco = extensions.record(kDraco);
      primitive.draco_view = draco.need("bufferView").index("bufferView");
      primitive.draco_ids = read_attributes(draco.need("attributes").record("attributes"));
    }
    mesh.primitives.push_back(std::move(primitive));
  }
  return mesh;
}

std::variant<GltfPlacement, Transform> read_placement(const GltfRecord& record) {
  const std::vector<double> m = record.numbers("matrix", 16), q = record.numbers("rotation", 4),
                            s = record.numbers("scale", 3), p = record.numbers("translation", 3);
  if (!m.empty())
    return Transform{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  GltfPlacement placement;
  if (!q.empty()) {
    if (q == std::vector<double>(4)) record.fail("rotation", "is not a rotation", "a nonzero quaternion");
    placement.rotation = {q[0], q[1], q[2], q[3]};
  }
  if (!s.empty()) placement.scale = {s[0], s[1], s[2]};
  if (!p.empty()) placement.translation = {p[0], p[1], p[2]};
  return placement;
}

class GltfBuilder {
 public:
  explicit GltfBuilder(GltfModel& gltf) : gltf_(gltf) {}

  /// Processes and frees records as they are parsed, so the JSON of a million nodes never exists as a whole.
  std::vector<GltfBuffer> run(std::string_view text) {
    const auto take_records = [this](int depth, Json::parse_event_t event, Json& parsed) {
      return keeps(depth, event, parsed);
    };
    try {
      const Json root = Json::parse(text.begin(), text.end(), take_records);
      read_root(root);
    } catch (const Json::exception& failure) {
      // "[json.exception.parse_error.101] parse error at line 1, ...": the number is the library's.
      const std::string what = failure.what();
      throw bad_file(gltf_.path, "cannot be read as glTF 2.0: " +
                                     what.substr(std::min(what.find("] ") + 2, what.size())));
    }
    return std::move(buffers_);
  }

 private:
  bool keeps(int depth, Json::parse_event_t event, Json& parsed) {
    using Event = Json::parse_event_t;
    if (depth > kMostDepth)
      throw bad_file(gltf_.path, "its JSON is nested too deep",
                     "at most " + std::to_string(kMostDepth) + " levels");
    if (depth == 1 && event == Event::key) list_ = parsed.get<std::string>();
    if (depth != 2 || (event != Event::object_end && event != Event::array_end && event != Event::value))
      return true;
    if (contains(kLazyLists, list_)) {
      gltf_.lists[list_].push_back(std::move(parsed));
      return false;
    }
    if (!contains(kReadLists, list_)) return true;
    take(parsed);
    return false;
  }

  void take(const Json& json) {
    const std::size_t index = counts_[list_]++;
    const GltfRecord record(gltf_.path, record_name(list_, index), json);
    if (list_ == "buffers")
      buffers_.push_back({record.need("byteLength").size("byteLength", 0), record.text("uri"),
                          record.record("extensions").record(kMeshopt).flag("fallback", false)});
    if (list_ == "bufferViews") {
      gltf_.views.push_back(read_view(record));
      if (const GltfRecord extensions = record.record("extensions"); extensions.has(kMeshopt))
        gltf_.compressed_views[index] = read_compressed_view(extensions.record(kMeshopt));
    }
    if (list_ == "accessors") gltf_.accessors.push_back(read_accessor(record));
    if (list_ == "meshes") gltf_.meshes.push_back(read_mesh(record));
    if (list_ == "nodes") take_node(index, record);
    if (list_ == "scenes") gltf_.scenes.push_back(record.indices("nodes"));
  }

  void take_node(std::size_t index, const GltfRecord& record) {
    const GltfRecord extensions = record.record("extensions");
    std::variant<GltfPlacement, Transform> placed = read_placement(record);
    const bool is_placed =
        record.has("matrix") || record.has("rotation") || record.has("scale") || record.has("translation");
    gltf_.nodes.push_back(
        {.name = record.text("name"),
         .mesh = record.index("mesh"),
         .camera = record.index("camera"),
         .skin = record.index("skin"),
         .light = extensions.record("KHR_lights_punctual").index("light"),
         .children = record.indices("children"),
         .placed =
             is_placed ? std::make_unique<const std::variant<GltfPlacement, Transform>>(placed) : nullptr});
    if (record.has("weights")) gltf_.node_weights[index] = record.numbers("weights");
    if (extensions.has("EXT_mesh_gpu_instancing"))
      gltf_.instances[index] =
          read_attributes(extensions.record("EXT_mesh_gpu_instancing").record("attributes"));
  }

  void read_root(const Json& json) {
    if (!json.is_object()) throw bad_file(gltf_.path, "is not a glTF file", "a JSON object");
    const GltfRecord root(gltf_.path, "", json);
    const std::string version = root.record("asset").text("version");
    if (version.empty())
      throw bad_file(gltf_.path, "cannot be read as glTF 2.0: asset.version is missing", "\"2.0\"");
    if (!version.starts_with("2.")) fail_at(gltf_.path, "asset.version", "is not supported", "2.0", version);
    for (const std::string_view list : kReadLists) root.records(std::string(list).c_str());
    for (const std::string_view list : kLazyLists) root.records(std::string(list).c_str());
    gltf_.scene = root.index("scene");
    gltf_.extensions_used = root.texts("extensionsUsed");
    gltf_.extensions_required = root.texts("extensionsRequired");
    const GltfRecord extensions = root.record("extensions"),
                     lights = extensions.record("KHR_lights_punctual");
    if (lights.has("lights")) {
      lights.records("lights");
      gltf_.lists["lights"] = json["extensions"]["KHR_lights_punctual"]["lights"].get<std::vector<Json>>();
    }
  }

  GltfModel& gltf_;
  std::vector<GltfBuffer> buffers_;
  std::string list_;
  std::map<std::string, std::size_t> counts_;
};

}  // namespace

std::vector<GltfBuffer> build_gltf(std::string_view json, GltfModel& gltf) {
  return GltfBuilder(gltf).run(json);
}

}  // namespace opaline
