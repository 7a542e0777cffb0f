// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 as far as cache entries need it: one-dimensional data sets of structs, written so that reading them
// back takes no HDF5.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "cache/blobs.h"

namespace opaline {

/// A number of HDF5's for something open, closed with it.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() { close(); }
  /// False if what was still to be written could not be.
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }
  hid_t id() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 has one state for the whole process: while this lives no other thread is inside it by way of the
/// cache, and it prints nothing.
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

/// Bytes in front of the file that HDF5 leaves alone.
inline constexpr std::size_t kUserBlock = 1024;

/// A file made in memory: HDF5 (1.10) cannot let go of one whose disk is full. After the first
/// failure what follows does nothing.
class Hdf5Writer final : public BlobWriter {
 public:
  Hdf5Writer();

  /// The whole file, kUserBlock bytes of nothing in front; empty after a failure. Valid until the next put.
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
