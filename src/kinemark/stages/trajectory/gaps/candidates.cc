// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/candidates.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/stages/trajectory/gaps/internal/filler.h"

namespace kinemark::trajectory {

Result<GapCandidates> compare_candidates(const data::Trajectories& in, std::int64_t marker,
                                         std::int64_t first_frame, std::int64_t last_frame,
                                         const GapOptions& options) {
  if (const Status s = options.check(); !s) return std::unexpected(s.error());
  if (const Status s = in.validate(); !s) return std::unexpected(s.error());
  if (marker < 0 || marker >= in.markers() || first_frame < 0 || last_frame < first_frame ||
      last_frame >= in.frames())
    return fail(Code::usage,
                fmt::format("frames {} to {} of marker {} were asked for; there are {} frames and {} markers",
                            first_frame, last_frame, marker, in.frames(), in.markers()));
  for (std::int64_t f = first_frame; f <= last_frame; ++f)
    if (in.present(f, marker))
      return fail(Code::usage, fmt::format("frame {} of marker '{}' is not missing", f,
                                           in.names[static_cast<std::size_t>(marker)]));
  GapOptions all = options;
  all.method = GapMethod::automatic;
  const internal::Filler filler(in, all);
  internal::Filled filled = filler.fill(filler.span(marker, first_frame, last_frame + 1),
                                        internal::find_rigid_neighbours(filler.recording(), marker));
  if (filled.fills.empty())
    return fail(Code::usage,
                fmt::format("marker '{}' frames {} to {}: there is nothing to predict from",
                            in.names[static_cast<std::size_t>(marker)], first_frame, last_frame));
  GapCandidates out;
  for (std::size_t k = 0; k < filled.fills.size(); ++k)
    out.candidates.push_back({.name = std::string(to_string(filled.fills[k].kind)),
                              .x_in_world = std::move(filled.fills[k].gap),
                              .rms_m = filled.fills[k].rms_m(),
                              .weight = filled.combination.weights[k],
                              .guarded = filled.combination.guarded[k]});
  out.x_in_world = std::move(filled.combination.gap);
  out.sd_m = std::move(filled.combination.sd_m);
  out.windows = static_cast<int>(filled.problem.windows());
  out.window_frames = filled.problem.window.length;
  out.predictors.assign(filled.problem.predictors.begin(), filled.problem.predictors.end());
  out.dropped.assign(filled.problem.dropped.begin(), filled.problem.dropped.end());
  return out;
}

}  // namespace kinemark::trajectory
