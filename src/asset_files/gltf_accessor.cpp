// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/gltf_accessor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <type_traits>

namespace opaline {
namespace {

/// Where an accessor's elements lie, checked against its buffer view.
struct Elements {
  const char* first = nullptr;  ///< null: all zero
  std::size_t count = 0, stride = 0;
};

std::size_t component_bytes(std::size_t type) {
  switch (type) {
    case kGltfByte:
    case kGltfUnsignedByte:
      return 1;
    case kGltfShort:
    case kGltfUnsignedShort:
      return 2;
    case kGltfUnsignedInt:
    case kGltfFloat:
      return 4;
    default:
      return 0;
  }
}

template <class T>
double number(const char* bytes, bool normalized) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  if (!normalized || !std::numeric_limits<T>::is_integer) return double(value);
  return std::max(double(value) / double(std::numeric_limits<T>::max()), -1.);
}

double number(const char* bytes, std::size_t type, bool normalized) {
  return with_component(type, [&](auto zero) { return number<decltype(zero)>(bytes, normalized); });
}

/// One accessor with its checks.
class AccessorReader {
 public:
  AccessorReader(const GltfModel& gltf, std::uint32_t index)
      : gltf_(gltf), accessor_(gltf.accessors[index]), place_(record_name("accessors", index)) {}

  /// in    components: of an element of this type
  std::vector<double> run(std::string_view type, std::size_t components) {
    size_ = component_bytes(accessor_.component);
    check_type(type);
    const Elements elements = dense(components * size_);
    std::vector<double> numbers(elements.count * components);
    if (elements.first != nullptr) copy(elements, components, numbers);
    if (accessor_.sparse) replace(components, numbers);
    return numbers;
  }

  /// Calls prepare(count), then use(numbers) with each element, without a list of all numbers where they are dense.
  template <std::size_t kNumbers, class Prepare, class Use>
  void for_each(std::string_view type, const Prepare& prepare, const Use& use) {
    size_ = component_bytes(accessor_.component);
    if (accessor_.sparse || accessor_.view == kNoRecord) {
      const std::vector<double> numbers = run(type, kNumbers);
      prepare(numbers.size() / kNumbers);
      for (std::size_t i = 0; i < numbers.size(); i += kNumbers) use(numbers.data() + i);
      return;
    }
    check_type(type);
    const Elements elements = dense(kNumbers * size_);
    prepare(elements.count);
    with_component(accessor_.component, [&](auto zero) { visit<decltype(zero), kNumbers>(elements, use); });
  }

 private:
  template <class T, std::size_t kNumbers, class Use>
  void visit(const Elements& elements, const Use& use) const {
    const bool is_normalized = accessor_.is_normalized;
    std::array<double, kNumbers> numbers;
    for (std::size_t i = 0; i < elements.count; ++i) {
      const char* const bytes = elements.first + i * elements.stride;
      for (std::size_t k = 0; k < kNumbers; ++k) numbers[k] = number<T>(bytes + k * sizeof(T), is_normalized);
      use(numbers.data());
    }
  }

  [[noreturn]] void fail(const std::string& message, const std::string& expected,
                         const std::string& got) const {
    fail_at(gltf_.path, place_, message, expected, got);
  }

  void check_type(std::string_view type) const {
    if (accessor_.type != type) fail("is of the wrong type", std::string(type), accessor_.type);
    if (size_ == 0)
      fail("has a componentType unknown to glTF", "5120 to 5123, 5125 or 5126",
           std::to_string(accessor_.component));
    if (accessor_.count == 0) fail("has no elements", "a count of at least 1", "0");
  }

  /// error unless `count` elements of `bytes` lie within the view
  Elements within(std::uint32_t view_index, std::size_t offset, std::size_t count, std::size_t bytes) const {
    const GltfBufferView& view = gltf_.views[view_index];
    const std::size_t stride = view.stride > 0 ? view.stride : bytes;
    const bool fits = offset <= view.length && bytes <= view.length - offset &&
                      count - 1 <= (view.length - offset - bytes) / stride;
    if (!fits)
      fail("reaches beyond " + record_name("bufferViews", view_index),
           "within " + std::to_string(view.length) + " bytes",
           std::to_string(count) + " elements, " + std::to_string(stride) + " bytes apart, from " +
               std::to_string(offset));
    return {bytes_of(gltf_, view).data() + offset, count, stride};
  }

  Elements dense(std::size_t bytes) const {
    if (accessor_.view != kNoRecord) return within(accessor_.view, accessor_.offset, accessor_.count, bytes);
    constexpr std::size_t most = 1 << 20;  // limit without data in a file
    if (accessor_.count > most)
      fail("has no bufferView: its elements are 0", "at most " + std::to_string(most) + " of them",
           std::to_string(accessor_.count));
    return {nullptr, accessor_.count, 0};
  }

