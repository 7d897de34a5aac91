// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The core of the smoother: an m-times integrated Wiener process seen in noise.
//
// State z_i = x^(i) / w^i, time in units of 1/w, variances in units of the noise: with w the corner of the
// filter (w^(2m) = q / (sigma^2 dt)) everything is of order one, for any rate, bandwidth and unit of length.
//   z(+h) = F z + noise,  F_ij = h^(j-i) / (j-i)!,  Q_ij = w dt h^(2m-1-i-j) / ((2m-1-i-j) (m-1-i)! (m-1-j)!)
// Covariances live as lower triangular square roots S, so that order 5 keeps its digits where P = S S' would
// not. Park & Kailath (1995), IEEE Trans. Autom. Control 40(5): square-root RTS smoothing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace kinemark::trajectory::smoothing {

/// Prior standard deviation of every scaled state, in noise units: no prior at all for data of any size.
inline constexpr double kDiffuse = 1e7;
/// Variances above this, in noise units, count as not determined by the data.
inline constexpr double kUndetermined = 1e8;
/// After a gap longer than this (in 1/w) the filter is restarted: no information is carried across.
inline constexpr double kLongestGap = 20.0;
/// Gains that change less than this (relative) have settled.
inline constexpr double kSettled = 1e-12;

[[nodiscard]] constexpr double factorial(int n) { return n <= 1 ? 1.0 : n * factorial(n - 1); }

/// Half-power corner w of the smoother whose amplitude 1 / (1 + (f/f0)^(2m)) is 1/sqrt(2) at the cut-off.
[[nodiscard]] inline double corner_rad_s(int order, double cutoff_hz) {
  return 2.0 * M_PI * cutoff_hz / std::pow(std::sqrt(2.0) - 1.0, 1.0 / (2.0 * order));
}

template <int m>
using Square = std::array<double, static_cast<std::size_t>(m) * m>;  // row-major

/// Data of a forward step for the backward pass: the smoother gain and the covariance of the earlier state
/// given the later one.
template <int m>
struct Step {
  Square<m> gain;
  Square<m> left;  // symmetric
};

