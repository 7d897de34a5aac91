// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/io/matlab/mat.h"

namespace kinemark::io::internal {

/// Bytes that a variable of a file of these versions may have.
constexpr std::size_t kMostVariableBytes = 0x7FFFFFFF;

/// Write a file of one variable, compressed; `bytes` is its array with a name, of kMostVariableBytes at most
/// (else a ContractError). Code::io as OutputFile.
[[nodiscard]] Status write_mat_file(const std::filesystem::path& path, const std::string& bytes,
                                    const MatWriteOptions& options);

}  // namespace kinemark::io::internal
