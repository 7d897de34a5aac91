// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a recorder writes beside the frames: docs/formats/recording.md.
#pragma once

#include <cstdint>
#include <string>

#include "kinemark/pipeline/acquire/recorder.h"

namespace kinemark::pipeline {

/// Record "gap": frames are missing from `first_frame` on, and who lost how many of them.
[[nodiscard]] io::RecordingMetadata gap_note(std::int64_t first_frame, std::int64_t by_device,
                                             std::int64_t here);
/// Record "acquisition_end". @param not_stopped  why the device did not stop; empty: it did
[[nodiscard]] io::RecordingMetadata end_note(const Recorded& end, const std::string& not_stopped);

}  // namespace kinemark::pipeline
