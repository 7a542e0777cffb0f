// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/blobs.h"

#include <algorithm>

namespace opaline {

template <>
BlobType blob_type<float>() {
  return {sizeof(float), {{"", 0, BlobNumber::float32}}};
}

template <>
BlobType blob_type<double>() {
  return {sizeof(double), {{"", 0, BlobNumber::float64}}};
}

template <>
BlobType blob_type<std::uint32_t>() {
  return {sizeof(std::uint32_t), {{"", 0, BlobNumber::uint32}}};
}

std::optional<std::span<const char>> BlobReader::bytes_of(std::string_view name,
                                                          std::size_t item_bytes) const {
  const auto array = std::ranges::find(arrays_, name, &BlobPlace::name);
  if (array == arrays_.end() || array->item_bytes != item_bytes) return {};
  if (array->count == 0) return std::span<const char>{};
  return std::span(bytes_).subspan(array->offset, array->count * item_bytes);
}

std::optional<double> BlobReader::number(std::string_view name) const {
  const auto values = get<double>(name);
  if (!values || values->size() != 1) return {};
  return values->front();
}

}  // namespace opaline
