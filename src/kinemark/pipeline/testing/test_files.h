// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A simulated recording in a folder, as a user would have it.
#pragma once

#include <filesystem>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/pipeline/simulate/simulate_subject_job.h"

namespace kinemark::pipeline::testing {

/// markers.c3d, markers.trc, model.osim, truth.mot, truth.trc of half a second of our human, 20 % gaps.
inline std::vector<std::filesystem::path> simulate_into(const std::filesystem::path& folder) {
  SimulateSubjectJob job;
  job.folder = folder;
  job.options.duration_s = 0.5;
  job.options.rate_hz = 60.0;
  job.options.dropout_random = 0.2;
  return run_simulate_subject(job).value().written;
}

/// Two markers, one of which nobody named, and an angle of a model, in three frames.
inline data::Trial trial_with_channel() {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"LASI", "*12"}, {.rate_hz = 100.0, .frames = 3});
  for (std::int64_t f = 0; f < 3; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      trial.markers.x(f, m) =
          Eigen::Vector3d(0.1, 0.2 + 0.01 * static_cast<double>(f), 1.0 + static_cast<double>(m));
      trial.markers.state[trial.markers.index(f, m)] = data::SampleState::measured;
    }
  trial.channels = {.names = {"LKneeAngles"},
                    .kinds = {data::ChannelKind::angle},
                    .units = {"deg"},
                    .rate_hz = 100.0,
                    .frames = 3,
                    .values = {}};
  for (int i = 0; i < 9; ++i) trial.channels.values.push_back(7.5 * i);
  return trial;
}

}  // namespace kinemark::pipeline::testing
