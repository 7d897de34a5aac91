// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/internal/segment_files.h"

#include <nlohmann/json.hpp>

#include "kinemark/pipeline/files/file_set.h"

namespace kinemark::pipeline::internal {

SegmentTables tables_of(const SegmentsOutcome& outcome, const data::Trial& recording) {
  const auto& motion = outcome.motion;
  SegmentTables out{.angles = series_of(motion),
                    .loads = series_of(outcome.loads),
                    .points = points_trial(motion, recording),
                    .whole = trial_with(motion, outcome.loads, recording),
                    .set = ""};
  SetDigest digest;
  digest.add("segments").add(outcome.inputs).add(series_csv(out.angles, motion.time));
  if (!out.loads.empty()) digest.add(series_csv(out.loads, motion.time));
  out.set = digest.hex();
  return out;
}

Result<std::vector<ResultFile>> list_files(const SegmentsJob& job, const SegmentTables& tables,
                                           const SegmentsOutcome& outcome, Staging& staging) {
  const auto& [angles, loads, points, whole, set] = tables;
  const auto& time = outcome.motion.time;
  const auto target = [&job](const char* name) { return job.output / name; };
  std::vector<ResultFile> made{
      table_file(target("angles.mot"), [&] { return series_table(angles, time, "angles"); }),
      table_file(target("angles_sd.sto"), [&] { return deviations_table(angles, time, "angles_sd"); }),
      text_file(target("angles.csv"), [&] { return series_csv(angles, time); }),
      marker_file(target("centres.csv"), points),
      marker_file(target("segments.c3d"), whole),
      json_file(target("segments.json"), [json = segments_outcome_json(outcome)] { return json; })};
  if (loads.empty()) return made;
  if (auto s = staging.add_in(job.output, {"loads.sto", "loads_sd.sto", "loads.csv"}); !s)
    return std::unexpected(s.error());
  made.push_back(table_file(target("loads.sto"), [&] { return series_table(loads, time, "loads"); }));
  made.push_back(
      table_file(target("loads_sd.sto"), [&] { return deviations_table(loads, time, "loads_sd"); }));
  made.push_back(text_file(target("loads.csv"), [&] { return series_csv(loads, time); }));
  return made;
}

}  // namespace kinemark::pipeline::internal
