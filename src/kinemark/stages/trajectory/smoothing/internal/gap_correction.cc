// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/gap_correction.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>

#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr std::int64_t kShortest = 3;      ///< frames: across fewer every filter is good
constexpr int kFeatures = 10;              ///< accelerations, half of them on either side
constexpr double kStepOfPeriod = 0.18;     ///< between two of them, of the period at the cut-off
constexpr std::size_t kMostPatterns = 8;   ///< kinds of gaps that are learnt
constexpr std::size_t kMostHidden = 96;    ///< stretches hidden for each kind ...
constexpr std::size_t kFewestHidden = 16;  ///< ... and the least that teach anything
constexpr int kPasses = 12;                ///< records with hidden stretches, at other frames in each
constexpr double kMostMissing = 0.15;      ///< of the frames around a hidden stretch
constexpr double kEnough = 0.9;            ///< squared error left, beyond which nothing is corrected
constexpr std::array kRidges = {1e-4, 1e-3, 1e-2, 1e-1, 1.0};  ///< of the mean square of the features

using Pattern = std::vector<std::uint8_t>;  ///< 1 where a sample is missing; the first and the last are 1

/// A gap, or several with few samples between them.
struct Gap {
  std::int64_t begin = 0;
  Pattern missing;
};

/// Frames around a stretch that matter, from the filter's time constant and band.
struct Reach {
  std::int64_t samples = 0;  ///< frames beside a gap in which its smoothed values are worse
  std::int64_t step = 0;     ///< between two accelerations that predict
  [[nodiscard]] std::int64_t features() const { return std::max(step * (kFeatures / 2 - 1) + 1, samples); }
};

Reach reach_of(int order, double cutoff_hz, double interval_s) {
  const double h = corner_rad_s(order, cutoff_hz) * interval_s;
  return {std::max<std::int64_t>(2, std::lround(2.0 / h)),
          std::max<std::int64_t>(1, std::lround(kStepOfPeriod / (cutoff_hz * interval_s)))};
}

/// Gaps inside a series; those with fewer than `apart` samples between them are one.
std::vector<Gap> gaps_of(const Series& series, std::int64_t apart) {
  std::vector<Gap> out;
  std::int64_t latest = -1;
  std::int64_t end = 0;  // of the latest gap
  for (std::int64_t k = 0; k < series.frames; ++k) {
    if (series.seen[k] == 0) continue;
    if (latest >= 0 && k > latest + 1) {
      if (out.empty() || latest + 1 - end >= apart) out.push_back({latest + 1, {}});
      auto& [begin, missing] = out.back();
      missing.resize(static_cast<std::size_t>(k - begin), 1);
      std::fill(missing.begin() + std::max<std::int64_t>(0, end - begin),
                missing.begin() + (latest + 1 - begin), 0);
      end = k;
    }
    latest = k;
  }
  return out;
}

/// Longest run of missing samples.
std::int64_t longest_run(const Pattern& missing) {
  std::int64_t most = 0, run = 0;
  for (const std::uint8_t m : missing) most = std::max(most, run = m != 0 ? run + 1 : 0);
  return most;
}

std::vector<double> run_filter(const Series& series, int order, double cutoff_hz) {
  std::vector<double> state(static_cast<std::size_t>(series.frames * series.axes * 4)),
      variance(static_cast<std::size_t>(series.frames * 4));
  smooth_series(series, order, cutoff_hz, {state.data(), variance.data()});
  return state;
}

/// Accelerations around a stretch, rows for the axes; none where one is unknown or outside.
std::optional<Eigen::MatrixXd> features_at(const std::vector<double>& state, const Series& series,
                                           std::int64_t begin, std::int64_t length, const Reach& reach) {
  if (begin < reach.features() || begin + length + reach.features() > series.frames) return std::nullopt;
  Eigen::MatrixXd out(series.axes, kFeatures);
  for (int j = 0; j < kFeatures / 2; ++j) {
    const std::int64_t at[2] = {begin - 1 - j * reach.step, begin + length + j * reach.step};
    for (int side = 0; side < 2; ++side)
      for (int axis = 0; axis < series.axes; ++axis)
        out(axis, 2 * j + side) = state[static_cast<std::size_t>((at[side] * series.axes + axis) * 4 + 2)];
  }
  if (!out.allFinite()) return std::nullopt;
  return out;
}

/// One hidden stretch: what the smoother misses there and what it sees around.
struct Hidden {
  std::size_t part = 0;
  std::int64_t begin = 0;
  Eigen::MatrixXd features, missed;  ///< axes x kFeatures; axes x 4 frames
  Eigen::MatrixXd gram, cross;
};

