// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Whether 16-bit analog samples are signed, from the samples themselves.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/c3d/byte_source.h"
#include "kinemark/io/c3d/layout.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {

/// Integer samples of 16 bits are signed or unsigned, as ANALOG:FORMAT says; it may be missing or wrong.
/// Where channels, read as it says, jump by the whole range between neighbours that are close to each other
/// in the other reading, and not the other way round, the other one is taken into `layout` and `warnings`
/// tell the jumps of both. Jumps of a signal that truly goes from one end of its range to the other, which
/// are larger than the steps around them in either reading, tell nothing. Floats, and samples of fewer bits
/// by ANALOG:BITS, stay as they are. Reads all frames once where samples are integers. `names` of the
/// channels. Code::io when reading fails.
[[nodiscard]] Status settle_analog_format(const ByteSource& source, const C3dParameters& parameters,
                                          const std::vector<std::string>& names, C3dLayout& layout,
                                          std::vector<std::string>& warnings);

}  // namespace kinemark::io
