// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/coordinate_smoother.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/math/golden_section.h"
#include "kinemark/math/statistics.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::motion {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::array<double, 4> kThirdDifference = {-1.0, 3.0, -3.0, 1.0};
// Ratio of the variance of a step to that of the noise. Below the first the bandwidth is a 600th of the rate
// and the matrix becomes ill-conditioned; above the second there is no smoothing.
constexpr double kSmallestRatio = 1e-12, kLargestRatio = 1e4;
constexpr Index kBlock = 1500, kBlocks = 4;  // blocks from which the ratio is estimated in long recordings
constexpr double kWidestSpread = 30.0;       // relative SDs beyond it count as this much

/// A = D'D / ratio + diag(weight) as L diag(d) L', with its solutions and inverse band.
class Band {
 public:
  Band(const VectorXd& weight, double ratio) : d_(weight), l_(3, weight.size()) {
    const Index F = weight.size();
    l_.setZero();
    for (Index k = 0; k + 3 < F; ++k)
      for (Index i = 0; i < 4; ++i) {
        d_[k + i] += term(i, i) / ratio;
        for (Index j = i + 1; j < 4; ++j) l_(j - i - 1, k + i) += term(i, j) / ratio;
      }
    for (Index k = 0; k < F; ++k) {  // column k below the diagonal, then what it takes from the next three
      const std::array<double, 3> column = {l_(0, k), l_(1, k), l_(2, k)};
      log_determinant_ += std::log(d_[k]);
      for (Index i = 1; i <= 3 && k + i < F; ++i) {
        const double share = column[static_cast<std::size_t>(i - 1)] / d_[k];
        l_(i - 1, k) = share;
        d_[k + i] -= share * column[static_cast<std::size_t>(i - 1)];
        for (Index j = i + 1; j <= 3 && k + j < F; ++j)
          l_(j - i - 1, k + i) -= share * column[static_cast<std::size_t>(j - 1)];
      }
    }
  }

  [[nodiscard]] double log_determinant() const { return log_determinant_; }

  void solve_in_place(VectorXd& x) const {
    const Index F = x.size();
    for (Index k = 0; k < F; ++k)
      for (Index i = 1; i <= 3 && k + i < F; ++i) x[k + i] -= l_(i - 1, k) * x[k];
    x.array() /= d_.array();
    for (Index k = F - 1; k >= 0; --k)
      for (Index i = 1; i <= 3 && k + i < F; ++i) x[k] -= l_(i - 1, k) * x[k + i];
  }

  /// Inverse within the band: column k holds the covariances of frame k with itself and the next three.
  [[nodiscard]] Eigen::Matrix4Xd inverse_band() const {
    const Index F = d_.size();
    Eigen::Matrix4Xd C = Eigen::Matrix4Xd::Zero(4, F);
    const auto entry = [&C](Index a, Index b) { return a <= b ? C(b - a, a) : C(a - b, b); };
    for (Index k = F - 1; k >= 0; --k) {
      for (Index j = 1; j <= 3 && k + j < F; ++j)
        for (Index i = 1; i <= 3 && k + i < F; ++i) C(j, k) -= l_(i - 1, k) * entry(k + i, k + j);
      C(0, k) = 1.0 / d_[k];
      for (Index i = 1; i <= 3 && k + i < F; ++i) C(0, k) -= l_(i - 1, k) * C(i, k);
    }
    return C;
  }

 private:
  static double term(Index i, Index j) {
    return kThirdDifference[static_cast<std::size_t>(i)] * kThirdDifference[static_cast<std::size_t>(j)];
  }

  VectorXd d_;
  Eigen::Matrix3Xd l_;
  double log_determinant_ = 0.0;
};

/// Misfit and roughness of the best curve, as the noise variance would have them.
double squares_of(const VectorXd& y, const VectorXd& weight, const VectorXd& x, double ratio) {
  double squares = (weight.array() * (y - x).array().square()).sum();
  for (Index k = 0; k + 3 < x.size(); ++k) {
    const double step = x[k + 3] - 3.0 * x[k + 2] + 3.0 * x[k + 1] - x[k];
    squares += step * step / ratio;
  }
  return squares;
}

