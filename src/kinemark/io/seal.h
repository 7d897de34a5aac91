// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A text of a result holds the checksum of its own content, so that a digit that was changed later, by hand
// or by a disk, is found by whoever reads it. docs/formats/results.md says where it stands in each format.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kinemark::io {

inline constexpr std::string_view kSumKey = "kinemark_sum";     ///< of the line or member
inline constexpr std::string_view kNoSum = "0000000000000000";  ///< in the digits' place while it is summed

/// "kinemark_set=SET kinemark_sum=0000000000000000", for OutputFile::write_sealed(); empty when `set` is.
[[nodiscard]] std::string sealed_mark(std::string_view set);

/// Where the 16 lower-case hexadecimal digits behind a key (kSetKey, kSumKey) stand in a text, with "=", ":",
/// spaces and quotation marks between; npos where there are none.
[[nodiscard]] std::size_t find_mark(std::string_view text, std::string_view key);

/// What the sum in a text says of it.
enum class Seal {
  none,    ///< it holds no sum
  whole,   ///< it is as it was written
  broken,  ///< it was changed since
};

/// Compare a text, all of it, with the sum that it holds within its first 64 KB: XXH3 with 64 bits of its
/// bytes, the digits as zeros. O(bytes), at some 10 GB/s.
[[nodiscard]] Seal check_seal(std::string_view text);

/// The sentence about a broken seal, without the file's name.
[[nodiscard]] std::string broken_seal();

}  // namespace kinemark::io
