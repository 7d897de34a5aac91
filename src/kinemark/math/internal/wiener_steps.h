// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The single steps of the Wiener smoother: beginning, prediction, update, and their adjoints.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "kinemark/math/wiener_smoother.h"

namespace kinemark::math::internal {

constexpr double factorial(int n) { return n <= 1 ? 1.0 : n * factorial(n - 1); }

/// to += factor * from, of n numbers. Plain loops of known length: Eigen's expressions of these sizes take
/// much longer to compile.
template <int n>
void add_scaled(double factor, const double* from, double* to) {
  for (int i = 0; i < n; ++i) to[i] += factor * from[i];
}

/// States are Taylor coefficients c_i = x^(i) h^i / i!, with h the scale of time: all of one size. Order by
/// order, the axes of one order side by side. Matrices stand column by column.
template <int kOrder, int kAxes>
class WienerSteps {
 public:
  using Observations = std::span<const PositionObservation<kAxes>>;

  explicit WienerSteps(const WienerProcess& process) : h_(process.time_scale_s) {
    const double density = process.spectral_density * std::pow(h_, 2 * kOrder - 1);
    for (int i = 0; i < kOrder; ++i)
      for (int j = 0; j < kOrder; ++j)
        growth_unit_[i][j] = density / ((2 * kOrder - 1 - i - j) * factorial(kOrder - 1 - i) *
                                        factorial(kOrder - 1 - j) * factorial(i) * factorial(j));
  }

  static constexpr int kStates = kOrder * kAxes, kFirst = kStates * kAxes, kSquare = kStates * kStates;
  using Axes = Eigen::Matrix<double, kAxes, 1>;
  using AxesMatrix = Eigen::Matrix<double, kAxes, kAxes>;

  struct Belief {
    double x[kStates];
    double p[kSquare];
  };
  /// What is believed after an observation, and what it added to the prediction.
  struct Step {
    Belief filtered;
    double p0[kFirst];  ///< first columns of the predicted covariance
    AxesMatrix w;       ///< weight of the innovation: (information^-1 + p00)^-1
    Axes y;             ///< innovation
    bool seen;
  };
  /// What later observations say: given all, x - p l and p - p a p. Of filtered x and p: predicted ones may
  /// be so much wider that the difference would keep few digits.
  struct Adjoint {
    double l[kStates] = {};
    double a[kSquare] = {};
  };

  [[nodiscard]] Belief begin(const WienerPrior<kAxes>& prior) const;
  [[nodiscard]] Belief begin(Observations all) const;
  void set_interval(double dt_s);
  static AxesMatrix update(const Belief& predicted, const PositionObservation<kAxes>& observation,
                           Step& step);
  void advance(Belief& belief) const;
  void back(bool with_covariance, Adjoint& later) const;
  static void look_back(const Step& step, bool with_covariance, Adjoint& later);
  void estimate(const Belief& filtered, const Adjoint& later, int covariances,
                WienerEstimate<kAxes>& out) const;
  void set_shift(double shift_s);

 private:
  static AxesMatrix corner(const double* square) {
    AxesMatrix out;
    for (int b = 0; b < kAxes; ++b)
      for (int a = 0; a < kAxes; ++a) out(a, b) = square[kStates * b + a];
    return out;
  }
  static void make_symmetric(double* square) {
    for (int j = 0; j < kStates; ++j)
      for (int i = 0; i < j; ++i)
        square[kStates * j + i] = square[kStates * i + j] =
            0.5 * (square[kStates * j + i] + square[kStates * i + j]);
  }
  /// out = first kAxes columns of `square` times m.
  static void first_columns_times(const double* square, const AxesMatrix& m, double* out) {
    std::fill_n(out, kFirst, 0.0);
    for (int a = 0; a < kAxes; ++a)
      for (int b = 0; b < kAxes; ++b) add_scaled<kStates>(m(b, a), square + kStates * b, out + kStates * a);
  }
  static double dot(const double* a, const double* b) {
    double sum = 0.0;
    for (int i = 0; i < kStates; ++i) sum += a[i] * b[i];
    return sum;
  }
  /// shift[i][j] = C(j, i) s^(j - i): Taylor coefficients s scales of time later.
  static void taylor_shift(double s, double (&shift)[kOrder][kOrder]) {
    for (int i = 0; i < kOrder; ++i) {
      double binomial = 1.0, power = 1.0;
      for (int j = 0; j < i; ++j) shift[i][j] = 0.0;
      for (int j = i; j < kOrder; ++j) {
        shift[i][j] = binomial * power;
        binomial = binomial * (j + 1) / (j + 1 - i);
        power *= s;
      }
    }
  }

