// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/scale/scale_recordings.h"

#include <set>

#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

std::size_t count_recordings(const ScaleJob& job, const io::ScaleSetup* setup) {
  std::set<fs::path> files{job.static_trial, job.markers};
  if (setup != nullptr) files.insert({setup->scale_marker_file, setup->place_marker_file});
  files.erase(fs::path());
  return files.size();
}

Result<Recording> open_scale_recording(const ScaleJob& job, std::size_t count, const fs::path& path) {
  const RecordingSource source{.path = path,
                               .rate = count > 1 ? RateRule::where_needed : RateRule::given,
                               .turns = false,
                               .force = job.force,
                               .seed = job.seed,
                               .threads = job.threads};
  RecordingOptions options = job;
  options.selection = job.selection.without_times();
  auto recording = read_recording(source, options);
  if (!recording) return recording;
  if (path != job.markers && !job.markers.empty())
    options.selection = job.selection.names_in(recording->trial);
  if (auto s = prepare_recording(source, options, *recording); !s) return std::unexpected(s.error());
  if (!job.drops_doubtful(false)) return recording;
  if (auto s =
          workflow::leave_out_defects(recording->trial, false, recording->edits.swapped, recording->notes);
      !s)
    return fail_at(path.string(), s.error());
  return recording;
}

}  // namespace kinemark::pipeline
