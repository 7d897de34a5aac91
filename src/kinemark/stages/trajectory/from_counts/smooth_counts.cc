// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/smooth_counts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/camera/light.h"
#include "kinemark/camera/usable.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/trajectory/from_counts/hand_on_start.h"
#include "kinemark/stages/trajectory/from_counts/internal/led_path.h"

namespace kinemark::trajectory {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Status check_shapes(const data::Counts& counts, std::span<const data::Rig> rigs,
                    const data::Trajectories& start) {
  if (auto s = counts.validate(); !s) return s;
  if (rigs.size() != 1 && rigs.size() != counts.leds.size())
    return fail(Code::bad_input, fmt::format("{} rigs for {} LEDs; one for all or one each was expected",
                                             rigs.size(), counts.led_count()));
  for (const auto& rig : rigs)
    if (auto s = data::check_same_rig(counts, rig); !s) return s;
  if (start.names != counts.leds || start.frames() != counts.frames())
    return fail(Code::bad_input,
                fmt::format("{} markers in {} frames to start from do not fit {} LEDs in {} frames",
                            start.markers(), start.frames(), counts.led_count(), counts.frames()));
  return {};
}

/// Positions to start from: straight lines over missing ones, the nearest beyond both ends. Empty when none
/// is there.
std::vector<Vector3d> bridge(const data::Trajectories& start, std::int64_t led) {
  std::vector<Vector3d> out(static_cast<std::size_t>(start.frames()));
  std::int64_t before = -1;
  for (std::int64_t f = 0; f < start.frames(); ++f) {
    if (!start.present(f, led)) continue;
    const Vector3d here = start.x(f, led);
    const Vector3d from = before < 0 ? here : Vector3d(start.x(before, led));
    for (std::int64_t g = before + 1; g <= f; ++g)
      out[static_cast<std::size_t>(g)] =
          before < 0
              ? here
              : from + (here - from) * (static_cast<double>(g - before) / static_cast<double>(f - before));
    before = f;
  }
  if (before < 0) return {};
  for (std::int64_t g = before + 1; g < start.frames(); ++g)
    out[static_cast<std::size_t>(g)] = start.x(before, led);
  return out;
}

using Stretch = std::pair<std::int64_t, std::int64_t>;  // first frame, one past the last

/// Runs of frames whose gaps (no camera usable) are short; each begins and ends with a frame that two cameras
/// saw.
std::vector<Stretch> stretches(const data::Counts& counts, const std::vector<std::uint8_t>& usable,
                               std::int64_t led, double longest_gap_s) {
  std::vector<Stretch> out;
  const auto longest = static_cast<std::int64_t>(std::floor(longest_gap_s * counts.time.rate_hz + 1e-9));
  for (std::int64_t f = 0; f < counts.frames(); ++f) {
    int cameras = 0;
    for (std::int64_t c = 0; c < counts.camera_count(); ++c) cameras += usable[counts.index(f, led, c)];
    if (cameras < 2) continue;
    if (out.empty() || f - out.back().second > longest) out.emplace_back(f, f);
    out.back().second = f + 1;
  }
  return out;
}

/// Cosine and sine of the flicker in the dark slot of each camera; 0 where it is not found.
std::vector<Vector2d> dark_flicker(const data::Counts& counts, double hz) {
  std::vector<Vector2d> out;
  for (std::int64_t c = 0; c < counts.camera_count(); ++c) {
    const auto found = camera::dark_slot(counts, c, hz);
    out.push_back(found ? found->flicker : Vector2d::Zero());
  }
  return out;
}

SmoothedCounts all_missing(const data::Counts& counts) {
  SmoothedCounts out;
  out.points = data::Trajectories::all_missing(counts.leds, counts.time);
  out.points.covariance.assign(6 * out.points.state.size(), kNaN);
  for (auto* rates : {&out.derivatives.velocity, &out.derivatives.velocity_sd, &out.derivatives.acceleration,
                      &out.derivatives.acceleration_sd})
    rates->assign(out.points.x_in_world.size(), kNaN);
  out.derivatives.filters.resize(counts.leds.size());
  out.leds.resize(counts.leds.size());
  return out;
}

void put(const internal::LedPath::Sample& s, std::size_t index, SmoothedCounts& out) {
  math::pack_symmetric3(s.covariance, out.points.covariance.data() + 6 * index);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    out.points.x_in_world[3 * index + a] = s.motion.position[axis];
    out.derivatives.velocity[3 * index + a] = s.motion.velocity[axis];
    out.derivatives.velocity_sd[3 * index + a] = s.sd.velocity[axis];
    out.derivatives.acceleration[3 * index + a] = s.motion.acceleration[axis];
    out.derivatives.acceleration_sd[3 * index + a] = s.sd.acceleration[axis];
  }
  out.points.state[index] = s.seen ? data::SampleState::measured : data::SampleState::model_filled;
}

