// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/gltf_uv_set.h"

namespace opaline {

std::string uv_attribute(std::size_t uv_set) {
  return "TEXCOORD_" + std::to_string(uv_set);
}

std::size_t uv_set_of(const GltfRecord& texture_info) {
  const GltfRecord transform = texture_info.record("extensions").record("KHR_texture_transform");
  return transform.size("texCoord", texture_info.size("texCoord", 0));
}

std::size_t uv_set_of(const GltfModel& gltf, const GltfPrimitive& primitive) {
  if (primitive.material == kNoRecord || primitive.material >= gltf.count("materials")) return 0;
  const GltfRecord material = gltf.record("materials", primitive.material),
                   pbr = material.record("pbrMetallicRoughness"), extensions = material.record("extensions"),
                   diffuse_transmission = extensions.record("KHR_materials_diffuse_transmission");
  for (const GltfRecord& info :
       {extensions.record("KHR_materials_pbrSpecularGlossiness").record("diffuseTexture"),
        pbr.record("baseColorTexture"), pbr.record("metallicRoughnessTexture"),
        material.record("normalTexture"),
        extensions.record("KHR_materials_transmission").record("transmissionTexture"),
        diffuse_transmission.record("diffuseTransmissionTexture"),
        diffuse_transmission.record("diffuseTransmissionColorTexture"), material.record("emissiveTexture"),
        extensions.record("KHR_materials_sheen").record("sheenColorTexture"),
        extensions.record("KHR_materials_sheen").record("sheenRoughnessTexture")}) {
    if (info.index("index") == kNoRecord) continue;
    const std::size_t uv_set = uv_set_of(info);
    if (primitive.attributes.contains(uv_attribute(uv_set))) return uv_set;
  }
  return 0;
}

}  // namespace opaline
