// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// Read a TRC marker file ("track row column": tab-separated text, one row per frame).
///
/// Coordinates come out in metres whatever the file's unit (mm, cm, dm, m, in, ft; mm with a warning when it
/// names none). t0 is the first time written, first_frame the first Frame# written. The rate is the header's
/// when the time column agrees with it within rounding, else that of the time column (warning).
///
/// A sample is missing when one of its three cells is blank, NaN or infinite, or when its row ends before it.
/// So is an exact (0, 0, 0), which programs write that know no blank, except where the marker passes through
/// the origin: the frames just before and after the run of zeros (one of them suffices at an end of the
/// trial) hold the marker within 5 mm of the origin. Markers without any sample stay, all missing. Zeros and
/// such markers are reported in the warnings, and so is a header whose NumFrames or NumMarkers contradict the
/// rows and names; the rows and names are then used. A blank line ends the data.
///
/// Code::bad_input, with line and column, for text where a number belongs, a marker name that occurs twice,
/// an unknown unit, time that lies (docs/formats/what-is-believed.md), no row, half a header. Code::io when
/// it cannot be read. O(bytes); memory at most 16 times the text + 125 MB, also for hostile input; files full
/// of numbers about twice.
[[nodiscard]] Result<data::Trial> read_trc(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages and in Trial::source.
[[nodiscard]] Result<data::Trial> parse_trc(std::string_view text, std::string_view name);

/// Unit of the coordinates in a file.
enum class LengthUnit : std::uint8_t { millimetre, metre };

/// Options of write_trc().
struct TrcWriteOptions {
  bool force = false;                         ///< replace a file that exists
  std::string set;                            ///< of files that it belongs to (set_mark()); empty: none
  LengthUnit units = LengthUnit::millimetre;  ///< of the coordinates
  int decimals =
      -1;  ///< digits after the point of coordinates, 0 to 17; -1: the shortest that read back exactly
};

/// Write the markers of a trial as OpenSim reads them: missing and rejected samples are NaN, never 0 0 0, and
/// every row has 3 M + 2 cells. Analog data, events and states other than missing cannot be stored in a TRC
/// file. Code::bad_input when a marker name holds a tab or line end, or the trial is invalid; Code::io as
/// OutputFile.
[[nodiscard]] Status write_trc(const std::filesystem::path& path, const data::Trial& trial,
                               const TrcWriteOptions& options = {});

}  // namespace kinemark::io
