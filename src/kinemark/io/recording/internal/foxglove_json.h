// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/recording.h"

namespace kinemark::io::internal {

/// Where a point was at a time.
struct TimedPosition {
  std::string point, frame;  ///< names of the point and of the axes that it is in
  std::int64_t time_ns = 0;  ///< on the clock of the messages
  Eigen::Vector3d x;         ///< m; NaN where the message does not tell
};

/// Whether the messages of a channel are JSON of a schema with positions.
[[nodiscard]] bool holds_positions(const RecordingChannel& channel);

/// The schemas that holds_positions() knows, for a sentence.
[[nodiscard]] std::string names_of_position_schemas();

/// Appends the positions of one message of such a channel. Code::bad_input for what is no JSON object.
[[nodiscard]] Status take_positions(const RecordingChannel& channel, const RecordingMessage& message,
                                    std::vector<TimedPosition>& out);

}  // namespace kinemark::io::internal
