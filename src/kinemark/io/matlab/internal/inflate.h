// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"

namespace kinemark::io::internal {

/// The first bytes of a zlib stream, as many as `out` holds; fewer make a failure, and so does damage.
[[nodiscard]] Status inflate_start(std::span<const std::byte> packed, std::span<std::byte> out);

/// The first `size` bytes of a zlib stream, as inflate_start(); nothing is allocated that the stream cannot
/// fill.
[[nodiscard]] Result<Array<std::byte>> inflate_all(std::span<const std::byte> packed, std::size_t size);

/// A zlib stream of `bytes`.
[[nodiscard]] Array<std::byte> deflate_all(std::span<const std::byte> bytes);

}  // namespace kinemark::io::internal
