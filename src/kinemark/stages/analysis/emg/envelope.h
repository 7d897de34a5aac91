// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// From a raw electromyogram to its envelope, and when the muscle is active.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"

namespace kinemark::analysis {

/// How an electromyogram is prepared (Merletti 1999; Hermens et al. 2000).
struct EnvelopeOptions {
  double high_pass_hz = 20.0;  ///< Butterworth of fourth order, both ways: -6 dB there; 0: none
  double low_pass_hz = 450.0;  ///< likewise; at or above 0.45 of the rate: none
  double envelope_hz = 6.0;    ///< low-pass of the rectified signal, likewise
  double rms_window_s = 0.0;   ///< above 0: the root mean square of this long around each sample instead

  /// Cut-offs are in order, above 0 where they are not none: Code::usage.
  [[nodiscard]] Status check() const;
};

/// The band-passed signal, in its unit.
/// @param x  S samples, finite
[[nodiscard]] Eigen::VectorXd band_passed(const Eigen::VectorXd& x, double rate_hz,
                                          const EnvelopeOptions& options);

/// The envelope of a band-passed signal, not below 0.
[[nodiscard]] Eigen::VectorXd envelope_of(const Eigen::VectorXd& band, double rate_hz,
                                          const EnvelopeOptions& options);

/// What the electrode sees of a muscle at rest; NaN where that is not known.
struct RestLevel {
  double mean = kNaN;  ///< of the envelope there
  double rms = kNaN;   ///< of the band-passed signal there
};

/// One burst, samples; instants between them.
struct Burst {
  double onset = 0.0;  ///< where it begins
  double end = 0.0;    ///< where it ends, > onset
};
/// Frequency that halves the power of a band-passed signal, Hz: of Hann windows of half a second (or all),
/// half overlapping (Welch 1967; De Luca 1984). NaN of a constant.
[[nodiscard]] double median_frequency(const Eigen::VectorXd& band, double rate_hz);

}  // namespace kinemark::analysis