  double h_;
  double dt_ = -1.0;
  double f_[kOrder][kOrder] = {};       ///< transition of one axis: upper triangular, ones on its diagonal
  double growth_[kOrder][kOrder] = {};  ///< process noise of one axis
  double growth_unit_[kOrder][kOrder];  ///< the same over one scale of time
  double read_[3][kOrder] = {};         ///< derivatives 0 to 2 in SI units from the states
};

template <int kOrder, int kAxes>
typename WienerSteps<kOrder, kAxes>::Belief WienerSteps<kOrder, kAxes>::begin(
    const WienerPrior<kAxes>& prior) const {
  Belief out{};
  double unit = 1.0;
  for (int i = 0; i < kOrder; ++i) {
    const double sd = prior.sd[static_cast<std::size_t>(i)] * unit;
    for (int a = 0; a < kAxes; ++a) out.p[(kStates + 1) * (kAxes * i + a)] = sd * sd;
    unit *= h_ / (i + 1);
  }
  std::copy_n(prior.position.data(), kAxes, out.x);
  return out;
}

template <int kOrder, int kAxes>
typename WienerSteps<kOrder, kAxes>::Belief WienerSteps<kOrder, kAxes>::begin(Observations all) const {
  // A polynomial through the first observations, over two scales of time or so, held ten times less certain
  // than it is: it counts those observations 1 % too much, and keeps the digits that a start from nothing
  // would cost.
  constexpr std::size_t kMost = 512;
  constexpr double kLess = 100.0, kRidge = 1.0;  // of the variance; m^-2
  Eigen::MatrixXd square = kRidge * Eigen::MatrixXd::Identity(kStates, kStates);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kStates);
  right.head(kAxes) = kRidge * all[0].position;
  int informative = 0;
  for (std::size_t k = 0; k < std::min(all.size(), kMost); ++k) {
    const double s = (all[k].time_s - all[0].time_s) / h_;
    if (informative >= kOrder + 2 && s > 2.0) break;
    if (!(all[k].information.trace() > 0.0)) continue;
    ++informative;
    const Axes weighted = all[k].information * all[k].position;
    double power_i = 1.0;
    for (int i = 0; i < kOrder; ++i, power_i *= s) {
      right.segment(kAxes * i, kAxes) += power_i * weighted;
      double power = power_i;
      for (int j = 0; j < kOrder; ++j, power *= s)
        square.block(kAxes * i, kAxes * j, kAxes, kAxes) += power * all[k].information;
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(square);
  const Eigen::VectorXd x = llt.solve(right);
  const Eigen::MatrixXd p = kLess * llt.solve(Eigen::MatrixXd::Identity(kStates, kStates));
  Belief out;
  std::copy_n(x.data(), kStates, out.x);
  std::copy_n(p.data(), kSquare, out.p);
  return out;
}

template <int kOrder, int kAxes>
void WienerSteps<kOrder, kAxes>::set_interval(double dt_s) {
  if (std::abs(dt_s - dt_) <= 1e-12 * dt_s) return;
  dt_ = dt_s;
  const double s = dt_s / h_;
  taylor_shift(s, f_);
  double power[2 * kOrder];
  power[0] = 1.0;
  for (int e = 1; e < 2 * kOrder; ++e) power[e] = power[e - 1] * s;
  for (int i = 0; i < kOrder; ++i)
    for (int j = 0; j < kOrder; ++j) growth_[i][j] = growth_unit_[i][j] * power[2 * kOrder - 1 - i - j];
}

/// Estimates are of this long after each instant.
template <int kOrder, int kAxes>
void WienerSteps<kOrder, kAxes>::set_shift(double shift_s) {
  double shift[kOrder][kOrder], unit = 1.0;
  taylor_shift(shift_s / h_, shift);
  for (int d = 0; d < 3; ++d, unit *= d / h_)
    for (int j = 0; j < kOrder; ++j) read_[d][j] = unit * shift[d][j];
}

/// Returns the matrix whose determinant counts in the likelihood.
template <int kOrder, int kAxes>
typename WienerSteps<kOrder, kAxes>::AxesMatrix WienerSteps<kOrder, kAxes>::update(
    const Belief& predicted, const PositionObservation<kAxes>& observation, Step& step) {
  step.filtered = predicted;
  step.seen = observation.information.trace() > 0.0;
  if (!step.seen) return AxesMatrix::Identity();
  std::copy_n(predicted.p, kFirst, step.p0);
  const AxesMatrix m = AxesMatrix::Identity() + observation.information * corner(predicted.p);
  const AxesMatrix w = m.partialPivLu().solve(observation.information);
  step.w = 0.5 * (w + w.transpose());
  step.y = observation.position - Eigen::Map<const Axes>(predicted.x);
  double gain[kFirst];
  first_columns_times(step.p0, step.w, gain);
  for (int a = 0; a < kAxes; ++a) {
    add_scaled<kStates>(step.y(a), gain + kStates * a, step.filtered.x);
    for (int c = 0; c < kStates; ++c)
      add_scaled<kStates>(-step.p0[kStates * a + c], gain + kStates * a, step.filtered.p + kStates * c);
  }
  make_symmetric(step.filtered.p);
  return m;
}

/// To the next instant: F x, F p F' and the noise. F acts on every axis alike: blocks from the first need
/// only those behind them.
template <int kOrder, int kAxes>
void WienerSteps<kOrder, kAxes>::advance(Belief& belief) const {
  double* p = belief.p;
  for (int i = 0; i < kOrder; ++i)
    for (int j = i + 1; j < kOrder; ++j) {
      add_scaled<kAxes>(f_[i][j], belief.x + kAxes * j, belief.x + kAxes * i);
      add_scaled<kFirst>(f_[i][j], p + kFirst * j, p + kFirst * i);
    }
  for (int c = 0; c < kStates; ++c)
    for (int i = 0; i < kOrder; ++i)
      for (int j = i + 1; j < kOrder; ++j)
        add_scaled<kAxes>(f_[i][j], p + kStates * c + kAxes * j, p + kStates * c + kAxes * i);
  for (int i = 0; i < kOrder; ++i)
    for (int j = 0; j < kOrder; ++j)
      for (int a = 0; a < kAxes; ++a) p[kStates * (kAxes * j + a) + kAxes * i + a] += growth_[i][j];
  make_symmetric(p);
}

/// Through the transition to the instant before: F' l, F' a F.
template <int kOrder, int kAxes>
void WienerSteps<kOrder, kAxes>::back(bool with_covariance, Adjoint& later) const {
  for (int j = kOrder - 1; j > 0; --j)
    for (int i = 0; i < j; ++i) add_scaled<kAxes>(f_[i][j], later.l + kAxes * i, later.l + kAxes * j);
  if (!with_covariance) return;
  double* a = later.a;
  for (int j = kOrder - 1; j > 0; --j)
    for (int i = 0; i < j; ++i) add_scaled<kFirst>(f_[i][j], a + kFirst * i, a + kFirst * j);
  for (int c = 0; c < kStates; ++c)
    for (int j = kOrder - 1; j > 0; --j)
      for (int i = 0; i < j; ++i)
        add_scaled<kAxes>(f_[i][j], a + kStates * c + kAxes * i, a + kStates * c + kAxes * j);
  make_symmetric(a);  // rounding's antisymmetric part would grow from step to step
}

/// From after an observation to before it.
template <int kOrder, int kAxes>
void WienerSteps<kOrder, kAxes>::look_back(const Step& step, bool with_covariance, Adjoint& later) {
  if (!step.seen) return;
  Axes innovation = step.y;
  for (int a = 0; a < kAxes; ++a) innovation(a) += dot(step.p0 + kStates * a, later.l);
  const Axes weighted = step.w * innovation;
  for (int a = 0; a < kAxes; ++a) later.l[a] -= weighted(a);
  if (!with_covariance) return;
  double gain[kFirst], b[kFirst] = {};  // b: a times the gain
  first_columns_times(step.p0, step.w, gain);
  for (int a = 0; a < kAxes; ++a)
    for (int k = 0; k < kStates; ++k)
      add_scaled<kStates>(gain[kStates * a + k], later.a + kStates * k, b + kStates * a);
  AxesMatrix square;
  for (int i = 0; i < kAxes; ++i)
    for (int j = 0; j < kAxes; ++j) square(i, j) = dot(gain + kStates * i, b + kStates * j);
  for (int a = 0; a < kAxes; ++a) {
    add_scaled<kStates>(-1.0, b + kStates * a, later.a + kStates * a);
    for (int c = 0; c < kStates; ++c) later.a[kStates * c + a] -= b[kStates * a + c];
  }
  for (int j = 0; j < kAxes; ++j)
    for (int i = 0; i < kAxes; ++i) later.a[kStates * j + i] += square(i, j) + step.w(i, j);
}

/// The first `covariances` derivatives get covariances.
template <int kOrder, int kAxes>
void WienerSteps<kOrder, kAxes>::estimate(const Belief& filtered, const Adjoint& later, int covariances,
                                          WienerEstimate<kAxes>& out) const {
  double x[kStates];
  std::copy_n(filtered.x, kStates, x);
  for (int k = 0; k < kStates; ++k) add_scaled<kStates>(-later.l[k], filtered.p + kStates * k, x);
  for (int d = 0; d < 3; ++d)
    for (int a = 0; a < kAxes; ++a) {
      double sum = 0.0;
      for (int j = d; j < kOrder; ++j) sum += read_[d][j] * x[kAxes * j + a];
      out.derivatives(a, d) = sum;
    }
  const int n = covariances * kAxes;
  double g[3 * kFirst], ag[3 * kFirst];  // columns: p times the rows that read a derivative; a times those
  std::fill_n(g, n * kStates, 0.0);
  std::fill_n(ag, n * kStates, 0.0);
  for (int c = 0; c < n; ++c) {
    const int d = c / kAxes, a = c % kAxes;
    for (int j = d; j < kOrder; ++j)
      add_scaled<kStates>(read_[d][j], filtered.p + kStates * (kAxes * j + a), g + kStates * c);
    for (int k = 0; k < kStates; ++k)
      add_scaled<kStates>(g[kStates * c + k], later.a + kStates * k, ag + kStates * c);
    for (int r = 0; r <= c; ++r) {
      double sum = -dot(g + kStates * r, ag + kStates * c);
      for (int j = d; j < kOrder; ++j) sum += read_[d][j] * g[kStates * r + kAxes * j + a];
      out.covariance(r, c) = out.covariance(c, r) = sum;
    }
  }
}

}  // namespace kinemark::math::internal
