// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/resample.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/math/scalar_function.h"

namespace kinemark::pipeline {
namespace {

constexpr double kSameInstant = 1e-3;  // of a frame
constexpr const char* kMethod = "resampled";

/// New frames on the scale of the old ones: frame i of the new lies at `position(i)`.
struct Grid {
  double step = 1.0;  ///< old frames from one new frame to the next
  std::int64_t frames = 0;

  [[nodiscard]] double position(std::int64_t i) const { return static_cast<double>(i) * step; }
  /// The old frame at the same instant, or -1.
  [[nodiscard]] std::int64_t same(std::int64_t i) const {
    const double at = position(i);
    return std::abs(at - std::round(at)) < kSameInstant ? std::llround(at) : -1;
  }
  /// New frames within old frames [first, last].
  [[nodiscard]] std::pair<std::int64_t, std::int64_t> within(std::int64_t first, std::int64_t last) const {
    const auto begin =
        static_cast<std::int64_t>(std::ceil((static_cast<double>(first) - kSameInstant) / step));
    const auto end =
        static_cast<std::int64_t>(std::floor((static_cast<double>(last) + kSameInstant) / step)) + 1;
    return {std::max<std::int64_t>(begin, 0), std::min(end, frames)};
  }
};

/// Runs of frames for which `present` holds and `joined` joins each to the one before: visit(first, last).
void each_run(std::int64_t frames, const std::function<bool(std::int64_t)>& present,
              const std::function<bool(std::int64_t)>& joined,
              const std::function<void(std::int64_t, std::int64_t)>& visit) {
  std::int64_t first = -1;
  for (std::int64_t f = 0; f <= frames; ++f) {
    const bool goes_on = f < frames && present(f) && (first < 0 || joined(f));
    if (first >= 0 && !goes_on) {
      visit(first, f - 1);
      first = -1;
    }
    if (first < 0 && f < frames && present(f)) first = f;
  }
}

/// Values of one component of a run at the new frames in it: write(i, value).
void on_spline(const Grid& grid, std::int64_t first, std::int64_t last,
               const std::function<double(std::int64_t)>& value,
               const std::function<void(std::int64_t, double)>& write) {
  const auto [begin, end] = grid.within(first, last);
  if (begin >= end) return;
  if (first == last) {
    for (auto i = begin; i < end; ++i) write(i, value(first));
    return;
  }
  std::vector<double> x, y;
  for (auto f = first; f <= last; ++f) {
    x.push_back(static_cast<double>(f));
    y.push_back(value(f));
  }
  const auto spline = math::ScalarFunction::simm_spline(std::move(x), std::move(y));
  check(spline.has_value(), "frames increase");
  for (auto i = begin; i < end; ++i) {
    const auto same = grid.same(i);
    write(i, same >= 0 ? value(same) : (*spline)(grid.position(i)).f);
  }
}

data::Trajectories resampled(const data::Trajectories& old, const Grid& grid, double rate_hz) {
  auto out = data::Trajectories::all_missing(
      old.names, {.rate_hz = rate_hz, .t0_s = old.time.t0_s, .frames = grid.frames});
  if (!old.covariance.empty())
    out.covariance.assign(6 * out.state.size(), std::numeric_limits<double>::quiet_NaN());
  // Samples from before a filter cannot be interpolated: they stay at the instants that stay.
  out.filters = old.filters;
  if (!old.unfiltered_in_world.empty())
    out.unfiltered_in_world.assign(out.x_in_world.size(), std::numeric_limits<double>::quiet_NaN());
  const auto always = [](std::int64_t) { return true; };
  for (std::int64_t m = 0; m < old.markers(); ++m) {
    const auto fill_run = [&](std::int64_t first, std::int64_t last) {
      for (int axis = 0; axis < 3; ++axis)
        on_spline(
            grid, first, last, [&](std::int64_t f) { return old.x(f, m)[axis]; },
            [&](std::int64_t i, double value) { out.x(i, m)[axis] = value; });
      const auto [begin, end] = grid.within(first, last);
      for (auto i = begin; i < end; ++i) {
        const std::size_t j = out.index(i, m);
        const auto same = grid.same(i);
        out.state[j] = same >= 0 ? old.state[old.index(same, m)] : data::SampleState::interpolated;
        if (same >= 0 && !old.unfiltered_in_world.empty())
          std::copy_n(old.unfiltered_in_world.data() + 3 * old.index(same, m), 3,
                      out.unfiltered_in_world.data() + 3 * j);
        if (same < 0)
          out.set_method(i, m, kMethod);
        else if (const auto method = old.made_by(same, m); !method.empty())
          out.set_method(i, m, method);
        if (old.covariance.empty()) continue;
        const auto before = same >= 0 ? same : static_cast<std::int64_t>(std::floor(grid.position(i)));
        const double share = same >= 0 ? 0.0 : grid.position(i) - static_cast<double>(before);
        const auto after = std::min(before + 1, last);
        for (std::size_t k = 0; k < 6; ++k)
          out.covariance[6 * j + k] =
              (1.0 - share) * old.covariance[6 * old.index(before, m) + k] +
              (share > 0.0 ? share * old.covariance[6 * old.index(after, m) + k] : 0.0);
      }
    };
    each_run(old.frames(), [&](std::int64_t f) { return old.present(f, m); }, always, fill_run);
    for (std::int64_t i = 0; i < grid.frames; ++i)
      if (const auto same = grid.same(i); same >= 0 && !old.present(same, m))
        out.state[out.index(i, m)] = old.state[old.index(same, m)];  // rejected stays rejected
  }
  return out;
}

data::Channels resampled(const data::Channels& old, const Grid& grid, double rate_hz) {
  data::Channels out{
      .names = old.names, .kinds = old.kinds, .units = old.units, .rate_hz = rate_hz, .frames = grid.frames};
  out.values.assign(at(3 * grid.frames * old.count()), std::numeric_limits<double>::quiet_NaN());
  for (std::int64_t c = 0; c < 3 * old.count(); ++c) {
    const auto value = [&](std::int64_t f) { return old.values[at(f * 3 * old.count() + c)]; };
    const bool wraps = old.kinds[at(c / 3)] == data::ChannelKind::angle;
    each_run(
        old.frames, [&](std::int64_t f) { return std::isfinite(value(f)); },
        [&](std::int64_t f) { return !wraps || std::abs(value(f) - value(f - 1)) <= 180.0; },
        [&](std::int64_t first, std::int64_t last) {
          on_spline(grid, first, last, value,
                    [&](std::int64_t i, double v) { out.values[at(i * 3 * old.count() + c)] = v; });
        });
  }
  return out;
}

/// What is known of samples and cannot be interpolated, at the instants that stay.
template <class T>
Array<T> at_same(const Array<T>& old, const Grid& grid, std::int64_t markers, T none) {
  if (old.empty()) return {};
  Array<T> out(at(grid.frames * markers), none);
  for (std::int64_t i = 0; i < grid.frames; ++i)
    if (const auto same = grid.same(i); same >= 0)
      for (std::int64_t m = 0; m < markers; ++m) out[at(i * markers + m)] = old[at(same * markers + m)];
  return out;
}

/// Analog samples in a frame at a rate; 0: no whole number.
std::int64_t samples_in_frame(const data::AnalogChannels& analog, double rate_hz) {
  const double per = analog.rate_hz / rate_hz;
  return std::abs(per - std::round(per)) < 1e-6 ? std::llround(per) : 0;
}

void fit_analog(data::Trial& trial, double rate_hz, std::int64_t frames) {
  if (trial.analog.names.empty()) return;
  if (const auto per = samples_in_frame(trial.analog, rate_hz); per > 0) {
    trial.analog.samples = per * frames;
    trial.analog.values.resize(at(trial.analog.samples * std::ssize(trial.analog.names)));
    return;
  }
  trial.warnings.push_back(
      fmt::format("{} at {:g} Hz and {} left out: no whole number of samples fits a frame at {:g} Hz",
                  counted(std::ssize(trial.analog.names), "analog channel"), trial.analog.rate_hz,
                  counted(std::ssize(trial.force_plates), "force plate"), rate_hz));
  trial.analog = {};
  trial.force_plates.clear();
}

}  // namespace

Status resample(data::Trial& trial, double rate_hz) {
  const auto& time = trial.markers.time;
  if (!std::isfinite(rate_hz) || rate_hz < 1e-3 * time.rate_hz || rate_hz > 1e6 * time.rate_hz)
    return fail(Code::usage,
                fmt::format("--resample: {:g} is no rate for a recording at {:g} Hz; need Hz, from a "
                            "thousandth to a million times that",
                            rate_hz, time.rate_hz));
  if (!trial.markers.sample_offset_s.empty())
    return fail(Code::bad_input,
                "samples have times of their own within their frame; these cannot be resampled");
  Grid grid{.step = time.rate_hz / rate_hz};
  const double frames = std::floor((static_cast<double>(time.frames - 1) + kSameInstant) / grid.step) + 1.0;
  if (frames * static_cast<double>(trial.markers.markers() + trial.channels.count()) > 0x1p31)
    return fail(Code::bad_input,
                fmt::format("{:.3g} frames at {:g} Hz; need fewer than 2^31 samples", frames, rate_hz));
  grid.frames = static_cast<std::int64_t>(frames);
  if (const auto per = trial.analog.names.empty() ? 0 : samples_in_frame(trial.analog, rate_hz);
      per > 0 && trial.analog.samples / per < grid.frames) {
    const auto whole = std::max<std::int64_t>(trial.analog.samples / per, 1), left_out = grid.frames - whole;
    grid.frames = whole;
    if (left_out == 1)
      trial.warnings.emplace_back("the last frame is left out: its analog samples are not all there");
    else if (left_out > 1)
      trial.warnings.push_back(
          fmt::format("the last {} frames are left out: their analog samples are not all there", left_out));
  }
  const bool slower = rate_hz < time.rate_hz * (1.0 - 1e-9);
  const auto M = trial.markers.markers();
  trial.residual_m = at_same(trial.residual_m, grid, M, std::numeric_limits<float>::quiet_NaN());
  trial.camera_mask = at_same(trial.camera_mask, grid, M, std::uint8_t{0});
  if (trial.channels.count() > 0) trial.channels = resampled(trial.channels, grid, rate_hz);
  fit_analog(trial, rate_hz, grid.frames);
  trial.markers = resampled(trial.markers, grid, rate_hz);
  trial.first_frame = std::llround(trial.markers.time.t0_s * rate_hz) + 1;
  trial.markers.time.first_number = trial.first_frame;
  if (slower)
    trial.warnings.push_back(fmt::format(
        "resampled without a filter: what moves faster than {:g} Hz is folded below it; 'clean' filters",
        rate_hz / 2));
  return {};
}

}  // namespace kinemark::pipeline
