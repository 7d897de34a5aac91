// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/internal/movement_ends.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/math/golden_section.h"

namespace kinemark::analysis::internal {
namespace {

using math::SeriesMatrix;

constexpr double kMoving_s[] = {0.25, 0.15};          // of the movement that is fitted, at most
constexpr double kLeastRate_hz = 80.0;                // at which a jump of the velocity is claimed
constexpr double kJumpSurely = 4.0;                   // nats by which a velocity jumps
constexpr double kRest_s = 0.12;                      // of the rest
constexpr double kEarlier_s = 0.08, kLater_s = 0.16;  // of the instant from where it is thought to be
constexpr int kPowers = 3;
constexpr std::int64_t kLeastMoving = 5, kLeastRest = 4;  // samples
constexpr double kMostMisfit = 4.0;  // deviations of the residual's mean square from the noise's
constexpr int kHalvings = 14;        // of what an edge of the profile lies in
constexpr double kBeside_s = 0.1;    // of a movement's mean speed, before and behind it
constexpr int kSpeeds = 200;         // of the fitted movement, among which the crossing lies

using Coefficients = Eigen::Matrix<double, kPowers + 1, 3>;
using Normal = Eigen::Matrix<double, kPowers + 1, kPowers + 1>;
using Powers = Eigen::Matrix<double, kPowers + 1, 1>;

// The best fit of a movement that rests from one instant on.
struct Fit {
  double at = kNaN;  // s behind where it is thought to be; before it, where it begins
  double squares = INFINITY;
  Coefficients coefficients = Coefficients::Zero();
  Normal inverse = Normal::Zero();
  std::int64_t moving = 0, resting = 0;  // samples
};

// Samples about an end, as if each were the end of a movement.
class Samples {
 public:
  // @param lowest  power of the time before the end
  Samples(const SeriesMatrix& x, const std::vector<bool>& seen, double rate_hz, const EndQuestion& question,
          double moving_s, int lowest)
      : reach_(std::min(moving_s, 0.5 * question.movement_s)), lowest_(lowest) {
    const double turn = question.begins ? -1.0 : 1.0;
    const auto behind = static_cast<std::int64_t>(std::ceil(moving_s * rate_hz)) + 1;
    const auto middle = static_cast<std::int64_t>(std::llround(question.near_s * rate_hz));
    std::vector<std::int64_t> taken;
    for (auto i = std::max<std::int64_t>(0, middle - behind);
         i <= std::min<std::int64_t>(x.rows() - 1, middle + behind); ++i) {
      const double t = turn * (static_cast<double>(i) / rate_hz - question.near_s);
      if (seen[at(i)] && t >= -reach_ && t <= kRest_s) taken.push_back(i), times_.push_back(t);
    }
    positions_.resize(std::ssize(taken), 3);
    for (std::size_t i = 0; i < taken.size(); ++i)
      positions_.row(static_cast<Eigen::Index>(i)) = x.row(taken[i]) - x.row(taken.front());
  }

  [[nodiscard]] std::int64_t count() const { return std::ssize(times_); }

  [[nodiscard]] Fit fit(double instant) const {
    Fit out{.at = instant};
    Normal normal = Normal::Zero();
    Coefficients right = Coefficients::Zero();
    double squares = 0.0;
    for (std::int64_t i = 0; i < count(); ++i) {
      const Powers row = powers(instant - times_[at(i)]);
      (instant > times_[at(i)] ? out.moving : out.resting) += 1;
      normal += row * row.transpose();
      right += row * positions_.row(i);
      squares += positions_.row(i).squaredNorm();
    }
    if (out.moving < kLeastMoving || out.resting < kLeastRest) return out;
    const Eigen::LDLT<Normal> solver(normal);
    out.coefficients = solver.solve(right);
    out.inverse = solver.solve(Normal::Identity());
    out.squares = squares - out.coefficients.cwiseProduct(right).sum();
    return out;
  }

