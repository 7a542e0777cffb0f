// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/hdf5_file.h"

namespace opaline {
namespace {

std::mutex hdf5_mutex;

Hdf5Handle create_in_memory() {
  constexpr std::size_t kGrowth = 1 << 22;
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose),
      access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_userblock(creation.id(), kUserBlock);
  H5Pset_fapl_core(access.id(), kGrowth, false);
  return {H5Fcreate("cache entry", H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose};
}

/// Contiguous, for copying from its offset.
Hdf5Handle set_properties() {
  Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.id(), false);  // reproducible bytes
  H5Pset_layout(properties.id(), H5D_CONTIGUOUS);
  return properties;
}

hid_t number_type(BlobNumber number) {
  switch (number) {
    case BlobNumber::uint8:
      return H5T_NATIVE_UINT8;
    case BlobNumber::uint32:
      return H5T_NATIVE_UINT32;
    case BlobNumber::float32:
      return H5T_NATIVE_FLOAT;
    case BlobNumber::float64:
      return H5T_NATIVE_DOUBLE;
  }
  return -1;
}

/// Member type of a number standing alone, or of an array of them.
Hdf5Handle member_type(const BlobMember& member) {
  const hsize_t count = member.count;
  if (count == 1) return {H5Tcopy(number_type(member.number)), H5Tclose};
  return {H5Tarray_create2(number_type(member.number), 1, &count), H5Tclose};
}

Hdf5Handle item_type(const BlobType& type) {
  if (*type.members.front().name == 0) return member_type(type.members.front());
  Hdf5Handle compound(H5Tcreate(H5T_COMPOUND, type.bytes), H5Tclose);
  for (const BlobMember& member : type.members) {
    const Hdf5Handle of_member = member_type(member);
    H5Tinsert(compound.id(), member.name, member.offset, of_member.id());
  }
  return compound;
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

void Hdf5Writer::put_items(const char* name, const BlobType& item, const void* values, std::size_t count) {
  if (!good_) return;
  const Hdf5Handle type = item_type(item);
  const hsize_t size = count;
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose), properties = set_properties();
  Hdf5Handle set(
      H5Dcreate2(file_.id(), name, type.id(), space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
      H5Dclose);
  good_ = set.id() >= 0 &&
          (count == 0 || H5Dwrite(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  const haddr_t offset = good_ && count > 0 ? H5Dget_offset(set.id()) : 0;
  arrays_.push_back({name, count, item.bytes, std::size_t(offset)});
  good_ = set.close() && good_ && offset != HADDR_UNDEF;
}

std::string_view Hdf5Writer::bytes() {
  void* memory = nullptr;  // memory of the core driver's buffer: its address
  good_ = good_ && H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) >= 0 &&
          H5Fget_vfd_handle(file_.id(), H5P_DEFAULT, &memory) >= 0;
  const ssize_t size = good_ ? H5Fget_file_image(file_.id(), nullptr, 0) : 0;  // behind the user block
  if (size <= 0) return {};
  return {*static_cast<const char* const*>(memory), kUserBlock + std::size_t(size)};
}

}  // namespace opaline
