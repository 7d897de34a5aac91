// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/iwp_smoother.h"

#include <algorithm>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr std::int64_t kBlock = 4096;  ///< frames whose filtered states are kept at a time

template <int m>
struct Checkpoint {
  Gains<m> gains;
  std::array<double, 3 * m> z{};  ///< predicted states of the axes
};

/// Filter and smoother of one stretch, block by block: forwards once, keeping a checkpoint for each block,
/// then back from the last block, each filtered a second time.
template <int m>
class Run {
 public:
  Run(const Series& series, double corner, const SmoothedOut& out)
      : series_(series), corner_(corner), model_(corner * series.interval_s), out_(out) {
    unit_[0] = 1.0;
    for (int i = 1; i < 4; ++i) unit_[i] = unit_[i - 1] * corner;
  }

  /// Smooth frames [begin, end); both the first and the last are seen.
  void stretch(std::int64_t begin, std::int64_t end, Scores& scores) {
    checkpoints_.clear();
    Checkpoint<m> now;
    for (int axis = 0; axis < series_.axes; ++axis) now.z[axis * m] = series_.y[begin * series_.axes + axis];
    for (std::int64_t at = begin; at < end; at += kBlock) {
      checkpoints_.push_back(now);
      if (at + kBlock < end) forward<false>(at, at + kBlock, end, now);
    }
    for (std::int64_t block = std::ssize(checkpoints_) - 1; block >= 0; --block) {
      const std::int64_t at = begin + block * kBlock;
      Checkpoint<m> start = checkpoints_[static_cast<std::size_t>(block)];
      start.gains.settled_r = 0.0;  // its step is not in this block's table
      forward<true>(at, std::min(end, at + kBlock), end, start);
      backward(at, std::min(end, at + kBlock), end, scores);
    }
  }

 private:
  [[nodiscard]] double variance(std::int64_t k) const {
    if (series_.seen[k] == 0) return 0.0;
    return series_.variance == nullptr ? 1.0 : series_.variance[k];
  }
  [[nodiscard]] double interval(std::int64_t k) const { return corner_ * series_.seconds_between(k, k + 1); }

  template <bool keep>
  void forward(std::int64_t begin, std::int64_t end, std::int64_t last, Checkpoint<m>& now) {
    const int axes = series_.axes;
    if (keep) {
      filtered_.resize(static_cast<std::size_t>((end - begin) * axes * m));
      step_of_.resize(static_cast<std::size_t>(end - begin));
      steps_.clear();
    }
    Step<m> step;
    for (std::int64_t k = begin; k < end; ++k) {
      const double r = variance(k);
      const bool final_one = k + 1 == last;
      const double h = final_one ? 0.0 : interval(k);
      if (final_one) {
        Iwp<m>::measure(r, now.gains.root, now.gains.gain);
        covariance_ = Iwp<m>::covariance(now.gains.root);
      } else if (now.gains.move(model_, r, h, keep ? &step : nullptr) && keep) {
        steps_.push_back(step);
      }
      if (r > 0.0) {
        for (int axis = 0; axis < axes; ++axis) {
          double* z = now.z.data() + axis * m;
          const double innovation = series_.y[k * axes + axis] - z[0];
          for (int i = 0; i < m; ++i) z[i] += now.gains.gain[i] * innovation;
        }
      }
      if (keep) {
        std::copy_n(now.z.data(), axes * m, filtered_.data() + (k - begin) * axes * m);
        step_of_[static_cast<std::size_t>(k - begin)] = static_cast<std::int32_t>(steps_.size()) - 1;
      }
      if (!final_one) Iwp<m>::predict(h, axes, now.z.data());
    }
  }

