// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Markers as their file has them: rate, what it must hold, its record; and the samples that a result is
// about. recording.h makes of them what a job uses, marker_screening.h deals with what the recorder did.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/run_record.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/trial.h"

namespace kinemark::pipeline {

/// What becomes of a rate that was given for a marker file.
enum class RateRule : std::uint8_t {
  given,         ///< it is for a file that tells none; any other refuses it
  where_needed,  ///< a file that tells its own passes over it: one rate for several files
  or_unknown,    ///< as `given`, and without one the frames of a file that tells none are only counted
};

/// A marker file to read (.c3d, .trc, .nwb, .csv or .v3d), and what is asked of it.
struct MarkerSource {
  std::filesystem::path path;           ///< file to read
  double rate_hz = 0.0;                 ///< of a file that tells none (.v3d, .amc); 0: not given
  RateRule rate = RateRule::given;      ///< what becomes of rate_hz, and likewise of unit
  std::string unit = {};                ///< of a table that states none: "mm"; empty: not given
  std::filesystem::path skeleton = {};  ///< .asf of an .amc; empty: the one beside it
  bool needs_samples = false;           ///< refuse a file without markers or without frames
  bool record = false;                  ///< size and checksum, which reads the file once more
};

/// Markers as read, in metres.
struct MarkerInput {
  data::Trial trial;       ///< as read, m
  data::InputFile file;    ///< role "markers"; bytes and hash only when asked for
  bool rate_known = true;  ///< false: frames are counted at 1 Hz (RateRule::or_unknown)
};

/// Fails as io::read_markers(); Code::bad_input for a file without samples where they are needed.
[[nodiscard]] Result<MarkerInput> read_marker_input(const MarkerSource& source);

}  // namespace kinemark::pipeline
