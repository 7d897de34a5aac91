// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace kinemark::studies {

/// How often the truth lies within one and two predicted standard deviations.
struct Coverage {
  std::int64_t within_1 = 0, within_2 = 0, all = 0;

  void add(double error, double sd) {
    within_1 += std::abs(error) <= sd;
    within_2 += std::abs(error) <= 2.0 * sd;
    ++all;
  }
  Coverage& operator+=(const Coverage& other) {
    within_1 += other.within_1;
    within_2 += other.within_2;
    all += other.all;
    return *this;
  }
  [[nodiscard]] double share_1() const { return static_cast<double>(within_1) / static_cast<double>(all); }
  [[nodiscard]] double share_2() const { return static_cast<double>(within_2) / static_cast<double>(all); }
};

}  // namespace kinemark::studies
