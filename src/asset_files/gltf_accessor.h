// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of a glTF accessor.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "asset_files/gltf_model.h"
#include "opaline/vec3.h"

namespace opaline {

/// Calls use with a 0 of a componentType's numbers; a float's for unknown types.
template <class Use>
auto with_component(std::size_t type, const Use& use) {
  switch (type) {
    case kGltfByte:
      return use(std::int8_t());
    case kGltfUnsignedByte:
      return use(std::uint8_t());
    case kGltfShort:
      return use(std::int16_t());
    case kGltfUnsignedShort:
      return use(std::uint16_t());
    case kGltfUnsignedInt:
      return use(std::uint32_t());
    default:
      return use(float());
  }
}

/// in    index: of an existing accessor
/// out   its vectors, with sparse ones substituted, and normalized integers converted
/// error Error{bad_input}: not a VEC3, or beyond its buffer view
std::vector<Vec3d> read_vectors(const GltfModel& gltf, std::uint32_t index);

/// The same of VEC4.
std::vector<std::array<double, 4>> read_quadruples(const GltfModel& gltf, std::uint32_t index);

/// The same of VEC2.
std::vector<std::array<float, 2>> read_pairs(const GltfModel& gltf, std::uint32_t index);

/// The same of MAT4, the last row left out.
std::vector<Transform> read_matrices(const GltfModel& gltf, std::uint32_t index);

/// The same of unsigned scalars.
std::vector<std::uint32_t> read_indices(const GltfModel& gltf, std::uint32_t index);

/// The numbers of SCALAR, VEC3 or VEC4, by their components.
std::vector<double> read_numbers(const GltfModel& gltf, std::uint32_t index, std::size_t components);

/// error Error{bad_input}: the accessor has integers, and the file does not declare KHR_mesh_quantization
void check_positions_type(const GltfModel& gltf, std::uint32_t index);

/// error Error{bad_input}: the accessor's numbers have a sign or fractions
void check_unsigned(const GltfModel& gltf, std::uint32_t index);

}  // namespace opaline
