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
  std::string unit = source.unit;
  if (!unit.empty() && !io::may_lack_unit(source.path)) {
    if (source.rate != RateRule::where_needed)
      return fail(
          Code::usage,
          fmt::format("{}: the file states the unit of its coordinates; one (--unit) is given only for "
                      "tables of coordinates that state none",
                      source.path.string()));
    unit.clear();
  }
  auto trial = io::read_markers(source.path, {.rate_hz = rate_hz, .unit = unit, .skeleton = source.skeleton});
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

}  // namespace kinemark::pipeline
