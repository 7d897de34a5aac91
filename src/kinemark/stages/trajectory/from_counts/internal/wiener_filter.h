// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Fixed-interval smoother of an integrated Wiener process, in covariance form.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace kinemark::trajectory::internal {

/// One observation of a position in `kAxes` dimensions: value and inverse covariance, which may be
/// singular (one camera sees a line) or zero (nothing seen).
template <int kAxes>
struct Sight {
  double time_s = 0.0;  ///< strictly increasing
  Eigen::Matrix<double, kAxes, kAxes> information = Eigen::Matrix<double, kAxes, kAxes>::Zero();
  Eigen::Matrix<double, kAxes, 1> value = Eigen::Matrix<double, kAxes, 1>::Zero();
};

/// Stretches (first index, count) of sights between gaps, runs without information that last longer than
/// `longest_s`; each begins and ends with information. Order kept; none when there is no information at all.
template <int kAxes>
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> runs_between_gaps(
    const std::vector<Sight<kAxes>>& sights, double longest_s) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t k = 0; k < sights.size(); ++k) {
    if (!(sights[k].information.trace() > 0.0)) continue;
    const bool goes_on =
        !out.empty() &&
        sights[k].time_s - sights[out.back().first + out.back().second - 1].time_s <= longest_s;
    if (!goes_on) out.emplace_back(k, 0);
    out.back().second = k + 1 - out.back().first;
  }
  return out;
}

/// The `kOrder`-times integrated Wiener process: its kOrder-th derivative is white with spectral density q on
/// each axis. Kalman filter forwards, Bryson-Frazier adjoint backwards: neither inverts a covariance, so
/// small q and high order keep their digits where banded normal equations lose them.
///
/// States are Taylor coefficients c_i = x^(i) h^i / i! with h the time constant of the filter: all of one
/// size. Forward results are kept for a block at a time and computed again on the way back, so memory grows
/// with frames / block only. Bierman (1977), Factorization Methods, section X.
template <int kOrder, int kAxes>
class WienerFilter {
 public:
  static constexpr int kStates = kOrder * kAxes;
  static constexpr std::size_t kBlock = 8192;
  using State = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;
  using Axes = Eigen::Matrix<double, kAxes, 1>;
  using AxesMatrix = Eigen::Matrix<double, kAxes, kAxes>;

  /// @param q           spectral density of the kOrder-th derivative, m^2 s^(1 - 2 kOrder)
  /// @param time_scale  h, s: any value gives the same answer, the filter's time constant the best digits
  /// @param block       sights whose forward results are kept at a time
  WienerFilter(double q, double time_scale, std::size_t block = kBlock)
      : q_(q), h_(time_scale), block_(block) {}

  /// Calls visit(frame, state, covariance or nullptr) for every sight, last to first, with the smoothed state
  /// and, when asked, its covariance (both in Taylor coefficients; see derivative()).
  template <class Visit>
  void smooth(std::span<const Sight<kAxes>> sights, bool with_covariance, Visit&& visit);

  /// Derivative `order` (0: position) of a state, in SI units.
  [[nodiscard]] Axes derivative(const State& state, int order) const {
    return state.template segment<kAxes>(kAxes * order) * unit(order);
  }
  using Transition = Eigen::Matrix<double, kOrder, kOrder>;
  /// Taylor coefficients (of one axis) at another time from those here.
  [[nodiscard]] Transition taylor_shift(double dt_s) const {
    Transition out = Transition::Zero();
    for (int i = 0; i < kOrder; ++i) {
      double binomial = 1.0, power = 1.0;  // C(j, i) (dt / h)^(j - i)
      for (int j = i; j < kOrder; ++j) {
        out(i, j) = binomial * power;
        binomial = binomial * (j + 1) / (j + 1 - i);
        power *= dt_s / h_;
      }
    }
    return out;
  }
  [[nodiscard]] static State shifted(State state, const Transition& by) {
    times(by, state);
    return state;
  }
  /// A short shift: what the process wanders meanwhile is left out.
  [[nodiscard]] static Covariance shifted(Covariance p, const Transition& by) {
    times(by, p);
    p.transposeInPlace();
    times(by, p);
    return p;
  }
  /// Covariance of that derivative.
  [[nodiscard]] AxesMatrix derivative_covariance(const Covariance& p, int order) const {
    return p.template block<kAxes, kAxes>(kAxes * order, kAxes * order) * (unit(order) * unit(order));
  }

