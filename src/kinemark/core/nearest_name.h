// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What a mistyped name may have been meant to be.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinemark {

/// Letters to insert, leave out, replace, or exchange with their neighbour to make `b` of `a`, each place
/// touched once (optimal string alignment; Damerau 1964). Compares bytes; cost is the product of both
/// lengths.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// Those of `names` that `word` was probably meant to be, nearest first and in their order where equally
/// near, `most` at most. Upper and lower case, '_' and '-' are the same. Near is a third of the word's
/// letters wrong, or one; or that one of both begins with the other, three letters at least.
[[nodiscard]] std::vector<std::string> nearest_names(std::string_view word,
                                                     std::span<const std::string> names,
                                                     std::size_t most = 3);

}  // namespace kinemark
