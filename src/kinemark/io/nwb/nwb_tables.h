// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Tables without samples, such as measures of many recordings, as DynamicTables of NWB. docs/formats/nwb.md
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
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
/// @param force  replace a file that exists
[[nodiscard]] Status write_nwb_tables(const std::filesystem::path& path, std::span<const NwbTable> tables,
                                      const NwbMetadata& metadata, bool force);

}  // namespace kinemark::io
