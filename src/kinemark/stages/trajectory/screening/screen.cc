// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/screen.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/trajectory/screening/internal/defects.h"
#include "kinemark/stages/trajectory/screening/internal/phase_table.h"

namespace kinemark::trajectory {
namespace internal {

std::string describe_frames(const TimeBase& time, std::int64_t first, std::int64_t last) {
  return first == last ? fmt::format("frame {}", time.number(first))
                       : fmt::format("frames {} to {}", time.number(first), time.number(last));
}

double confidence_of(double ratio, double half) {
  return std::isfinite(ratio) ? std::clamp(ratio / (ratio + half), 0.0, 0.999) : 0.999;
}

double median_of(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });  // of numbers too large to subtract
  return values.empty() ? 0.0 : math::upper_median(values);
}

double rounding_of(const data::Trajectories& t, std::int64_t marker) {
  double step = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> y;
    for (std::int64_t f = 0; f < t.frames() && y.size() < 4096; ++f)
      if (t.present(f, marker)) y.push_back(t.x(f, marker)(axis));
    step = std::max(step, rounding_step_m(y));
  }
  return step;
}

data::Finding as_finding(Defect defect, const data::Trajectories& t) {
  const auto name_of = [&](std::int64_t marker) { return marker < 0 ? std::string() : t.names[at(marker)]; };
  return {.kind = defect.kind,
          .subject = name_of(defect.marker),
          .partner = name_of(defect.other_marker),
          .first_frame = defect.first_frame,
          .last_frame = defect.last_frame,
          .frames = std::move(defect.frames),
          .size = defect.size,
          .confidence = defect.confidence,
          .description = std::move(defect.description)};
}

void reject(const Defect& defect, data::Trajectories& t) {
  if (defect.kind == FindingKind::clock_jump) return;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    const bool partner = defect.kind == FindingKind::label_swap && m == defect.other_marker;
    if (defect.marker != -1 && m != defect.marker && !partner) continue;
    for (const auto f : defect.frames)
      if (t.present(f, m)) t.set_missing(f, m, data::SampleState::rejected);
    if (!defect.frames.empty()) continue;
    for (std::int64_t f = defect.first_frame; f <= defect.last_frame; ++f)
      if (t.present(f, m)) t.set_missing(f, m, data::SampleState::rejected);
  }
}

}  // namespace internal

using internal::FindingKind;

Status ScreenOptions::check() const {
  const auto positive = [](double v) { return v > 0.0 && std::isfinite(v); };
  if (!positive(min_spike_m))
    return fail(Code::usage, fmt::format("the smallest spike is {} m; need a positive number", min_spike_m));
  if (!positive(min_jump_m))
    return fail(Code::usage, fmt::format("the smallest jump is {} m; need a positive number", min_jump_m));
  if (!positive(min_stuck_s))
    return fail(Code::usage,
                fmt::format("the shortest stuck value is {} s; need a positive number", min_stuck_s));
  if (!(min_confidence >= 0.0 && min_confidence <= 1.0))
    return fail(Code::usage, fmt::format("the least confidence is {}; need 0 to 1", min_confidence));
  return {};
}

Result<std::vector<data::Finding>> screen(const data::Trajectories& t, const ScreenOptions& options,
                                          std::span<const double> frame_time_s) {
  if (const Status s = options.check(); !s) return std::unexpected(s.error());
  if (const Status s = t.validate(); !s) return std::unexpected(s.error());
  if (!frame_time_s.empty() && static_cast<std::int64_t>(frame_time_s.size()) != t.frames())
    return fail(Code::bad_input,
                fmt::format("{} frame times were given for {} frames", frame_time_s.size(), t.frames()));
  internal::Defects found;
  data::Trajectories rest = t;
  const auto without = [&](const internal::Defects& defects) {
    rest = t;
    for (const auto& defect : defects) reject(defect, rest);
  };
  if (options.zeros) internal::find_zeros(t, found);
  without(found);
  // Zeros are a thousand times smaller than anything.
  if (options.unit_slips) internal::find_unit_slips(rest, found);
  without(found);  // both leave jumps behind that are no defects of their own
  internal::Defects repeats;
  internal::find_duplicated_frames(rest, repeats);  // found in any case: they are not stuck values
  if (options.stuck) internal::find_stuck(rest, options, repeats);
  if (!options.duplicated_frames)
    std::erase_if(repeats, [](const auto& d) { return d.kind == FindingKind::duplicated_frame; });
  std::ranges::move(repeats, std::back_inserter(found));
  if (options.clock_jumps && !frame_time_s.empty()) internal::find_clock_jumps(t.time, frame_time_s, found);
  if (options.clock_jumps && frame_time_s.empty()) internal::find_leaps(rest, found);
  internal::Defects jumps;
  internal::find_swaps(rest, options, jumps);
  if (options.spikes) internal::find_spikes(rest, options, jumps);
  if (!options.swaps)
    std::erase_if(jumps, [](const auto& d) {
      return d.kind == FindingKind::swap_within || d.kind == FindingKind::label_swap;
    });
  std::ranges::move(jumps, std::back_inserter(found));
  std::erase_if(found, [&](const auto& d) { return d.confidence < options.min_confidence; });
  std::ranges::stable_sort(
      found, {}, [](const auto& d) { return std::tuple(d.marker, d.first_frame, d.kind, d.other_marker); });
  std::vector<data::Finding> out;
  for (auto& defect : found) out.push_back(as_finding(std::move(defect), t));
  return out;
}

Result<data::Trajectories> reject_defects(const data::Trajectories& t, std::span<const data::Finding> defects,
                                          double min_confidence) {
  if (const Status s = t.validate(); !s) return std::unexpected(s.error());
  data::Trajectories out = t;
  for (const data::Finding& f : defects) {
    const internal::Defect defect{.kind = f.kind,
                                  .marker = f.subject.empty() ? -1 : t.find(f.subject),
                                  .other_marker = f.partner.empty() ? -1 : t.find(f.partner),
                                  .first_frame = f.first_frame,
                                  .last_frame = f.last_frame,
                                  .frames = f.frames};
    const bool listed_inside = std::ranges::all_of(
        f.frames, [&](std::int64_t frame) { return frame >= f.first_frame && frame <= f.last_frame; });
    if (!listed_inside || (!f.subject.empty() && defect.marker < 0) ||
        (!f.partner.empty() && defect.other_marker < 0) || f.first_frame < 0 ||
        f.last_frame < f.first_frame || f.last_frame >= t.frames())
      return fail(Code::bad_input,
                  fmt::format("a finding is about marker '{}' and {}; that marker or these frames are not "
                              "among the {} markers and {} frames of the trajectories",
                              f.subject, internal::describe_frames(t.time, f.first_frame, f.last_frame),
                              t.markers(), t.frames()));
    if (!(f.confidence < min_confidence)) reject(defect, out);
  }
  return out;
}

}  // namespace kinemark::trajectory
