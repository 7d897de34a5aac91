// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

// Archives of NumPy. docs/formats/npz.md lists the arrays.
namespace kinemark::io {

/// Whether a file that begins like this is an archive of arrays: a ZIP whose first member is an .npy.
[[nodiscard]] bool is_npz(std::string_view begin);

/// Read markers of an archive that numpy.savez() or savez_compressed() wrote: one array of all positions
/// (frames x markers x 3, or another order that names and times settle) with an array of names, or an array
/// of frames x 3 for each marker under its name; a clock from times in s or a rate in Hz. The unit is the one
/// that the archive or `unit` says, else the one of m, cm and mm that makes the recording as large as a body,
/// with a warning. NaN is a missing sample; arrays that are none of these are named in a warning.
///
/// Code::bad_input or not_supported, with what the archive holds and what was expected. Memory: the file, its
/// largest array unpacked and twice the trial.
[[nodiscard]] Result<data::Trial> read_npz(const std::filesystem::path& path, std::string_view unit = {});

/// The same from memory; `name` stands for the file in messages and in Trial::source.
[[nodiscard]] Result<data::Trial> parse_npz(std::span<const std::byte> bytes, std::string_view name,
                                            std::string_view unit = {});

}  // namespace kinemark::io
