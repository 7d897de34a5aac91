// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/internal/velocity_jumps.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/math/golden_section.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis::internal {
namespace {

using math::SeriesMatrix;

constexpr double kReach_s = 0.15;         // to both sides of a jump
constexpr std::int64_t kLeastReach = 12;  // samples
constexpr double kEnough_hz = 200.0;      // means of neighbours are taken where there are more samples
constexpr int kDegree = 5;                // of the polynomial about a jump
constexpr double kQuiet = 0.25;           // share of the samples that tell what noise does
constexpr double kQuietSquare = 1.2125;   // that quantile of chi-square with three degrees of freedom
constexpr double kMostOfWhite = 1.25;     // what quiet samples hold over white noise
constexpr double kSurely = 20.0;          // nats by which a jump stands out
constexpr double kLikelier = 5.0;         // nats than a jump of acceleration or of its rate
constexpr double kMostResidual = 1.5;     // squares left behind a jump over those of quiet samples
constexpr double kMore = 10.0;            // nats that a jump of acceleration must add to that of velocity
constexpr double kNarrow = 1e-3;          // of a sample, to which the place of a jump is sought
constexpr double kStep = 0.25;            // of a sample, by which the place of a jump is sought

// Samples about a place in units of the reach, less the polynomial that fits them best.
class Surroundings {
 public:
  explicit Surroundings(std::int64_t reach) : reach_(reach), times_(2 * reach + 1) {
    for (std::int64_t i = 0; i < times_.size(); ++i)
      times_[i] = static_cast<double>(i - reach) / static_cast<double>(reach);
    Eigen::MatrixXd powers(times_.size(), kDegree + 1);
    for (int k = 0; k <= kDegree; ++k) powers.col(k) = times_.array().pow(k);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(powers);
    polynomial_ = qr.householderQ() * Eigen::MatrixXd::Identity(times_.size(), kDegree + 1);
  }

  [[nodiscard]] std::int64_t reach() const { return reach_; }
  [[nodiscard]] double samples() const { return static_cast<double>(times_.size()); }
  [[nodiscard]] Eigen::MatrixXd without_polynomial(const Eigen::MatrixXd& values) const {
    return values - polynomial_ * (polynomial_.transpose() * values);
  }
  // What begins `at` samples from the middle with that power of the time behind it.
  [[nodiscard]] Eigen::VectorXd begins(double at, int power) const {
    const double from = at / static_cast<double>(reach_);
    return without_polynomial((times_.array() - from).max(0.0).pow(power).matrix());
  }

 private:
  std::int64_t reach_;
  Eigen::VectorXd times_;
  Eigen::MatrixXd polynomial_;
};

// Means of `step` samples each, single missing ones bridged by the cubic through their neighbours.
struct Series {
  SeriesMatrix x;
  std::vector<bool> whole;
};

Series series_of(const SeriesMatrix& x, const std::vector<bool>& seen, std::int64_t step) {
  const std::int64_t n = x.rows();
  SeriesMatrix bridged = x;
  std::vector<bool> known = seen;
  for (std::int64_t i = 2; i + 2 < n; ++i)
    if (!seen[at(i)] && seen[at(i - 2)] && seen[at(i - 1)] && seen[at(i + 1)] && seen[at(i + 2)]) {
      bridged.row(i) = (4.0 * (x.row(i - 1) + x.row(i + 1)) - x.row(i - 2) - x.row(i + 2)) / 6.0;
      known[at(i)] = true;
    }
  Series out{.x = SeriesMatrix::Zero(n / step, x.cols()), .whole = std::vector<bool>(at(n / step), true)};
  for (std::int64_t i = 0; i < out.x.rows(); ++i)
    for (std::int64_t k = i * step; k < (i + 1) * step; ++k) {
      out.x.row(i) += bridged.row(k) / static_cast<double>(step);
      out.whole[at(i)] = out.whole[at(i)] && known[at(k)];
    }
  return out;
}

// Places whose surroundings are whole.
std::vector<std::int64_t> instants_of(const Series& series, std::int64_t reach) {
  std::vector<std::int64_t> out;
  std::int64_t run = 0;
  for (std::int64_t i = 0; i < series.x.rows(); ++i) {
    run = series.whole[at(i)] ? run + 1 : 0;
    if (run >= 2 * reach + 1) out.push_back(i - reach);
  }
  return out;
}

class Search {
 public:
  explicit Search(const Series& series, std::int64_t reach) : series_(series), about_(reach) {}

