// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Text exports of camera systems, each in the form of its vendor: Qualisys, OptiTrack, Vicon, PhaseSpace.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// A text export that read_vendor_export() knows.
enum class VendorExport : std::uint8_t {
  qtm,          ///< Qualisys Track Manager, TSV: 3D data with header
  motive,       ///< OptiTrack Motive, CSV, format versions 1.0 to 1.25
  vicon,        ///< Vicon Nexus or Workstation, CSV with a section of trajectories
  phasespace,   ///< PhaseSpace, CSV without a header: a time, then condition, x, y, z of each marker
  coordinates,  ///< a table that somebody wrote: a time, then columns such as "LASI_X", "LASI_Y", "LASI_Z"
};

/// Which of them a text is that begins like this (the labels of a table are in it); none: another text.
[[nodiscard]] std::optional<VendorExport> vendor_export_of(std::string_view begin);

/// Whether a text begins as a table of coordinates that has no column of times: its rate must be given.
[[nodiscard]] bool lacks_times(std::string_view begin);

/// Whether a text begins as a table of coordinates that Motek's D-Flow recorded.
[[nodiscard]] bool begins_d_flow(std::string_view begin);

/// Read the markers of such an export, in metres.
///
/// - QTM: lines of a keyword and its values up to MARKER_NAMES and TRAJECTORY_TYPES, then, where they were
/// exported,
///   a row of column names and columns of frames and times; millimetres; EVENT lines become events. Samples
///   that are exactly (0, 0, 0) are missing. Of a trajectory that QTM calls virtual or gap-filled all samples
///   are SampleState::interpolated; of mixed ones filled samples cannot be kept apart from measured ones,
///   which a warning says. 2D and 6DOF exports are Code::not_supported.
/// - Motive: columns of Type "Marker" and their positions, in the length unit of line 1. Rigid bodies, bones
/// and
///   their markers are solved, not measured, and are not read (warning).
/// - Vicon: the first section "Trajectories"; units from the row of units, else millimetres. Other sections,
/// and
///   columns that are not X, Y, Z, are not read (warning).
/// - PhaseSpace: a row a frame; times in seconds, millimetres. A sample whose condition is 0 or below is
/// missing. The
///   text names no markers: M000, M001 and so on, in the order of its columns (warning).
///
/// - Tables of coordinates: labels in one line ("LASI_X", "LASI.x", "LASI X (mm)"), or names above a line of
/// X, Y, Z;
///   commas, tabs or semicolons between cells. A column of time, in seconds, or `rate_hz`: then rows are
///   frames in a row, or those that a column of frame numbers says. The unit of length is that of the labels,
///   of a line of units below them, or `unit`; without any it is the one of m, cm and mm that makes the
///   recording as large as a body, with a warning, and Code::bad_input where several do. Other columns are
///   not read (warning). Those of D-Flow ("LASI.PosX") are in metres, and (0, 0, 0) in them is missing.
///
/// Blank cells and what is no finite number are missing samples. Names that stand twice get a number. Frame
/// numbers give first_frame; times come from the time column, else from frame numbers and the stated rate.
/// Axes stay as they are. Code::bad_input, with line and column, for what does not fit; Code::io when it
/// cannot be read. O(bytes); memory at most 16 times the text + 125 MB.
[[nodiscard]] Result<data::Trial> read_vendor_export(const std::filesystem::path& path, VendorExport which,
                                                     std::string_view unit = {}, double rate_hz = 0.0);

/// The same from memory; `name` stands for the file in messages and in Trial::source.
[[nodiscard]] Result<data::Trial> parse_vendor_export(std::string_view text, std::string_view name,
                                                      VendorExport which, std::string_view unit = {},
                                                      double rate_hz = 0.0);

}  // namespace kinemark::io