/// The stretches of a recording on which the ratio is estimated.
std::vector<Index> stretches(Index frames) {
  if (frames <= kBlock * kBlocks) return {0};
  std::vector<Index> first;
  for (Index b = 0; b < kBlocks; ++b) first.push_back(b * (frames - kBlock) / (kBlocks - 1));
  return first;
}

/// Curve of a ratio: what C_p and the likelihood are made of.
struct Fit {
  double squares = 0.0;       ///< misfit to the samples
  double all_squares = 0.0;   ///< and roughness
  double determinants = 0.0;  ///< log det(A)
  double freedom = 0.0, steps = 0.0;
  VectorXd curve;  ///< where one stretch is all

  /// The noise variance profiled out, not above `largest`, and the given one at least.
  [[nodiscard]] double noise(double largest) const {
    return std::clamp(all_squares / std::max(freedom, 1.0), 1.0, largest);
  }
  /// -2 log of the marginal likelihood of a ratio, with noise of this variance.
  [[nodiscard]] double misfit(double ratio, double variance) const {
    return all_squares / variance + freedom * std::log(variance) + determinants + steps * std::log(ratio);
  }
};

Fit fit(const VectorXd& y, const VectorXd& weight, double ratio) {
  const auto first = stretches(y.size());
  const Index length = first.size() == 1 ? y.size() : kBlock;
  Fit out;
  for (const Index f : first) {
    const VectorXd w = weight.segment(f, length), values = y.segment(f, length);
    const auto seen = static_cast<double>((w.array() > 0.0).count());
    if (seen < kFewestSamples) continue;
    const Band band(w, ratio);
    VectorXd x = w.cwiseProduct(values);
    band.solve_in_place(x);
    out.squares += (w.array() * (values - x).array().square()).sum();
    out.all_squares += squares_of(values, w, x, ratio);
    out.determinants += band.log_determinant();
    out.freedom += seen - 3.0, out.steps += static_cast<double>(length - 3);
    if (first.size() == 1) out.curve = std::move(x);
  }
  return out;
}

/// -2 log of the marginal likelihood of a ratio, the noise variance profiled out, but not above `largest`.
double misfit(const VectorXd& y, const VectorXd& weight, double ratio, double largest) {
  const Fit found = fit(y, weight, ratio);
  return found.misfit(ratio, std::min(largest, found.all_squares / std::max(found.freedom, 1.0)) + 1e-30);
}

double best_ratio(const VectorXd& y, const VectorXd& weight, double largest) {
  const auto at_log = [&](double log_ratio) { return misfit(y, weight, std::exp(log_ratio), largest); };
  const double low = std::log(kSmallestRatio), high = std::log(kLargestRatio);
  constexpr int kGrid = 13;
  const double spacing = (high - low) / (kGrid - 1);
  double best = low, best_misfit = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kGrid; ++i) {
    const double here = at_log(low + i * spacing);
    if (here < best_misfit) best_misfit = here, best = low + i * spacing;
  }
  // Golden section between the neighbours of the best grid point, to 2 % of the ratio.
  const auto refined = math::golden_section(at_log, std::max(low, best - spacing),
                                            std::min(high, best + spacing), {.width = 0.05});
  return std::exp(refined.middle());
}

VectorXd weights_of(std::span<const double> sd, Index frames) {
  if (sd.empty()) return VectorXd::Ones(frames);
  std::vector<double> seen;
  for (const double s : sd)
    if (s >= 0.0) seen.push_back(s);
  VectorXd weight = VectorXd::Zero(frames);
  if (seen.empty()) return weight;
  const double usual = math::upper_median(seen);
  for (Index f = 0; f < frames; ++f) {
    const double s = sd[static_cast<std::size_t>(f)];
    if (!(s >= 0.0)) continue;
    const double relative = usual > 0.0 ? std::clamp(s / usual, 1.0 / kWidestSpread, kWidestSpread) : 1.0;
    weight[f] = 1.0 / (relative * relative);
  }
  return weight;
}

