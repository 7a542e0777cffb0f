// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 as far as cache entries need it: one-dimensional data sets of structs, and numbers beside them.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
inline constexpr std::size_t kUserBlock = 512;

/// Each struct in a cache entry says what its members are.
template <class T>
Hdf5Handle hdf5_type();

/// A file that is made in memory: HDF5 (1.10) cannot let go of one whose disk is full. After the first
/// failure what follows does nothing.
class Hdf5Writer {
 public:
  Hdf5Writer();

  template <class T>
  void put(const char* name, std::span<const T> values) {
    put(name, hdf5_type<T>(), values.data(), values.size());
  }
  void put(const char* name, double value);
  /// The whole file, kUserBlock bytes of nothing in front; empty after a failure. Valid until the next put.
  std::string_view bytes();

 private:
  void put(const char* name, const Hdf5Handle& type, const void* values, std::size_t count);
  Hdf5Handle file_;
  bool good_;
};

/// A file in memory, which must outlive this; get gives nothing where the file has no such data set, or one
/// of other members.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(std::span<char> bytes);

  template <class T>
  std::optional<std::vector<T>> get(const char* name) const {
    const Hdf5Handle set = open(name), type = hdf5_type<T>();
    const std::optional<std::size_t> count = count_of(set, type);
    if (!count) return {};
    std::vector<T> values(*count);
    if (!read(set, type, values.data(), *count)) return {};
    return values;
  }
  std::optional<double> number(const char* name) const;

 private:
  Hdf5Handle open(const char* name) const;
  static std::optional<std::size_t> count_of(const Hdf5Handle& set, const Hdf5Handle& type);
  static bool read(const Hdf5Handle& set, const Hdf5Handle& type, void* values, std::size_t count);
  Hdf5Handle file_;
};

}  // namespace opaline
