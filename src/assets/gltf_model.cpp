// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>  // tinygltf does not, without its own access to files
#include <sstream>

#define TINYGLTF_IMPLEMENTATION
#include <algorithm>
#include <array>
#include <filesystem>
#include <mutex>
#include <vector>

#include "assets/gltf_model.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace opaline {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 3> compressions{"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                                  "KHR_meshopt_compression"};

/// A buffer's bytes must be longer by what tinygltf may read behind a chunk that lies about its length.
constexpr std::size_t spare_bytes = 16;

void add_hash(std::string& contents, const void* bytes, std::size_t size) {
  const XXH128_hash_t hash = XXH3_128bits(bytes, size);
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, hash);
  contents.append(reinterpret_cast<const char*>(canonical.digest), sizeof canonical.digest);
}

/// The files beside the asset, as tinygltf asks for them.
struct Neighbours {
  std::string folder;  ///< with a slash at its end
  std::vector<std::string> read;
  std::string failure;
};

/// tinygltf looks into the folder of the program's user as well, and takes a + in an URI for a space.
std::string existing(const Neighbours& beside, const std::string& name) {
  if (!name.starts_with(beside.folder)) return {};
  std::error_code ignored;
  if (fs::is_regular_file(name, ignored)) return name;
  std::string plus = name;
  std::ranges::replace(plus, ' ', '+');
  return fs::is_regular_file(plus, ignored) ? plus : std::string();
}

bool file_exists(const std::string& name, void* user_data) {
  return !existing(*static_cast<const Neighbours*>(user_data), name).empty();
}

std::string same_path(const std::string& name, void*) {
  return name;
}

bool read_whole_file(std::vector<unsigned char>* out, std::string*, const std::string& name,
                     void* user_data) {
  Neighbours& beside = *static_cast<Neighbours*>(user_data);
  const std::string path = existing(beside, name);
  try {
    const std::string bytes = read_asset_bytes(path);
    out->assign(bytes.begin(), bytes.end());
  } catch (const Error& failure) {
    beside.failure = failure.what();
    return false;
  }
  beside.read.push_back(path);
  return true;
}

[[maybe_unused]] bool file_size(std::size_t* size, std::string*, const std::string& name, void* user_data) {
  std::error_code failed;
  *size = fs::file_size(existing(*static_cast<const Neighbours*>(user_data), name), failed);
  return !failed;
}

/// tinygltf 2.9 also asks for the size of a file, 2.7 does not.
template <class Callbacks>
Callbacks file_callbacks(Neighbours& beside) {
  Callbacks callbacks{};
  callbacks.FileExists = file_exists;
  callbacks.ExpandFilePath = same_path;
  callbacks.ReadWholeFile = read_whole_file;
  if constexpr (requires { callbacks.GetFileSizeInBytes; }) callbacks.GetFileSizeInBytes = file_size;
  callbacks.user_data = &beside;
  return callbacks;
}

bool take_no_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
                   int, void*) {
  return true;
}

/// The first record that was not read, in the order in which tinygltf reads the lists; empty: none is missing.
std::string first_unread(const GltfModel& gltf) {
  const tinygltf::Model& m = gltf.model;
  const std::array<std::pair<const char*, std::size_t>, 8> lists{{{"buffers", m.buffers.size()},
                                                                  {"bufferViews", m.bufferViews.size()},
                                                                  {"accessors", m.accessors.size()},
                                                                  {"meshes", m.meshes.size()},
                                                                  {"nodes", m.nodes.size()},
                                                                  {"scenes", m.scenes.size()},
                                                                  {"materials", m.materials.size()},
                                                                  {"cameras", m.cameras.size()}}};
  for (const auto& [name, size] : lists) {
    const auto listed = gltf.counts.find(name);
    if (listed != gltf.counts.end() && size < listed->second) return record_name(name, size);
  }
  return {};
}

std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  for (char& c : text)
    if (c < ' ') c = ' ';
  constexpr std::size_t most = 300;  // a data URI would follow
  if (text.size() > most) text = text.substr(0, most) + "...";
  return text;
}

