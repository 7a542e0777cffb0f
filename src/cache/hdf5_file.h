// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 output for cache entries: one-dimensional data sets of structs, readable without HDF5.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "cache/blobs.h"

namespace opaline {

/// Identifier of an open HDF5 object, closed with it.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() { close(); }
  /// False if pending data could not be written.
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }
  hid_t id() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Lock and silent mode of HDF5 for this lifetime: HDF5 has one state for the whole process.
class Hdf5Turn {
 public:
  Hdf5Turn();
  ~Hdf5Turn();
  Hdf5Turn(const Hdf5Turn&) = delete;
  Hdf5Turn& operator=(const Hdf5Turn&) = delete;

 private:
  std::unique_lock<std::mutex> lock_;
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// Bytes before HDF5's data, ignored by HDF5.
inline constexpr std::size_t kUserBlock = 1024;

/// A file in memory, as HDF5 (1.10) cannot close one on a full disk. No effect after the first failure.
class Hdf5Writer final : public BlobWriter {
 public:
  Hdf5Writer();

  /// The whole file, with kUserBlock zero bytes at the front; empty after a failure. Valid until the next
  /// put.
  std::string_view bytes();
  /// Arrays in the order of writing.
  const std::vector<BlobPlace>& arrays() const { return arrays_; }

 private:
  void put_items(const char* name, const BlobType& type, const void* values, std::size_t count) override;
  Hdf5Handle file_;
  bool good_;
  std::vector<BlobPlace> arrays_;
};

}  // namespace opaline
