// SPDX-License-Identifier: GPL-3.0-or-later
// Cache entries of any stage, sealed with the hash that makes them whole, as their stage reads them; what is
// believed is used.
#include <array>

#include "cache/content_hash.h"
#include "cache/entry_header.h"
#include "fuzz_target.h"
#include "input/load_scene.h"
#include "methods/hierarchical/hierarchical_state.h"
#include "methods/hierarchical/surface_caches.h"
#include "session/session_records.h"
#include "stages/stage_codecs.h"
#include "subsurface/method.h"

namespace opaline::fuzz {
namespace {

constexpr const char* kScene = R"({
  "media": {"marble": {"preset": "marble"}},
  "shapes": [{"box": {"low": [-5, -5, -5], "high": [5, 5, 5]}, "medium": "marble"}],
  "lights": [{"type": "point", "position": [20, 30, 40], "intensity": 1000}],
  "film": {"resolution": [16, 16]},
  "settings": {"samples": 60, "evaluator": "surface_cache"}
})";

/// The scene with all its results.
struct Computed {
  Session session;
  explicit Computed(StageCache* cache) : session(cache) {
    session.edit(parse_scene(kScene, "scene.json"));
    session.prepare();
  }
  const Body& group() const { return session.bodies().front(); }
};

StageKey hash_of(std::string_view listing, std::string_view payload) {
  ContentHash hash;
  hash.add(listing.data(), listing.size());
  hash.add(payload.data(), payload.size());
  return hash.value();
}

/// Under the name, with the length and hash that its listing and payload have; as it is where it has no
/// listing.
std::string sealed(const EntryName& name, const std::string& bytes) {
  if (bytes.size() < kUserBlock) return bytes;
  const std::size_t begin = bytes.find("\nkey "), first = bytes.find('\n', begin + 1),
                    last = bytes.find("\npayload ", begin);
  if (begin == bytes.npos || last == bytes.npos || first > last || last > kUserBlock) return bytes;
  const std::string listing = bytes.substr(first + 1, last - first), payload = bytes.substr(kUserBlock);
  std::string header = header_text(name, listing, payload.size(), hash_of(listing, payload));
  header.resize(kUserBlock);
  return header + payload;
}

void look_up(const SurfaceCache& exitance, const World& world, std::uint32_t mesh) {
  for (std::uint32_t t = 0; t < world.meshes[mesh].triangles.size(); ++t)
    for (const auto& [u, v] : {std::pair(0.f, 0.f), {1.f, 0.f}, {0.f, 1.f}, {.3f, .6f}, {.33f, .33f}})
      exitance.at(mesh, t, u, v);
}

void evaluate_with(const Octree& tree, const Computed& computed) {
  const Body& known = computed.group();
  Body group{known.plan, known.profile, known.boundary, known.surface, known.transfers, known.entering};
  hierarchical_state(group).kernels = hierarchical_state(known).kernels;
  hierarchical_state(group).tree.value = tree;
  for (const EvaluatorKind evaluator : {EvaluatorKind::dual_tree, EvaluatorKind::classic}) {
    Settings settings = computed.session.scene().settings;
    settings.evaluator = evaluator;
    const std::vector<Vec3d> points{{5, 0, 0}, {0, 5, 1}};
    const std::vector<Vec3f> normals{{1, 0, 0}, {0, 1, 0}};
    radiant_exitance(group, computed.session.world(), points, normals, settings);
  }
}

void try_entry(const std::string& stage, StageCache& cache, const StageKey& key, const Computed& computed) {
  const World& world = computed.session.world();
  const Body& group = computed.group();
  if (stage == "samples") cache.find(key, SamplesCodec{{world, group.plan.meshes, group.plan.samples}});
  if (stage == "light") cache.find(key, LightCodec{group.surface.samples.size()});
  if (stage == "octree")
    if (const auto tree = cache.find(key, OctreeCodec{group.surface})) evaluate_with(*tree, computed);
  if (stage == "exitance")
    if (const auto exitance = cache.find(key, SurfaceCacheCodec{world, group.plan.meshes}))
      look_up(*exitance, world, group.plan.meshes[0]);
}

}  // namespace

std::vector<std::string> seeds() {
  const ScratchFile file("seeds");
  StageCache cache(file.folder() + "/cache");
  Computed computed(&cache);
  std::vector<std::string> all;
  for (const char* stage : {"samples", "light", "octree", "exitance"})
    for (const auto& entry : std::filesystem::directory_iterator(file.folder() + "/cache"))
      if (entry.path().filename().string().starts_with(stage)) all.push_back(file_bytes(entry.path()));
  expect(all.size() == 4, "an entry of each stage");
  return all;
}

std::vector<std::string> words() {
  return {"\nsamples 1 x 56 at 1024",
          " x ",
          " at ",
          "18446744073709551615",
          std::string("\0\0\x80\x7f", 4),
          std::string("\0\0\xc0\x7f", 4),
          std::string("\xff\xff\xff\xff", 4),
          std::string(4, '\0')};
}

}  // namespace opaline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace opaline;
  static const fuzz::ScratchFile file("entry");
  static const fuzz::Computed computed(nullptr);
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t at = bytes.find("\nstage ");
  const std::string word = at == bytes.npos ? "" : bytes.substr(at + 7, bytes.find('\n', at + 1) - at - 7);
  for (const std::string stage : {"samples", "light", "octree", "exitance"}) {
    if (!word.empty() && word != stage) continue;
    const EntryName name{stage, {1, 2}};
    const std::string path = file.folder() + '/' + file_name(name);
    const std::string entry = fuzz::sealed(name, bytes);
    std::ofstream(path, std::ios::binary).write(entry.data(), std::streamsize(entry.size()));
    StageCache cache(file.folder());
    fuzz::try_input([&] { fuzz::try_entry(stage, cache, name.key, computed); });
  }
  return 0;
}