class Learner {
 public:
  Learner(std::span<const Series> parts, int order, double cutoff_hz, const Reach& reach)
      : parts_(parts), order_(order), cutoff_hz_(cutoff_hz), reach_(reach) {}

  /// Hides stretches of this pattern; false where there are too few to learn from.
  bool learn(const Pattern& missing) {
    missing_ = &missing;
    length_ = std::ssize(missing);
    derivatives_ = std::min(order_, 4);
    hidden_.clear();
    const std::int64_t spacing = length_ + 2 * reach_.features();
    for (int pass = 0; pass < kPasses && hidden_.size() < kMostHidden; ++pass)
      for (std::size_t p = 0; p < parts_.size() && hidden_.size() < kMostHidden; ++p)
        hide(p, (pass * 5 % kPasses) * spacing / kPasses, spacing);
    if (hidden_.size() < kFewestHidden) return false;
    total_gram_ = Eigen::MatrixXd::Zero(kFeatures, kFeatures);
    total_cross_ = Eigen::MatrixXd::Zero(kFeatures, hidden_[0].missed.cols());
    for (Hidden& h : hidden_) {
      h.gram = h.features.transpose() * h.features;
      h.cross = h.features.transpose() * h.missed;
      total_gram_ += h.gram;
      total_cross_ += h.cross;
    }
    return choose();
  }

  /// Changes the smoothed values of a gap, and the factors on what it adds to variances.
  bool apply(const Series& series, std::int64_t begin, const std::vector<double>& before,
             std::vector<double>& state, std::vector<double>& left) const {
    const auto features = features_at(before, series, begin, length_, reach_);
    if (!features) return false;
    const Eigen::LDLT<Eigen::MatrixXd> solver = ridge_solver(total_gram_, ridge_);
    const Eigen::MatrixXd change = *features * solver.solve(total_cross_);
    const double leverage =
        (*features * solver.solve(features->transpose())).trace() / static_cast<double>(series.axes);
    const std::int64_t first = begin - reach_.samples;
    for (std::int64_t k = 0; k < length_ + 2 * reach_.samples; ++k)
      for (int d = 0; d < derivatives_; ++d) {
        for (int axis = 0; axis < series.axes; ++axis)
          state[static_cast<std::size_t>(((first + k) * series.axes + axis) * 4 + d)] +=
              change(axis, 4 * k + d);
        left[static_cast<std::size_t>(4 * (first + k) + d)] =
            left_[static_cast<std::size_t>(d)] * (1.0 + leverage);
      }
    return true;
  }

  [[nodiscard]] std::size_t hidden() const { return hidden_.size(); }
  [[nodiscard]] double velocity_left() const { return std::sqrt(left_[1]); }

 private:
  [[nodiscard]] static Eigen::LDLT<Eigen::MatrixXd> ridge_solver(Eigen::MatrixXd gram, double ridge) {
    gram.diagonal().array() += ridge * gram.trace() / kFeatures + std::numeric_limits<double>::min();
    return gram.ldlt();
  }

  void hide(std::size_t p, std::int64_t offset, std::int64_t spacing) {
    const Series& part = parts_[p];
    const std::int64_t around = reach_.features();
    std::vector<std::uint8_t> seen(part.seen, part.seen + part.frames);
    std::vector<std::int64_t> begins;
    for (std::int64_t at = around + offset; at + length_ + around <= part.frames; at += spacing) {
      const auto absent = std::count(part.seen + at - around, part.seen + at + length_ + around, 0);
      const auto inside =
          std::count(part.seen + at - reach_.samples, part.seen + at + length_ + reach_.samples, 0);
      if (inside > length_ / 8 ||
          static_cast<double>(absent) > kMostMissing * static_cast<double>(length_ + 2 * around))
        continue;
      for (std::int64_t k = 0; k < length_; ++k)
        if ((*missing_)[static_cast<std::size_t>(k)] != 0) seen[static_cast<std::size_t>(at + k)] = 0;
      begins.push_back(at);
    }
    if (begins.empty()) return;
    if (full_.size() <= p) full_.resize(parts_.size());
    if (full_[p].empty()) full_[p] = run_filter(part, order_, cutoff_hz_);
    Series with_holes = part;
    with_holes.seen = seen.data();
    const std::vector<double> blind = run_filter(with_holes, order_, cutoff_hz_);
    for (const std::int64_t at : begins) {
      const auto features = features_at(blind, part, at, length_, reach_);
      if (!features) continue;
      const std::int64_t frames = length_ + 2 * reach_.samples;
      Eigen::MatrixXd missed = Eigen::MatrixXd::Zero(part.axes, 4 * frames);
      for (std::int64_t k = 0; k < frames; ++k)
        for (int axis = 0; axis < part.axes; ++axis)
          for (int d = 0; d < derivatives_; ++d) {
            const auto i = static_cast<std::size_t>(((at - reach_.samples + k) * part.axes + axis) * 4 + d);
            missed(axis, 4 * k + d) = full_[p][i] - blind[i];
          }
      if (missed.allFinite() && hidden_.size() < kMostHidden)
        hidden_.push_back({p, at, *features, std::move(missed), {}, {}});
    }
  }