void check_compression(const GltfModel& gltf) {
  for (const std::string& name : gltf.model.extensionsRequired)
    if (std::ranges::find(compressions, name) != compressions.end())
      throw bad_file(gltf.path, "its meshes are compressed by " + name + ", which is not read",
                     "an asset exported without compression");
}

/// Indices between the records; all names are of their JSON.
class ReferenceCheck {
 public:
  explicit ReferenceCheck(const GltfModel& gltf) : path_(gltf.path), model_(gltf.model) {}

  void run() const {
    for (std::size_t i = 0; i < model_.bufferViews.size(); ++i) buffer_view(i);
    for (std::size_t i = 0; i < model_.accessors.size(); ++i) accessor(i);
    for (std::size_t i = 0; i < model_.meshes.size(); ++i) mesh(i);
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) node(i);
    for (std::size_t i = 0; i < model_.scenes.size(); ++i)
      for (const int root : model_.scenes[i].nodes)
        index(record_name("scenes", i) + ".nodes", root, model_.nodes.size());
    optional(std::string("scene"), model_.defaultScene, model_.scenes.size());
  }

 private:
  void index(const std::string& place, int value, std::size_t size) const {
    if (value >= 0 && std::size_t(value) < size) return;
    fail_at(path_, place, "points at nothing",
            size == 0 ? "nothing: there is none" : "0 to " + std::to_string(size - 1), std::to_string(value));
  }

  void optional(const std::string& place, int value, std::size_t size) const {
    if (value != -1) index(place, value, size);
  }

  void buffer_view(std::size_t i) const {
    const tinygltf::BufferView& view = model_.bufferViews[i];
    const std::string place = record_name("bufferViews", i);
    index(place + ".buffer", view.buffer, model_.buffers.size());
    const std::size_t size = model_.buffers[std::size_t(view.buffer)].data.size();
    if (view.byteOffset > size || view.byteLength > size - view.byteOffset)
      fail_at(path_, place, "reaches beyond its buffer", "within " + std::to_string(size) + " bytes",
              std::to_string(view.byteLength) + " from " + std::to_string(view.byteOffset));
  }

  void accessor(std::size_t i) const {
    const tinygltf::Accessor& accessor = model_.accessors[i];
    const std::string place = record_name("accessors", i);
    optional(place + ".bufferView", accessor.bufferView, model_.bufferViews.size());
    if (!accessor.sparse.isSparse) return;
    index(place + ".sparse.indices.bufferView", accessor.sparse.indices.bufferView,
          model_.bufferViews.size());
    index(place + ".sparse.values.bufferView", accessor.sparse.values.bufferView, model_.bufferViews.size());
  }

  void mesh(std::size_t i) const {
    for (std::size_t p = 0; p < model_.meshes[i].primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = model_.meshes[i].primitives[p];
      const std::string place = record_name("meshes", i) + '.' + record_name("primitives", p);
      for (const auto& [name, accessor] : primitive.attributes)
        index(place + ".attributes." + name, accessor, model_.accessors.size());
      optional(place + ".indices", primitive.indices, model_.accessors.size());
      optional(place + ".material", primitive.material, model_.materials.size());
    }
  }

  void node(std::size_t i) const {
    const tinygltf::Node& node = model_.nodes[i];
    const std::string place = record_name("nodes", i);
    optional(place + ".mesh", node.mesh, model_.meshes.size());
    optional(place + ".camera", node.camera, model_.cameras.size());
    for (const int child : node.children) index(place + ".children", child, model_.nodes.size());
  }

  const std::string& path_;
  const tinygltf::Model& model_;
};

