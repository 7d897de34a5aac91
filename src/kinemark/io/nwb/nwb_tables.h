// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Tables without samples, such as measures of many recordings, as DynamicTables of NWB. docs/formats/nwb.md
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/nwb/metadata.h"

namespace kinemark::io {

/// A column: texts or numbers, never both.
struct NwbColumn {
  std::string name;                ///< without a slash, unique in its table
  std::string description;         ///< what it holds, in which unit, and where its definition is from
  std::vector<std::string> texts;  ///< one a row
  std::vector<double> numbers;     ///< one a row; NaN where not determined
};

/// A DynamicTable.
struct NwbTable {
  std::string name;                ///< without a slash, unique in the file
  std::string description;         ///< one sentence
  std::vector<NwbColumn> columns;  ///< one or more, all of one length above 0
};

/// Write tables into the processing module `behavior` of a new file; it appears complete or not at all.
/// Code::bad_input for no table, one without rows, columns of different lengths, names that occur twice or
/// hold a slash, and metadata that NWB does not allow; Code::io: the disk; Code::not_supported without HDF5.
/// @param force   replace a file that exists
/// @param beside  null, or of no file: the tables alone. Else the file is a copy of that one, untouched, with
/// the
///                tables in a processing module of their own, in place of those that we put there before
/// @param module  its name
[[nodiscard]] Status write_nwb_tables(const std::filesystem::path& path, std::span<const NwbTable> tables,
                                      const NwbMetadata& metadata, bool force,
                                      const data::Beside* beside = nullptr,
                                      const std::string& module = "measures");

}  // namespace kinemark::io
