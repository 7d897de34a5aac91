// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Which noise lies under a movement: models of NoiseKind fitted to the spectrum above it, and how sure that
// is.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/math/multitaper.h"
#include "kinemark/math/noise_model.h"

namespace kinemark::math {

/// What is expected of noise before a recording is seen.
struct NoiseSearch {
  double typical_sd = 5e-4;  ///< of one axis, in the unit of the series; a factor of 4.5 is one deviation
  /// A filtered recording's floor (rounding) is at most this, and a tenth of the noise before the filter.
  double largest_floor_sd = 5e-5;
  /// What is known of a filter: NaN or 0 where it is not.
  std::optional<NoiseModel>
      known;  ///< form, order and half of it are taken as they are, `variance` where above 0
};

/// One model with its parameters at their most probable values.
struct NoiseFit {
  NoiseModel model;            ///< at these values
  Eigen::VectorXd parameters;  ///< logarithms and logits, as noise_fit.cc has them
  Eigen::MatrixXd covariance;  ///< of them, by the curvature of the likelihood
  double evidence = 0.0;  ///< logarithm of the likelihood less half the parameters' number times log n (BIC)
};

/// Models of the spectrum from one frequency on.
struct NoiseFits {
  double lowest = 0.0;          ///< that frequency, cycles per sample
  double misfit = 0.0;          ///< deviance over what is expected of the right model
  double largest_misfit = 0.0;  ///< that the right model has, but for few
  std::vector<NoiseFit> fits;   ///< the most probable first
};

/// What was found. Where a model is right from a frequency on, what the next higher one says belongs to the
/// uncertainty: the choice of the frequency is one, too.
struct FoundNoise {
  NoiseFits chosen;  ///< the lowest frequency from which a model is right, else the best there is
  std::optional<NoiseFits> next;  ///< from the next higher frequency on
  [[nodiscard]] const NoiseModel& model() const {
    return chosen.fits.front().model;
  }  ///< the most probable one
  /// A model describes what lies above the movement. Spikes and noise that changes in time fit none.
  [[nodiscard]] bool fits() const { return chosen.misfit <= kMostMisfit; }
  static constexpr double kMostMisfit = 2.5;  ///< times the expected deviance
};

/// Fit all models (Whittle's likelihood of gamma distributed powers, damped scoring) above the lowest of
/// seven frequencies from 2 to 18 Hz from which one of them is right, and weigh them by BIC. Each has a tail
/// of the movement, a power steeper than f^-5 or an exponential, which goes through the filter as the noise
/// does; white and correlated noise are tried without one, too. A filter is a claim: it must be 12 nats
/// better than any other model and its floor must be as low as rounding.
///
/// @return nothing where the spectrum is empty. Cost: some 40 fits of 50 microseconds for each frequency.
[[nodiscard]] std::optional<FoundNoise> find_noise(const NoiseSpectrum& spectrum, double rate_hz,
                                                   const NoiseSearch& search = {});

/// Noise as it may be: models by their evidence, parameters by the curvature of the likelihood with 1.3 times
/// its deviations, four of ten from the next higher frequency. The first of each is at its most probable
/// values.
/// @param random  the draws that decide
[[nodiscard]] std::vector<NoiseModel> draw_noise(const FoundNoise& found, const NoiseSearch& search,
                                                 std::int64_t count, Random random);

}  // namespace kinemark::math
