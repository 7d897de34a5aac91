// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Force plates of a recording.
#pragma once

#include <filesystem>
#include <optional>

#include "kinemark/data/trial.h"
#include "kinemark/data/wrenches.h"

namespace kinemark::pipeline {

/// Forces of the plates of a .c3d on the trial's frames, which may be a part of the file's, not cut off at a
/// threshold; none where there are none that can be read.
[[nodiscard]] std::optional<data::Wrenches> plates_of(const std::filesystem::path& path,
                                                      const data::Trial& trial);

}  // namespace kinemark::pipeline
