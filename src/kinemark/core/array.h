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
  struct rebind {
    using other = UninitializedAllocator<U>;
  };
  template <class U>
  void construct(U* p) noexcept {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
};

/// Contiguous numbers. `Array<double>(n)` and resize(n) leave new elements unwritten; `Array<double>(n, 0.0)`
/// fills them.
template <class T>
using Array = std::vector<T, UninitializedAllocator<T>>;

}  // namespace kinemark