  void backward(std::int64_t begin, std::int64_t end, std::int64_t last, Scores& scores) {
    const int axes = series_.axes;
    std::int32_t settled_for = -1;
    for (std::int64_t k = end - 1; k >= begin; --k) {
      const double* filtered = filtered_.data() + (k - begin) * axes * m;
      if (k + 1 == last) {
        std::copy_n(filtered, axes * m, smoothed_.data());
      } else {
        const std::int32_t at = step_of_[static_cast<std::size_t>(k - begin)];
        const Step<m>& step = steps_[static_cast<std::size_t>(at)];
        Iwp<m>::back(interval(k), step, axes, filtered, smoothed_.data());
        if (at != settled_for) {
          const Square<m> before = covariance_;
          Iwp<m>::back_covariance(step, covariance_);
          settled_for = Iwp<m>::settled(covariance_, before) ? at : -1;
        }
      }
      if (const double r = variance(k); r > 0.0) {
        for (int axis = 0; axis < axes; ++axis) {
          const double residual = series_.y[k * axes + axis] - smoothed_[axis * m];
          scores.rss += residual * residual / r;
        }
        scores.trace += axes * covariance_[0] / r;
        scores.values += axes;
      }
      write(k);
    }
  }

  void write(std::int64_t k) const {
    if (out_.state == nullptr) return;
    for (int i = 0; i < 4; ++i) {
      double v = i < m ? covariance_[i * m + i] : kNaN;
      if (!(v <= kUndetermined)) v = kNaN;
      out_.variance[k * 4 + i] = v * unit_[i] * unit_[i];
      for (int axis = 0; axis < series_.axes; ++axis)
        out_.state[(k * series_.axes + axis) * 4 + i] =
            std::isnan(v) ? kNaN : smoothed_[axis * m + i] * unit_[i];
    }
    // A sample that is worth next to nothing beside the others, far from them, stands as it is.
    if (const double r = variance(k); r > 0.0 && std::isnan(out_.variance[k * 4])) {
      out_.variance[k * 4] = r;
      for (int axis = 0; axis < series_.axes; ++axis)
        out_.state[(k * series_.axes + axis) * 4] = series_.y[k * series_.axes + axis];
    }
  }

  Series series_;
  double corner_;
  Iwp<m> model_;
  SmoothedOut out_;
  std::array<double, 4> unit_{};
  std::vector<Checkpoint<m>> checkpoints_;
  std::vector<double> filtered_;
  std::vector<std::int32_t> step_of_;
  std::vector<Step<m>> steps_;
  std::array<double, 3 * m> smoothed_{};
  Square<m> covariance_{};
};

template <int m>
Scores smooth_order(const Series& series, double cutoff_hz, const SmoothedOut& out) {
  const double corner = corner_rad_s(m, cutoff_hz);
  Scores scores;
  Run<m> run(series, corner, out);
  if (out.state != nullptr) {
    std::fill_n(out.state, series.frames * series.axes * 4, kNaN);
    std::fill_n(out.variance, series.frames * 4, kNaN);
  }
  std::int64_t begin = -1, latest = -1;
  for (std::int64_t k = 0; k < series.frames; ++k) {
    if (series.seen[k] == 0) continue;
    if (latest >= 0 && corner * series.seconds_between(latest, k) > kLongestGap) {
      run.stretch(begin, latest + 1, scores);
      begin = -1;
    }
    if (begin < 0) begin = k;
    latest = k;
  }
  if (begin >= 0) run.stretch(begin, latest + 1, scores);
  return scores;
}

}  // namespace

Series Series::part(std::int64_t begin, std::int64_t count) const {
  check(begin >= 0 && count >= 0 && begin + count <= frames, "a part lies inside its series");
  Series p = *this;
  p.frames = count;
  p.y += begin * axes;
  p.seen += begin;
  if (variance != nullptr) p.variance += begin;
  if (time_s != nullptr) p.time_s += begin;
  return p;
}

double Series::seconds_between(std::int64_t earlier, std::int64_t later) const {
  return time_s == nullptr ? static_cast<double>(later - earlier) * interval_s
                           : time_s[later] - time_s[earlier];
}

Scores smooth_series(const Series& series, int order, double cutoff_hz, const SmoothedOut& out) {
  check(series.axes >= 1 && series.axes <= 3 && series.interval_s > 0.0 && cutoff_hz > 0.0,
        "a series has 1 to 3 axes, a positive interval and cut-off");
  switch (order) {
    case 2:
      return smooth_order<2>(series, cutoff_hz, out);
    case 3:
      return smooth_order<3>(series, cutoff_hz, out);
    case 4:
      return smooth_order<4>(series, cutoff_hz, out);
    default:
      check(order == 5, "the order of a smoother is 2 to 5");
      return smooth_order<5>(series, cutoff_hz, out);
  }
}

}  // namespace kinemark::trajectory::smoothing
