// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/online.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"

namespace kinemark::trajectory {

/// The part common to all orders: the delay line of frames and the output arrays.
class OnlineTrajectorySmoother::Core {
 public:
  Core(std::int64_t markers, const OnlineOptions& options)
      : markers_(markers), lag_(options.lag_frames), values_(4), sd_(static_cast<std::size_t>(4 * markers)) {
    for (auto& v : values_) v.resize(static_cast<std::size_t>(3 * markers));
  }
  virtual ~Core() = default;
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  std::optional<OnlineFrame> push(std::span<const double> x) {
    check(std::ssize(x) == 3 * markers_, "a frame has three numbers for each marker");
    for (std::int64_t m = 0; m < markers_; ++m) take(m, x.data() + 3 * m);
    ++pushed_;
    if (pushed_ - given_ <= lag_) return std::nullopt;
    return give();
  }
  std::optional<OnlineFrame> drain() {
    if (given_ == pushed_) return std::nullopt;
    return give();
  }

 protected:
  virtual void take(std::int64_t marker, const double* x) = 0;
  virtual void estimate(std::int64_t marker, std::int64_t frame) = 0;

  [[nodiscard]] std::int64_t capacity() const { return lag_ + 1; }
  [[nodiscard]] std::int64_t pushed() const { return pushed_; }  ///< frames that are complete
  double* value(std::int64_t marker, int derivative) {
    return values_[static_cast<std::size_t>(derivative)].data() + 3 * marker;
  }
  double& sd(std::int64_t marker, int derivative) {
    return sd_[static_cast<std::size_t>(4 * marker + derivative)];
  }

 private:
  OnlineFrame give() {
    for (std::int64_t m = 0; m < markers_; ++m) estimate(m, given_);
    return {given_++, values_[0], values_[1], values_[2], values_[3], sd_};
  }

  std::int64_t markers_, lag_;
  std::int64_t pushed_ = 0, given_ = 0;
  std::vector<std::vector<double>> values_;
  std::vector<double> sd_;
};

namespace {

using smoothing::Gains;
using smoothing::Iwp;
using smoothing::Square;
using smoothing::Step;

template <int m>
class CoreOf final : public OnlineTrajectorySmoother::Core {
 public:
  CoreOf(std::int64_t markers, double rate_hz, const OnlineOptions& options)
      : Core(markers, options),
        options_(options),
        h_(smoothing::corner_rad_s(m, options.cutoff_hz) / rate_hz),
        model_(h_),
        lines_(static_cast<std::size_t>(markers)) {
    double unit = 1.0;
    for (double& u : unit_) {
      u = unit;
      unit *= h_ * rate_hz;
    }
    for (Line& line : lines_) line.slots.resize(static_cast<std::size_t>(capacity()));
  }

 private:
  /// A frame of one marker, filtered.
  struct Slot {
    std::array<double, 3 * m> z{};
    Step<m> step;             ///< to the next frame
    Square<m> covariance;     ///< of z; only where the marker was seen
    std::int64_t piece = -1;  ///< index of the stretch between long gaps; -1: nothing known
    bool seen = false, settled = false;
  };
  struct Line {
    std::vector<Slot> slots;
    Gains<m> gains;
    std::array<double, 3 * m> z{};
    std::int64_t piece = -1, last_seen = -1, last_unsettled = -1;
    bool running = false;
    Square<m> lagged;  ///< smoothed covariance `lagged_steps` before a frame that was seen, all gains settled
    std::int64_t lagged_steps = -1;
  };

  static Slot& slot(Line& line, std::int64_t frame) {
    return line.slots[static_cast<std::size_t>(frame % std::ssize(line.slots))];
  }

  void take(std::int64_t marker, const double* x) override {
    Line& line = lines_[static_cast<std::size_t>(marker)];
    const std::int64_t frame = pushed();
    Slot& now = slot(line, frame);
    now.seen = std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
    if (line.running && static_cast<double>(frame - line.last_seen) * h_ > smoothing::kLongestGap)
      line.running = false;
    if (!line.running && now.seen) {
      line.running = true;
      ++line.piece;
      line.gains = {};
      line.z = {};
      for (int axis = 0; axis < 3; ++axis) line.z[axis * m] = x[axis];
    }
    now.piece = line.running ? line.piece : -1;
    if (!line.running) return;
    if (now.seen) {
      line.last_seen = frame;
      Square<m> root = line.gains.root;
      std::array<double, m> gain;
      Iwp<m>::measure(1.0, root, gain);
      now.covariance = Iwp<m>::covariance(root);
    }
    now.settled = !line.gains.move(model_, now.seen ? 1.0 : 0.0, h_, &now.step);
    if (now.settled)
      now.step = slot(line, frame - 1).step;
    else
      line.last_unsettled = frame;
    if (now.seen) {
      for (int axis = 0; axis < 3; ++axis) {
        const double innovation = x[axis] - line.z[axis * m];
        for (int i = 0; i < m; ++i)
          line.z[axis * m + i] += line.gains.gain[static_cast<std::size_t>(i)] * innovation;
      }
    }
    now.z = line.z;
    Iwp<m>::predict(h_, 3, line.z.data());
  }