template <int m>
class Iwp {
 public:
  /// @param corner_times_interval  w dt, > 0: corner of the filter and nominal time between samples
  explicit Iwp(double corner_times_interval) {
    // Lower Cholesky factor of Q for h = 1; h only scales its rows.
    Square<m> q;
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j)
        q[i * m + j] =
            corner_times_interval / ((2 * m - 1 - i - j) * factorial(m - 1 - i) * factorial(m - 1 - j));
    root_q_.fill(0.0);
    for (int j = 0; j < m; ++j) {
      for (int i = j; i < m; ++i) {
        double sum = q[i * m + j];
        for (int k = 0; k < j; ++k) sum -= root_q_[i * m + k] * root_q_[j * m + k];
        root_q_[i * m + j] = i == j ? std::sqrt(sum) : sum / root_q_[j * m + j];
      }
    }
  }

  [[nodiscard]] static Square<m> diffuse() {
    Square<m> s{};
    for (int i = 0; i < m; ++i) s[i * m + i] = kDiffuse;
    return s;
  }

  /// A position with noise variance r arrives. S is lower triangular with the position first, so only its
  /// first column involves the position: the update scales that column without loss of precision.
  static void measure(double r, Square<m>& s, std::array<double, m>& gain) {
    const double alpha = s[0] * s[0] + r;
    const double shrink = std::sqrt(r / alpha);
    const double s00 = s[0];
    for (int i = 0; i < m; ++i) {
      gain[static_cast<std::size_t>(i)] = s00 * s[i * m] / alpha;
      s[i * m] *= shrink;
    }
  }

  /// Root of F S S' F' + Q, and, when `step` is not null, the data for the backward pass. h > 0 in units of
  /// 1/w.
  void advance(double h, Square<m>& s, Step<m>* step) const {
    // [ (F S)'  S' ]   orthogonal    [ S+'  B' ]
    // [ Lq'     0  ]       ->        [ 0    W  ],  gain = B S+^-1,  left = W' W
    const int columns = step == nullptr ? m : 2 * m;
    double a[2 * m][2 * m];
    double f[m], scale[m];
    f[0] = 1.0;
    for (int d = 1; d < m; ++d) f[d] = f[d - 1] * h / d;
    scale[m - 1] = std::sqrt(h);
    for (int i = m - 2; i >= 0; --i) scale[i] = scale[i + 1] * h;
    for (int row = 0; row < m; ++row) {
      for (int col = 0; col < m; ++col) {
        double sum = 0.0;
        for (int k = std::max(row, col); k < m; ++k) sum += f[k - col] * s[k * m + row];
        a[row][col] = sum;
        a[row][m + col] = s[col * m + row];
        a[m + row][col] = scale[col] * root_q_[col * m + row];
        a[m + row][m + col] = 0.0;
      }
    }
    for (int j = 0; j < m; ++j) {
      // Column j is not zero in rows j to m + j only: Lq' is triangular.
      double tail = 0.0;
      for (int i = j + 1; i <= m + j; ++i) tail += a[i][j] * a[i][j];
      if (tail == 0.0) continue;
      const double pivot = a[j][j];
      const double norm = std::copysign(std::sqrt(pivot * pivot + tail), pivot);
      const double v0 = pivot + norm;
      const double beta = 1.0 / (norm * v0);
      for (int col = j + 1; col < columns; ++col) {
        double dot = v0 * a[j][col];
        for (int i = j + 1; i <= m + j; ++i) dot += a[i][j] * a[i][col];
        dot *= beta;
        a[j][col] -= dot * v0;
        for (int i = j + 1; i <= m + j; ++i) a[i][col] -= dot * a[i][j];
      }
      a[j][j] = -norm;
    }
    for (int i = 0; i < m; ++i)  // one root of many: that with a positive diagonal, so that it can settle
      if (a[i][i] < 0.0)
        for (int col = i; col < columns; ++col) a[i][col] = -a[i][col];
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j) s[i * m + j] = j <= i ? a[j][i] : 0.0;
    if (step == nullptr) return;
    for (int row = 0; row < m; ++row) {
      for (int col = m - 1; col >= 0; --col) {
        double sum = a[col][m + row];
        for (int k = col + 1; k < m; ++k) sum -= step->gain[row * m + k] * s[k * m + col];
        step->gain[row * m + col] = sum / s[col * m + col];
      }
      for (int col = 0; col <= row; ++col) {
        double sum = 0.0;
        for (int k = m; k < 2 * m; ++k) sum += a[k][m + row] * a[k][m + col];
        step->left[row * m + col] = step->left[col * m + row] = sum;
      }
    }
  }

  /// z <- F z for `axes` states stored one after another.
  static void predict(double h, int axes, double* z) {
    double f[m];
    f[0] = 1.0;
    for (int d = 1; d < m; ++d) f[d] = f[d - 1] * h / d;
    for (int axis = 0; axis < axes; ++axis, z += m)
      for (int i = 0; i < m; ++i)
        for (int j = i + 1; j < m; ++j) z[i] += f[j - i] * z[j];
  }

  /// One step back: `later` (smoothed) becomes the smoothed state before it, from the filtered one.
  static void back(double h, const Step<m>& step, int axes, const double* filtered, double* later) {
    for (int axis = 0; axis < axes; ++axis, filtered += m, later += m) {
      double ahead[m], moved[m];
      std::copy_n(filtered, m, ahead);
      predict(h, 1, ahead);
      for (int i = 0; i < m; ++i) ahead[i] = later[i] - ahead[i];
      for (int i = 0; i < m; ++i) {
        moved[i] = filtered[i];
        for (int j = 0; j < m; ++j) moved[i] += step.gain[i * m + j] * ahead[j];
      }
      std::copy_n(moved, m, later);
    }
  }

  /// Covariance of the smoothed state before a step from the one behind it: a sum of positive parts.
  static void back_covariance(const Step<m>& step, Square<m>& p) {
    Square<m> gp;
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < m; ++j) {
        double sum = 0.0;
        for (int k = 0; k < m; ++k) sum += step.gain[i * m + k] * p[k * m + j];
        gp[i * m + j] = sum;
      }
    }
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j <= i; ++j) {
        double sum = step.left[i * m + j];
        for (int k = 0; k < m; ++k) sum += gp[i * m + k] * step.gain[j * m + k];
        p[i * m + j] = p[j * m + i] = sum;
      }
    }
  }

  /// S S'.
  [[nodiscard]] static Square<m> covariance(const Square<m>& s) {
    Square<m> p;
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j <= i; ++j) {
        double sum = 0.0;
        for (int k = 0; k <= j; ++k) sum += s[i * m + k] * s[j * m + k];
        p[i * m + j] = p[j * m + i] = sum;
      }
    }
    return p;
  }

  /// True when no entry differs by more than kSettled of its row's diagonal.
  [[nodiscard]] static bool settled(const Square<m>& a, const Square<m>& b) {
    for (int i = 0; i < m; ++i)
      for (int j = 0; j <= i; ++j)
        if (!(std::abs(a[i * m + j] - b[i * m + j]) <= kSettled * std::abs(a[i * m + i]))) return false;
    return true;
  }

 private:
  Square<m> root_q_;
};

/// Filter of one marker while it runs: the root of the predicted covariance, and whether it has settled.
template <int m>
struct Gains {
  Square<m> root = Iwp<m>::diffuse();       ///< before the measurement
  std::array<double, m> gain{};             ///< of the last measurement
  double settled_r = 0.0, settled_h = 0.0;  ///< what it has settled for; 0: not settled

  /// Update by a measurement of variance r (0: none) and advance by h; fills `step`, if it is not null, and
  /// returns true, unless all has settled and the last filled step holds on.
  bool move(const Iwp<m>& model, double r, double h, Step<m>* step) {
    if (r > 0.0 && r == settled_r && h == settled_h) return false;
    const Square<m> before = root;
    if (r > 0.0) Iwp<m>::measure(r, root, gain);
    model.advance(h, root, step);
    const bool holds = r > 0.0 && Iwp<m>::settled(root, before);
    settled_r = holds ? r : 0.0;
    settled_h = holds ? h : 0.0;
    return true;
  }
};

}  // namespace kinemark::trajectory::smoothing
