// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace kinemark::analysis {

/// Amplitudes of the discrete Fourier transform of a series continued by zeros to `length` values: those of
/// the frequencies k / length cycles per sample, k = 0 to length / 2. O(length log length).
/// @param length  at least the length of the series
[[nodiscard]] Eigen::VectorXd amplitudes(const Eigen::VectorXd& series, std::int64_t length);

}  // namespace kinemark::analysis
