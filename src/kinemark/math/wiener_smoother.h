// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The path of a point whose derivative of some order is white noise (an integrated Wiener process), from
// noisy positions at any times: fixed-interval smoother in covariance form.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kinemark::math {

/// What one instant says of a position in `kAxes` dimensions (1 or 3): a value and its inverse covariance,
/// which may be singular (one camera sees a line) or zero (nothing was seen).
template <int kAxes>
struct PositionObservation {
  double time_s = 0.0;  ///< strictly increasing
  Eigen::Matrix<double, kAxes, kAxes> information = Eigen::Matrix<double, kAxes, kAxes>::Zero();  ///< m^-2
  /// m; not read where there is no information.
  Eigen::Matrix<double, kAxes, 1> position = Eigen::Matrix<double, kAxes, 1>::Zero();
};

/// Stretches (first index, count) of observations between gaps, which are runs without information that last
/// longer than `longest_s`; each begins and ends with information. None when there is no information at all.
template <int kAxes>
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> runs_between_gaps(
    std::span<const PositionObservation<kAxes>> observations, double longest_s);

/// The `order` times integrated Wiener process: that derivative of the position is white on each axis.
struct WienerProcess {
  int order = 3;                  ///< 3, 4 or 5
  double spectral_density = 0.0;  ///< of derivative `order`, m^2 s^(1 - 2 order); 0: it stays 0
  /// Unit of time of the arithmetic, > 0: any gives the same answer, the filter's time constant the best
  /// digits.
  double time_scale_s = 1.0;
};

/// What is known at the first instant before any observation, the same and independent on all axes.
template <int kAxes>
struct WienerPrior {
  /// m; the derivatives are expected to be 0.
  Eigen::Matrix<double, kAxes, 1> position = Eigen::Matrix<double, kAxes, 1>::Zero();
  std::array<double, 5> sd{};  ///< of derivative 0 to order - 1: m, m/s, m/s^2 ...
};

/// Which covariances a smoother finds; they cost most of its time.
enum class WienerCovariance : std::uint8_t { none, position, all };

/// How to smooth.
template <int kAxes>
struct WienerOptions {
  WienerCovariance covariance = WienerCovariance::all;  ///< which covariances to find
  /// Without one, the first observation must carry information, and the filter starts from a polynomial
  /// through the first observations, held ten times less certain than it is.
  std::optional<WienerPrior<kAxes>> prior;
  /// Estimates are of this long after each time_s. Short: what the process wanders meanwhile is left out.
  double shift_s = 0.0;
  std::size_t block = 8192;  ///< observations whose forward results are kept at a time, at least 1
};

/// Position, velocity and acceleration at one instant, given all observations.
template <int kAxes>
struct WienerEstimate {
  Eigen::Matrix<double, kAxes, 3> derivatives;  ///< columns: 0 to 2, m, m/s, m/s^2
  /// Of the columns of `derivatives`, one below the other; zero where not asked for.
  Eigen::Matrix<double, 3 * kAxes, 3 * kAxes> covariance;

  /// The column of derivative 0 to 2.
  [[nodiscard]] Eigen::Matrix<double, kAxes, 1> derivative(int order) const { return derivatives.col(order); }
  /// Covariance of derivative 0 to 2 alone.
  [[nodiscard]] Eigen::Matrix<double, kAxes, kAxes> covariance_of(int derivative) const {
    return covariance.template block<kAxes, kAxes>(kAxes * derivative, kAxes * derivative);
  }
};

/// Takes the index of an observation and the estimate at its time.
template <int kAxes>
using WienerVisit = std::function<void(std::size_t, const WienerEstimate<kAxes>&)>;

/// Calls `visit` for every observation, last to first.
///
/// Kalman filter forwards, Bryson-Frazier adjoint backwards: neither inverts a covariance, so that a small
/// density and a high order keep their digits where banded normal equations lose them. O(n) time, at most two
/// passes forwards; memory grows with n / block only. Bierman (1977), Factorization Methods, section X.
template <int kAxes>
void smooth_wiener(const WienerProcess& process, std::span<const PositionObservation<kAxes>> observations,
                   const WienerOptions<kAxes>& options, const WienerVisit<kAxes>& visit);

/// Log likelihood of the observations, up to a constant that their times and information alone fix. O(n).
template <int kAxes>
[[nodiscard]] double wiener_log_likelihood(const WienerProcess& process,
                                           std::span<const PositionObservation<kAxes>> observations,
                                           const WienerPrior<kAxes>& prior);

}  // namespace kinemark::math
