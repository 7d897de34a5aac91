// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/marker_input.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/files/file_hash.h"

namespace kinemark::pipeline {

Result<MarkerInput> read_marker_input(const MarkerSource& source) {
  const bool tells_none = io::needs_rate(source.path);
  const bool unknown = source.rate == RateRule::or_unknown && tells_none && source.rate_hz == 0.0;
  const double rate_hz = unknown                                                ? 1.0
                         : source.rate == RateRule::where_needed && !tells_none ? 0.0
                                                                                : source.rate_hz;
  auto trial = io::read_markers(source.path, {.rate_hz = rate_hz, .skeleton = source.skeleton});
  if (!trial) return std::unexpected(trial.error());
  MarkerInput input{.trial = std::move(*trial), .file = {}, .rate_known = !unknown};
  const auto& markers = input.trial.markers;
  if (source.needs_samples && (markers.markers() == 0 || markers.frames() == 0))
    return fail(Code::bad_input, fmt::format("{}: holds {} markers and {} frames; need at least one of each",
                                             source.path.string(), markers.markers(), markers.frames()));
  input.file = {.role = "markers", .path = source.path.string(), .bytes = 0, .hash = {}, .hash_kind = {}};
  if (!source.record) return input;
  auto file = record_input("markers", source.path);
  if (!file) return std::unexpected(file.error());
  input.file = std::move(*file);
  return input;
}

data::Trajectories select_markers(const data::Trajectories& recorded, std::span<const std::int64_t> from,
                                  std::vector<std::string> names, std::int64_t first_frame,
                                  const TimeBase& time) {
  check(names.size() == from.size(), "select_markers() needs one name for each marker");
  auto selected = data::Trajectories::all_missing(std::move(names), time);
  if (!recorded.unfiltered_in_world.empty())
    selected.unfiltered_in_world.assign(selected.x_in_world.size(), kNaN);
  if (!recorded.filters.empty())
    for (const std::int64_t m : from) selected.filters.push_back(recorded.filters[at(m)]);
  for (std::int64_t m = 0; m < selected.markers(); ++m)
    for (std::int64_t f = 0; f < selected.frames(); ++f) {
      selected.x(f, m) = recorded.x(first_frame + f, from[at(m)]);
      selected.state[selected.index(f, m)] = recorded.state[recorded.index(first_frame + f, from[at(m)])];
      if (!recorded.unfiltered_in_world.empty())
        std::copy_n(recorded.unfiltered_in_world.data() + 3 * recorded.index(first_frame + f, from[at(m)]), 3,
                    selected.unfiltered_in_world.data() + 3 * selected.index(f, m));
    }
  return selected;
}

}  // namespace kinemark::pipeline