/// Covariance of value, rate and acceleration from that of three neighbouring frames.
/// @param band  of the F frames with one more at each end, which nobody saw: what lies beyond the ends is not
///              known better than the prior has it
void fill_covariance(const Eigen::Matrix4Xd& band, double variance, double rate_hz, Eigen::MatrixXd& out) {
  const Index F = band.cols() - 2;
  out.resize(6, F);
  const double r = rate_hz;
  Eigen::Matrix3d T;
  T << 0.0, 1.0, 0.0, -0.5 * r, 0.0, 0.5 * r, r * r, -2.0 * r * r, r * r;
  for (Index f = 0; f < F; ++f) {
    Eigen::Matrix3d window;
    for (Index i = 0; i < 3; ++i)
      for (Index j = i; j < 3; ++j) window(i, j) = window(j, i) = band(j - i, f + i);
    const Eigen::Matrix3d C = variance * (T * window * T.transpose());
    math::pack_symmetric3(C, out.col(f).data());
  }
}

}  // namespace

NearestCurve nearest_curve(const VectorXd& y, const VectorXd& weight, double first, double largest) {
  constexpr double kSpacing = 1.0;       // of log ratio
  constexpr double kBeyond = 10.0;       // of C_p above the best, where weights are small
  constexpr double kFlat = 0.02;         // of C_p from one ratio to the next
  constexpr int kLeast = 2, kMost = 30;  // ratios on either side
  constexpr double kSharpness =
      0.25;  // of the weights by C_p: half of Akaike's, as C_p has a scatter of its own
  check(y.size() == weight.size(), "need one weight for every sample");
  NearestCurve out{.step_variance = first, .spread = VectorXd::Zero(y.size())};
  if ((weight.array() > 0.0).count() < kFewestSamples) return out;
  const VectorXd values = y.array() - weight.dot(y) / weight.sum();
  const double middle = std::log(std::clamp(first, kSmallestRatio, kLargestRatio));
  std::vector<Fit> fits(2 * kMost + 1);
  const auto ratio_at = [&](int i) { return middle + kSpacing * (i - kMost); };
  const auto fit_at = [&](int i) -> Fit& { return fits[static_cast<std::size_t>(i)]; };
  double noise = 1.0, least_misfit = std::numeric_limits<double>::infinity();
  const auto ask = [&](int i) {
    fit_at(i) = fit(values, weight, std::exp(ratio_at(i)));
    const double variance = fit_at(i).noise(largest),
                 misfit = fit_at(i).misfit(std::exp(ratio_at(i)), variance);
    if (misfit < least_misfit) least_misfit = misfit, noise = variance;
  };
  // C_p = squares / noise + 2 tr(A^-1 W), the trace from the slope of log det(A), but for the number of
  // frames.
  const auto distance = [&](int i) {
    return fit_at(i).squares / noise + (fit_at(i + 1).determinants - fit_at(i - 1).determinants) / kSpacing;
  };
  int low = kMost - kLeast, high = kMost + kLeast;
  for (int i = low - 1; i <= high + 1; ++i) ask(i);
  const auto best = [&] {
    double least = distance(low);
    for (int i = low + 1; i <= high; ++i) least = std::min(least, distance(i));
    return least;
  };
  const auto go_on = [&](int i, int inner) {
    return distance(i) < best() + kBeyond && std::abs(distance(i) - distance(inner)) > kFlat;
  };
  while (low > 1 && ratio_at(low - 2) > std::log(kSmallestRatio) && go_on(low, low + 1)) ask(--low - 1);
  while (high + 2 < 2 * kMost && ratio_at(high + 2) < std::log(kLargestRatio) && go_on(high, high - 1))
    ask(++high + 1);
  double weights = 0.0, bandwidths = 0.0;
  const double least = best();
  VectorXd sum = VectorXd::Zero(y.size());
  for (int i = low; i <= high; ++i) {
    const double likely = std::exp(kSharpness * (least - distance(i)));
    weights += likely, bandwidths += likely * std::exp(ratio_at(i) / 6.0);
    if (const auto& curve = fit_at(i).curve; curve.size() > 0) {
      sum += likely * curve;
      out.spread.array() += likely * curve.array().square();
    }
  }
  out.step_variance = noise * std::pow(bandwidths / weights, 6);
  out.spread = (out.spread.array() / weights - (sum.array() / weights).square()).cwiseMax(0.0);
  return out;
}

