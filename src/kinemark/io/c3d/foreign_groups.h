// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/foreign_group.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {

/// The group that tells who recorded.
inline constexpr std::string_view kC3dRecorderGroup = "MANUFACTURER";

/// Groups that a copy keeps as they are: all but those whose content the trial holds or that would not be
/// true of the copy's samples. Of POINT, ANALOG, FORCE_PLATFORM, EVENT and TRIAL, which are written anew, the
/// parameters that are neither. At most 120 groups and 32 kB, so that there is room for our own; what is left
/// out for that is reported in `warnings`.
[[nodiscard]] std::vector<data::ForeignGroup> find_foreign_groups(const C3dParameters& parameters,
                                                                  std::vector<std::string>& warnings);

}  // namespace kinemark::io