/// in    file: is written to, see prepare_gltf_json
void parse(GltfModel& gltf, std::string& file, Neighbours& beside) {
  GltfOutline outline = prepare_gltf_json(gltf.path, file);
  gltf.counts = std::move(outline.counts);
  gltf.images = std::move(outline.images);
  gltf.textures = std::move(outline.textures);
  const std::size_t size = file.size();
  if (size > 0xffffffff) throw bad_file(gltf.path, "is too large for a glTF file", "less than 4 GiB");
  file.resize(size + spare_bytes);
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(file_callbacks<tinygltf::FsCallbacks>(beside));
  loader.SetImageLoader(take_no_image, nullptr);
  std::string error, warning;
  bool good = false;
  try {
    const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
    good = file.starts_with("glTF") ? loader.LoadBinaryFromMemory(&gltf.model, &error, &warning, bytes,
                                                                  unsigned(size), beside.folder)
                                    : loader.LoadASCIIFromString(&gltf.model, &error, &warning, file.data(),
                                                                 unsigned(size), beside.folder);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& failure) {
    error += failure.what();
  }
  check_compression(gltf);
  if (good && error.empty()) return;
  // "[json.exception.parse_error.101] parse error at line 1, ...": the number is the library's.
  if (error.starts_with("[json.exception.")) error.erase(0, std::min(error.find("] "), error.size() - 2) + 2);
  if (!beside.failure.empty()) error = beside.failure;
  const std::string record = gltf.model.asset.version.empty() ? "" : first_unread(gltf);
  throw bad_file(gltf.path,
                 (record.empty() ? "" : record + ": ") + "cannot be read as glTF 2.0: " + one_line(error));
}

/// Of a GLB file: glTF 1 had another layout under the same name.
void check_binary_version(const std::string& path, const std::string& file) {
  constexpr std::size_t version_at = 4;
  if (file.starts_with("glTF") && file.size() > version_at && file[version_at] != 2)
    throw bad_file(path, "is not of a version that is read", "binary glTF 2",
                   std::to_string(int(std::uint8_t(file[version_at]))));
}

void check_version(const GltfModel& gltf) {
  if (!gltf.model.asset.version.starts_with("2."))
    fail_at(gltf.path, "asset.version", "is not one that is read", "2.0", gltf.model.asset.version);
}

/// The last asset, and what it was read from.
struct Kept {
  std::mutex mutex;
  std::shared_ptr<const GltfModel> gltf;
  std::vector<std::string> files;  ///< the asset, then its buffers
};

Kept& kept() {
  static Kept last;
  return last;
}

/// Of all files, read again.
std::string contents_of(const std::vector<std::string>& files, const std::string& first) {
  std::string contents;
  add_hash(contents, first.data(), first.size());
  for (std::size_t i = 1; i < files.size(); ++i) {
    const std::string bytes = read_asset_bytes(files[i]);
    add_hash(contents, bytes.data(), bytes.size());
  }
  return contents;
}

bool is_kept(const std::string& path, const std::string& file) {
  const Kept& last = kept();
  if (!last.gltf || last.files.front() != path) return false;
  try {
    return contents_of(last.files, file) == last.gltf->contents;
  } catch (const Error&) {
    return false;  // a buffer is gone: reading it again says which
  }
}

}  // namespace

void fail_at(const std::string& path, const std::string& record, const std::string& message,
             const std::string& expected, const std::string& got) {
  throw bad_file(path, record + ' ' + message, expected, got);
}

std::string record_name(const char* list, std::size_t index) {
  return std::string(list) + '[' + std::to_string(index) + ']';
}

std::shared_ptr<const GltfModel> load_gltf(const std::string& path) {
  std::string file = read_asset_bytes(path);
  if (file.empty()) throw bad_file(path, "the file is empty");
  const std::lock_guard lock(kept().mutex);
  if (is_kept(path, file)) return kept().gltf;
  const auto gltf = std::make_shared<GltfModel>();
  gltf->path = path;
  add_hash(gltf->contents, file.data(), file.size());
  const fs::path folder = fs::path(path).parent_path();
  check_binary_version(path, file);
  Neighbours beside{(folder.empty() ? "." : folder.string()) + '/', {}, {}};
  parse(*gltf, file, beside);
  check_version(*gltf);
  ReferenceCheck(*gltf).run();
  std::vector<std::string> files{path};
  files.insert(files.end(), beside.read.begin(), beside.read.end());
  for (const std::string& name : beside.read) {
    const std::string bytes = read_asset_bytes(name);
    add_hash(gltf->contents, bytes.data(), bytes.size());
  }
  kept().gltf = gltf;
  kept().files = std::move(files);
  return gltf;
}

}  // namespace opaline
