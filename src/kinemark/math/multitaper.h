// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Power spectra by Slepian's tapers, and the spectrum of noise under a movement that is far larger.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/math/difference_smoother.h"

namespace kinemark::math {

/// Discrete prolate spheroidal sequences: unit vectors of `length` samples with the most of their energy
/// below `time_bandwidth` / length cycles per sample, orthogonal, best first (Slepian 1978; Thomson 1982).
/// @param length  16 or more
/// @param count   below 2 time_bandwidth
[[nodiscard]] std::vector<Eigen::VectorXd> slepian_tapers(std::int64_t length, double time_bandwidth,
                                                          int count);

/// Powers over some frequencies that lie side by side.
struct SpectrumBin {
  double frequency = 0.0;  ///< their mean, cycles per sample
  double power = 0.0;      ///< mean square per sample of white noise that has it: exp of the mean logarithm
  double count = 0.0;      ///< frequencies that can be told apart in it, stretches added
  double shape = 0.0;      ///< of the gamma distribution that the power follows
};

/// Powers of series that show the noise and not the leakage of the movement: of the first to the sixth
/// differences, each divided by its gain, the least at each frequency. Leakage only adds, and no single
/// difference serves both white noise and the skirt of a low-pass.
class NoiseSpectrum {
 public:
  /// Stretches without missing samples; one or two missing ones in a row are bridged by polynomials through
  /// three neighbours on both sides. Of long series eight stretches of 4096 samples, at even distances.
  /// @param series  n x axes, finite
  NoiseSpectrum(const SeriesMatrix& series, const std::vector<bool>& seen);

  /// No stretch is long enough (kLeastStretch).
  [[nodiscard]] bool empty() const { return stretches_.empty(); }
  [[nodiscard]] std::int64_t longest() const { return longest_; }  ///< stretch, samples
  [[nodiscard]] std::int64_t axes() const { return axes_; }        ///< that are averaged

  /// At most 44 bins from `lowest` (cycles per sample) to half a cycle per sample, the wider the higher.
  [[nodiscard]] std::vector<SpectrumBin> bins(double lowest) const;

  static constexpr std::int64_t kLeastStretch = 60;  ///< samples

 private:
  struct Stretch {
    std::int64_t samples = 0;
    double step = 0.0;      // cycles per sample between powers; the first is of one step
    Eigen::VectorXd power;  // mean over axes and tapers
  };
  [[nodiscard]] static Stretch spectrum_of(const SeriesMatrix& x);

  std::vector<Stretch> stretches_;
  std::int64_t longest_ = 0, axes_ = 0;
};

}  // namespace kinemark::math