 private:
  struct Step {
    State x;       // predicted
    Covariance p;  // predicted
    AxesMatrix w;  // weight of the innovation: (H^-1 + P00)^-1
    Axes y;        // innovation
  };
  struct Prediction {
    State x;
    Covariance p;
  };

  [[nodiscard]] double unit(int order) const {
    double scale = 1.0;
    for (int i = 1; i <= order; ++i) scale *= i / h_;
    return scale;
  }
  [[nodiscard]] Prediction start(std::span<const Sight<kAxes>> sights) const;
  void set_interval(double dt_s);
  [[nodiscard]] Step weigh(const Prediction& at, const Sight<kAxes>& sight) const;
  [[nodiscard]] Prediction advance(const Step& step) const;
  /// F m, with F acting on every axis alike. It is upper triangular with ones on its diagonal: rows from the
  /// top need only rows below them.
  template <class Matrix>
  static void times(const Transition& f, Matrix& m) {
    for (int i = 0; i < kOrder; ++i)
      for (int j = i + 1; j < kOrder; ++j)
        m.template middleRows<kAxes>(kAxes * i) += f(i, j) * m.template middleRows<kAxes>(kAxes * j);
  }

  double q_, h_;
  std::size_t block_;
  double dt_ = -1.0;
  Transition f_;       // transition of one axis
  Transition growth_;  // process noise of one axis
};

template <int kOrder, int kAxes>
typename WienerFilter<kOrder, kAxes>::Prediction WienerFilter<kOrder, kAxes>::start(
    std::span<const Sight<kAxes>> sights) const {
  // A polynomial through the first sights, over two time constants or so, held ten times less certain than it
  // is: it counts those sights 1 % too much, and keeps the digits that a start from nothing would cost.
  constexpr std::size_t kMost = 512;
  constexpr double kLess = 100.0, kRidge = 1.0;  // of the variance; m^-2
  Covariance square = kRidge * Covariance::Identity();
  State right = State::Zero();
  right.template head<kAxes>() = kRidge * sights[0].value;
  int informative = 0;
  for (std::size_t k = 0; k < std::min(sights.size(), kMost); ++k) {
    const double s = (sights[k].time_s - sights[0].time_s) / h_;
    if (informative >= kOrder + 2 && s > 2.0) break;
    if (!(sights[k].information.trace() > 0.0)) continue;
    ++informative;
    const Axes weighted = sights[k].information * sights[k].value;
    double power_i = 1.0;
    for (int i = 0; i < kOrder; ++i, power_i *= s) {
      right.template segment<kAxes>(kAxes * i) += power_i * weighted;
      double power = power_i;
      for (int j = 0; j < kOrder; ++j, power *= s)
        square.template block<kAxes, kAxes>(kAxes * i, kAxes * j) += power * sights[k].information;
    }
  }
  const Eigen::LLT<Covariance> llt(square);
  return {llt.solve(right), kLess * llt.solve(Covariance::Identity())};
}

template <int kOrder, int kAxes>
void WienerFilter<kOrder, kAxes>::set_interval(double dt_s) {
  if (std::abs(dt_s - dt_) <= 1e-12 * dt_s) return;
  dt_ = dt_s;
  f_ = taylor_shift(dt_s);
  const auto factorial = [](int n) { return std::tgamma(n + 1.0); };
  for (int i = 0; i < kOrder; ++i)
    for (int j = 0; j < kOrder; ++j) {
      const int e = 2 * kOrder - 1 - i - j;
      growth_(i, j) =
          q_ * std::pow(dt_s, e) * std::pow(h_, i + j) /
          (e * factorial(kOrder - 1 - i) * factorial(kOrder - 1 - j) * factorial(i) * factorial(j));
    }
}

template <int kOrder, int kAxes>
typename WienerFilter<kOrder, kAxes>::Step WienerFilter<kOrder, kAxes>::weigh(
    const Prediction& at, const Sight<kAxes>& sight) const {
  Step step{at.x, at.p, AxesMatrix::Zero(), Axes::Zero()};
  const AxesMatrix p00 = at.p.template topLeftCorner<kAxes, kAxes>();
  const AxesMatrix m = AxesMatrix::Identity() + sight.information * p00;
  step.w = m.inverse() * sight.information;
  step.w = 0.5 * (step.w + step.w.transpose().eval());
  step.y = sight.value - at.x.template head<kAxes>();
  return step;
}

