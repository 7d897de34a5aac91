// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The arrays of VTK's XML files: words, or bytes as base64 or raw, packed by zlib or not.
#pragma once

#include <pugixml.hpp>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io::internal {

/// What a whole file says of its arrays.
struct VtkFile {
  bool wide_headers = false;  ///< numbers ahead of bytes have 64 bits, else 32
  bool packed = false;        ///< by zlib
  bool appended_raw = false;  ///< what is appended is bytes, else base64
  std::string_view appended;  ///< behind its "_"; empty: nothing
};

/// Header of a file: what its attributes say. Code::not_supported for big-endian bytes and other packing.
[[nodiscard]] Result<VtkFile> vtk_file_of(pugi::xml_node root);

/// The numbers of a DataArray, `most` at most. One sentence where they cannot be read.
[[nodiscard]] Result<std::vector<double>> read_vtk_array(const VtkFile& file, pugi::xml_node array,
                                                         std::size_t most);

}  // namespace kinemark::io::internal
