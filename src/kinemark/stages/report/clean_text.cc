// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <vector>

#include "kinemark/stages/report/internal/clean_text.h"

namespace kinemark::report::internal {

using data::SampleState;

std::uint8_t state_rank(SampleState state) {
  switch (state) {
    case SampleState::measured:
      return 0;
    case SampleState::upsampled:
      return 1;
    case SampleState::interpolated:
      return 2;
    case SampleState::model_filled:
      return 3;
    case SampleState::missing:
      return 4;
    case SampleState::rejected:
      return 5;
  }
  return 4;
}

std::string how_filled(const data::GapAccount& gap) {
  if (!gap.filled) return "";
  std::vector<std::string> parts;
  for (const data::GapWeight& w : gap.weights)
    if (w.weight >= 0.005) parts.push_back(fmt::format("{:.0f} % {}", 100.0 * w.weight, w.name));
  if (gap.weights.size() < 2 || parts.empty()) return gap.method;
  return fmt::format("{}: {}", gap.method, fmt::join(parts, "; "));
}

double length_s(const data::GapAccount& gap, const TimeBase& time) {
  return static_cast<double>(gap.frames()) / time.rate_hz;
}

}  // namespace kinemark::report::internal
