// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/foreign_number.h"

#include <algorithm>
#include <bit>

namespace kinemark::data {

std::optional<double> number_of(const ForeignParameter& parameter) {
  const bool one = std::ranges::all_of(parameter.dims, [](std::uint8_t size) { return size == 1; });
  const auto size = static_cast<std::size_t>(parameter.type == 4 ? 4 : 2);
  if (!one || (parameter.type != 4 && parameter.type != 2) || parameter.values.size() != size)
    return std::nullopt;
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < size; ++k) bits |= static_cast<std::uint32_t>(parameter.values[k]) << (8 * k);
  if (parameter.type == 2) return static_cast<std::int16_t>(bits);
  return std::bit_cast<float>(bits);
}

}  // namespace kinemark::data