  // By how much the crossing of a level lies before the instant, s, and its deviation for unit noise, with
  // the instant as it is.
  struct Crossing {
    double before = kNaN, sd = kNaN;
  };
  [[nodiscard]] Crossing crossing(const Fit& fit, double level) const {
    double last = 0.0;
    for (int i = 0; i <= kSpeeds; ++i) {
      const double before = reach_ * i / kSpeeds, speed = velocity(fit, before).norm();
      if (speed > level) {
        if (i == 0) return {.before = 0.0, .sd = 0.0};
        const double step = reach_ / kSpeeds, slope = (speed - last) / step;
        const Powers weights = rates(before);
        return {.before = before - (speed - level) / slope,
                .sd = std::sqrt(weights.dot(fit.inverse * weights)) / slope};
      }
      last = speed;
    }
    return {};
  }

  // Of the acceleration at the instant, for unit noise.
  [[nodiscard]] double acceleration(const Fit& fit) const {
    return 2.0 * fit.coefficients.row(1).norm() / (reach_ * reach_);
  }
  [[nodiscard]] double acceleration_sd(const Fit& fit) const {
    return 2.0 * std::sqrt(fit.inverse(1, 1)) / (reach_ * reach_);
  }

 private:
  [[nodiscard]] Powers powers(double before) const {
    Powers out = Powers::Zero();
    out[0] = 1.0;
    const double share = before / reach_;
    if (!(share > 0.0)) return out;
    double power = lowest_ == 1 ? share : share * share;
    for (int k = 1; k <= kPowers; ++k, power *= share) out[k] = power;
    return out;
  }
  // Their rates of change.
  [[nodiscard]] Powers rates(double before) const {
    Powers out = Powers::Zero();
    const double share = before / reach_;
    double power = lowest_ == 1 ? 1.0 : share;
    for (int k = 1; k <= kPowers; ++k, power *= share) out[k] = (lowest_ + k - 1) * power / reach_;
    return out;
  }
  [[nodiscard]] Eigen::RowVector3d velocity(const Fit& fit, double before) const {
    return rates(before).transpose() * fit.coefficients;
  }

  double reach_;
  int lowest_;
  std::vector<double> times_;  // s, negative in the movement
  SeriesMatrix positions_;
};

// Instants whose fit is as good as noise allows, from the earliest to the latest.
std::vector<Fit> as_good(const Samples& samples, double step, double allowed) {
  std::vector<Fit> all;
  for (double at = -kEarlier_s; at <= kLater_s; at += step) all.push_back(samples.fit(at));
  const auto coarse = std::ranges::min_element(all, {}, &Fit::squares);
  if (!std::isfinite(coarse->squares)) return {};
  const auto found = math::golden_section([&](double at) { return samples.fit(at).squares; },
                                          coarse->at - step, coarse->at + step, {.width = 1e-3 * step});
  const Fit best = samples.fit(found.at);
  const double most = best.squares + allowed;
  std::vector<Fit> out{best};
  for (const double side : {-1.0, 1.0}) {
    double inside = best.at, outside = best.at + side * step;
    if (samples.fit(outside).squares > most) {
      for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (inside + outside);
        (samples.fit(middle).squares > most ? outside : inside) = middle;
      }
      out.push_back(samples.fit(0.5 * (best.at + inside)));
      out.push_back(samples.fit(inside));
    }
  }
  for (const auto& one : all)
    if (one.squares <= most) out.push_back(one);
  return out;
}

// What a family of fits says; nothing where it misses the samples by more than noise. `misfit` gets the
// squares that the best one leaves.
std::optional<SharpEnd> end_of(const Samples& samples, double rate_hz, const EndQuestion& question,
                               bool velocity_jumps, double& misfit) {
  misfit = INFINITY;
  const double free = 3.0 * static_cast<double>(samples.count()) - 3.0 * (kPowers + 1) - 1.0;
  if (free < 10.0) return std::nullopt;
  const double square = question.deviations * question.deviations;
  const auto fits = as_good(samples, 0.5 / rate_hz, square * question.noise_variance);
  if (fits.empty()) return std::nullopt;
  const double least = misfit = fits.front().squares;
  if (least / free > question.noise_variance * (1.0 + kMostMisfit * std::sqrt(2.0 / free)))
    return std::nullopt;
  const double turn = question.begins ? -1.0 : 1.0, sd = std::sqrt(question.noise_variance);
  SharpEnd out{.low_s = INFINITY,
               .high_s = -INFINITY,
               .acceleration = velocity_jumps ? kNaN : 0.0,
               .velocity_jumps = velocity_jumps};
  for (const auto& fit : fits) {
    const auto crossing = samples.crossing(fit, question.level);
    if (std::isnan(crossing.before)) return std::nullopt;
    // What the fit's own place in the profile leaves of the deviations.
    const double left =
        sd * std::sqrt(std::max(0.0, square - (fit.squares - least) / question.noise_variance));
    const double time = question.near_s + turn * (fit.at - crossing.before);
    if (std::isnan(out.time_s)) out.time_s = time;
    out.low_s = std::min(out.low_s, time - left * crossing.sd);
    out.high_s = std::max(out.high_s, time + left * crossing.sd);
    if (!velocity_jumps)
      out.acceleration =
          std::max(out.acceleration, samples.acceleration(fit) + left * samples.acceleration_sd(fit));
  }
  return out;
}

}  // namespace

