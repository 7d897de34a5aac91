// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/interval_refits.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace kinemark::data {
namespace {

constexpr std::int64_t kLeastRefits = 39;  // below, mean and deviation of the refits are too uncertain
constexpr double kRounding = 1e-6;         // 2 / (1 - 0.95) is not quite 40

bool is_level(double level) { return level > 0.5 && level <= kMostLevel; }

}  // namespace

std::int64_t least_refits(double level) {
  if (!is_level(level)) return 0;
  return std::max<std::int64_t>(kLeastRefits, std::llround(std::ceil(2.0 / (1.0 - level) - 1.0 - kRounding)));
}

Status check_interval_refits(std::int64_t refits, double level) {
  if (!is_level(level))
    return fail(Code::usage,
                fmt::format("intervals of level {}; need one above 0.5 and at most {:g}", level, kMostLevel));
  if (const auto least = least_refits(level); refits != 0 && refits < least)
    return fail(Code::usage, fmt::format("{} refits; need 0 (no intervals) or at least {} for intervals of "
                                         "level {:g}",
                                         refits, least, level));
  return {};
}

}  // namespace kinemark::data
