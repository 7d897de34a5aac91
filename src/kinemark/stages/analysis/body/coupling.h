// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How two coordinates move together: phase, lag, direction in the angle-angle plane.
#pragma once

#include <Eigen/Core>
#include <array>

#include "kinemark/core/missing.h"

namespace kinemark::analysis {

/// Phase angles, rad, of a series about the middle of its range, by its analytic signal: the angle of x + i
/// H(x), with the Hilbert transform over the whole series (Lamb & Stoeckl 2014). Exact for whole numbers of
/// turns of a sinusoid; at both ends of another series a sixth of a turn is in doubt. O(n log n).
[[nodiscard]] Eigen::VectorXd hilbert_phase(const Eigen::VectorXd& x);

/// How the phase of one series differs from that of another.
struct RelativePhase {
  double mean = kNaN;     ///< circular mean of phase(a) - phase(b), rad, in (-pi, pi]: positive: a leads
  double locking = kNaN;  ///< length of the mean vector, 0 to 1: 1, a constant difference (Lachaux 1999)
};
/// NaN where one of the series is constant or shorter than 8.
[[nodiscard]] RelativePhase relative_phase(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// Where two series resemble each other most.
struct CrossCorrelation {
  double lag = kNaN;          ///< samples by which b follows a; between samples by a parabola
  double correlation = kNaN;  ///< Pearson's of the samples that overlap there, of the largest size
};
/// Pearson's correlations of the samples that overlap, at lags from minus to plus a quarter of the samples.
/// O(n^2). Nothing where one is constant or shorter than 8.
[[nodiscard]] Eigen::VectorXd correlations(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// Lags up to a quarter of the samples to both sides (Li & Caldwell 1999). O(n^2). NaN where one is constant.
[[nodiscard]] CrossCorrelation cross_correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// Shares of the steps from sample to sample in the plane of a (along) and b (up) by their direction, in
/// sectors of 45 deg (Chang, Van Emmerik & Hamill 2008): both alike, both contrary, a alone, b alone. Steps
/// shorter than a tenth of the longest do not count. NaN where nothing moves.
[[nodiscard]] std::array<double, 4> coordination_shares(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

}  // namespace kinemark::analysis
