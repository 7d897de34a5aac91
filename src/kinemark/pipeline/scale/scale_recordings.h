// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The recordings that a model is scaled by: a motion, static trials.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/io/osim/scale_setup.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/scale/scale_job.h"

namespace kinemark::pipeline {

/// How many recordings a job reads. @param setup  null: none
[[nodiscard]] std::size_t count_recordings(const ScaleJob& job, const io::ScaleSetup* setup);

/// One of them as the job's options ask for it, in its own axes: frames are those of the motion, times are
/// left to the solver; names that a static trial beside a motion does not have are passed over.
/// @param count  count_recordings()
[[nodiscard]] Result<Recording> open_scale_recording(const ScaleJob& job, std::size_t count,
                                                     const std::filesystem::path& path);

/// All of them: the motion, the static trial of the job or else those of the setup that are of use there. A
/// file that the setup measures in and places by is read once.
/// @param found_in  checksum of the recording that the measured joints were found in; empty: not known
[[nodiscard]] Status read_scale_recordings(const ScaleJob& job, const io::ScaleSetup* setup,
                                           const std::string& found_in, workflow::ScaleInputs& inputs);

}  // namespace kinemark::pipeline