template <int kOrder, int kAxes>
typename WienerFilter<kOrder, kAxes>::Prediction WienerFilter<kOrder, kAxes>::advance(
    const Step& step) const {
  const auto p0 = step.p.template leftCols<kAxes>();
  const Eigen::Matrix<double, kStates, kAxes> gain = p0 * step.w;
  Prediction next{step.x + gain * step.y, step.p - gain * p0.transpose()};
  times(f_, next.x);
  times(f_, next.p);
  next.p.transposeInPlace();
  times(f_, next.p);
  for (int i = 0; i < kOrder; ++i)
    for (int j = 0; j < kOrder; ++j)
      for (int a = 0; a < kAxes; ++a) next.p(kAxes * i + a, kAxes * j + a) += growth_(i, j);
  next.p = 0.5 * (next.p + next.p.transpose().eval());
  return next;
}

template <int kOrder, int kAxes>
template <class Visit>
void WienerFilter<kOrder, kAxes>::smooth(std::span<const Sight<kAxes>> sights, bool with_covariance,
                                         Visit&& visit) {
  const std::size_t n = sights.size();
  if (n == 0) return;
  std::vector<Prediction> marks;  // prediction of the first sight of each block
  marks.reserve(n / block_ + 1);
  Prediction at = start(sights);
  for (std::size_t k = 0; k < n; ++k) {
    if (k % block_ == 0) marks.push_back(at);
    if (k + 1 == n || marks.size() == (n - 1) / block_ + 1) break;
    const Step step = weigh(at, sights[k]);
    set_interval(sights[k + 1].time_s - sights[k].time_s);
    at = advance(step);
  }
  State lambda = State::Zero();
  Covariance adjoint = Covariance::Zero();
  std::vector<Step> steps;
  steps.reserve(std::min(n, block_));
  for (std::size_t block = marks.size(); block-- > 0;) {
    const std::size_t first = block * block_, last = std::min(n, first + block_);
    steps.clear();
    at = marks[block];
    for (std::size_t k = first; k < last; ++k) {
      steps.push_back(weigh(at, sights[k]));
      if (k + 1 == last) break;
      set_interval(sights[k + 1].time_s - sights[k].time_s);
      at = advance(steps.back());
    }
    for (std::size_t k = last; k-- > first;) {
      const Step& s = steps[k - first];
      if (k + 1 < n) {  // through the transition: F' lambda, F' adjoint F
        set_interval(sights[k + 1].time_s - sights[k].time_s);
        for (int j = kOrder - 1; j > 0; --j)
          for (int i = 0; i < j; ++i)
            lambda.template segment<kAxes>(kAxes * j) += f_(i, j) * lambda.template segment<kAxes>(kAxes * i);
        if (with_covariance) {
          for (int pass = 0; pass < 2; ++pass) {
            for (int j = kOrder - 1; j > 0; --j)
              for (int i = 0; i < j; ++i)
                adjoint.template middleCols<kAxes>(kAxes * j) +=
                    f_(i, j) * adjoint.template middleCols<kAxes>(kAxes * i);
            adjoint.transposeInPlace();
          }
          // Rounding's antisymmetric part would grow from step to step.
          adjoint = 0.5 * (adjoint + adjoint.transpose().eval());
        }
      }
      const auto p0 = s.p.template leftCols<kAxes>();
      lambda.template head<kAxes>() -= s.w * (p0.transpose() * lambda + s.y);
      const State smoothed = s.x - s.p * lambda;
      if (!with_covariance) {
        visit(k, smoothed, static_cast<const Covariance*>(nullptr));
        continue;
      }
      const Eigen::Matrix<double, kAxes, kStates> b = s.w * (p0.transpose() * adjoint);
      const AxesMatrix corner = b * p0 * s.w;
      adjoint.template topRows<kAxes>() -= b;
      adjoint.template leftCols<kAxes>() -= b.transpose();
      adjoint.template topLeftCorner<kAxes, kAxes>() += corner + s.w;
      const Covariance posterior = s.p - s.p * adjoint * s.p;
      visit(k, smoothed, &posterior);
    }
  }
}

}  // namespace kinemark::trajectory::internal
