// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Smoothing splines of evenly spaced samples, by their differences: many series at once, missing samples
// exactly, and fast enough to be run on hundreds of simulated recordings.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace kinemark::math {

/// One row per sample or unknown, one column per series.
using SeriesMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The posterior mean of an m-times integrated Wiener process seen in white noise at even times: a smoothing
/// spline of degree 2m - 1.
///
/// In Reinsch's dual form the unknowns are n - m multipliers gamma of the m-th differences D f, which the
/// process makes N(0, r B), with B the cardinal B-spline of order 2m at the integers and r its intensity
/// over the noise. A missing sample is one unknown l more, from [r B + D_s D_s', D_g; D_g', 0] [gamma; l] =
/// [D y; 0] (s seen, g missing): exact, as against a large variance. The unknowns stand in the order of their
/// samples, so that the matrix stays a band of width 2m, and its factor is that of Gauss without pivots:
/// gammas first, each l after the gammas it touches. (Reinsch 1967; de Hoog & Hutchinson 1987.)
///
/// Cost: n w^2 for a factor (w = m without missing samples, up to 2m about them), less where rows far from a
/// gap repeat in all digits; n w for each series.
class DifferenceSmoother {
 public:
  /// @param seen   n flags, true where there is a sample; at least order + 1 of them
  /// @param order  m, 1 to 5: the smoothed path has 2m - 2 continuous derivatives
  DifferenceSmoother(std::vector<bool> seen, int order);

  /// Make the factor for a cut-off. @return false where double precision does not reach (a cut-off far below
  /// the sampling rate at a high order), and the smoother is not to be used.
  /// @param half_power  frequency that the smoother halves, in cycles per sample, above 0
  [[nodiscard]] bool factor(double half_power);

  /// log det of the matrix that was factored: with the cut-off it tells the trace of the smoother.
  [[nodiscard]] double log_determinant() const { return log_determinant_; }

  /// Smooth every column in place. Missing samples get their most probable value; what stood there does not
  /// count, but must be finite. factor() first.
  void smooth(SeriesMatrix& series) const;

  [[nodiscard]] int order() const { return order_; }                     ///< m
  [[nodiscard]] const std::vector<bool>& seen() const { return seen_; }  ///< n flags
  [[nodiscard]] std::int64_t samples() const {                           ///< n
    return static_cast<std::int64_t>(seen_.size());
  }

  /// ln r of a half-power frequency in cycles per sample: r = (2 pi f)^(2m).
  [[nodiscard]] static double log_intensity(int order, double half_power);

 private:
  [[nodiscard]] double& band(std::int64_t row, std::int64_t column) {
    return factor_[static_cast<std::size_t>(row * (width_ + 1) + (column - row + width_))];
  }
  [[nodiscard]] double band(std::int64_t row, std::int64_t column) const {
    return factor_[static_cast<std::size_t>(row * (width_ + 1) + (column - row + width_))];
  }
  void find_envelope();
  void assemble(double intensity);
  struct Band;
  template <class Columns>
  void solve(double* series, std::int64_t stride, std::vector<double>& unknown) const;

  std::vector<bool> seen_;
  int order_;
  std::vector<double> difference_;       ///< m + 1 coefficients of the m-th difference
  std::vector<double> spline_;           ///< B-spline at lags 0 to m - 1
  std::vector<std::int64_t> gamma_row_;  ///< n - m: unknown of each difference
  std::vector<std::int64_t> gap_row_;    ///< n: unknown of each missing sample, -1 where seen
  std::int64_t unknowns_ = 0;
  std::int64_t width_ = 0;           ///< columns left of the diagonal, at most
  std::vector<std::int64_t> first_;  ///< of each row's entries
  std::vector<std::int64_t> last_;   ///< row that has an entry in each column
  std::vector<double> factor_;       ///< unknowns x (width + 1): L without its ones, D on the diagonal
  double log_determinant_ = 0.0;
};

}  // namespace kinemark::math
