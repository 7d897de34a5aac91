// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/smooth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/trajectory/smoothing/hand_on.h"
#include "kinemark/stages/trajectory/smoothing/internal/account.h"
#include "kinemark/stages/trajectory/smoothing/internal/kalman.h"
#include "kinemark/stages/trajectory/smoothing/internal/local_bias.h"
#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"
#include "kinemark/stages/trajectory/smoothing/internal/whiteness.h"

namespace kinemark::trajectory {
namespace {

Status run_filter(const smoothing::MarkerSamples& samples, const data::Trajectories& in,
                  const SmoothOptions& options, MarkerResult& result) {
  switch (options.method) {
    case FilterMethod::kalman:
    case FilterMethod::gcv:
      smoothing::smooth_kalman(samples, in, options, result);
      return {};
    case FilterMethod::savgol:
      return smoothing::smooth_savgol(samples, options, in.time.rate_hz, result);
    case FilterMethod::none:
    case FilterMethod::butterworth:
    case FilterMethod::classic:
      return smoothing::smooth_butterworth(samples, options, in.time.rate_hz, result);
  }
  return {};
}

/// What the filter that was used makes of a 1 among zeros, in the middle; empty for none.
std::vector<double> impulse_response(const data::FilterUsed& used, const SmoothOptions& asked,
                                     double rate_hz) {
  if (asked.method == FilterMethod::none || !(used.cutoff_hz > 0.0)) return {};
  constexpr std::int64_t kMiddle = smoothing::kWhitenessFrames;
  SmoothOptions options;
  // The chain of 1986 is a Butterworth filter whose cut-off was named before its second pass.
  options.method = asked.method == FilterMethod::classic ? FilterMethod::butterworth : asked.method;
  options.order = used.order;
  options.cutoff_hz = used.cutoff_hz;
  options.noise_sd_m = 1.0;
  smoothing::MarkerSamples impulse;
  impulse.frames = impulse.measured = 2 * kMiddle + 1;
  impulse.interval_s = 1.0 / rate_hz;
  impulse.x.assign(at(3 * impulse.frames), 0.0);
  impulse.x[at(3 * kMiddle)] = 1.0;
  impulse.present.assign(at(impulse.frames), 1);
  impulse.judged = impulse.present;
  data::Trajectories in;
  in.time.rate_hz = rate_hz;
  MarkerResult result;
  result.state.assign(at(impulse.frames), data::SampleState::measured);
  if (!run_filter(impulse, in, options, result)) return {};
  std::vector<double> response(at(impulse.frames));
  for (std::int64_t f = 0; f < impulse.frames; ++f) response[at(f)] = result.x[at(3 * f)];
  return response;
}

bool is_fill(data::SampleState state) {
  return state == data::SampleState::interpolated || state == data::SampleState::model_filled;
}

/// A fill errs for the whole gap in one way, which no filter averages out: where one says that it knows a
/// filled sample better than who filled it, its standard deviations there grow until it does not.
void keep_fill_errors(const data::Trajectories& in, std::int64_t marker, MarkerResult& result) {
  if (in.covariance.empty() || result.covariance.empty()) return;
  for (std::int64_t f = 0; f < in.frames(); ++f) {
    if (!is_fill(in.state[in.index(f, marker)])) continue;
    const double* fill = in.covariance.data() + 6 * in.index(f, marker);
    double* six = result.covariance.data() + 6 * f;
    std::array<double, 3> factor{1.0, 1.0, 1.0};
    for (int axis = 0; axis < 3; ++axis) {
      const auto d = math::kSymmetric3Diagonal[at(axis)];
      if (six[d] > 0.0 && fill[d] > six[d]) factor[at(axis)] = std::sqrt(fill[d] / six[d]);
    }
    for (int axis = 0; axis < 3; ++axis)
      six[math::kSymmetric3Diagonal[at(axis)]] *= factor[at(axis)] * factor[at(axis)];
    six[1] *= factor[0] * factor[1];
    six[2] *= factor[0] * factor[2];
    six[4] *= factor[1] * factor[2];
    for (Array<double>* sd : {&result.velocity_sd, &result.acceleration_sd, &result.jerk_sd})
      for (int axis = 0; axis < 3 && !sd->empty(); ++axis) (*sd)[at(3 * f + axis)] *= factor[at(axis)];
  }
}

/// Options of a marker that stays as it is.
SmoothOptions as_it_is(const SmoothOptions& options) {
  return {.method = FilterMethod::none, .noise_sd_m = options.noise_sd_m};
}

Result<MarkerResult> smooth_marker(const data::Trajectories& in, const SmoothOptions& options,
                                   std::int64_t marker) {
  const auto samples = smoothing::marker_samples(in, marker);
  if (!samples) return std::unexpected(samples.error());
  MarkerResult result;
  result.marker = marker;
  result.state.resize(static_cast<std::size_t>(in.frames()));
  for (std::int64_t f = 0; f < in.frames(); ++f)
    result.state[static_cast<std::size_t>(f)] = in.state[in.index(f, marker)];
  data::MarkerAccount& account = result.account;
  account.name = in.names[static_cast<std::size_t>(marker)];
  account.used.method = to_string(options.method);
  account.used.cutoff_hz = account.used.noise_sd_m = kNaN;
  account.measured = samples->measured;
  account.bad_variances = samples->bad_variances;
  if (const auto status = run_filter(*samples, in, options, result); !status)
    return std::unexpected(status.error());
  const auto response = impulse_response(account.used, options, in.time.rate_hz);
  smoothing::add_local_bias(*samples, response, result);
  keep_fill_errors(in, marker, result);
  smoothing::judge_residuals(*samples, response, in.time.rate_hz, result);
  return result;
}

/// Copy one marker's numbers, `width` to a frame, into the array of all markers; made on first use.
void copy_marker(const Array<double>& from, Array<double>& to, std::int64_t marker, std::int64_t markers,
                 int width) {
  if (from.empty()) return;
  const std::int64_t frames = std::ssize(from) / width;
  if (to.empty()) to.assign(static_cast<std::size_t>(frames * markers * width), kNaN);
  for (std::int64_t f = 0; f < frames; ++f)
    std::copy_n(from.begin() + f * width, width, to.begin() + (f * markers + marker) * width);
}

}  // namespace

Status smooth_each(const data::Trajectories& in, const SmoothOptions& options,
                   const std::function<Status(MarkerResult&&)>& sink) {
  if (const auto status = in.validate(); !status) return status;
  if (const auto status = options.check(in.time.rate_hz); !status) return status;
  const std::int64_t together = std::max(1, thread_count(options.threads));
  const SmoothOptions untouched = as_it_is(options);
  for (std::int64_t begin = 0; begin < in.markers(); begin += together) {
    const std::int64_t count = std::min(together, in.markers() - begin);
    std::vector<std::optional<Result<MarkerResult>>> done(static_cast<std::size_t>(count));
    parallel_for(count, 1, options.threads, [&](std::int64_t first, std::int64_t last) {
      for (std::int64_t i = first; i < last; ++i) {
        const bool is_left = std::ranges::find(options.leave, begin + i) != options.leave.end();
        done[static_cast<std::size_t>(i)] = smooth_marker(in, is_left ? untouched : options, begin + i);
      }
    });
    for (auto& result : done) {
      if (!*result) return std::unexpected(result->error());
      const std::int64_t marker = (*result)->marker;
      if (const auto status = sink(std::move(**result)); !status) return status;
      result.reset();
      if (options.progress && !options.progress(marker + 1, in.markers()))
        return fail(Code::cancelled, "smoothing was stopped");
    }
  }
  return {};
}

Result<SmoothResult> smooth(const data::Trajectories& in, const SmoothOptions& options) {
  SmoothResult out;
  out.trajectories = in;
  data::Trajectories& t = out.trajectories;
  t.covariance.clear();
  data::Derivatives& d = out.derivatives;
  const std::int64_t markers = in.markers();
  const auto numbers = in.x_in_world.size();
  for (Array<double>* values : {&d.velocity, &d.acceleration, &d.jerk}) values->assign(numbers, kNaN);
  const auto status = smooth_each(in, options, [&](MarkerResult&& one) -> Status {
    copy_marker(one.x, t.x_in_world, one.marker, markers, 3);
    copy_marker(one.covariance, t.covariance, one.marker, markers, 6);
    copy_marker(one.velocity, d.velocity, one.marker, markers, 3);
    copy_marker(one.velocity_sd, d.velocity_sd, one.marker, markers, 3);
    copy_marker(one.acceleration, d.acceleration, one.marker, markers, 3);
    copy_marker(one.acceleration_sd, d.acceleration_sd, one.marker, markers, 3);
    copy_marker(one.jerk, d.jerk, one.marker, markers, 3);
    copy_marker(one.jerk_sd, d.jerk_sd, one.marker, markers, 3);
    for (std::int64_t f = 0; f < in.frames(); ++f) {
      if (one.state[static_cast<std::size_t>(f)] == in.state[in.index(f, one.marker)]) continue;
      t.state[in.index(f, one.marker)] = one.state[static_cast<std::size_t>(f)];
      t.set_method(f, one.marker, one.account.used.method);
    }
    hand_on(in, one.marker, one.account.used, t, one.marker);
    d.filters.push_back(one.account.used);
    out.markers.push_back(std::move(one.account));
    return {};
  });
  if (!status) return std::unexpected(status.error());
  return out;
}

}  // namespace kinemark::trajectory
