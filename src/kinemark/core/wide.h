// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Loops over many numbers by the widest vectors that the processor has, with the same bits on all of them:
// four numbers side by side are added, multiplied and compared as they would be one by one, and never fused.
#pragma once

#include <cstdint>

namespace kinemark {

/// Four numbers side by side.
using Lanes [[gnu::vector_size(32)]] = double;
/// Their bits, or what a comparison of them says: all ones or none.
using LaneBits [[gnu::vector_size(32)]] = std::int64_t;
/// Numbers in Lanes.
inline constexpr std::int64_t kLanes = 4;

/// The next four numbers from an address, aligned or not.
[[gnu::always_inline]] inline void load(Lanes& to, const double* from) {
  __builtin_memcpy(&to, from, sizeof(Lanes));
}
/// Four numbers to an address, aligned or not.
[[gnu::always_inline]] inline void store(double* to, const Lanes& from) {
  __builtin_memcpy(to, &from, sizeof(Lanes));
}
/// The same number four times.
[[gnu::always_inline]] inline void spread(Lanes& to, double value) { to = Lanes{value, value, value, value}; }
/// Sum of four numbers, in an order that does not depend on the processor.
[[gnu::always_inline]] inline double sum_of(const Lanes& of) { return (of[0] + of[2]) + (of[1] + of[3]); }

#if defined(__x86_64__)
/// Whether this processor has vectors of 256 bits for numbers and for their bits (AVX2).
[[nodiscard]] inline bool has_wide_vectors() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}
#else
/// Whether a loop is worth compiling twice: not here.
[[nodiscard]] inline bool has_wide_vectors() { return false; }
#endif

/// A loop compiled for wide vectors; called by run_wide() alone.
/// @tparam kLoop  a function that is always inlined ([[gnu::always_inline]])
template <auto kLoop, class... Arguments>
#if defined(__x86_64__)
[[gnu::target("avx2")]]
#endif
void wide_version(Arguments... arguments) {
  kLoop(arguments...);
}

/// Call a loop, compiled for what this processor has.
/// @tparam kLoop  a function that returns nothing and is always inlined ([[gnu::always_inline]])
template <auto kLoop, class... Arguments>
void run_wide(Arguments... arguments) {
  if (has_wide_vectors())
    wide_version<kLoop>(arguments...);
  else
    kLoop(arguments...);
}

}  // namespace kinemark
