// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/screen.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kinemark/math/statistics.h"
#include "kinemark/stages/trajectory/screening/internal/defects.h"
#include "kinemark/stages/trajectory/screening/internal/phase_table.h"

namespace kinemark::trajectory {
namespace internal {

std::string frames_in_words(std::int64_t first, std::int64_t last) {
  return first == last ? fmt::format("frame {}", first) : fmt::format("frames {} to {}", first, last);
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

}  // namespace internal

using data::DefectKind;

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

Result<std::vector<data::Defect>> screen(const data::Trajectories& t, const ScreenOptions& options,
                                         std::span<const double> frame_time_s) {
  if (const Status s = options.check(); !s) return std::unexpected(s.error());
  if (const Status s = t.validate(); !s) return std::unexpected(s.error());
  if (!frame_time_s.empty() && static_cast<std::int64_t>(frame_time_s.size()) != t.frames())
    return fail(Code::bad_input,
                fmt::format("{} frame times were given for {} frames", frame_time_s.size(), t.frames()));
  internal::Defects findings;
  if (options.zeros) internal::find_zeros(t, findings);
  if (options.unit_slips) {
    // Zeros are a thousand times smaller than anything.
    const auto seen = reject_defects(t, findings, 0.0);
    internal::find_unit_slips(*seen, findings);
  }
  // Both leave jumps behind that are no defects of their own.
  const data::Trajectories rest = findings.empty() ? t : *reject_defects(t, findings, 0.0);
  internal::Defects repeats;
  internal::find_duplicated_frames(rest, repeats);  // found in any case: they are not stuck values
  if (options.stuck) internal::find_stuck(rest, options, repeats);
  if (!options.duplicated_frames)
    std::erase_if(repeats, [](const data::Defect& f) { return f.kind == DefectKind::duplicated_frame; });
  findings.insert(findings.end(), repeats.begin(), repeats.end());
  if (options.clock_jumps && !frame_time_s.empty()) internal::find_clock_jumps(frame_time_s, findings);
  if (options.clock_jumps && frame_time_s.empty()) internal::find_leaps(rest, findings);
  internal::Defects jumps;
  internal::find_swaps(rest, options, jumps);
  if (options.spikes) internal::find_spikes(rest, options, jumps);
  if (!options.swaps)
    std::erase_if(jumps, [](const data::Defect& f) {
      return f.kind == DefectKind::swap_within || f.kind == DefectKind::label_swap;
    });
  findings.insert(findings.end(), jumps.begin(), jumps.end());
  std::erase_if(findings, [&](const data::Defect& f) { return f.confidence < options.min_confidence; });
  std::ranges::stable_sort(findings, {}, [](const data::Defect& f) {
    return std::tuple(f.marker, f.first_frame, f.kind, f.other_marker);
  });
  return findings;
}

Result<data::Trajectories> reject_defects(const data::Trajectories& t, std::span<const data::Defect> findings,
                                          double min_confidence) {
  if (const Status s = t.validate(); !s) return std::unexpected(s.error());
  data::Trajectories out = t;
  for (const data::Defect& f : findings) {
    if (f.marker < -1 || f.marker >= t.markers() || f.other_marker < -1 || f.other_marker >= t.markers() ||
        f.first_frame < 0 || f.last_frame < f.first_frame || f.last_frame >= t.frames())
      return fail(
          Code::bad_input,
          fmt::format("a finding is about marker {} and {} of the trajectories; they have {} markers and {} "
                      "frames",
                      f.marker, internal::frames_in_words(f.first_frame, f.last_frame), t.markers(),
                      t.frames()));
    if (f.confidence < min_confidence || f.kind == DefectKind::clock_jump) continue;
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      const bool partner = f.kind == DefectKind::label_swap && m == f.other_marker;
      if (f.marker != -1 && m != f.marker && !partner) continue;
      for (std::int64_t n = f.first_frame; n <= f.last_frame; ++n)
        if (out.present(n, m)) out.set_missing(n, m, data::SampleState::rejected);
    }
  }
  return out;
}

}  // namespace kinemark::trajectory