  void copy(const Elements& elements, std::size_t components, std::vector<double>& numbers) const {
    for (std::size_t i = 0; i < elements.count; ++i)
      for (std::size_t k = 0; k < components; ++k)
        numbers[i * components + k] = number(elements.first + i * elements.stride + k * size_,
                                             accessor_.component, accessor_.is_normalized);
  }

  void replace(std::size_t components, std::vector<double>& numbers) const {
    const GltfSparse& sparse = *accessor_.sparse;
    const std::size_t index_bytes = component_bytes(sparse.index_component), count = sparse.count;
    if (count == 0 || index_bytes == 0)
      fail("has a broken sparse part", "a count above 0 and unsigned indices",
           "a count of " + std::to_string(count));
    const Elements indices = within(sparse.index_view, sparse.index_offset, count, index_bytes);
    const Elements values = within(sparse.value_view, sparse.value_offset, count, components * size_);
    for (std::size_t i = 0; i < count; ++i) {
      const double at = number(indices.first + i * indices.stride, sparse.index_component, false);
      if (!(at >= 0 && at < double(accessor_.count)))
        fail("has a sparse index beyond its elements", "below " + std::to_string(accessor_.count),
             std::to_string(at));
      for (std::size_t k = 0; k < components; ++k)
        numbers[std::size_t(at) * components + k] = number(values.first + i * values.stride + k * size_,
                                                           accessor_.component, accessor_.is_normalized);
    }
  }

  const GltfModel& gltf_;
  const GltfAccessor& accessor_;
  std::string place_;
  std::size_t size_ = 0;  // size of a component, bytes
};

/// make(numbers) returns an element, from its numbers.
template <std::size_t kNumbers, class Make>
auto read_elements(const GltfModel& gltf, std::uint32_t index, std::string_view type, const Make& make) {
  std::vector<std::invoke_result_t<const Make&, const double*>> elements;
  AccessorReader(gltf, index)
      .template for_each<kNumbers>(
          type, [&](std::size_t count) { elements.reserve(count); },
          [&](const double* numbers) { elements.push_back(make(numbers)); });
  return elements;
}

}  // namespace

std::vector<double> read_numbers(const GltfModel& gltf, std::uint32_t index, std::size_t components) {
  return AccessorReader(gltf, index)
      .run(components == 1   ? "SCALAR"
           : components == 3 ? "VEC3"
                             : "VEC4",
           components);
}

std::vector<Vec3d> read_vectors(const GltfModel& gltf, std::uint32_t index) {
  return read_elements<3>(gltf, index, "VEC3", [](const double* v) { return Vec3d(v[0], v[1], v[2]); });
}

std::vector<std::array<double, 4>> read_quadruples(const GltfModel& gltf, std::uint32_t index) {
  return read_elements<4>(gltf, index, "VEC4", [](const double* v) {
    return std::array{v[0], v[1], v[2], v[3]};
  });
}

std::vector<std::array<float, 2>> read_pairs(const GltfModel& gltf, std::uint32_t index) {
  return read_elements<2>(gltf, index, "VEC2", [](const double* v) {
    return std::array{float(v[0]), float(v[1])};
  });
}

std::vector<Transform> read_matrices(const GltfModel& gltf, std::uint32_t index) {
  return read_elements<16>(gltf, index, "MAT4", [](const double* m) {
    return Transform{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  });
}

void check_positions_type(const GltfModel& gltf, std::uint32_t index) {
  constexpr std::string_view kQuantization = "KHR_mesh_quantization";
  const std::size_t type = gltf.accessors[index].component;
  for (const auto* names : {&gltf.extensions_used, &gltf.extensions_required})
    if (std::ranges::find(*names, kQuantization) != names->end()) return;
  if (type != kGltfFloat)
    fail_at(gltf.path, record_name("accessors", index), "has positions that are not floats",
            "a componentType of 5126, or " + std::string(kQuantization), std::to_string(type));
}

void check_unsigned(const GltfModel& gltf, std::uint32_t index) {
  const std::size_t type = gltf.accessors[index].component;
  if (type != kGltfUnsignedByte && type != kGltfUnsignedShort && type != kGltfUnsignedInt)
    fail_at(gltf.path, record_name("accessors", index), "cannot hold indices",
            "a componentType of 5121, 5123 or 5125", std::to_string(type));
}

std::vector<std::uint32_t> read_indices(const GltfModel& gltf, std::uint32_t index) {
  check_unsigned(gltf, index);
  return read_elements<1>(gltf, index, "SCALAR", [](const double* v) { return std::uint32_t(*v); });
}

}  // namespace opaline
