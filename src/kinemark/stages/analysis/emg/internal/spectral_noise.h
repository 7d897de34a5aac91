// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Random noise of the spectrum that an electromyogram has.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace kinemark::analysis {

/// Noise of the spectrum that a series has, of its length and unit variance. The spectrum is that of the
/// series as it is, phases are drawn; a longer transform is cut to length.
class SpectralNoise {
 public:
  SpectralNoise(const Eigen::VectorXd& series, double rate_hz);

  /// The frequency that halves its power: what draws have on average.
  [[nodiscard]] double median_hz(double rate_hz) const;
  /// Independent squares of Gaussian samples that say as much about its power as one of its samples does.
  [[nodiscard]] double freedom_of_a_sample() const;
  /// The variance that the mean of N of its samples has when rectified, times N.
  [[nodiscard]] double variance_of_rectified();
  [[nodiscard]] Eigen::VectorXd draw(std::uint64_t seed, std::uint64_t stream, std::int64_t k);

 private:
  Eigen::Index samples_, length_ = 0;
  std::vector<double> amplitude_;
  Eigen::FFT<double> transform_;
};

}  // namespace kinemark::analysis
