// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/c3d/byte_source.h"
#include "kinemark/io/recording/recording.h"

namespace kinemark::io::internal {

/// What an MCAP file is about, besides its messages.
struct McapSummary {
  std::string profile, library;       ///< of the header
  std::vector<std::string> warnings;  ///< what was not read of a file that is not whole
};

/// Gets one message and its channel; a failure ends the walk.
using TakeMessage = std::function<Status(const RecordingChannel& channel, const RecordingMessage& message)>;

/// Walks over the messages of any MCAP file, in the order of the file, those in chunks included. Messages do
/// not name the file. Code::bad_input for what is no MCAP or damaged; Code::not_supported for a compression
/// other than zstd and lz4.
[[nodiscard]] Result<McapSummary> walk_mcap(const ByteSource& source, const TakeMessage& take);

}  // namespace kinemark::io::internal