  /// Squared errors of hidden stretches by derivative, each predicted from those that do not overlap it, over
  /// those without correction.
  [[nodiscard]] std::array<double, 4> left_out(double ridge) const {
    std::array<double, 4> with{}, without{};
    for (const Hidden& test : hidden_) {
      Eigen::MatrixXd gram = total_gram_, cross = total_cross_;
      for (const Hidden& other : hidden_) {
        if (other.part != test.part || std::abs(other.begin - test.begin) > length_ + 2 * reach_.samples)
          continue;
        gram -= other.gram;
        cross -= other.cross;
      }
      const Eigen::MatrixXd error =
          test.missed - test.features * ridge_solver(std::move(gram), ridge).solve(cross);
      for (Eigen::Index i = 0; i < error.cols(); ++i) {
        with[static_cast<std::size_t>(i % 4)] += error.col(i).squaredNorm();
        without[static_cast<std::size_t>(i % 4)] += test.missed.col(i).squaredNorm();
      }
    }
    std::array<double, 4> out{1.0, 1.0, 1.0, 1.0};
    for (std::size_t d = 0; d < 4; ++d)
      if (without[d] > 0.0) out[d] = with[d] / without[d];
    return out;
  }

  bool choose() {
    double least = 2.0 * kEnough;
    bool found = false;
    for (const double ridge : kRidges) {
      const auto left = left_out(ridge);
      if (!(left[0] + left[1] < least)) continue;
      least = left[0] + left[1];
      ridge_ = ridge;
      left_ = left;
      found = true;
    }
    return found;
  }

  std::span<const Series> parts_;
  int order_;
  double cutoff_hz_;
  Reach reach_;
  const Pattern* missing_ = nullptr;
  std::int64_t length_ = 0;
  int derivatives_ = 0;
  std::vector<std::vector<double>> full_;
  std::vector<Hidden> hidden_;
  Eigen::MatrixXd total_gram_, total_cross_;
  double ridge_ = 0.0;
  std::array<double, 4> left_{1.0, 1.0, 1.0, 1.0};
};

}  // namespace

GapCorrection correct_gaps(std::span<const Series> learn_from, const Series& series, int order,
                           double cutoff_hz, std::int64_t longest, std::vector<double>& state) {
  GapCorrection out;
  const Reach reach = reach_of(order, cutoff_hz, series.interval_s);
  const double corner = corner_rad_s(order, cutoff_hz);  // nothing reaches across more than kLongestGap
  longest = std::min(longest, static_cast<std::int64_t>(kLongestGap / (corner * series.interval_s)) - 1);
  std::map<Pattern, std::vector<std::int64_t>> patterns;
  for (Gap& gap : gaps_of(series, reach.samples))
    if (const std::int64_t run = longest_run(gap.missing); run >= kShortest && run <= longest)
      patterns[std::move(gap.missing)].push_back(gap.begin);
  std::vector<const std::pair<const Pattern, std::vector<std::int64_t>>*> longest_first;
  for (const auto& entry : patterns) longest_first.push_back(&entry);
  std::ranges::stable_sort(longest_first, std::ranges::greater{},
                           [](const auto* entry) { return longest_run(entry->first); });
  if (longest_first.size() > kMostPatterns) longest_first.resize(kMostPatterns);

  Learner learner(learn_from, order, cutoff_hz, reach);
  const std::vector<double> before = state;
  for (const auto* entry : longest_first) {
    if (!learner.learn(entry->first)) continue;
    for (const std::int64_t begin : entry->second) {
      if (out.left.empty()) out.left.assign(static_cast<std::size_t>(4 * series.frames), 1.0);
      if (!learner.apply(series, begin, before, state, out.left)) continue;
      out.hidden = out.gaps == 0 ? static_cast<std::int64_t>(learner.hidden())
                                 : std::min(out.hidden, static_cast<std::int64_t>(learner.hidden()));
      out.error_left =
          out.gaps == 0 ? learner.velocity_left() : std::max(out.error_left, learner.velocity_left());
      ++out.gaps;
    }
  }
  if (out.gaps == 0) out.left.clear();
  return out;
}

}  // namespace kinemark::trajectory::smoothing
