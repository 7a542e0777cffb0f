// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/gltf_instances.h"

#include <fmt/format.h>

#include "asset_files/gltf_accessor.h"

namespace opaline {

std::vector<Transform> read_instances(const GltfModel& gltf, std::size_t node) {
  constexpr std::size_t kMostInstances = 100000;  // each is a shape
  const auto found = gltf.instances.find(node);
  if (found == gltf.instances.end()) return {Transform{}};
  const GltfAttributes& attributes = found->second;
  std::vector<Transform> all;
  const auto for_each = [&](const char* name, const auto& read, const auto& use) {
    const auto attribute = attributes.find(name);
    if (attribute == attributes.end()) return;
    const std::string place = record_name("accessors", attribute->second);
    if (const std::size_t count = gltf.accessors[attribute->second].count; count > kMostInstances)
      fail_at(gltf.path, place, "has too many instances", fmt::format("at most {}", kMostInstances),
              std::to_string(count));
    const auto values = read(gltf, attribute->second);
    if (!all.empty() && values.size() != all.size())
      fail_at(gltf.path, place, "has the wrong number of instances", std::to_string(all.size()),
              std::to_string(values.size()));
    all.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) use(all[i], values[i]);
  };
  for_each("ROTATION", read_quadruples, [](Transform& t, const auto& q) { t = rotation(q); });
  for_each("SCALE", read_vectors, [](Transform& t, const Vec3d& s) {
    t = {t.x * s.x, t.y * s.y, t.z * s.z, {}};
  });
  for_each("TRANSLATION", read_vectors, [](Transform& t, const Vec3d& p) { t.translation = p; });
  return all;
}

}  // namespace opaline