  void estimate(std::int64_t marker, std::int64_t frame) override {
    Line& line = lines_[static_cast<std::size_t>(marker)];
    const Slot& out = slot(line, frame);
    for (int d = 0; d < 4; ++d) {
      std::fill_n(value(marker, d), 3, std::numeric_limits<double>::quiet_NaN());
      sd(marker, d) = std::numeric_limits<double>::quiet_NaN();
    }
    if (out.piece < 0 || (!out.seen && !options_.bridge)) return;
    std::int64_t from = pushed() - 1;
    while (from > frame && !(slot(line, from).seen && slot(line, from).piece == out.piece)) --from;
    if (!slot(line, from).seen) return;  // the gap has not ended yet

    std::array<double, 3 * m> z = slot(line, from).z;
    for (std::int64_t k = from - 1; k >= frame; --k)
      Iwp<m>::back(h_, slot(line, k).step, 3, slot(line, k).z.data(), z.data());
    const bool settled = line.last_unsettled < frame;
    Square<m> p;
    if (settled && line.lagged_steps == from - frame) {
      p = line.lagged;
    } else {
      p = slot(line, from).covariance;
      for (std::int64_t k = from - 1; k >= frame; --k) Iwp<m>::back_covariance(slot(line, k).step, p);
      if (settled) {
        line.lagged = p;
        line.lagged_steps = from - frame;
      }
    }
    for (int d = 0; d < std::min(m, 4); ++d) {
      const double variance = p[d * m + d];
      if (!(variance <= smoothing::kUndetermined)) continue;
      for (int axis = 0; axis < 3; ++axis)
        value(marker, d)[axis] = z[axis * m + d] * unit_[static_cast<std::size_t>(d)];
      sd(marker, d) = options_.noise_sd_m * std::sqrt(variance) * unit_[static_cast<std::size_t>(d)];
    }
  }

  OnlineOptions options_;
  double h_;
  Iwp<m> model_;
  std::vector<Line> lines_;
  std::array<double, 4> unit_{};
};

}  // namespace

Status OnlineOptions::check(double rate_hz) const {
  if (order < 2 || order > 5) return fail(Code::usage, fmt::format("order is {}; expected 2 to 5", order));
  if (!(rate_hz > 0.0) || !std::isfinite(rate_hz))
    return fail(Code::usage, fmt::format("rate_hz is {}; expected a positive number", rate_hz));
  if (!(cutoff_hz >= 1e-5 * rate_hz && cutoff_hz < 0.5 * rate_hz))
    return fail(Code::usage,
                fmt::format("cutoff_hz is {}; expected more than 0 and less than half of the rate, {} Hz",
                            cutoff_hz, 0.5 * rate_hz));
  if (!(noise_sd_m > 0.0) || !std::isfinite(noise_sd_m))
    return fail(Code::usage, fmt::format("noise_sd_m is {}; expected a positive number", noise_sd_m));
  if (lag_frames < 0 || lag_frames > 1'000'000)
    return fail(Code::usage, fmt::format("lag_frames is {}; expected 0 to 1000000", lag_frames));
  return {};
}

Result<OnlineTrajectorySmoother> OnlineTrajectorySmoother::create(std::int64_t markers, double rate_hz,
                                                                  const OnlineOptions& options) {
  if (const auto status = options.check(rate_hz); !status) return std::unexpected(status.error());
  if (markers < 0) return fail(Code::usage, fmt::format("markers is {}; expected 0 or more", markers));
  switch (options.order) {
    case 2:
      return OnlineTrajectorySmoother(std::make_unique<CoreOf<2>>(markers, rate_hz, options));
    case 3:
      return OnlineTrajectorySmoother(std::make_unique<CoreOf<3>>(markers, rate_hz, options));
    case 4:
      return OnlineTrajectorySmoother(std::make_unique<CoreOf<4>>(markers, rate_hz, options));
    default:
      return OnlineTrajectorySmoother(std::make_unique<CoreOf<5>>(markers, rate_hz, options));
  }
}

OnlineTrajectorySmoother::OnlineTrajectorySmoother(std::unique_ptr<Core> core) : core_(std::move(core)) {}
OnlineTrajectorySmoother::OnlineTrajectorySmoother(OnlineTrajectorySmoother&&) noexcept = default;
OnlineTrajectorySmoother& OnlineTrajectorySmoother::operator=(OnlineTrajectorySmoother&&) noexcept = default;
OnlineTrajectorySmoother::~OnlineTrajectorySmoother() = default;
std::optional<OnlineFrame> OnlineTrajectorySmoother::push(std::span<const double> x) {
  return core_->push(x);
}
std::optional<OnlineFrame> OnlineTrajectorySmoother::drain() { return core_->drain(); }

}  // namespace kinemark::trajectory
