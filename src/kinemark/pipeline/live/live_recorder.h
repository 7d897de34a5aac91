// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/markers_recording.h"
#include "kinemark/stream/stream.h"

namespace kinemark::pipeline {

/// Keeps every frame of a source in a file, as it comes.
class LiveRecorder final : public stream::Sink {
 public:
  /// Fails as io::MarkersWriter::create(). @param force  replace a file that is there
  [[nodiscard]] static Result<std::unique_ptr<LiveRecorder>> create(const std::filesystem::path& file,
                                                                    const stream::SourceFacts& facts,
                                                                    bool force);
  /// Fails as io::MarkersWriter::push().
  [[nodiscard]] Status push(const stream::Frame& frame) override;
  /// Closes the file.
  [[nodiscard]] Status finish() override;
  /// Frames that a stop of this program cannot lose. From any thread.
  [[nodiscard]] std::int64_t kept() const { return kept_; }

 private:
  explicit LiveRecorder(io::MarkersWriter writer) : writer_(std::move(writer)) {}
  io::MarkersWriter writer_;
  std::atomic<std::int64_t> kept_ = 0;
};

}  // namespace kinemark::pipeline
