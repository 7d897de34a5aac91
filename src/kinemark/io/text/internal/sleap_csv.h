// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What SLEAP writes as analysis CSV: a line for each animal in each frame.
#pragma once

#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/io/text/keypoints_csv.h"

namespace kinemark::io::internal {

/// Whether a text begins as one does: a line of labels with `frame_idx` and columns `NODE.x` and `NODE.y`.
[[nodiscard]] bool begins_sleap_csv(std::string_view begin);

/// Points of such a text, frame 0 first; frames without a line show nobody. Lines of one track in any order.
/// Code::bad_input with the line for what makes no sense; Code::not_supported for several tracks of which
/// none is chosen. Errors carry the line, not the file. Memory: at most 20 numbers a byte, or 100,000.
[[nodiscard]] Result<Keypoints> parse_sleap_csv(std::string_view text, const KeypointsOptions& options);

}  // namespace kinemark::io::internal
