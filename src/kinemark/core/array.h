// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

namespace kinemark {

/// Allocator that leaves new numbers unwritten, so that a reader that fills an array writes it once, not
/// twice.
template <class T>
struct UninitializedAllocator : std::allocator<T> {
  template <class U>
  /// The same allocator for another type, as containers ask for it.
  struct rebind {
    using other = UninitializedAllocator<U>;  ///< for type U
  };
  template <class U>
  /// Default-initialises, which leaves numbers as they are.
  void construct(U* p) noexcept {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Args>
  /// Constructs from arguments, as any allocator.
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
};

/// Contiguous numbers. `Array<double>(n)` and resize(n) leave new elements unwritten; `Array<double>(n, 0.0)`
/// fills them.
template <class T>
using Array = std::vector<T, UninitializedAllocator<T>>;

}  // namespace kinemark
