// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/reader.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

/// What `kinemark info` is asked to do.
struct InfoJob : JobSettings {
  std::filesystem::path file;
  double rate_hz = 0.0;  ///< of marker files that tell none; 0: not given, theirs stays unknown
};

/// Of a marker file (.c3d, .trc, .nwb, .csv, .v3d).
struct MarkerFileFacts {
  std::string format, units, software;  ///< as data::Trial has them
  std::int64_t points = 0, frames = 0;
  std::optional<double> rate_hz;  ///< none: the file does not tell it
  std::int64_t first_frame = 1, last_frame = 0;
  std::int64_t missing = 0;  ///< marker frames
  std::size_t analog_channels = 0;
  double analog_rate_hz = 0.0;
  std::size_t force_plates = 0, events = 0;
  std::vector<std::string> labels;
};

/// Of a table (.mot, .sto).
struct TableFacts {
  std::int64_t rows = 0;
  std::optional<double> first_time_s, last_time_s;  ///< none: no rows
  bool in_degrees = false;
  std::vector<std::string> labels;  ///< columns without the time
};

/// Of a body model (.osim).
struct ModelFacts {
  std::string name;
  std::size_t joints = 0, markers = 0, couplings = 0, point_constraints = 0;
  double mass_kg = 0.0;
  std::vector<std::string> labels;  ///< of the coordinates
  std::vector<std::string> body_names;
};

/// Of the counts in a recording.
struct CountsFacts {
  std::int64_t frames = 0;
  double rate_hz = 0.0, first_time_s = 0.0;
  std::string rig;
  bool dark_slot = false;
  std::int64_t saturated = 0, occluded = 0, lost = 0;  ///< sightings
  std::vector<std::string> cameras, labels;            ///< labels: of the LEDs
};

/// Of a recording (.mcap).
struct RecordingFacts {
  io::RecordingEnd end = io::RecordingEnd::closed;
  std::uint64_t bytes = 0;
  std::int64_t messages = 0;
  std::vector<std::string> channels, metadata;  ///< topics and names
  std::optional<CountsFacts> counts;            ///< when it holds any
};

struct InfoOutcome : JobOutcome {
  std::filesystem::path file;
  std::variant<MarkerFileFacts, TableFacts, ModelFacts, RecordingFacts> facts;
};

/// Read a file, by its ending, and say what it holds and what is odd about it. Writes nothing. Fails as the
/// reader of its format.
[[nodiscard]] Result<InfoOutcome> run_info(const InfoJob& job);

}  // namespace kinemark::pipeline
