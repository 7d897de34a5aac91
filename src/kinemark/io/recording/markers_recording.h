// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Positions of markers as a recording: one message a frame on the channel /markers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/recording/reader.h"
#include "kinemark/io/recording/writer.h"

namespace kinemark::io {

/// What a recording of markers knows before its first frame.
struct MarkersLayout {
  std::vector<std::string> names;  ///< M, unique
  double rate_hz = 0.0;            ///< nominal, of the frames
  double t0_s = 0.0;               ///< time of frame 0
  std::string source;              ///< where they come from: "sim:walk"
};

/// One frame of markers.
struct MarkersFrame {
  std::int64_t frame = 0;                    ///< in [0, 2^32); a step of more than 1 says that some were lost
  std::uint64_t log_time_ns = 0;             ///< when it came, ns since 1970
  std::span<const double> x_in_world;        ///< M x 3, m; NaN where there is none
  std::span<const data::SampleState> state;  ///< M
};

/// Records markers as they come; see RecordingWriter for what an acknowledged frame survives.
class MarkersWriter {
 public:
  /// Code::usage for names that are not unique and for a rate that is none.
  static Result<MarkersWriter> create(const std::filesystem::path& path, const MarkersLayout& layout,
                                      const RecordingOptions& options = {});
  /// Returns once the frame is acknowledged. Shapes are a contract.
  [[nodiscard]] Status push(const MarkersFrame& frame);
  /// End the recording with its summary; nothing may be pushed after it.
  [[nodiscard]] Status close() { return writer_.close(); }
  /// frames that a stop of this program cannot lose
  [[nodiscard]] std::int64_t acknowledged() const { return writer_.acknowledged(); }

 private:
  MarkersWriter(RecordingWriter writer, std::size_t markers)
      : writer_(std::move(writer)), markers_(markers) {}
  RecordingWriter writer_;
  std::size_t markers_;
  Bytes bytes_;
};

/// True for a channel that read_markers_recording() reads.
[[nodiscard]] bool carries_markers(const RecordingChannel& channel);

/// Everything that can be kept of a recording of markers, closed or not, damaged or not; `format` is
/// "recording". Frames that are missing in between are missing samples; every irregularity is a warning.
/// Code::not_supported when the recording holds no markers; Code::bad_input when their layout makes no sense.
/// Memory: the samples, and at most 16 times the file for frames that are lost.
[[nodiscard]] Result<data::Trial> read_markers_recording(RecordingReader reader);

}  // namespace kinemark::io
