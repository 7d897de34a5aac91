// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/real_samples.h"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "kinemark/data/filtering.h"

namespace kinemark::trajectory {
namespace {

using data::SampleState;
using data::Trajectories;

/// Made by the recorder, as far as known: no method is recorded for the sample but that it was smoothed
/// since.
bool made_by_recorder(const Trajectories& t, std::int64_t frame, std::int64_t marker,
                      const data::Upsampling& u) {
  const SampleState s = t.state[t.index(frame, marker)];
  const std::string_view by = t.made_by(frame, marker);
  return (s == SampleState::measured || s == SampleState::interpolated) && !u.real(frame) &&
         (by.empty() || by.starts_with(data::smoothed_by("")));
}

Trajectories mark(const Trajectories& t, const data::UpsamplingAccount& report, bool drop) {
  Trajectories out = t;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    const data::Upsampling& u = report.markers[static_cast<std::size_t>(m)];
    if (!u.found()) continue;
    const std::string method = fmt::format("recorder, {} x{}", to_string(u.kernel), u.factor);
    for (std::int64_t f = 0; f < t.frames(); ++f) {
      if (!made_by_recorder(t, f, m, u)) continue;
      if (!out.unfiltered_in_world.empty())  // nobody measured it
        std::fill_n(out.unfiltered_in_world.begin() + static_cast<std::ptrdiff_t>(3 * out.index(f, m)), 3,
                    std::numeric_limits<double>::quiet_NaN());
      if (drop) {
        out.set_missing(f, m);
      } else {
        out.state[out.index(f, m)] = SampleState::upsampled;
        out.set_method(f, m, method);
      }
    }
  }
  return out;
}

/// Everything that belongs to one sample.
void take(const Trajectories& from, std::int64_t frame, std::int64_t marker, std::int64_t low_frame,
          Trajectories& to) {
  const std::size_t a = from.index(frame, marker);
  const std::size_t b = to.index(low_frame, marker);
  to.x(low_frame, marker) = from.x(frame, marker);
  to.state[b] = from.state[a];
  if (!from.covariance.empty())
    std::copy_n(from.covariance.begin() + static_cast<std::ptrdiff_t>(6 * a), 6,
                to.covariance.begin() + static_cast<std::ptrdiff_t>(6 * b));
  if (!from.method.empty()) to.method[b] = from.method[a];
  if (!from.unfiltered_in_world.empty())
    std::copy_n(from.unfiltered_in_world.begin() + static_cast<std::ptrdiff_t>(3 * a), 3,
                to.unfiltered_in_world.begin() + static_cast<std::ptrdiff_t>(3 * b));
}

Trajectories decimate(const Trajectories& t, const data::UpsamplingAccount& report) {
  const std::int64_t factor = report.recording.factor;
  const int phase = report.recording.phase;
  TimeBase low;
  low.rate_hz = t.time.rate_hz / static_cast<double>(factor);
  low.t0_s = t.time.time_s(phase);
  low.frames = (t.frames() + factor - 1) / factor;
  if (low.frames > 0 && (low.frames - 1) * factor + phase >= t.frames()) {
    // The last low frame is cut off before its sample; keep it only if some marker was seen early in it.
    bool seen = false;
    for (std::int64_t f = (low.frames - 1) * factor; f < t.frames(); ++f)
      for (std::int64_t m = 0; m < t.markers(); ++m) {
        const data::Upsampling& u = report.markers[static_cast<std::size_t>(m)];
        seen |= u.found() && u.real(f) && t.present(f, m);
      }
    if (!seen) --low.frames;
  }
  Trajectories out = Trajectories::all_missing(t.names, low);
  out.methods = t.methods;
  if (!t.method.empty()) out.method.assign(out.state.size(), 0);
  if (!t.covariance.empty())
    out.covariance.assign(6 * out.state.size(), std::numeric_limits<double>::quiet_NaN());
  out.filters = t.filters;
  if (!t.unfiltered_in_world.empty())
    out.unfiltered_in_world.assign(3 * out.state.size(), std::numeric_limits<double>::quiet_NaN());
  Array<double> offset(out.state.size(), 0.0);
  bool any_offset = false;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    const data::Upsampling& u = report.markers[static_cast<std::size_t>(m)];
    for (std::int64_t k = 0; k < low.frames; ++k) {
      for (std::int64_t f = k * factor; f < std::min((k + 1) * factor, t.frames()); ++f) {
        if (u.found() ? !u.real(f) : f != k * factor + phase) continue;
        take(t, f, m, k, out);
        const double late = t.time_s(f, m) - out.time.time_s(k);
        const double tick = static_cast<double>(f - k * factor - phase) / t.time.rate_hz;
        // Without sample times of its own the offset is a whole number of frames: no rounding noise.
        offset[out.index(k, m)] = t.sample_offset_s.empty() ? tick : late;
        any_offset |= offset[out.index(k, m)] != 0.0;
        break;
      }
    }
  }
  if (any_offset) out.sample_offset_s = std::move(offset);
  return out;
}

}  // namespace

Result<Trajectories> keep_real_samples(const Trajectories& t, const data::UpsamplingAccount& report,
                                       MadeSamples made) {
  if (const Status s = t.validate(); !s) return std::unexpected(s.error());
  if (report.markers.size() != t.names.size())
    return fail(Code::bad_input,
                fmt::format("the upsampling report is about {} markers; the trajectories have {}",
                            report.markers.size(), t.names.size()));
  if (made != MadeSamples::decimate) return mark(t, report, made == MadeSamples::missing);
  for (std::size_t m = 0; m < report.markers.size(); ++m) {
    const data::Upsampling& u = report.markers[m];
    if (u.found() && u.factor != report.recording.factor)
      return fail(
          Code::not_supported,
          fmt::format(
              "marker '{}' was interpolated {} times, the recording as a whole {} times; one lower rate "
              "does not hold both, mark the samples instead",
              t.names[m], u.factor, report.recording.factor));
  }
  if (!report.recording.found()) return t;
  return decimate(t, report);
}

}  // namespace kinemark::trajectory
