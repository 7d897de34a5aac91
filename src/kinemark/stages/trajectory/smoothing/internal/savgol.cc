// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "kinemark/core/missing.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"
#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr int kDefaultDegree = 4;
constexpr int kWidest = 500;  ///< half width tried, frames

/// Weights of one window: row (derivative * points + where), column sample; times in frames. With a = sample
/// times about the window's middle, x^(d) at time t is sum_i c_i (d-th derivative of t^i), c =
/// pinv(Vandermonde) y.
class Window {
 public:
  Window(int points, int degree) : points_(points), weights_(4 * points, points) {
    degree = std::min(degree, points - 1);
    const double half = std::max(0.5 * (points - 1), 0.5);
    Eigen::MatrixXd basis(points, degree + 1);
    for (int i = 0; i < points; ++i) {
      const double u = (i - 0.5 * (points - 1)) / half;
      for (int p = 0; p <= degree; ++p) basis(i, p) = std::pow(u, p);
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(basis);
    const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(points, degree + 1);
    const Eigen::MatrixXd r = qr.matrixQR().topRows(degree + 1).triangularView<Eigen::Upper>();
    const Eigen::MatrixXd inverse = r.triangularView<Eigen::Upper>().solve(q.transpose());
    for (int d = 0; d < 4; ++d) {
      for (int i = 0; i < points; ++i) {
        const double u = (i - 0.5 * (points - 1)) / half;
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(degree + 1);
        for (int p = d; p <= degree; ++p)
          row(p) = factorial(p) / factorial(p - d) * std::pow(u, p - d) / std::pow(half, d);
        weights_.row(d * points + i) = row * inverse;
      }
    }
    determined_ = degree;
  }
  [[nodiscard]] auto at(int derivative, int where) const {
    return weights_.row(derivative * points_ + where);
  }
  [[nodiscard]] int points() const { return points_; }
  /// Highest derivative that this many points give.
  [[nodiscard]] int determined() const { return determined_; }

 private:
  int points_, determined_ = 0;
  Eigen::MatrixXd weights_;
};

/// Calls use(frame, window's first frame, where in the window, window) for every frame of a stretch.
class Windows {
 public:
  explicit Windows(int degree) : degree_(degree) {}
  const Window& of(std::int64_t points) {
    const int key = static_cast<int>(points);
    auto found = known_.find(key);
    if (found == known_.end()) found = known_.emplace(key, Window(key, degree_)).first;
    return found->second;
  }
  template <class Use>
  void each(const Stretch& stretch, int half, Use use) {
    const std::int64_t points = std::min<std::int64_t>(2 * half + 1, stretch.length());
    const Window& window = of(points);
    for (std::int64_t f = stretch.begin; f < stretch.end; ++f) {
      const std::int64_t first = std::clamp(f - half, stretch.begin, stretch.end - points);
      use(f, first, static_cast<int>(f - first), window);
    }
  }

 private:
  int degree_;
  std::map<int, Window> known_;
};

/// Generalised cross-validation of a half width.
double criterion(const MarkerSamples& samples, const std::vector<Stretch>& all, Windows& windows, int half) {
  double rss = 0.0, trace = 0.0, n = 0.0;
  for (const Stretch& stretch : all) {
    windows.each(stretch, half, [&](std::int64_t f, std::int64_t first, int where, const Window& window) {
      const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> y(
          samples.x.data() + 3 * first, window.points(), 3);
      const Eigen::RowVector3d smooth = window.at(0, where) * y;
      rss += (smooth - y.row(where)).squaredNorm();
      trace += 3.0 * window.at(0, where)(where);
      n += 3.0;
      (void)f;
    });
  }
  const double left = std::max(1.0 - trace / n, 1e-9);
  return rss / n / (left * left);
}

/// -3 dB of the middle weights, found by bisection.
double half_power_hz(const Window& window, double rate_hz) {
  const int middle = window.points() / 2;
  const auto amplitude = [&](double f) {
    double sum = 0.0;
    for (int i = 0; i < window.points(); ++i)
      sum += window.at(0, middle)(i) * std::cos(2.0 * M_PI * f * (i - middle));
    return sum;
  };
  double low = 0.0, high = 0.0;
  while (high < 0.5 && amplitude(high) > std::sqrt(0.5)) {
    low = high;
    high += 0.05 / window.points();
  }
  if (high >= 0.5) return kNaN;
  for (int i = 0; i < 50; ++i) {
    const double f = 0.5 * (low + high);
    (amplitude(f) > std::sqrt(0.5) ? low : high) = f;
  }
  return high * rate_hz;
}

int choose_half(const MarkerSamples& samples, const std::vector<Stretch>& all, int degree, double rate_hz,
                Windows& windows, const SmoothOptions& options, data::MarkerAccount& account) {
  std::int64_t longest = 1;
  for (const Stretch& s : all) longest = std::max(longest, s.length());
  const int narrowest = degree / 2 + 1;
  const int widest = static_cast<int>(std::clamp<std::int64_t>((longest - 1) / 2, narrowest, kWidest));
  if (options.cutoff_hz > 0.0) {
    // The narrowest window whose cut-off is not above the one asked.
    int low = narrowest, high = kWidest;
    while (low < high) {
      const int half = (low + high) / 2;
      if (half_power_hz(Window(2 * half + 1, degree), rate_hz) <= options.cutoff_hz)
        high = half;
      else
        low = half + 1;
    }
    account.description =
        fmt::format("Degree {}, window of {} frames for the cut-off asked.", degree, 2 * low + 1);
    return low;
  }
  int best = narrowest;
  double least = std::numeric_limits<double>::infinity();
  for (int half = narrowest; half <= widest; half = std::max(half + 1, static_cast<int>(half * 1.15))) {
    const double value = criterion(samples, all, windows, half);
    if (value >= least) continue;
    least = value;
    best = half;
  }
  account.criterion_name = "GCV, m^2";
  account.candidates = {{degree, half_power_hz(windows.of(2 * best + 1), rate_hz), least}};
  account.description =
      fmt::format("Degree {}, window of {} frames: the least cross-validated error.", degree, 2 * best + 1);
  return best;
}

}  // namespace

