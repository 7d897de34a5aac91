// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording as its files have it: markers with their rate, forces, journal of edits, and the record of each
// file. pipeline/files/recording.h makes of it what a job uses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/recording.h"
#include "kinemark/data/run_record.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/input/journal_input.h"

namespace kinemark::io {

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

/// Fails as read_markers(); Code::bad_input for a file without samples where they are needed.
[[nodiscard]] Result<MarkerInput> read_marker_input(const MarkerSource& source);

/// Forces that are wanted of a recording.
struct ForcesSource {
  bool wanted = false;              ///< else no plate is looked at
  std::filesystem::path file = {};  ///< that holds them; empty: the recording's own plates
  double contact_force_n = 0.0;     ///< below which a plate is empty (PlateOptions); 0: never
};

/// A recording, and the files that it is of.
struct RecordingInput : data::Recording {
  data::InputFile file;                 ///< as MarkerInput::file
  std::vector<data::InputFile> forces;  ///< files of ForcesSource::file, role "forces"
  Journal journal;                      ///< not applied yet
};

/// Markers, journal and forces on the frames of the markers, one after the other. Plates that are there and
/// cannot be read are the recording's `plates_fault`. Fails as read_marker_input(), read_journal() and
/// read_external_forces().
/// @param edits  as EditsSource::edits
[[nodiscard]] Result<RecordingInput> read_recording(const MarkerSource& markers, const ForcesSource& forces,
                                                    const std::filesystem::path& edits,
                                                    bool force_edits = false);

/// The files that this reads: the recording's own, the skeleton of an .amc, the sidecars of a _motion.tsv,
/// and the journal, whether it is there or not.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const std::filesystem::path& recording,
                                                          const std::filesystem::path& edits);

}  // namespace kinemark::io
