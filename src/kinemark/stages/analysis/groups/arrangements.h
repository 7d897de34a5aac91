// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Labels that say which group a curve belongs to, in every arrangement that is equally likely when groups do
// not differ.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/random.h"

namespace kinemark::analysis {

/// Arrangements of the labels of N curves: all of them where there are at most `most`, else that many drawn
/// at random. The first is always the one observed. Deterministic for a seed.
class Arrangements {
 public:
  using Labels = std::vector<std::uint8_t>;  ///< N, from 0

  /// Labels change places: `sizes[g]` curves of group g, in the order of the groups when observed.
  /// @param most  at least 1
  [[nodiscard]] static Arrangements of_groups(const std::vector<std::int64_t>& sizes, std::int64_t most,
                                              std::uint64_t seed);
  /// Each of `curves` labels is 0 (as observed) or 1 (sign turned) by itself.
  [[nodiscard]] static Arrangements of_signs(std::int64_t curves, std::int64_t most, std::uint64_t seed);

  /// Arrangements that there are, the observed one among them; infinity where a double cannot hold it.
  [[nodiscard]] double possible() const { return possible_; }
  /// Arrangements that next() hands out.
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// Whether next() hands out every one that there is.
  [[nodiscard]] bool exact() const { return exact_; }
  /// The next arrangement; count() of them, then the same ones again from the first.
  [[nodiscard]] const Labels& next();

 private:
  Arrangements(Labels observed, bool signs, double possible, std::int64_t most, std::uint64_t seed);
  void step_exact();
  void draw();

  Labels observed_, labels_;
  bool signs_ = false, exact_ = true;
  double possible_ = 1.0;
  std::int64_t count_ = 1, at_ = 0;
  std::uint64_t seed_ = 0;
  Random random_;
};

}  // namespace kinemark::analysis
