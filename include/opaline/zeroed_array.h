// SPDX-License-Identifier: GPL-3.0-or-later
// A vector with lazily zeroed memory.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

namespace opaline {

/// Allocates zeroed pages from the system and does not initialize new elements: untouched memory costs no
/// space and no time, as much of an image is often empty. For arithmetic types; elements reappearing after
/// the vector shrank keep their old values.
template <class T>
struct ZeroedAllocator {
  using value_type = T;

  ZeroedAllocator() = default;
  template <class U>
  explicit ZeroedAllocator(const ZeroedAllocator<U>&) {}

  T* allocate(std::size_t n) {
    void* memory = std::calloc(n, sizeof(T));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { std::free(memory); }

  void construct(T*) {}
  template <class... Arguments>
  void construct(T* place, Arguments&&... arguments) {
    ::new (place) T(std::forward<Arguments>(arguments)...);
  }

  template <class U>
  bool operator==(const ZeroedAllocator<U>&) const {
    return true;
  }
};

template <class T>
using ZeroedArray = std::vector<T, ZeroedAllocator<T>>;

}  // namespace opaline