std::optional<SharpEnd> fit_sharp_end(const SeriesMatrix& x, const std::vector<bool>& seen, double rate_hz,
                                      const EndQuestion& question) {
  for (const double moving_s : kMoving_s) {
    double squares = INFINITY, squares_of_jump = INFINITY;
    const auto of = [&](int lowest, double& misfit) {
      return end_of(Samples(x, seen, rate_hz, question, moving_s, lowest), rate_hz, question, lowest == 1,
                    misfit);
    };
    const auto steady = of(2, squares), jumps = of(1, squares_of_jump);
    if (jumps && rate_hz >= kLeastRate_hz &&
        squares - squares_of_jump > 2.0 * kJumpSurely * question.noise_variance)
      return jumps;
    if (steady) return steady;
  }
  return std::nullopt;
}

SharpValue MovementEnds::value_of(std::string_view id, double smooth) const {
  if (!onset && !end) return {};
  if (id == "onset" || id == "movement_end") {
    const auto& one = id == "onset" ? onset : end;
    if (!one) return {};
    return {.value = first_s + one->time_s, .low = first_s + one->low_s, .high = first_s + one->high_s};
  }
  if (id == "peak_acceleration")
    return {.high = std::fmax(onset ? onset->acceleration : kNaN, end ? end->acceleration : kNaN)};
  const SharpEnd from =
      onset.value_or(SharpEnd{.time_s = smooth_onset_s, .low_s = smooth_onset_s, .high_s = smooth_onset_s});
  const SharpEnd to =
      end.value_or(SharpEnd{.time_s = smooth_end_s, .low_s = smooth_end_s, .high_s = smooth_end_s});
  const double value = to.time_s - from.time_s;
  const SharpValue time{.value = value,
                        .low = value - std::hypot(to.time_s - to.low_s, from.high_s - from.time_s),
                        .high = value + std::hypot(to.high_s - to.time_s, from.time_s - from.low_s)};
  if (id == "movement_time") return time;
  if (id != "movement_mean_speed") return {};
  // The same way in another time, of which 50 ms at both ends are part.
  const double way = smooth * (smooth_end_s - smooth_onset_s + kBeside_s);
  return {.value = way / (time.value + kBeside_s),
          .low = way / (time.high + kBeside_s),
          .high = way / (time.low + kBeside_s)};
}

}  // namespace kinemark::analysis::internal
