// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Many normal numbers of a seed at once.
#pragma once

#include <cstdint>
#include <span>

namespace kinemark::math {

/// Standard normal numbers by Box and Muller, both of each pair: numbers 2 p and 2 p + 1 come from draws 2 p
/// + 1 and 2 p + 2 of the stream, counted from 1 (core/random.h), so that any part of a stream can be made
/// alone. Logarithm, sine and cosine by their series, so that all processors give the same bits. Cost: 3 ns
/// each.
/// @param first  number of the first one in its stream, even, 0 or more
void fill_normals(std::uint64_t seed, std::uint64_t stream, std::int64_t first, std::span<double> out);

/// Natural logarithms of numbers above 0 that are normal in the sense of IEEE 754, in place; within 1e-15 of
/// the value or of 1, whichever is more. Cost: 1 ns each.
void logarithms(std::span<double> values);

}  // namespace kinemark::math
