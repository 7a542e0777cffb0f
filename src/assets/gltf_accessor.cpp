// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/gltf_accessor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace opaline {
namespace {

/// Where an accessor's elements lie, checked against its buffer view.
struct Elements {
  const unsigned char* first = nullptr;  ///< null: all zero
  std::size_t count = 0, stride = 0;
};

std::size_t component_bytes(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

template <class T>
double number(const unsigned char* bytes, bool normalized) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  if (!normalized || !std::numeric_limits<T>::is_integer) return double(value);
  return std::max(double(value) / double(std::numeric_limits<T>::max()), -1.);
}

double number(const unsigned char* bytes, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return number<std::int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return number<std::uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return number<std::int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return number<std::uint16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return number<std::uint32_t>(bytes, normalized);
    default:
      return number<float>(bytes, normalized);
  }
}

/// One accessor with its checks; `components` 1 of a scalar, 2 to 4 of a vector.
class AccessorReader {
 public:
  AccessorReader(const GltfModel& gltf, int index)
      : gltf_(gltf),
        accessor_(gltf.model.accessors[std::size_t(index)]),
        place_(record_name("accessors", std::size_t(index))) {}

  std::vector<double> run(std::size_t components) {
    size_ = component_bytes(accessor_.componentType);
    check_type(components);
    const Elements elements = dense(components * size_);
    std::vector<double> numbers(elements.count * components);
    if (elements.first != nullptr) copy(elements, components, numbers);
    if (accessor_.sparse.isSparse) replace(components, numbers);
    return numbers;
  }

 private:
  [[noreturn]] void fail(const std::string& message, const std::string& expected,
                         const std::string& got) const {
    fail_at(gltf_.path, place_, message, expected, got);
  }

  void check_type(std::size_t components) const {
    constexpr std::array<int, 4> types{TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3,
                                       TINYGLTF_TYPE_VEC4};
    constexpr std::array<const char*, 4> names{"SCALAR", "VEC2", "VEC3", "VEC4"};
    if (accessor_.type != types[components - 1])
      fail("is of the wrong type", names[components - 1],
           std::to_string(tinygltf::GetNumComponentsInType(std::uint32_t(accessor_.type))) + " components");
    if (size_ == 0)
      fail("has a componentType that is none of glTF", "5120 to 5123, 5125 or 5126",
           std::to_string(accessor_.componentType));
    if (accessor_.count == 0) fail("has no elements", "a count of at least 1", "0");
  }

  /// error unless `count` elements of `bytes` lie within the view
  Elements within(int view_index, std::size_t offset, std::size_t count, std::size_t bytes) const {
    const tinygltf::BufferView& view = gltf_.model.bufferViews[std::size_t(view_index)];
    const std::size_t stride = view.byteStride > 0 ? view.byteStride : bytes;
    const bool fits = offset <= view.byteLength && bytes <= view.byteLength - offset &&
                      count - 1 <= (view.byteLength - offset - bytes) / stride;
    if (!fits)
      fail("reaches beyond " + record_name("bufferViews", std::size_t(view_index)),
           "within " + std::to_string(view.byteLength) + " bytes",
           std::to_string(count) + " elements, " + std::to_string(stride) + " bytes apart, from " +
               std::to_string(offset));
    const tinygltf::Buffer& buffer = gltf_.model.buffers[std::size_t(view.buffer)];
    return {buffer.data.data() + view.byteOffset + offset, count, stride};
  }

  Elements dense(std::size_t bytes) const {
    if (accessor_.bufferView >= 0)
      return within(accessor_.bufferView, accessor_.byteOffset, accessor_.count, bytes);
    constexpr std::size_t most = 1 << 20;  // no file stands behind this number
    if (accessor_.count > most)
      fail("has no bufferView: its elements are 0", "at most " + std::to_string(most) + " of them",
           std::to_string(accessor_.count));
    return {nullptr, accessor_.count, 0};
  }

  void copy(const Elements& elements, std::size_t components, std::vector<double>& numbers) const {
    for (std::size_t i = 0; i < elements.count; ++i)
      for (std::size_t k = 0; k < components; ++k)
        numbers[i * components + k] = number(elements.first + i * elements.stride + k * size_,
                                             accessor_.componentType, accessor_.normalized);
  }

  void replace(std::size_t components, std::vector<double>& numbers) const {
    const auto& sparse = accessor_.sparse;
    const std::size_t index_bytes = component_bytes(sparse.indices.componentType);
    if (sparse.count <= 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 ||
        index_bytes == 0)
      fail("has a broken sparse part", "a count above 0, offsets from 0 and unsigned indices",
           "a count of " + std::to_string(sparse.count));
    const auto count = std::size_t(sparse.count);
    const Elements indices =
        within(sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset), count, index_bytes);
    const Elements values =
        within(sparse.values.bufferView, std::size_t(sparse.values.byteOffset), count, components * size_);
    for (std::size_t i = 0; i < count; ++i) {
      const double at = number(indices.first + i * indices.stride, sparse.indices.componentType, false);
      if (!(at >= 0 && at < double(accessor_.count)))
        fail("has a sparse index beyond its elements", "below " + std::to_string(accessor_.count),
             std::to_string(at));
      for (std::size_t k = 0; k < components; ++k)
        numbers[std::size_t(at) * components + k] = number(values.first + i * values.stride + k * size_,
                                                           accessor_.componentType, accessor_.normalized);
    }
  }

  const GltfModel& gltf_;
  const tinygltf::Accessor& accessor_;
  std::string place_;
  std::size_t size_ = 0;  // of a component, bytes
};

}  // namespace

std::vector<Vec3d> read_vectors(const GltfModel& gltf, int index) {
  const std::vector<double> numbers = AccessorReader(gltf, index).run(3);
  std::vector<Vec3d> vectors;
  vectors.reserve(numbers.size() / 3);
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    vectors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return vectors;
}

std::vector<std::array<double, 4>> read_quadruples(const GltfModel& gltf, int index) {
  const std::vector<double> numbers = AccessorReader(gltf, index).run(4);
  std::vector<std::array<double, 4>> quadruples;
  quadruples.reserve(numbers.size() / 4);
  for (std::size_t i = 0; i < numbers.size(); i += 4)
    quadruples.push_back({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]});
  return quadruples;
}

std::vector<std::array<float, 2>> read_pairs(const GltfModel& gltf, int index) {
  const std::vector<double> numbers = AccessorReader(gltf, index).run(2);
  std::vector<std::array<float, 2>> pairs;
  pairs.reserve(numbers.size() / 2);
  for (std::size_t i = 0; i < numbers.size(); i += 2)
    pairs.push_back({float(numbers[i]), float(numbers[i + 1])});
  return pairs;
}

std::vector<std::uint32_t> read_indices(const GltfModel& gltf, int index) {
  const int type = gltf.model.accessors[std::size_t(index)].componentType;
  if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    fail_at(gltf.path, record_name("accessors", std::size_t(index)), "cannot hold indices",
            "a componentType of 5121, 5123 or 5125", std::to_string(type));
  const std::vector<double> numbers = AccessorReader(gltf, index).run(1);
  std::vector<std::uint32_t> indices;
  indices.reserve(numbers.size());
  for (const double value : numbers) indices.push_back(std::uint32_t(value));
  return indices;
}

}  // namespace opaline
