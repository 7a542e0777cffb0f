// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/hdf5_file.h"

#include <algorithm>

namespace opaline {
namespace {

std::mutex hdf5_mutex;

// HDF5 checks and caches whole chunks; its default cache holds one of this size.
constexpr std::size_t kChunkBytes = 1 << 19;

Hdf5Handle create_in_memory() {
  constexpr std::size_t kGrowth = 1 << 22;
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose),
      access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_userblock(creation.id(), kUserBlock);
  H5Pset_fapl_core(access.id(), kGrowth, false);
  return {H5Fcreate("cache entry", H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose};
}

Hdf5Handle set_properties(const Hdf5Handle& type, std::size_t count) {
  Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.id(), false);  // the same input gives the same bytes
  if (count == 0) return properties;
  const hsize_t chunk = std::clamp<hsize_t>(kChunkBytes / H5Tget_size(type.id()), 1, count);
  H5Pset_chunk(properties.id(), 1, &chunk);
  H5Pset_fletcher32(properties.id());
  return properties;
}

// An image that stays where it is: HDF5 asks for memory to copy it to, and is given the image itself. (HDF5's
// own H5LTopen_file_image does this too, and in 1.10 loses 72 bytes a file.)
void* same_memory(size_t, H5FD_file_image_op_t, void* image) {
  return image;
}
void* no_copy(void* to, const void*, size_t, H5FD_file_image_op_t, void*) {
  return to;
}
void* no_growth(void*, size_t, H5FD_file_image_op_t, void*) {
  return nullptr;
}
herr_t no_release(void*, H5FD_file_image_op_t, void*) {
  return 0;
}
void* same_image(void* image) {
  return image;
}
herr_t keep_image(void*) {
  return 0;
}

Hdf5Handle open_in_memory(std::span<char> bytes) {
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5FD_file_image_callbacks_t callbacks{same_memory, no_copy,    no_growth,   no_release,
                                        same_image,  keep_image, bytes.data()};
  H5Pset_fapl_core(access.id(), 1, false);
  if (H5Pset_file_image_callbacks(access.id(), &callbacks) < 0 ||
      H5Pset_file_image(access.id(), bytes.data(), bytes.size()) < 0)
    return {-1, H5Fclose};
  return {H5Fopen("cache entry", H5F_ACC_RDONLY, access.id()), H5Fclose};
}

}  // namespace

Hdf5Turn::Hdf5Turn() : lock_(hdf5_mutex) {
  H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Turn::~Hdf5Turn() {
  H5Eset_auto2(H5E_DEFAULT, print_, data_);
}

Hdf5Writer::Hdf5Writer() : file_(create_in_memory()), good_(file_.id() >= 0) {}

void Hdf5Writer::put(const char* name, const Hdf5Handle& type, const void* values, std::size_t count) {
  if (!good_) return;
  const hsize_t size = count;
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose),
      properties = set_properties(type, count);
  Hdf5Handle set(
      H5Dcreate2(file_.id(), name, type.id(), space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
      H5Dclose);
  good_ = set.id() >= 0 &&
          (count == 0 || H5Dwrite(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  good_ = set.close() && good_;
}

void Hdf5Writer::put(const char* name, double value) {
  if (!good_) return;
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  Hdf5Handle attribute(H5Acreate2(file_.id(), name, H5T_NATIVE_DOUBLE, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                       H5Aclose);
  good_ = attribute.id() >= 0 && H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, &value) >= 0;
  good_ = attribute.close() && good_;
}

std::string_view Hdf5Writer::bytes() {
  void* memory = nullptr;  // of the core driver's buffer: its address
  good_ = good_ && H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) >= 0 &&
          H5Fget_vfd_handle(file_.id(), H5P_DEFAULT, &memory) >= 0;
  const ssize_t size = good_ ? H5Fget_file_image(file_.id(), nullptr, 0) : 0;  // behind the user block
  if (size <= 0) return {};
  return {*static_cast<const char* const*>(memory), kUserBlock + std::size_t(size)};
}

Hdf5Reader::Hdf5Reader(std::span<char> bytes) : file_(open_in_memory(bytes)) {}

Hdf5Handle Hdf5Reader::open(const char* name) const {
  return {file_.id() < 0 ? hid_t(-1) : H5Dopen2(file_.id(), name, H5P_DEFAULT), H5Dclose};
}

std::optional<std::size_t> Hdf5Reader::count_of(const Hdf5Handle& set, const Hdf5Handle& type) {
  if (set.id() < 0) return {};
  const Hdf5Handle stored(H5Dget_type(set.id()), H5Tclose), space(H5Dget_space(set.id()), H5Sclose);
  hsize_t count = 0;
  if (H5Tequal(stored.id(), type.id()) <= 0 || H5Sget_simple_extent_ndims(space.id()) != 1 ||
      H5Sget_simple_extent_dims(space.id(), &count, nullptr) != 1)
    return {};
  return std::size_t(count);
}

bool Hdf5Reader::read(const Hdf5Handle& set, const Hdf5Handle& type, void* values, std::size_t count) {
  return count == 0 || H5Dread(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
}

std::optional<double> Hdf5Reader::number(const char* name) const {
  if (file_.id() < 0) return {};
  const Hdf5Handle attribute(H5Aopen(file_.id(), name, H5P_DEFAULT), H5Aclose);
  double value = 0;
  if (attribute.id() < 0 || H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value) < 0) return {};
  return value;
}

}  // namespace opaline
