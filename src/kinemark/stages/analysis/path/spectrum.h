// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace kinemark::analysis {

/// Amplitudes of the discrete Fourier transform of a series continued by zeros to `length` values: those of
/// the frequencies k / length cycles per sample, k = 0 to length / 2. O(length log length).
/// @param length  at least the length of the series, even; quickest where a FourierTransform (math/fourier.h)
/// fits
[[nodiscard]] Eigen::VectorXd amplitudes(const Eigen::VectorXd& series, std::int64_t length);

/// The first of them: of the frequencies 0 to highest / length. Of a long series whose frequencies are low,
/// every 2^k-th sample of a low-pass that lets them through, within 1e-9 of the largest.
/// @param length   as of amplitudes()
/// @param highest  at most length / 2
[[nodiscard]] Eigen::VectorXd low_amplitudes(const Eigen::VectorXd& series, std::int64_t length,
                                             std::int64_t highest);

/// The squares of the same amplitudes, those of all columns added.
[[nodiscard]] Eigen::VectorXd low_powers(const Eigen::MatrixXd& series, std::int64_t length,
                                         std::int64_t highest);

}  // namespace kinemark::analysis
