// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// Options of read_markers().
struct MarkerReadOptions {
  double rate_hz = 0.0;   ///< of the frames, for files that store none (Visual3D text, AMC, tables without
                          ///< times); 0: not given
  std::string unit = {};  ///< of coordinates, for tables that state none: "mm"; empty: not given
  std::filesystem::path skeleton = {};  ///< .asf of an AMC; empty: the one beside it. Other formats have none
};

/// Read a marker file, C3D, TRC, NWB, CSV, Visual3D text (.v3d) or another file of the table
/// marker_formats(), in metres. The content decides which (a C3D has 0x50 in its second byte, a TRC begins
/// with PathFileType, an NWB file with the signature of HDF5); where the content is not conclusive the
/// extension decides, so that a damaged file gets the error message of its format. Of an NWB file
/// read_nwb() gives also derivatives and metadata, and read_v3d() the segment orientations
/// of a Visual3D text. Samples that no marker can have are rejected with a warning (reject_implausible()).
/// Code::not_supported for any other file, naming what is supported; Code::usage when a rate is given for a
/// file that stores its own; else as read_c3d(), read_trc(), read_nwb(), read_trajectories_csv() and
/// read_v3d().
[[nodiscard]] Result<data::Trial> read_markers(const std::filesystem::path& path,
                                               const MarkerReadOptions& options = {});

/// True for a file without a frame rate, by its content, or by its ending where that tells nothing:
/// read_markers() then needs one.
[[nodiscard]] bool needs_rate(const std::filesystem::path& path);

/// True for a file whose content, whatever its ending, says that it holds markers.
[[nodiscard]] bool begins_as_markers(const std::filesystem::path& path);

/// True for a file whose format need not state the unit of its coordinates, by its content: read_markers()
/// then heeds MarkerReadOptions::unit where the file states none.
[[nodiscard]] bool may_lack_unit(const std::filesystem::path& path);

/// Code::usage, naming what is supported, when write_markers() knows no format of that extension.
[[nodiscard]] Status check_marker_format(const std::filesystem::path& path);

/// Options of write_markers().
struct MarkerWriteOptions {
  bool force = false;     ///< replace a file that exists
  std::string set;        ///< of files that it belongs to (set_mark()); empty: none. A CSV cannot name one
  bool ndx_pose = false;  ///< of an NWB file: also as a pose of ndx-pose (NwbWriteOptions)
  std::vector<std::string>* lost = nullptr;  ///< gets what had no room, a sentence each; null: not wanted
};

/// Write a trial in the format of the extension: .c3d, .trc (millimetres), .nwb, .mat or .csv
/// (write_trajectories_csv()). Code::usage for any other; else as the writer of that format.
[[nodiscard]] Status write_markers(const std::filesystem::path& path, const data::Trial& trial,
                                   const MarkerWriteOptions& options);

/// The same. An existing file is replaced only with `force`.
/// @param set   as in MarkerWriteOptions
/// @param lost  as in MarkerWriteOptions
[[nodiscard]] Status write_markers(const std::filesystem::path& path, const data::Trial& trial, bool force,
                                   const std::string& set = {}, std::vector<std::string>* lost = nullptr);

}  // namespace kinemark::io