/// Add the statistics of one stretch to those of its LED.
void merge(LedFit& all, const LedFit& one) {
  const auto total = all.observations + one.observations;
  if (total > 0)
    all.chi2_per_dof = (all.chi2_per_dof * static_cast<double>(all.observations) +
                        one.chi2_per_dof * static_cast<double>(one.observations)) /
                       static_cast<double>(total);
  if (one.observations >= all.observations)
    all.bandwidth = one.bandwidth, all.flicker_counts = one.flicker_counts;
  all.name = one.name;
  all.observations = total;
  all.rejected += one.rejected;
  all.held_down += one.held_down;
}

}  // namespace

Status SmoothCountsOptions::check() const {
  if (order != 0 && (order < 3 || order > 5))
    return fail(Code::usage, fmt::format("an order of {}; 3, 4, 5 or 0 was expected", order));
  if (!(half_gain_hz >= 0.0) || !std::isfinite(half_gain_hz))
    return fail(
        Code::usage,
        fmt::format("a half-gain frequency of {} Hz; a positive number or 0 was expected", half_gain_hz));
  if (!(dim_share >= 0.0) || dim_share >= 1.0)
    return fail(Code::usage, fmt::format("a dim share of {}; 0 to below 1 was expected", dim_share));
  if (!(student_freedom > 0.0) || !(reject_chi2 > 0.0) || !(flicker_hz > 0.0) || !(largest_sd_m > 0.0))
    return fail(Code::usage,
                "degrees of freedom, the limits on chi2 and uncertainty, and the flicker's frequency must be "
                "positive");
  if (!(longest_gap_s >= 0.0) || longest_gap_s > 2.0)
    return fail(Code::usage, fmt::format("a longest gap of {} s; 0 to 2 was expected", longest_gap_s));
  if (passes < 3 || passes > 50)
    return fail(Code::usage, fmt::format("{} passes; 3 to 50 were expected", passes));
  return {};
}

Result<SmoothedCounts> smooth_counts(const data::Counts& counts, std::span<const data::Rig> rigs,
                                     const data::Trajectories& start, const SmoothCountsOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = check_shapes(counts, rigs, start); !s) return std::unexpected(s.error());
  const auto usable = camera::usable_views(counts, options.dim_share);
  const auto dark = options.flicker == Flicker::dark_slot ? dark_flicker(counts, options.flicker_hz)
                                                          : std::vector<Vector2d>{};
  SmoothedCounts out = all_missing(counts);
  parallel_for(counts.led_count(), 1, options.threads, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t led = begin; led < end; ++led) {
      LedFit& fit = out.leds[static_cast<std::size_t>(led)];
      fit.name = counts.leds[static_cast<std::size_t>(led)];
      out.derivatives.filters[static_cast<std::size_t>(led)] = {
          .method = "none", .order = 0, .cutoff_hz = kNaN, .noise_sd_m = kNaN};
      const auto from = bridge(start, led);
      if (from.empty()) continue;
      for (const auto& [first, last] : stretches(counts, usable, led, options.longest_gap_s)) {
        const auto& rig = rigs.size() == 1 ? rigs.front() : rigs[static_cast<std::size_t>(led)];
        internal::LedPath path(counts, rig, led, first, last, from, usable, options);
        for (std::size_t c = 0; c < dark.size(); ++c) path.remove_flicker(static_cast<int>(c), dark[c]);
        path.run();
        merge(fit, path.fit());
        for (std::int64_t f = first; f < last; ++f) {
          const auto& sample = path.result()[static_cast<std::size_t>(f - first)];
          if (sample.sd.position.maxCoeff() <= options.largest_sd_m && sample.motion.position.allFinite())
            put(sample, out.points.index(f, led), out);
        }
      }
      if (fit.observations == 0) continue;
      out.derivatives.filters[static_cast<std::size_t>(led)] = {.method = "kalman",
                                                                .order = fit.bandwidth.order,
                                                                .cutoff_hz = fit.bandwidth.cutoff_hz,
                                                                .noise_sd_m = kNaN};
    }
  });
  hand_on_start(start, out.derivatives, out.points);
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    for (std::int64_t led = 0; led < counts.led_count(); ++led)
      if (out.points.state[out.points.index(f, led)] == data::SampleState::model_filled)
        out.points.set_method(f, led, "smoother");
  return out;
}

}  // namespace kinemark::trajectory