Status smooth_savgol(const MarkerSamples& samples, const SmoothOptions& options, double rate_hz,
                     MarkerResult& result) {
  data::MarkerAccount& account = result.account;
  if (!samples.time_s.empty())
    return fail(Code::not_supported,
                fmt::format("marker '{}' is not seen at even times, which filter savgol needs; use kalman",
                            account.name));
  const auto all = stretches(samples.present);
  const auto n = static_cast<std::size_t>(3 * samples.frames);
  Array<double>* const values[4] = {&result.x, &result.velocity, &result.acceleration, &result.jerk};
  Array<double>* const sds[4] = {nullptr, &result.velocity_sd, &result.acceleration_sd, &result.jerk_sd};
  for (Array<double>* v : values) v->assign(n, kNaN);
  account.left_missing = samples.frames;
  for (const Stretch& stretch : all) account.left_missing -= stretch.length();
  account.used.noise_sd_m = account.used.cutoff_hz = kNaN;
  const int degree = options.order > 0 ? options.order : kDefaultDegree;
  account.used.order = degree;
  if (all.empty()) {
    account.description = "Never seen.";
    return {};
  }
  Windows windows(degree);
  const int half = choose_half(samples, sample_of(all), degree, rate_hz, windows, options, account);
  account.used.cutoff_hz = half_power_hz(windows.of(2 * half + 1), rate_hz);
  double rss = 0.0, freedom = 0.0;
  for (const Stretch& stretch : all) {
    windows.each(stretch, half, [&](std::int64_t f, std::int64_t first, int where, const Window& window) {
      const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> y(
          samples.x.data() + 3 * first, window.points(), 3);
      for (int d = 0; d <= std::min(3, window.determined()); ++d) {
        const Eigen::RowVector3d smooth = window.at(d, where) * y * std::pow(rate_hz, d);
        std::copy_n(smooth.data(), 3, values[d]->begin() + 3 * f);
        if (d == 0) rss += (smooth - y.row(where)).squaredNorm();
      }
      freedom += 3.0 * (1.0 - window.at(0, where)(where));
    });
  }
  double noise = options.noise_sd_m;
  account.noise_from = noise > 0.0 ? "given" : "data";
  if (noise <= 0.0) {
    if (freedom < 1e-6) {
      account.noise_from.clear();
      return {};
    }
    noise = std::sqrt(rss / freedom);
  }
  account.used.noise_sd_m = noise;
  result.covariance.assign(2 * n, kNaN);
  for (int d = 1; d < 4; ++d) sds[d]->assign(n, kNaN);
  for (const Stretch& stretch : all) {
    windows.each(stretch, half, [&](std::int64_t f, std::int64_t, int where, const Window& window) {
      const double v = noise * noise * window.at(0, where).squaredNorm();
      math::pack_isotropic3(v, result.covariance.data() + 6 * f);
      for (int d = 1; d <= std::min(3, window.determined()); ++d)
        std::fill_n(sds[d]->begin() + 3 * f, 3, noise * window.at(d, where).norm() * std::pow(rate_hz, d));
    });
  }
  return {};
}

}  // namespace kinemark::trajectory::smoothing
