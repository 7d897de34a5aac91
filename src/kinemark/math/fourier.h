// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Discrete Fourier transforms of real series of good lengths, for power spectra.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace kinemark::math {

/// The transform of real series of one length. Four parts of a series, every fourth pair of samples each, are
/// transformed side by side (Stockham's order, factors 4, 2, 3 and 5), then joined.
class FourierTransform {
 public:
  /// @param length  see fits(). Cost: length sines.
  explicit FourierTransform(std::int64_t length);

  /// A multiple of 8, at least 8, without a prime factor above 5.
  [[nodiscard]] static bool fits(std::int64_t length);
  /// The least length from n on that fits; from 2048 on a multiple of 32, so that series can be thinned out.
  [[nodiscard]] static std::int64_t good_length(std::int64_t n);

  /// |sum over i of x[i] exp(-2 pi i k / length)|^2 for k = 0 to `highest`, added to `power`.
  /// @param series  at most `length` values, continued by zeros
  /// @param power   highest + 1 values, highest at most length / 2
  /// Cost: length log length. Not for several threads at once.
  void add_power(const Eigen::Ref<const Eigen::VectorXd>& series, Eigen::Ref<Eigen::VectorXd> power);

  [[nodiscard]] std::int64_t length() const { return length_; }  ///< of the series

 private:
  void join();

  std::int64_t length_, part_;               // part_: length / 8, of each of the four
  std::vector<double> cosines_, sines_;      // of 2 pi k / part, k = 0 to part - 1
  std::vector<double> join_cos_, join_sin_;  // of 2 pi k / length
  std::vector<double> real_, imaginary_;     // length / 2
  std::vector<double> other_real_, other_imaginary_;
};

}  // namespace kinemark::math