KnownCurve curve_of(const VectorXd& y, const VectorXd& weight, double step_variance) {
  check(y.size() == weight.size(), "need one weight for every sample");
  KnownCurve out{.value = weight.cwiseProduct(y), .variance = {}};
  const Band band(weight, std::clamp(step_variance, kSmallestRatio, kLargestRatio));
  band.solve_in_place(out.value);
  out.variance = band.inverse_band().row(0);
  return out;
}

void five_point_rates(const VectorXd& y, double rate_hz, VectorXd& rate, VectorXd& acceleration) {
  const Index F = y.size();
  check(F >= 3, "five_point_rates() needs three samples or more");
  rate.resize(F);
  acceleration.resize(F);
  const auto value = [&](Index f) {
    const auto beyond = static_cast<double>(f < 0 ? -f : f - F + 1);
    if (f >= 0 && f < F) return y[f];
    // A parabola through the last three samples.
    const double y0 = f < 0 ? y[0] : y[F - 1], y1 = f < 0 ? y[1] : y[F - 2], y2 = f < 0 ? y[2] : y[F - 3];
    return y0 + beyond * (y0 - y1) + 0.5 * beyond * (beyond + 1.0) * (y0 - 2.0 * y1 + y2);
  };
  for (Index f = 0; f < F; ++f) {
    const double far_back = value(f - 2), back = value(f - 1), next = value(f + 1), far_next = value(f + 2);
    rate[f] = rate_hz * (8.0 * (next - back) - (far_next - far_back)) / 12.0;
    acceleration[f] = rate_hz * rate_hz * (16.0 * (next + back) - (far_next + far_back) - 30.0 * y[f]) / 12.0;
  }
}

SmoothedCoordinate smooth_coordinate(std::span<const double> y, std::span<const double> sd, double rate_hz,
                                     double largest_noise_scale) {
  const auto F = static_cast<Index>(y.size());
  check(sd.empty() || sd.size() == y.size(), "sd must be empty or as long as y");
  SmoothedCoordinate out;
  out.value = Eigen::Map<const VectorXd>(y.data(), F);
  out.rate.setZero(F);
  out.acceleration.setZero(F);
  out.covariance.setConstant(6, F, std::numeric_limits<double>::quiet_NaN());
  const VectorXd weight = weights_of(sd, F);
  const auto seen = (weight.array() > 0.0).count();
  if (seen < kFewestSamples) return out;
  // About the mean: large offsets cost digits.
  const double mean = weight.dot(out.value) / weight.sum();
  const VectorXd values = out.value.array() - mean;
  double usual = 1.0;
  if (!sd.empty()) {
    std::vector<double> all;
    for (const double s : sd)
      if (s >= 0.0) all.push_back(s);
    if (const double middle = math::upper_median(all); middle > 0.0) usual = middle;
  }
  const double largest = std::pow(largest_noise_scale * usual, 2);
  const double ratio = best_ratio(values, weight, largest);
  const Band band(weight, ratio);
  VectorXd x = weight.cwiseProduct(values);
  band.solve_in_place(x);
  const double variance =
      std::min(largest, squares_of(values, weight, x, ratio) / static_cast<double>(seen - 3));
  out.known = true;
  out.noise_scale = std::sqrt(variance) / usual;
  out.step_sd = std::sqrt(variance * ratio);
  VectorXd wide = VectorXd::Zero(F + 2);
  wide.segment(1, F) = weight;
  fill_covariance(Band(wide, ratio).inverse_band(), variance, rate_hz, out.covariance);
  five_point_rates(x, rate_hz, out.rate, out.acceleration);
  out.value = x.array() + mean;
  return out;
}

}  // namespace kinemark::motion
