// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kinemark {

/// Finaliser of SplitMix64 (Steele, Lea & Flood 2014), a bijection of 64-bit words.
[[nodiscard]] constexpr std::uint64_t mix64(std::uint64_t z) {
  z ^= z >> 30;
  z *= 0xBF58476D1CE4E5B9ULL;
  z ^= z >> 27;
  z *= 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return z;
}

/// Seeded, counter-based random numbers: the i-th draw depends on (seed, stream, i) only, so streams can be
/// drawn in any order and by any number of threads with the same values.
///
/// key = mix64(seed) ^ mix64(stream + 0x632BE59BD9B4E019); draw i (from 1) = mix64(key + i *
/// 0x9E3779B97F4A7C15).
class Random {
 public:
  /// Stream number `stream` of a seed, before its first draw.
  Random(std::uint64_t seed, std::uint64_t stream);

  /// Uniform on [0, 1), 53 bits.
  double uniform();
  /// Uniform on [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal by Box-Muller, cosine branch; consumes two uniforms.
  double gaussian();
  /// Jump so that the next draw is number `draws_done` + 1.
  void seek(std::uint64_t draws_done) { counter_ = draws_done; }
  [[nodiscard]] std::uint64_t draws() const { return counter_; }  ///< draws done so far

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace kinemark