  std::vector<VelocityJump> found() {
    const auto instants = instants_of(series_, about_.reach());
    if (std::ssize(instants) < 4 * about_.reach()) return {};
    measure(instants);
    // Where quiet samples hold more than what differs from one to the next, a jump could be that as well.
    if (residual_ > kMostOfWhite * white_variance()) return {};
    std::vector<std::int64_t> standing;
    for (std::size_t p = 0; p < instants.size(); ++p)
      if (stands_out(instants, p)) standing.push_back(instants[p]);
    // Where one velocity jumps, others may: of those it is enough that nothing else is likelier.
    if (jumps_at(standing, kLikelier).empty()) return {};
    return jumps_at(standing, 0.0);
  }

 private:
  // Squares of the ramp's size at each place, and what quiet instants have of it and of residuals.
  void measure(const std::vector<std::int64_t>& instants) {
    const Eigen::VectorXd all = squares_of_ramp();
    std::vector<double> residuals;
    squares_.reserve(instants.size());
    for (std::size_t p = 0; p < instants.size(); ++p) {
      squares_.push_back(all[instants[p] - about_.reach()]);
      if (static_cast<std::int64_t>(p) % (about_.reach() / 2) == 0)
        residuals.push_back(about_.without_polynomial(around(instants[p])).squaredNorm());
    }
    noise_ = math::quantile(squares_, kQuiet) / kQuietSquare;
    residual_ = math::quantile(residuals, kQuiet) / (about_.samples() - kDegree - 1.0);
  }

  // Squares of the ramp's size at every place, whole or not. The ramp has nothing of a constant, so that
  // samples are taken as they are; block by block, as the processor reads them fastest.
  [[nodiscard]] Eigen::VectorXd squares_of_ramp() const {
    constexpr Eigen::Index kBlock = 512;
    const Eigen::VectorXd ramp = about_.begins(0.0, 1).normalized();
    Eigen::VectorXd out = Eigen::VectorXd::Zero(series_.x.rows() - ramp.size() + 1), size;
    for (Eigen::Index axis = 0; axis < series_.x.cols(); ++axis) {
      const Eigen::VectorXd x = series_.x.col(axis);
      for (Eigen::Index first = 0; first < out.size(); first += kBlock) {
        const Eigen::Index n = std::min(kBlock, out.size() - first);
        size.setZero(n);
        for (Eigen::Index k = 0; k < ramp.size(); ++k) size += ramp[k] * x.segment(first + k, n);
        out.segment(first, n) += size.cwiseAbs2();
      }
    }
    return out;
  }

  // Of white noise on three axes, from the distances of samples to the cubic through their neighbours.
  [[nodiscard]] double white_variance() const {
    constexpr double kMedianSquare = 2.366,
                     kOfCubic = 70.0 / 36.0;  // of chi-square with three; squared weights
    const auto& x = series_.x;
    std::vector<double> squares;
    for (std::int64_t i = 2; i + 2 < x.rows(); ++i)
      if (series_.whole[at(i - 2)] && series_.whole[at(i - 1)] && series_.whole[at(i)] &&
          series_.whole[at(i + 1)] && series_.whole[at(i + 2)])
        squares.push_back(
            (x.row(i) - (4.0 * (x.row(i - 1) + x.row(i + 1)) - x.row(i - 2) - x.row(i + 2)) / 6.0)
                .squaredNorm());
    return 3.0 * math::median(squares) / (kMedianSquare * kOfCubic);
  }

  [[nodiscard]] Eigen::MatrixXd around(std::int64_t place) const {
    const auto first = place - about_.reach();
    return series_.x.middleRows(first, 2 * about_.reach() + 1).rowwise() - series_.x.row(place);
  }

  [[nodiscard]] bool stands_out(const std::vector<std::int64_t>& instants, std::size_t p) const {
    if (!(squares_[p] > 2.0 * kSurely * noise_)) return false;
    for (std::size_t k = p; k > 0 && instants[p] - instants[k - 1] <= about_.reach(); --k)
      if (squares_[k - 1] > squares_[p]) return false;
    for (std::size_t k = p + 1; k < instants.size() && instants[k] - instants[p] <= about_.reach(); ++k)
      if (squares_[k] >= squares_[p]) return false;
    return true;
  }

