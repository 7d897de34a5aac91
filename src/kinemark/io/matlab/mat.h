// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/table.h"
#include "kinemark/data/trial.h"

// MAT files of MATLAB, versions 5 to 7. docs/formats/mat.md lists the fields.
namespace kinemark::io {

/// Whether a file that begins like this is a MAT file: version 5 to 7, or 7.3, which read_mat() refuses.
/// @param begin  the first 128 bytes, or all where there are fewer
[[nodiscard]] bool is_mat(std::string_view begin);

/// Read the trial of a file that write_mat() made (to the last bit) or that Qualisys Track Manager exported:
/// labelled and unidentified trajectories, what of them was filled, residuals, analog channels, forces as
/// channels, events. Of a file that holds neither, plain arrays are read, alone or in structs, as those of an
/// .npz are (read_npz()); `unit` is theirs. Code::not_supported for version 7.3 (HDF5), saying how to save
/// again; Code::usage for a unit beside a struct that states its own; Code::bad_input, with the field, for
/// one that is damaged, and for arrays that hold no recording; Code::io when it cannot be read. Memory: the
/// file, what is compressed in it (at most 256 MB and 64 times the file) and the trial.
[[nodiscard]] Result<data::Trial> read_mat(const std::filesystem::path& path, std::string_view unit = {});

/// The same from memory; `name` stands for the file in messages and in Trial::source.
[[nodiscard]] Result<data::Trial> parse_mat(std::span<const std::byte> bytes, std::string_view name,
                                            std::string_view unit = {});

/// Options of write_mat().
struct MatWriteOptions {
  bool force = false;  ///< replace a file that exists
  std::string set;     ///< of files that it belongs to (set_mark()); empty: none
};

/// Write a trial as one struct `trial`, compressed (MATLAB 7 and newer, Octave, scipy.io). Only groups of
/// parameters of a C3D file have no room. The same trial gives the same bytes. Code::bad_input: the trial is
/// not valid; Code::not_supported: it needs the 2 GB that a variable of these versions cannot have; Code::io
/// as OutputFile. Memory: three times the trial.
[[nodiscard]] Status write_mat(const std::filesystem::path& path, const data::Trial& trial,
                               const MatWriteOptions& options = {});

/// Write a table (of joint angles, torques, forces) as one struct `table`, likewise; it is not read back by
/// read_mat(). @param degrees  whether its rotational columns are in degrees
[[nodiscard]] Status write_mat(const std::filesystem::path& path, const data::Table& table, bool degrees,
                               const MatWriteOptions& options = {});

}  // namespace kinemark::io
