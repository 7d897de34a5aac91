// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/recorder_notes.h"

#include <fmt/core.h>

#include "kinemark/core/number.h"

namespace kinemark::pipeline {

io::RecordingMetadata gap_note(std::int64_t first_frame, std::int64_t by_device, std::int64_t here) {
  return {"gap",
          {{"first_frame", fmt::format("{}", first_frame)},
           {"frames", fmt::format("{}", by_device + here)},
           {"dropped_by_device", fmt::format("{}", by_device)},
           {"dropped_here", fmt::format("{}", here)}}};
}

io::RecordingMetadata end_note(const Recorded& end, const std::string& not_stopped) {
  const auto& p = end.progress;
  io::RecordingMetadata out{"acquisition_end",
                            {{"frames", fmt::format("{}", p.frames)},
                             {"acknowledged", fmt::format("{}", p.acknowledged)},
                             {"dropped_by_device", fmt::format("{}", p.dropped_by_device)},
                             {"dropped_here", fmt::format("{}", p.dropped_here)},
                             {"reopened", fmt::format("{}", p.reopened)},
                             {"fullest_ring", format_number(p.fullest_ring)},
                             {"ended", std::string(to_string(end.end))}}};
  if (!not_stopped.empty()) out.values["not_stopped"] = not_stopped;
  if (!end.clock) return out;
  out.values["clock_rate_hz"] = format_number(end.clock->rate_hz);
  out.values["clock_rate_sd_hz"] = format_number(end.clock->sd_hz);
  out.values["clock_fast_ppm"] = format_number(end.clock->ppm_fast);
  out.values["clock_fast_sd_ppm"] = format_number(end.clock->sd_ppm);
  out.values["clock_seconds"] = format_number(end.clock->span_s);
  return out;
}

}  // namespace kinemark::pipeline
