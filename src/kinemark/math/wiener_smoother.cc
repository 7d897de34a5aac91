// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/wiener_smoother.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "kinemark/core/check.h"

namespace kinemark::math {
namespace {

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
class Smoother {
 public:
  using Observations = std::span<const PositionObservation<kAxes>>;

  explicit Smoother(const WienerProcess& process) : h_(process.time_scale_s) {
    const double density = process.spectral_density * std::pow(h_, 2 * kOrder - 1);
    for (int i = 0; i < kOrder; ++i)
      for (int j = 0; j < kOrder; ++j)
        growth_unit_[i][j] = density / ((2 * kOrder - 1 - i - j) * factorial(kOrder - 1 - i) *
                                        factorial(kOrder - 1 - j) * factorial(i) * factorial(j));
  }

  void smooth(Observations all, const WienerOptions<kAxes>& options, const WienerVisit<kAxes>& visit);
  [[nodiscard]] double log_likelihood(Observations all, const WienerPrior<kAxes>& prior);

 private:
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
typename Smoother<kOrder, kAxes>::Belief Smoother<kOrder, kAxes>::begin(
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
typename Smoother<kOrder, kAxes>::Belief Smoother<kOrder, kAxes>::begin(Observations all) const {
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
void Smoother<kOrder, kAxes>::set_interval(double dt_s) {
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

/// Returns the matrix whose determinant counts in the likelihood.
template <int kOrder, int kAxes>
typename Smoother<kOrder, kAxes>::AxesMatrix Smoother<kOrder, kAxes>::update(
    const Belief& predicted, const PositionObservation<kAxes>& observation, Step& step) {
  step.filtered = predicted;
  step.seen = observation.information.trace() > 0.0;
  if (!step.seen) return AxesMatrix::Identity();
  std::copy_n(predicted.p, kFirst, step.p0);
  const AxesMatrix m = AxesMatrix::Identity() + observation.information * corner(predicted.p);
  const AxesMatrix w = m.inverse() * observation.information;
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
void Smoother<kOrder, kAxes>::advance(Belief& belief) const {
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
void Smoother<kOrder, kAxes>::back(bool with_covariance, Adjoint& later) const {
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
void Smoother<kOrder, kAxes>::look_back(const Step& step, bool with_covariance, Adjoint& later) {
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
void Smoother<kOrder, kAxes>::estimate(const Belief& filtered, const Adjoint& later, int covariances,
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

template <int kOrder, int kAxes>
void Smoother<kOrder, kAxes>::smooth(Observations all, const WienerOptions<kAxes>& options,
                                     const WienerVisit<kAxes>& visit) {
  const std::size_t n = all.size(), block = options.block;
  double shift[kOrder][kOrder], unit = 1.0;
  taylor_shift(options.shift_s / h_, shift);
  for (int d = 0; d < 3; ++d, unit *= d / h_)
    for (int j = 0; j < kOrder; ++j) read_[d][j] = unit * shift[d][j];

  // Forwards once, marking the prediction of each block's first observation; each block again on the way
  // back.
  std::vector<Belief> marks{options.prior ? begin(*options.prior) : begin(all)};
  std::vector<Step> steps(std::min(n, block));
  const auto forward = [&](std::size_t first, std::size_t last, bool mark) {
    Belief predicted = marks.back();
    for (std::size_t k = first; k < last; ++k) {
      Step& step = steps[k - first];
      std::ignore = update(predicted, all[k], step);
      if (k + 1 == n || (k + 1 == last && !mark)) return;
      set_interval(all[k + 1].time_s - all[k].time_s);
      predicted = step.filtered;
      advance(predicted);
    }
    marks.push_back(predicted);
  };
  for (std::size_t first = 0; first + block < n; first += block) forward(first, first + block, true);

  const bool with_covariance = options.covariance != WienerCovariance::none;
  const int covariances = with_covariance ? options.covariance == WienerCovariance::position ? 1 : 3 : 0;
  Adjoint later;
  WienerEstimate<kAxes> estimated;
  estimated.covariance.setZero();
  for (; !marks.empty(); marks.pop_back()) {
    const std::size_t first = (marks.size() - 1) * block, last = std::min(n, first + block);
    forward(first, last, false);
    for (std::size_t k = last; k-- > first;) {
      const Step& step = steps[k - first];
      if (k + 1 < n) {
        set_interval(all[k + 1].time_s - all[k].time_s);
        back(with_covariance, later);
      }
      estimate(step.filtered, later, covariances, estimated);
      visit(k, estimated);
      look_back(step, with_covariance, later);
    }
  }
}

template <int kOrder, int kAxes>
double Smoother<kOrder, kAxes>::log_likelihood(Observations all, const WienerPrior<kAxes>& prior) {
  Step step;
  Belief predicted = begin(prior);
  double sum = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const AxesMatrix m = update(predicted, all[k], step);
    if (step.seen) sum -= 0.5 * (step.y.dot(step.w * step.y) + std::log(m.determinant()));
    if (k + 1 == all.size()) break;
    set_interval(all[k + 1].time_s - all[k].time_s);
    predicted = step.filtered;
    advance(predicted);
  }
  return sum;
}

/// Calls `use` with the smoother of the process's order.
template <int kAxes, class Use>
auto with_order(const WienerProcess& process, const Use& use) {
  check(process.spectral_density >= 0.0 && process.time_scale_s > 0.0,
        "a Wiener process has a density of 0 or more and a positive scale of time");
  if (process.order == 3) return use(Smoother<3, kAxes>(process));
  if (process.order == 4) return use(Smoother<4, kAxes>(process));
  check(process.order == 5, "the order of a smoother is 3, 4 or 5");
  return use(Smoother<5, kAxes>(process));
}

}  // namespace

template <int kAxes>
std::vector<std::pair<std::size_t, std::size_t>> runs_between_gaps(
    std::span<const PositionObservation<kAxes>> observations, double longest_s) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (!(observations[k].information.trace() > 0.0)) continue;
    const bool goes_on =
        !out.empty() &&
        observations[k].time_s - observations[out.back().first + out.back().second - 1].time_s <= longest_s;
    if (!goes_on) out.emplace_back(k, 0);
    out.back().second = k + 1 - out.back().first;
  }
  return out;
}

template <int kAxes>
void smooth_wiener(const WienerProcess& process, std::span<const PositionObservation<kAxes>> observations,
                   const WienerOptions<kAxes>& options, const WienerVisit<kAxes>& visit) {
  check(options.block > 0, "a block has at least one observation");
  if (observations.empty()) return;
  check(options.prior || observations[0].information.trace() > 0.0,
        "without a prior, the first observation must carry information");
  with_order<kAxes>(process, [&](auto smoother) { smoother.smooth(observations, options, visit); });
}

template <int kAxes>
double wiener_log_likelihood(const WienerProcess& process,
                             std::span<const PositionObservation<kAxes>> observations,
                             const WienerPrior<kAxes>& prior) {
  return with_order<kAxes>(process,
                           [&](auto smoother) { return smoother.log_likelihood(observations, prior); });
}

template std::vector<std::pair<std::size_t, std::size_t>> runs_between_gaps<1>(
    std::span<const PositionObservation<1>>, double);
template std::vector<std::pair<std::size_t, std::size_t>> runs_between_gaps<3>(
    std::span<const PositionObservation<3>>, double);
template void smooth_wiener<1>(const WienerProcess&, std::span<const PositionObservation<1>>,
                               const WienerOptions<1>&, const WienerVisit<1>&);
template void smooth_wiener<3>(const WienerProcess&, std::span<const PositionObservation<3>>,
                               const WienerOptions<3>&, const WienerVisit<3>&);
template double wiener_log_likelihood<1>(const WienerProcess&, std::span<const PositionObservation<1>>,
                                         const WienerPrior<1>&);
template double wiener_log_likelihood<3>(const WienerProcess&, std::span<const PositionObservation<3>>,
                                         const WienerPrior<3>&);

}  // namespace kinemark::math
