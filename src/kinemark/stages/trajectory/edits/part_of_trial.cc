// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/part_of_trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"

namespace kinemark::trajectory {
namespace {

/// `values` of frames x columns x n, on some frames and of some columns.
template <class T>
Array<T> part_of(const Array<T>& values, std::int64_t columns, const FrameSpan& frames,
                 std::span<const std::int64_t> kept, std::int64_t n = 1) {
  if (values.empty()) return {};
  Array<T> part;
  part.reserve(at(frames.count * std::ssize(kept) * n));
  for (std::int64_t f = frames.first; f < frames.first + frames.count; ++f)
    for (const auto c : kept)
      for (std::int64_t i = 0; i < n; ++i) part.push_back(values[at((f * columns + c) * n + i)]);
  return part;
}

template <class T>
std::vector<T> part_of(const std::vector<T>& values, std::span<const std::int64_t> kept) {
  std::vector<T> part;
  for (const auto i : kept) part.push_back(values[at(i)]);
  return part;
}

data::Trajectories markers_of(const data::Trajectories& all, const FrameSpan& frames,
                              std::span<const std::int64_t> kept) {
  const auto M = all.markers();
  data::Trajectories part;
  part.names = part_of(all.names, kept);
  part.time = {.rate_hz = all.time.rate_hz,
               .t0_s = frames.first == 0 ? all.time.t0_s : all.time.time_s(frames.first),
               .frames = frames.count};
  part.x_in_world = part_of(all.x_in_world, M, frames, kept, 3);
  part.state = part_of(all.state, M, frames, kept);
  part.covariance = part_of(all.covariance, M, frames, kept, 6);
  part.methods = all.methods;
  part.method = part_of(all.method, M, frames, kept);
  part.unfiltered_in_world = part_of(all.unfiltered_in_world, M, frames, kept, 3);
  if (!all.filters.empty()) part.filters = part_of(all.filters, kept);
  const bool same_in_every_frame = std::ssize(all.sample_offset_s) == M;
  part.sample_offset_s =
      part_of(all.sample_offset_s, M, same_in_every_frame ? FrameSpan{.first = 0, .count = 1} : frames, kept);
  return part;
}

data::Channels channels_of(const data::Channels& all, const FrameSpan& frames,
                           std::span<const std::int64_t> kept) {
  if (kept.empty()) return {};
  return {.names = part_of(all.names, kept),
          .kinds = part_of(all.kinds, kept),
          .units = part_of(all.units, kept),
          .rate_hz = all.rate_hz,
          .frames = frames.count,
          .values = part_of(all.values, all.count(), frames, kept, 3)};
}

/// Analog samples from the first chosen frame to the end of the last.
void crop_analog(data::AnalogChannels& analog, double rate_hz, const FrameSpan& frames) {
  const double per_frame = analog.rate_hz / rate_hz;
  const auto sample_of = [&](std::int64_t frame) {
    return std::clamp<std::int64_t>(std::llround(static_cast<double>(frame) * per_frame), 0, analog.samples);
  };
  const auto first = sample_of(frames.first), end = sample_of(frames.first + frames.count);
  const auto channels = std::ssize(analog.names);
  analog.values.erase(analog.values.begin() + end * channels, analog.values.end());
  analog.values.erase(analog.values.begin(), analog.values.begin() + first * channels);
  analog.samples = end - first;
}

std::vector<std::int64_t> all_of(std::int64_t count) {
  std::vector<std::int64_t> indices(at(count));
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

void crop_events(data::Trial& trial, const data::Trajectories& part) {
  const double half = 0.5 / part.time.rate_hz;
  const double first = part.time.t0_s - half, last = part.time.time_s(part.frames() - 1) + half;
  const auto outside =
      std::erase_if(trial.events, [&](const data::Event& e) { return e.time_s < first || e.time_s > last; });
  if (outside > 0)
    trial.warnings.push_back(fmt::format("{} outside the chosen frames {} left out",
                                         outside == 1 ? "1 event" : fmt::format("{} events", outside),
                                         outside == 1 ? "was" : "were"));
}

}  // namespace

void keep_part(data::Trial& trial, const FrameSpan& frames, std::span<const std::int64_t> markers,
               std::span<const std::int64_t> channels) {
  const auto M = trial.markers.markers();
  auto part = markers_of(trial.markers, frames, markers);
  trial.channels = channels_of(trial.channels, frames, channels);
  trial.residual_m = part_of(trial.residual_m, M, frames, markers);
  trial.camera_mask = part_of(trial.camera_mask, M, frames, markers);
  if (frames.count < trial.markers.frames()) {
    crop_analog(trial.analog, part.time.rate_hz, frames);
    crop_events(trial, part);
    trial.first_frame += frames.first;
  }
  const bool had_baseline = data::unloaded_frames(trial).has_value();
  trial.markers = std::move(part);
  if (had_baseline && !trial.force_plates.empty() && !data::unloaded_frames(trial))
    trial.warnings.emplace_back(
        "the frames in which nobody loads the force plates are not among the chosen ones: a file of these "
        "has "
        "no baseline to subtract");
  trial.markers.time.first_number = trial.first_frame;
}

void keep_frames(data::Trial& trial, const FrameSpan& frames) {
  keep_part(trial, frames, all_of(trial.markers.markers()), all_of(trial.channels.count()));
}

void keep_markers(data::Trial& trial, std::span<const std::int64_t> markers) {
  keep_part(trial, {.first = 0, .count = trial.markers.frames()}, markers, all_of(trial.channels.count()));
}

}  // namespace kinemark::trajectory
