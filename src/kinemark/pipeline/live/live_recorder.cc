// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/live/live_recorder.h"

#include <utility>

namespace kinemark::pipeline {

Result<std::unique_ptr<LiveRecorder>> LiveRecorder::create(const std::filesystem::path& file,
                                                           const stream::SourceFacts& facts, bool force) {
  auto writer = io::MarkersWriter::create(
      file, {.names = facts.markers, .rate_hz = facts.rate_hz, .t0_s = facts.t0_s, .source = facts.name},
      {.force = force});
  if (!writer) return std::unexpected(writer.error());
  return std::unique_ptr<LiveRecorder>(new LiveRecorder(std::move(*writer)));
}

Status LiveRecorder::push(const stream::Frame& frame) {
  auto status = writer_.push({.frame = frame.number,
                              .log_time_ns = frame.came_ns,
                              .x_in_world = frame.x_in_world,
                              .state = frame.state});
  kept_ = writer_.acknowledged();
  return status;
}

Status LiveRecorder::finish() { return writer_.close(); }

}  // namespace kinemark::pipeline
