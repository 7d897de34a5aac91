// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/internal/samples.h"

#include <algorithm>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"

namespace kinemark::trajectory::internal {
namespace {

using data::SampleState;

/// visit(array, numbers per sample, number of a sample that is not there), for arrays that hold something.
template <class Visit>
void for_each_array(data::Trial& trial, const Visit& visit) {
  const auto visit_some = [&](auto& array, std::int64_t n, auto blank) {
    if (!array.empty()) visit(array, n, blank);
  };
  auto& m = trial.markers;
  visit_some(m.x_in_world, 3, kNaN);
  visit_some(m.state, 1, SampleState::missing);
  visit_some(m.covariance, 6, kNaN);
  visit_some(m.unfiltered_in_world, 3, kNaN);
  visit_some(m.method, 1, std::uint8_t{0});
  visit_some(trial.residual_m, 1, static_cast<float>(kNaN));
  visit_some(trial.camera_mask, 1, std::uint8_t{0});
}

bool one_time_per_marker(const data::Trajectories& m) {
  return !m.sample_offset_s.empty() && m.frames() != 1 && std::ssize(m.sample_offset_s) == m.markers();
}

/// One time per marker becomes one per sample.
void spread_times(data::Trajectories& m) {
  if (!one_time_per_marker(m)) return;
  const auto row = m.sample_offset_s;
  m.sample_offset_s.clear();
  m.sample_offset_s.reserve(m.state.size());
  for (std::int64_t f = 0; f < m.frames(); ++f)
    m.sample_offset_s.insert(m.sample_offset_s.end(), row.begin(), row.end());
}

/// `values` of F x M x n with a column more behind the others.
template <class T>
void widen(Array<T>& values, std::int64_t columns, std::int64_t n, T blank) {
  Array<T> wide;
  wide.reserve(values.size() / at(columns) * at(columns + 1));
  for (std::int64_t row = 0; row < std::ssize(values); row += columns * n) {
    wide.insert(wide.end(), values.begin() + row, values.begin() + row + columns * n);
    wide.insert(wide.end(), at(n), blank);
  }
  values = std::move(wide);
}

}  // namespace

void swap_samples(data::Trial& trial, std::int64_t a, std::int64_t b, const FrameSpan& frames) {
  auto& markers = trial.markers;
  spread_times(markers);  // gather_times() takes them together again where they can be
  const auto exchange = [&](auto& array, std::int64_t n, auto /*blank*/) {
    for (std::int64_t f = frames.first; f < frames.first + frames.count; ++f) {
      const auto i = array.begin() + n * static_cast<std::int64_t>(markers.index(f, a));
      const auto j = array.begin() + n * static_cast<std::int64_t>(markers.index(f, b));
      std::swap_ranges(i, i + n, j);
    }
  };
  for_each_array(trial, exchange);
  if (!markers.sample_offset_s.empty()) exchange(markers.sample_offset_s, 1, 0.0);
  if (!markers.filters.empty() && frames.count == markers.frames() && markers.frames() > 1)
    std::iter_swap(markers.filters.begin() + a, markers.filters.begin() + b);
}

void move_samples(data::Trial& trial, std::int64_t from, std::int64_t to, const FrameSpan& frames) {
  for (std::int64_t f = frames.first; f < frames.first + frames.count; ++f) {
    if (!trial.markers.present(f, from)) continue;
    swap_samples(trial, from, to, {.first = f, .count = 1});
    blank_sample(trial, f, from, SampleState::missing);
  }
}

void blank_sample(data::Trial& trial, std::int64_t frame, std::int64_t marker, SampleState why) {
  const auto i = static_cast<std::int64_t>(trial.markers.index(frame, marker));
  for_each_array(
      trial, [&](auto& array, std::int64_t n, auto blank) { std::fill_n(array.begin() + n * i, n, blank); });
  trial.markers.state[at(i)] = why;
}

void forget_cameras(data::Trial& trial, std::int64_t frame, std::int64_t marker) {
  const auto i = trial.markers.index(frame, marker);
  if (!trial.residual_m.empty()) trial.residual_m[i] = static_cast<float>(kNaN);
  if (!trial.camera_mask.empty()) trial.camera_mask[i] = 0;
}

void add_marker(data::Trial& trial, const std::string& name, std::int64_t like) {
  auto& markers = trial.markers;
  const auto M = markers.markers();
  const bool per_marker = one_time_per_marker(markers) || (markers.frames() == 1);
  for_each_array(trial, [&](auto& array, std::int64_t n, auto blank) { widen(array, M, n, blank); });
  auto& times = markers.sample_offset_s;
  if (!times.empty() && per_marker) {
    times.push_back(times[at(like)]);
  } else if (!times.empty()) {
    widen(times, M, 1, 0.0);
    for (std::int64_t f = 0; f < markers.frames(); ++f)
      times[at(f * (M + 1) + M)] = times[at(f * (M + 1) + like)];
  }
  markers.names.push_back(name);
  // What is moved here went through the filter of the marker that it comes from.
  if (!markers.filters.empty()) {
    const data::FilterUsed filter = markers.filters[at(like)];
    markers.filters.push_back(filter);
  }
}

void gather_times(data::Trajectories& m) {
  auto& times = m.sample_offset_s;
  const auto M = m.markers();
  if (times.empty() || one_time_per_marker(m) || m.frames() < 2) return;
  for (auto row = times.begin() + M; row != times.end(); row += M)
    if (!std::equal(times.begin(), times.begin() + M, row)) return;
  times.resize(at(M));
}

}  // namespace kinemark::trajectory::internal