  // @param likelier  nats by which a jump must be likelier than others
  [[nodiscard]] std::vector<VelocityJump> jumps_at(const std::vector<std::int64_t>& instants,
                                                   double likelier) const {
    std::vector<VelocityJump> out;
    for (const auto place : instants)
      if (const auto jump = jump_near(place, likelier); jump.at >= 0.0) out.push_back(jump);
    return out;
  }

  // The jump that fits best near a place; at < 0: something else fits as well, or nothing does.
  [[nodiscard]] VelocityJump jump_near(std::int64_t place, double likelier) const {
    const Eigen::MatrixXd values = about_.without_polynomial(around(place));
    const auto explained = [&](double at, int power) {
      return (about_.begins(at, power).normalized().transpose() * values).squaredNorm();
    };
    double best = -1.0, best_at = 0.0, rival = 0.0;
    for (double at = -2.0; at <= 2.0; at += kStep)
      if (const double squares = explained(at, 1); squares > best) best = squares, best_at = at;
    const double far = 0.5 * static_cast<double>(about_.reach());
    for (double at = -far; at <= far; at += 2.0 * kStep)
      for (const int power : {2, 3}) rival = std::max(rival, explained(at, power));
    VelocityJump out{.at = -1.0};
    if (best - rival < 2.0 * likelier * noise_) return out;
    const auto ramp_at = math::golden_section([&](double at) { return -explained(at, 1); }, best_at - kStep,
                                              best_at + kStep, {.width = kNarrow});
    const auto all_at = math::golden_section([&](double at) { return all_from(at, values).left; },
                                             best_at - kStep, best_at + kStep, {.width = kNarrow});
    const auto all = all_from(all_at.at, values);
    const double ramp_left = values.squaredNorm() + ramp_at.value;
    if (all.left > kMostResidual * residual_ * (about_.samples() - kDegree - 5.0)) return out;
    const double unit = static_cast<double>(about_.reach());
    if (ramp_left - all.left > 2.0 * kMore * noise_) {
      out.at = static_cast<double>(place) + all_at.at;
      for (int k = 0; k < 3; ++k) out.change.row(k) = all.sizes.row(k) / std::pow(unit, k + 1);
    } else {
      const Eigen::VectorXd ramp = about_.begins(ramp_at.at, 1);
      out.at = static_cast<double>(place) + ramp_at.at;
      out.change.row(0) = ramp.transpose() * values / ramp.squaredNorm() / unit;
    }
    return out;
  }

  // Ramp, square and cube that begin at one place, by least squares.
  struct AllFrom {
    Eigen::Matrix3d sizes;
    double left = 0.0;  // squares
  };
  [[nodiscard]] AllFrom all_from(double at, const Eigen::MatrixXd& values) const {
    Eigen::MatrixXd patterns(values.rows(), 3);
    for (int k = 0; k < 3; ++k) patterns.col(k) = about_.begins(at, k + 1);
    AllFrom out;
    out.sizes = patterns.householderQr().solve(values);
    out.left = (values - patterns * out.sizes).squaredNorm();
    return out;
  }

  const Series& series_;
  Surroundings about_;
  std::vector<double> squares_;
  double noise_ = 0.0, residual_ = 0.0;
};

}  // namespace

std::vector<VelocityJump> find_velocity_jumps(const SeriesMatrix& x, const std::vector<bool>& seen,
                                              double rate_hz) {
  const auto step = std::max<std::int64_t>(1, std::llround(rate_hz / kEnough_hz));
  const auto reach = std::llround(kReach_s * rate_hz / static_cast<double>(step));
  if (reach < kLeastReach) return {};
  const Series series = series_of(x, seen, step);
  auto out = Search(series, reach).found();
  const double width = static_cast<double>(step);
  for (auto& jump : out) {
    jump.at = width * jump.at + 0.5 * (width - 1.0);
    for (int k = 0; k < 3; ++k) jump.change.row(k) /= std::pow(width, k + 1);
  }
  return out;
}

SeriesMatrix without_jumps(const SeriesMatrix& x, const std::vector<VelocityJump>& jumps) {
  SeriesMatrix out = x;
  for (const auto& jump : jumps)
    for (auto i = static_cast<std::int64_t>(std::ceil(jump.at)); i < out.rows(); ++i) {
      const double since = static_cast<double>(i) - jump.at;
      out.row(i) -= Eigen::RowVector3d(since, since * since, since * since * since) * jump.change;
    }
  return out;
}

}  // namespace kinemark::analysis::internal
