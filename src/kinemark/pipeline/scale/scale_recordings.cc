// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/scale/scale_recordings.h"

#include <optional>
#include <set>
#include <utility>

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// One recording, or none where no file is named.
struct TrialReader {
  const ScaleJob& job;
  std::size_t count;            ///< count_recordings()
  const std::string& found_in;  ///< checksum

  Status read(const fs::path& path, std::optional<workflow::ScaleTrial>& trial) const {
    if (path.empty()) return {};
    auto recording = open_scale_recording(job, count, path);
    if (!recording) return std::unexpected(recording.error());
    const auto hash = std::move(recording->file.hash);
    trial = workflow::ScaleTrial{.recording = std::move(*recording),
                                 .name = path.filename().string(),
                                 .where = path.string(),
                                 .holds_joints = !found_in.empty() && hash == found_in};
    return {};
  }
};

}  // namespace

std::size_t count_recordings(const ScaleJob& job, const io::ScaleSetup* setup) {
  std::set<fs::path> files{job.static_trial, job.markers};
  if (setup != nullptr) files.insert({setup->scale_marker_file, setup->place_marker_file});
  files.erase(fs::path());
  return files.size();
}

Result<Recording> open_scale_recording(const ScaleJob& job, std::size_t count, const fs::path& path) {
  const bool moves = path == job.markers;  // static trials are judged by a gate of their own
  const RecordingSource source{.path = path,
                               .rate = count > 1 ? io::RateRule::where_needed : io::RateRule::given,
                               .record = !job.joints.empty(),
                               .facts = {.sides = moves, .pairs = moves},
                               .one_time = true,
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
  return recording;
}

Status read_scale_recordings(const ScaleJob& job, const io::ScaleSetup* setup, const std::string& found_in,
                             workflow::ScaleInputs& inputs) {
  const TrialReader reader{.job = job, .count = count_recordings(job, setup), .found_in = found_in};
  if (auto s = reader.read(job.markers, inputs.motion); !s) return s;
  if (setup == nullptr || !job.static_trial.empty()) return reader.read(job.static_trial, inputs.still);
  const bool wants_place = setup->place, wants_sizes = setup->recipe.measures();
  const auto &measured = setup->scale_marker_file, &placed = setup->place_marker_file;
  if (wants_sizes && !(wants_place && measured == placed))
    if (auto s = reader.read(measured, inputs.measured); !s) return s;
  if (!wants_place) return {};
  return reader.read(placed, inputs.still);
}

}  // namespace kinemark::pipeline
